"""Writes one frame of a glTF scene for POV-Ray 3.7: diffuse meshes, lamps as area lights, radiosity for the rest."""
import numpy as np

LAMP_GAP_M = 0.0005


def vector(values):
    return "<" + ", ".join(f"{v:.9g}" for v in values) + ">"


def mesh(triangles):
    corners = triangles.reshape(-1, 3)
    faces = "\n".join(f"<{3 * k}, {3 * k + 1}, {3 * k + 2}>," for k in range(len(triangles)))
    points = "\n".join(vector(c) + "," for c in corners)
    return (f"mesh2 {{ vertex_vectors {{ {len(corners)},\n{points}\n}}\n"
            f"face_indices {{ {len(triangles)},\n{faces}\n}}\n")


def rectangle(triangles):
    """Centre, two edges and normal of two triangles that make a rectangle."""
    corners = np.unique(triangles.reshape(-1, 3).round(6), axis=0)
    if len(corners) != 4:
        raise ValueError("a lamp is no rectangle")
    first = corners[0]
    near, also_near, far = sorted(corners[1:], key=lambda p: np.linalg.norm(p - first))
    a, b, c = triangles[0]
    normal = np.cross(b - a, c - a)
    return (first + far) / 2, near - first, also_near - first, normal / np.linalg.norm(normal)


def area_light(surface, grid):
    """Colour × 2 (gap/d)² × cosine: the light of grid² points, as much in all as the rectangle's."""
    centre, u, v, normal = rectangle(surface.triangles)
    power = surface.radiance * np.linalg.norm(np.cross(u, v)) / np.pi
    fade_m = 0.001
    centre = centre + LAMP_GAP_M * normal
    return (f"light_source {{ {vector(centre)} color rgb {vector(power / (2 * fade_m**2))}\n"
            f"area_light {vector(u)}, {vector(v)}, {grid}, {grid} area_illumination on jitter\n"
            f"spotlight point_at {vector(centre + normal)} radius 90 falloff 90 tightness 1\n"
            f"fade_distance {fade_m} fade_power 2 }}\n")


def lamp(surface, grid):
    """Shines to the front only: a black copy lies behind it."""
    _, _, _, normal = rectangle(surface.triangles)
    back = mesh(surface.triangles - LAMP_GAP_M * normal) + "pigment { color rgb 0 } finish { diffuse 0 ambient 0 } }\n"
    shown = (mesh(surface.triangles) + f"pigment {{ color rgb 1 }} finish {{ diffuse 0 ambient 0 emission rgb {vector(surface.radiance)} }}")
    if grid == 0:
        return back + shown + " }\n"
    return back + shown + " no_radiosity no_shadow }\n" + area_light(surface, grid)


def text(scene, frame, radiosity, grid):
    """`radiosity`: the block's text; `grid`: points along a lamp's edge, 0 to let radiosity find lamps by itself."""
    camera = scene.camera(frame)
    wide = 2 * np.tan(camera.vertical_angle / 2)
    parts = ["#version 3.7;\nglobal_settings { assumed_gamma 1.0 max_trace_level 32 adc_bailout 0.0005\n"
             f"radiosity {{ {radiosity} }} }}\n",
             "background { color rgb 0 }\n#default { finish { ambient 0 diffuse 1 } }\n",
             f"camera {{ location {vector(camera.position)} direction {vector(camera.forward)} "
             f"right {vector(wide * camera.right)} up {vector(wide * camera.up)} }}\n"]
    for surface in scene.surfaces(frame):
        if surface.radiance.max() > 0:
            parts.append(lamp(surface, grid))
        else:
            parts.append(mesh(surface.triangles) + f"pigment {{ color rgb {vector(surface.reflectance)} }} }}\n")
    return "".join(parts)
