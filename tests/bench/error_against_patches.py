#!/usr/bin/env python3
"""Draws picture error against the number of patches: even ones, and patches as small as they must be.

usage: error_against_patches.py AFTERGLOWD OUTPUT.svg

All with the samples of the final quality and 512 lines a patch, so that patches make the difference.
"""
import json
import subprocess
import sys
import tempfile

from charts import Axis, Chart, Panel, percent
from reference_error import colours, data, error, frames

even_sizes_m = {"cornell-slide": [0.6, 0.4, 0.25, 0.16, 0.1], "living-room": [0.4, 0.25, 0.16, 0.1, 0.065]}


def render(program, scene, *settings):
    """The number of patches and the error."""
    with tempfile.TemporaryDirectory() as folder:
        subprocess.run([program, "render", data / f"{scene}.glb", "--frames", str(frames[scene]), "--size", "256x256", "--quality",
                        "final", "--rays", "512", "--out", folder, "--report", f"{folder}/report.json", "--cache", "none", "--quiet",
                        *settings], check=True)
        with open(f"{folder}/report.json", encoding="utf-8") as report:
            return json.load(report)["patches"], error(f"{folder}/frame_{frames[scene]:04}.exr", scene)


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    chart = Chart("What do patches buy that are small only where they must be?", 800, 360)
    panel = chart.add(Panel((80, 50), (500, 250), Axis(1000, 100_000, (1000, 3000, 10_000, 30_000, 100_000)),
                            Axis(0.005, 0.16, (0.005, 0.01, 0.02, 0.04, 0.08, 0.16), percent), "", "patches", "relative RMSE"))
    names = []
    for scene in frames:
        even = [render(sys.argv[1], scene, "--patch-size", str(size)) for size in even_sizes_m[scene]]
        refined = render(sys.argv[1], scene)
        panel.line(even, colours[scene], "5 4")
        panel.dots([refined], colours[scene])
        names += [(f"{scene}, even", colours[scene], "5 4"), (f"{scene}, refined: the dot", colours[scene], "none")]
        print(scene, "even", " ".join(f"{n}:{100 * e:.2f}%" for n, e in even), "refined", f"{refined[0]}:{100 * refined[1]:.2f}%")
    chart.legend(592, 70, names, down=True)
    chart.write(sys.argv[2])
