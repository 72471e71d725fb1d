#!/usr/bin/env python3
"""Draws picture error against CPU time for one cold frame of each sample scene: by quality, beside the path tracer.

usage: error_against_time.py BIN_FOLDER OUTPUT.svg

Times are CPU seconds of whole programs, reading the scene included, medians of three interleaved runs, and one run of the
longest.
"""
import pathlib
import resource
import statistics
import subprocess
import sys
import tempfile

from charts import Axis, Chart, Panel, percent
from reference_error import colours, data, error, frames

qualities = ["draft", "preview", "final"]
samples = [4, 16, 64, 256]
runs = 3


def cpu_seconds(command):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    subprocess.run([str(c) for c in command], check=True, stdout=subprocess.DEVNULL)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    return after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime


def commands(programs, scene, folder):
    """What is drawn: (method, setting) → (command, picture it leaves)."""
    frame, out = frames[scene], {}
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
    with tempfile.TemporaryDirectory() as folder:
        todo = commands(programs, scene, folder)
        times = {key: [] for key in todo}
        for number in range(runs):
            for key, (command, _) in todo.items():
                if number == 0 or key[1] not in samples[2:]:
                    times[key].append(cpu_seconds(command))
        return {key: (statistics.median(times[key]), error(picture, scene)) for key, (_, picture) in todo.items()}


def draw(results, path):
    chart = Chart("How long until one cold frame of 256×256 is how exact?", 800, 360)
    panel = chart.add(Panel((80, 50), (500, 250), Axis(0.03, 100, (0.1, 1, 10, 100)),
                            Axis(0.005, 0.64, (0.005, 0.01, 0.02, 0.04, 0.08, 0.16, 0.32, 0.64), percent), "",
                            "CPU seconds, everything included", "relative RMSE"))
    names = []
    for scene, points in results.items():
        for method, dashes in (("afterglow", "none"), ("path tracer", "5 4")):
            panel.line([points[key] for key in points if key[0] == method], colours[scene], dashes)
            names.append((f"{scene}, {method}", colours[scene], dashes))
    chart.legend(592, 70, names, down=True)
    chart.write(path)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    measured = {scene: measure(pathlib.Path(sys.argv[1]), scene) for scene in frames}
    for scene, points in measured.items():
        for (method, setting), (seconds, rmse) in points.items():
            print(f"{scene:14} {method:11} {setting!s:8} {seconds:7.2f} CPU s  {100 * rmse:5.2f} %")
    draw(measured, sys.argv[2])
