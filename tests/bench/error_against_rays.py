#!/usr/bin/env python3
"""Draws docs/error-against-rays.svg: relative RMSE of pictures of the two sample scenes against rays per patch.

usage: error_against_rays.py AFTERGLOWD OUTPUT.svg

Errors come from two independent halves of each reference picture, which makes them unbiased (see tests/data/reference).
"""
import pathlib
import subprocess
import sys
import tempfile

import numpy as np
import OpenImageIO as oiio

data = pathlib.Path(__file__).resolve().parents[1] / "data"
scenes = {"cornell-slide": [0, 12, 36], "living-room": [0, 24, 72]}
rays = [16, 32, 64, 128, 256, 512, 1024]
colours = {"cornell-slide": "#c1440e", "living-room": "#1f6f8b"}


def read(path):
    image = oiio.ImageInput.open(str(path))
    return np.asarray(image.read_image(0, 3, "float"), dtype=np.float64)


def error(picture, a, b):
    bright = (np.maximum(a, b) > 2.5).any(axis=2)
    near_lamp = bright.copy()
    for dy in (-1, 0, 1):
        for dx in (-1, 0, 1):
            near_lamp |= np.roll(np.roll(bright, dy, 0), dx, 1)
    keep = ~near_lamp
    mean_square = ((picture - a) * (picture - b))[keep].mean()
    return np.sqrt(max(mean_square, 0) / (a * b)[keep].mean())


def mean_error(program, scene, count):
    errors = []
    with tempfile.TemporaryDirectory() as folder:
        for frame in scenes[scene]:
            subprocess.run([program, "render", data / f"{scene}.glb", "--frames", str(frame), "--size", "256x256", "--rays",
                            str(count), "--out", folder, "--cache", "none", "--quiet"], check=True)
            halves = [read(data / "reference" / f"{scene}_{frame:04}_{k}.exr") for k in (1, 2)]
            errors.append(error(read(f"{folder}/frame_{frame:04}.exr"), *halves))
    return float(np.mean(errors))


def draw(results):
    def x(count):
        return 70 + 560 * np.log2(count / rays[0]) / np.log2(rays[-1] / rays[0])

    def y(value):
        return 290 - 240 * np.log2(value / 0.02) / np.log2(8)

    parts = ['<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 760 350" font-family="sans-serif" font-size="13">',
             '<rect width="760" height="350" fill="white"/>',
             '<text x="70" y="26" font-size="15">What do more rays a patch buy? Relative RMSE of a 256×256 frame, about 8,000 patches</text>']
    for value in (0.02, 0.04, 0.08, 0.16):
        parts.append(f'<path d="M70 {y(value):.1f}H630" stroke="#ddd"/>'
                     f'<text x="62" y="{y(value) + 4:.1f}" text-anchor="end">{value:.0%}</text>')
    for count in rays:
        parts.append(f'<text x="{x(count):.1f}" y="312" text-anchor="middle">{count}</text>')
    parts.append('<text x="350" y="336" text-anchor="middle">rays per patch</text>')
    for scene, errors in results.items():
        points = " ".join(f"{x(c):.1f},{y(e):.1f}" for c, e in zip(rays, errors))
        parts.append(f'<polyline points="{points}" fill="none" stroke="{colours[scene]}" stroke-width="2"/>')
        parts += [f'<circle cx="{x(c):.1f}" cy="{y(e):.1f}" r="3.5" fill="{colours[scene]}"/>' for c, e in zip(rays, errors)]
        parts.append(f'<text x="640" y="{y(errors[-1]) + 4:.1f}" fill="{colours[scene]}">{scene} {errors[-1]:.1%}</text>')
    return "\n".join(parts + ["</svg>"]) + "\n"


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    measured = {scene: [mean_error(sys.argv[1], scene, count) for count in rays] for scene in scenes}
    for scene, errors in measured.items():
        print(scene, " ".join(f"{c}:{e:.4f}" for c, e in zip(rays, errors)))
    pathlib.Path(sys.argv[2]).write_text(draw(measured), encoding="utf-8")
