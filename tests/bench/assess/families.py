"""Families of scenes with one knob each, generated from seeds and written as Afterglow's own JSON.

A scene is a closed room with a lamp under its ceiling, furniture along two walls, and things: boxes or balls, every other one
of which walks along the aisle between the furniture while the others fly through the room, all from one random place to the next at
one speed. Things that do not move stand where their way would begin.

usage: families.py FAMILY VALUE [SEED] > scene.json
"""
import dataclasses
import json
import math
import random
import sys

frames_per_second = 24


@dataclasses.dataclass(frozen=True)
class Room:
    """What a scene is made of."""
    seed: int = 1
    size_m: tuple = (8.0, 3.0, 6.0)
    things: int = 3
    moving: int = 3            # how many of the things move
    faces: int = 12            # of a thing: 12 is a box; 320 and 5120 are balls
    speed_m_per_s: float = 1.2
    reflectance: float = 0.6   # of the walls, and about that of what stands in the room
    pieces: int = 12           # of furniture
    screens: int = 0           # walls across the room, each hiding what is behind from the lamp
    lamps: int = 1
    lamp_edge_m: float = 1.2
    camera: str = "rests"      # "rests", "creeps" a millimetre or "walks" two metres
    frames: int = 24           # that paths last for


def box(name, low, high, material):
    return {"name": name, "translation": [(a + b) / 2 for a, b in zip(low, high)],
            "geometry": {"box": {"size": [b - a for a, b in zip(low, high)]}, "material": material}}


def ball(radius_m, faces):
    """An icosahedron whose faces are divided until there are as many."""
    t = (1 + math.sqrt(5)) / 2
    corners = [(-1, t, 0), (1, t, 0), (-1, -t, 0), (1, -t, 0), (0, -1, t), (0, 1, t), (0, -1, -t), (0, 1, -t),
               (t, 0, -1), (t, 0, 1), (-t, 0, -1), (-t, 0, 1)]
    triangles = [(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4), (11, 10, 2), (10, 7, 6),
                 (7, 1, 8), (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8), (3, 8, 9), (4, 9, 5), (2, 4, 11), (6, 2, 10), (8, 6, 7),
                 (9, 8, 1)]

    def unit(v):
        length = math.sqrt(sum(c * c for c in v))
        return tuple(c / length for c in v)

    corners, middles = [unit(c) for c in corners], {}

    def middle(a, b):
        key = (min(a, b), max(a, b))
        if key not in middles:
            middles[key] = len(corners)
            corners.append(unit([p + q for p, q in zip(corners[a], corners[b])]))
        return middles[key]

    while len(triangles) < faces:
        divided = []
        for a, b, c in triangles:
            ab, bc, ca = middle(a, b), middle(b, c), middle(c, a)
            divided += [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
        triangles = divided
    return {"positions": [[round(radius_m * c, 6) for c in v] for v in corners], "triangles": [list(f) for f in triangles]}


def way(chance, low, high, speed_m_per_s, seconds):
    """Keys from one random place to the next at one speed; the last one may lie past the end."""
    def place():
        return [round(chance.uniform(a, b), 4) for a, b in zip(low, high)]

    keys = [[0.0, *place()]]
    while keys[-1][0] < seconds:
        there = place()
        length_m = math.dist(keys[-1][1:], there)
        if length_m > 0.05:
            keys.append([round(keys[-1][0] + length_m / speed_m_per_s, 6), *there])
    return keys


def furniture(chance, room):
    """Pieces along both long walls that do not touch one another; the aisle between stays free."""
    width, _, depth = room.size_m
    nodes, taken = [], []
    for k in range(room.pieces):
        for _ in range(40):
            size = [chance.uniform(0.3, 1.0), chance.uniform(0.2, 1.3), chance.uniform(0.3, 1.0)]
            x = chance.uniform(0.1, width - 0.1 - size[0])
            z = chance.uniform(0.1, 0.38 * depth - size[2]) if k % 2 else chance.uniform(0.62 * depth, depth - 0.1 - size[2])
            if all(x > b + 0.05 or x + size[0] < a - 0.05 or z > d + 0.05 or z + size[2] < c - 0.05 for a, b, c, d in taken):
                taken.append((x, x + size[0], z, z + size[2]))
                nodes.append(box(f"piece {k}", [x, 0.01, z], [x + size[0], 0.01 + size[1], z + size[2]], f"paint {k % 6}"))
                break
    return nodes


def screens(room):
    """Thin walls from near the ceiling down, in turns from either long wall, two thirds across."""
    width, height, depth = room.size_m
    out = []
    for k in range(room.screens):
        x = width * (k + 1) / (room.screens + 1)
        z = (0.02, 0.64 * depth) if k % 2 else (0.36 * depth, depth - 0.02)
        out.append(box(f"screen {k}", [x, 0.02, z[0]], [x + 0.05, height - 0.25, z[1]], "wall"))
    return out


def things(chance, room):
    """Nodes and tracks of what may move."""
    width, height, depth = room.size_m
    nodes, tracks = [], []
    round_thing = ball(0.28, room.faces) if room.faces > 12 else None
    for k in range(room.things):
        walks = k % 2 == 0
        half = (0.2, 0.75, 0.2) if walks and not round_thing else (0.22, 0.22, 0.22)
        clear = 0.32 if round_thing else max(half[0], half[2]) + 0.05
        low = [clear, half[1] + 0.01, 0.42 * depth + clear] if walks else [clear, 0.55 * height, clear]
        high = [0.85 * width, half[1] + 0.01, 0.58 * depth - clear] if walks else [0.8 * width, 0.85 * height - clear, 0.78 * depth]
        if round_thing and walks:
            low[1] = high[1] = 0.3
        low, high = [min(a, b) for a, b in zip(low, high)], [max(a, b) for a, b in zip(low, high)]
        keys = way(chance, low, high, room.speed_m_per_s, room.frames / frames_per_second)
        material = f"paint {k % 6}"
        node = {"name": f"thing {k}", "translation": keys[0][1:]}
        node["geometry"] = ({**round_thing, "material": material} if round_thing else
                            {"box": {"size": [2 * h for h in half]}, "material": material})
        nodes.append(node)
        if k < room.moving:
            tracks.append({"node": node["name"], "translation": keys})
    return nodes, tracks


def lamps(room):
    width, height, depth = room.size_m
    edge, out = room.lamp_edge_m, []
    for k in range(room.lamps):
        x, z = width * (k + 0.5) / room.lamps, 0.5 * depth
        out.append({"name": f"lamp {k}", "translation": [x, height - 0.03, z], "rotation": [1, 0, 0, 180],
                    "geometry": {"quad": {"size": [edge, 0.75 * edge]}, "material": "lamp"}})
    return out


def camera_track(room, position):
    move_m = {"rests": 0, "creeps": -1e-3, "walks": -2}[room.camera]
    if not move_m:
        return []
    there = [position[0] + move_m, position[1], position[2]]
    return [{"camera": "camera", "position": [[0, *position], [room.frames / frames_per_second, *there]]}]


def scene(room):
    """The document."""
    chance = random.Random(room.seed)
    width, height, depth = room.size_m
    paints = [{"name": f"paint {k}", "reflectance": [round(min(0.95, room.reflectance * chance.uniform(0.6, 1.25)), 4)
                                                     for _ in range(3)]} for k in range(6)]
    radiance = 12 * (1.2 / room.lamp_edge_m) ** 2 / room.lamps
    materials = [{"name": "wall", "reflectance": room.reflectance},
                 {"name": "lamp", "reflectance": 0, "emission": [radiance, 0.9 * radiance, 0.75 * radiance]}, *paints]
    standing = furniture(chance, room)
    moving, tracks = things(chance, room)
    position = [width - 0.4, 0.7 * height, depth - 0.4]
    return {"afterglow": 1, "name": "room", "frames_per_second": frames_per_second, "materials": materials,
            "nodes": [box("room", [0, 0, 0], [width, height, depth], "wall"), *lamps(room), *standing, *screens(room), *moving],
            "cameras": [{"name": "camera", "position": position, "look_at": [0.3 * width, 0.3 * height, 0.35 * depth],
                         "vertical_angle_deg": 60}],
            "tracks": tracks + camera_track(room, position)}


# What a knob's value makes of a room, and the values that are tried, the first form's first.
families = {
    "actors": (lambda room, n: dataclasses.replace(room, things=n, moving=n), [1, 3, 10, 30, 100]),
    "faces": (lambda room, n: dataclasses.replace(room, faces=n), [12, 320, 5120]),
    "speed": (lambda room, v: dataclasses.replace(room, speed_m_per_s=v), [0.1, 0.3, 1.2, 5, 20]),
    "moving": (lambda room, n: dataclasses.replace(room, things=24, moving=n, pieces=0), [0, 1, 3, 6, 12, 24]),
    "reflectance": (lambda room, r: dataclasses.replace(room, reflectance=r), [0.2, 0.4, 0.6, 0.8, 0.9]),
    "occlusion": (lambda room, n: dataclasses.replace(room, screens=n), [0, 1, 2, 4, 8]),
    "frames": (lambda room, n: dataclasses.replace(room, frames=n), [1, 2, 4, 8, 16, 32, 64, 128]),
    "camera": (lambda room, how: dataclasses.replace(room, camera=how), ["rests", "creeps", "walks"]),
}


def member(family, value, seed=1):
    """The room of a family with its knob turned to a value."""
    return families[family][0](Room(seed=seed), value)


def drawn(seed):
    """A room of which everything is drawn by chance, for judging settings on scenes that they were not tuned for. Boxes only:
    pictures shade coarse balls smoothly and paths do not, which is no error of either."""
    chance = random.Random(1000 + seed)
    moving = chance.choice([0, 1, 2, 4])
    return Room(seed=seed, size_m=tuple(round(chance.uniform(a, b), 2) for a, b in ((3, 10), (2.4, 4), (3, 8))),
                things=moving + chance.choice([0, 2, 6]), moving=moving,
                # One shape only, drawn all the same so that seeds keep the rest of their rooms.
                faces=chance.choice([12, 12, 12]),
                reflectance=round(chance.uniform(0.25, 0.85), 3), pieces=chance.choice([0, 4, 12, 24]),
                screens=chance.choice([0, 0, 1, 3]), lamps=chance.choice([1, 1, 2, 4]),
                lamp_edge_m=round(chance.uniform(0.25, 1.4), 2))


if __name__ == "__main__":
    if len(sys.argv) not in (3, 4):
        sys.exit(__doc__)
    number = int(sys.argv[3]) if len(sys.argv) == 4 else 1
    if sys.argv[1] == "drawn":
        document = scene(drawn(int(sys.argv[2])))
    else:
        values = {str(v): v for v in families[sys.argv[1]][1]}
        document = scene(member(sys.argv[1], values[sys.argv[2]], number))
    json.dump(document, sys.stdout)
