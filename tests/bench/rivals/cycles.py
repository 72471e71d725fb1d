"""Renders frames of a glTF scene with Cycles; runs inside Blender, in one process for all frames.

usage: blender -b --factory-startup --python-exit-code 1 --python cycles.py -- JOB.json

JOB.json: {"scene", "frames": [n…], "samples", "seed": "fixed" | "changing", "edge",
"vertical_angle" (of the camera, radians), "folder", "rows"}. Writes
folder/frame_NNNN.exr, linear radiance, and appends one JSON line a frame to `rows`: {"frame", "cpu_seconds",
"positions"}, CPU of this process while that frame was rendered and written, and before them one line
{"startup_cpu_seconds"}: starting, importing and converting. All surfaces become diffuse with the base colour as reflectance; a mesh that
emits must be a rectangle and becomes an area lamp half a millimetre before its now black self, because this Cycles renders mesh
lamps too dark at grazing angles.
"""
import json
import pathlib
import resource
import sys

import bpy
import numpy
from mathutils import Matrix

LAMP_GAP_M = 0.0005


def cpu_seconds():
    used = resource.getrusage(resource.RUSAGE_SELF)
    return used.ru_utime + used.ru_stime


def read_scene(path):
    numpy.bool = bool  # the importer of Blender 3.4 uses a name that NumPy has dropped since
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=str(path))
    for moved in (o for o in bpy.context.scene.objects if o.animation_data):
        if moved.animation_data.nla_tracks:  # of several animations the importer plays the first one only
            moved.animation_data.action = moved.animation_data.nla_tracks[0].strips[0].action
            for track in moved.animation_data.nla_tracks:
                track.mute = True


def shader(material):
    """Reflectance and emitted radiance of an imported material."""
    node = material.node_tree.nodes["Principled BSDF"]
    strength = node.inputs["Emission Strength"].default_value
    return (tuple(node.inputs["Base Color"].default_value[:3]),
            tuple(strength * c for c in node.inputs["Emission"].default_value[:3]))


def make_diffuse(material):
    reflectance, _ = shader(material)
    tree = material.node_tree
    tree.nodes.clear()
    bsdf, out = tree.nodes.new("ShaderNodeBsdfDiffuse"), tree.nodes.new("ShaderNodeOutputMaterial")
    bsdf.inputs["Color"].default_value = (*reflectance, 1)
    bsdf.inputs["Roughness"].default_value = 0
    tree.links.new(bsdf.outputs["BSDF"], out.inputs["Surface"])


def rectangle(mesh_object):
    """Centre, two edges and normal of a mesh that is one rectangle, in the world."""
    corners = [mesh_object.matrix_world @ v.co for v in mesh_object.data.vertices]
    first, *others = corners
    near, also_near, far = sorted(others, key=lambda p: (p - first).length) if len(corners) == 4 else sys.exit(
        f"cycles.py: lamp {mesh_object.name} is no rectangle")
    u, v = near - first, also_near - first
    if (first + u + v - far).length > 1e-4 or abs(u.dot(v)) > 1e-4:
        sys.exit(f"cycles.py: lamp {mesh_object.name} is no rectangle")
    normal = (mesh_object.matrix_world.to_3x3() @ mesh_object.data.polygons[0].normal).normalized()
    return (first + far) / 2, u, v, normal


def add_area_lamp(mesh_object, radiance):
    centre, u, v, normal = rectangle(mesh_object)
    if u.cross(v).dot(normal) > 0:  # a lamp shines along its own −z
        u, v = v, u
    lamp = bpy.data.lights.new(mesh_object.name + "_lamp", "AREA")
    lamp.shape, lamp.size, lamp.size_y = "RECTANGLE", u.length, v.length
    peak = max(radiance)
    lamp.color = [c / peak for c in radiance]
    lamp.energy = 4 * u.length * v.length * peak  # Cycles divides by the area and by 4, not by π
    placed = bpy.data.objects.new(lamp.name, lamp)
    axes = Matrix((u.normalized(), v.normalized(), -normal)).transposed().to_4x4()
    placed.matrix_world = Matrix.Translation(centre + LAMP_GAP_M * normal) @ axes
    bpy.context.scene.collection.objects.link(placed)


def convert():
    lamps = [(o, shader(o.active_material)[1]) for o in bpy.context.scene.objects
             if o.type == "MESH" and max(shader(o.active_material)[1]) > 0]
    for material in bpy.data.materials:
        if material.use_nodes and "Principled BSDF" in material.node_tree.nodes:
            make_diffuse(material)
    for mesh_object, radiance in lamps:
        add_area_lamp(mesh_object, radiance)
    for mesh in bpy.data.meshes:
        mesh.use_auto_smooth = False
        mesh.polygons.foreach_set("use_smooth", [False] * len(mesh.polygons))


def set_up(job):
    scene = bpy.context.scene
    camera = next(o for o in scene.objects if o.type == "CAMERA")
    camera.data.sensor_fit, camera.data.angle_y = "VERTICAL", job["vertical_angle"]
    scene.camera = camera
    scene.world = bpy.data.worlds.new("black")
    scene.world.color = (0, 0, 0)
    render, cycles = scene.render, scene.cycles
    render.engine = "CYCLES"
    render.resolution_x = render.resolution_y = job["edge"]
    render.resolution_percentage = 100
    render.threads_mode, render.threads = "FIXED", 1
    render.use_persistent_data = True
    render.use_compositing = render.use_sequencer = False
    settings = render.image_settings
    settings.file_format, settings.color_mode, settings.color_depth = "OPEN_EXR", "RGB", "32"
    cycles.samples, cycles.seed = job["samples"], 1
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.pixel_filter_type = "BOX"
    cycles.max_bounces = cycles.diffuse_bounces = 64
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0
    cycles.light_sampling_threshold = 0
    return scene


def positions(scene):
    return {o.name: [round(x, 5) for x in o.matrix_world.translation] for o in scene.objects if o.animation_data}


def main(job):
    read_scene(job["scene"])
    convert()
    scene = set_up(job)
    started = cpu_seconds()
    with open(job["rows"], "a", encoding="utf-8") as rows:
        print(json.dumps({"startup_cpu_seconds": round(started, 3)}), file=rows, flush=True)
        for frame in job["frames"]:
            scene.frame_set(frame)
            if job["seed"] == "changing":
                scene.cycles.seed = 1 + frame
            scene.render.filepath = str(pathlib.Path(job["folder"]) / f"frame_{frame:04}.exr")
            before = cpu_seconds()
            bpy.ops.render.render(write_still=True)
            spent = cpu_seconds() - before
            print(json.dumps({"frame": frame, "cpu_seconds": round(spent, 3), "positions": positions(scene)}), file=rows, flush=True)


main(json.loads(pathlib.Path(sys.argv[-1]).read_text(encoding="utf-8")))
