"""Reads what the other renderers need of a binary glTF scene: triangles in the world at a frame, surfaces, the camera.

Only what Blender exports for rigid scenes is understood: one primitive or more a mesh, float positions, tracks of translation,
rotation and scale with linear keys. Metres, y up, linear radiance.
"""
import json
import pathlib
import struct
from dataclasses import dataclass

import numpy as np

TYPES = {5121: "u1", 5123: "<u2", 5125: "<u4", 5126: "<f4"}
COUNTS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}


@dataclass
class Surface:
    name: str
    triangles: np.ndarray  # (n, 3, 3): triangle, corner, coordinate
    reflectance: np.ndarray
    radiance: np.ndarray  # of a lamp; else 0


@dataclass
class Camera:
    position: np.ndarray
    right: np.ndarray
    up: np.ndarray
    forward: np.ndarray
    vertical_angle: float  # radians


class Scene:
    frames_per_second = 24

    def __init__(self, path):
        blob = pathlib.Path(path).read_bytes()
        (length,) = struct.unpack_from("<I", blob, 12)
        self.document, self.binary = json.loads(blob[20:20 + length]), blob[28 + length:]
        self.tracks = {}
        for animation in self.document.get("animations", []):
            for channel in animation["channels"]:
                sampler, target = animation["samplers"][channel["sampler"]], channel["target"]
                self.tracks[target["node"], target["path"]] = (
                    self.values(sampler["input"])[:, 0], self.values(sampler["output"]))

    def values(self, accessor):
        a = self.document["accessors"][accessor]
        view = self.document["bufferViews"][a["bufferView"]]
        width = COUNTS[a["type"]]
        start = view.get("byteOffset", 0) + a.get("byteOffset", 0)
        flat = np.frombuffer(self.binary, TYPES[a["componentType"]], a["count"] * width, start)
        return flat.reshape(-1, width).astype(np.float64 if a["componentType"] == 5126 else np.int64)

    def property(self, node, name, otherwise, time_s):
        if (node, name) not in self.tracks:
            return np.array(self.document["nodes"][node].get(name, otherwise), dtype=np.float64)
        times, keys = self.tracks[node, name]
        value = np.array([np.interp(time_s, times, keys[:, k]) for k in range(keys.shape[1])])
        return value / np.linalg.norm(value) if name == "rotation" else value

    def matrix(self, node, time_s):
        if "matrix" in self.document["nodes"][node]:
            return np.array(self.document["nodes"][node]["matrix"]).reshape(4, 4).T
        x, y, z, w = self.property(node, "rotation", [0, 0, 0, 1], time_s)
        turn = np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                         [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                         [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])
        out = np.eye(4)
        out[:3, :3] = turn * self.property(node, "scale", [1, 1, 1], time_s)
        out[:3, 3] = self.property(node, "translation", [0, 0, 0], time_s)
        return out

    def placed_nodes(self, time_s):
        """(node, matrix to the world) of all nodes of the scene."""
        roots = self.document["scenes"][self.document.get("scene", 0)]["nodes"]
        todo = [(root, np.eye(4)) for root in roots]
        while todo:
            node, parent = todo.pop(0)
            here = parent @ self.matrix(node, time_s)
            yield node, here
            todo += [(child, here) for child in self.document["nodes"][node].get("children", [])]

    def surfaces(self, frame):
        """Surfaces at a frame; one a primitive."""
        for node, here in self.placed_nodes(frame / self.frames_per_second):
            description = self.document["nodes"][node]
            if "mesh" not in description:
                continue
            for primitive in self.document["meshes"][description["mesh"]]["primitives"]:
                corners = self.values(primitive["attributes"]["POSITION"]) @ here[:3, :3].T + here[:3, 3]
                order = self.values(primitive["indices"])[:, 0]
                material = self.document["materials"][primitive["material"]]
                colour = material["pbrMetallicRoughness"].get("baseColorFactor", [1, 1, 1, 1])[:3]
                strength = material.get("extensions", {}).get("KHR_materials_emissive_strength", {}).get("emissiveStrength", 1)
                yield Surface(description["name"], corners[order].reshape(-1, 3, 3), np.array(colour),
                              strength * np.array(material.get("emissiveFactor", [0, 0, 0]), dtype=np.float64))

    def camera(self, frame):
        for node, here in self.placed_nodes(frame / self.frames_per_second):
            description = self.document["nodes"][node]
            if "camera" in description:
                angle = self.document["cameras"][description["camera"]]["perspective"]["yfov"]
                return Camera(here[:3, 3], here[:3, 0], here[:3, 1], -here[:3, 2], angle)
        raise ValueError("the scene has no camera")
