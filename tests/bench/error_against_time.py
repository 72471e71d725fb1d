#!/usr/bin/env python3
"""Draws relative picture error against CPU time for one cold frame of each sample scene: by quality, beside the path tracer.

usage: error_against_time.py BIN_FOLDER OUTPUT.svg

Errors come from two independent halves of each reference picture, which makes them unbiased (see tests/data/reference).
Times are CPU seconds of whole programs, reading the scene included, medians of three interleaved runs.
"""
import pathlib
import resource
import statistics
import subprocess
import sys
import tempfile

import numpy as np
import OpenImageIO as oiio

data = pathlib.Path(__file__).resolve().parents[1] / "data"
scenes = {"cornell-slide": 12, "living-room": 24}
qualities = ["draft", "preview", "final"]
samples = [4, 16, 64, 256]
colours = {"cornell-slide": "#c1440e", "living-room": "#1f6f8b"}
runs = 3


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
    return float(np.sqrt(max(mean_square, 0) / (a * b)[keep].mean()))


def cpu_seconds(command):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([str(c) for c in command], check=True, stdout=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def commands(programs, scene, frame, folder):
    """What is drawn: (method, setting) → (command, picture it leaves)."""
    out = {}
    for quality in qualities:
        where = f"{folder}/{quality}"
        out["afterglow", quality] = (
            [programs / "afterglowd", "render", data / f"{scene}.glb", "--frames", frame, "--size", "256x256", "--quality", quality,
             "--out", where, "--cache", "none", "--quiet"], f"{where}/frame_{frame:04}.exr")
    for count in samples:
        picture = f"{folder}/path_{count}.exr"
        out["path tracer", count] = ([programs / "path_trace", data / f"{scene}.glb", frame, count, 256, picture], picture)
    return out


def measure(programs, scene):
    frame = scenes[scene]
    halves = [read(data / "reference" / f"{scene}_{frame:04}_{k}.exr") for k in (1, 2)]
    with tempfile.TemporaryDirectory() as folder:
        todo = commands(programs, scene, frame, folder)
        times = {key: [] for key in todo}
        for _ in range(runs):
            for key, (command, _) in todo.items():
                times[key].append(cpu_seconds(command))
        return {key: (statistics.median(times[key]), error(read(picture), *halves)) for key, (_, picture) in todo.items()}


def draw(results):
    def x(seconds):
        return 70 + 520 * np.log10(seconds / 0.1) / np.log10(1000)

    def y(value):
        return 300 - 250 * np.log2(value / 0.005) / np.log2(64)

    parts = ['<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 760 360" font-family="sans-serif" font-size="13">',
             '<rect width="760" height="360" fill="white"/>',
             '<text x="70" y="26" font-size="15">How long until one cold frame of 256×256 is how exact?</text>']
    for value in (0.005, 0.01, 0.02, 0.04, 0.08, 0.16, 0.32):
        parts.append(f'<path d="M70 {y(value):.1f}H590" stroke="#ddd"/>'
                     f'<text x="62" y="{y(value) + 4:.1f}" text-anchor="end">{100 * value:g} %</text>')
    for seconds in (0.1, 1, 10, 100):
        parts.append(f'<path d="M{x(seconds):.1f} 50V300" stroke="#ddd"/>'
                     f'<text x="{x(seconds):.1f}" y="320" text-anchor="middle">{seconds:g}</text>')
    parts.append('<text x="330" y="344" text-anchor="middle">CPU seconds, everything included</text>')
    parts.append('<text x="20" y="175" text-anchor="middle" transform="rotate(-90 20 175)">relative RMSE</text>')
    for scene, points in results.items():
        for method, dash in (("afterglow", ""), ("path tracer", ' stroke-dasharray="5 4"')):
            chosen = [points[key] for key in points if key[0] == method]
            line = " ".join(f"{x(t):.1f},{y(e):.1f}" for t, e in chosen)
            parts.append(f'<polyline points="{line}" fill="none" stroke="{colours[scene]}" stroke-width="2"{dash}/>')
            parts += [f'<circle cx="{x(t):.1f}" cy="{y(e):.1f}" r="3.5" fill="{colours[scene]}"/>' for t, e in chosen]
            t, e = chosen[-1]
            parts.append(f'<text x="{x(t) + 8:.1f}" y="{y(e) + 4:.1f}" fill="{colours[scene]}">{scene}, {method}</text>')
    return "\n".join(parts + ["</svg>"]) + "\n"


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    measured = {scene: measure(pathlib.Path(sys.argv[1]), scene) for scene in scenes}
    for scene, points in measured.items():
        for (method, setting), (seconds, rmse) in points.items():
            print(f"{scene:14} {method:11} {setting!s:8} {seconds:7.2f} CPU s  {100 * rmse:5.2f} %")
    pathlib.Path(sys.argv[2]).write_text(draw(measured), encoding="utf-8")
