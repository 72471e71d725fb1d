#!/usr/bin/env python3
"""Renders the sample scenes with Afterglow and its rivals, with the CPU time of every frame: a table for figures.py.

usage: rivals.py BIN_FOLDER OUTPUT_FOLDER [--only PART] [--list]

Rivals: the method `full`, our path tracer, and, where they are installed, Cycles (Debian's `blender`) and POV-Ray (`povray`). One
thread each. Writes pictures and rows.csv (scene, renderer, setting, seed, edge, frame, cpu_seconds, picture) into OUTPUT_FOLDER;
what its rows hold already is not rendered again, so an interrupted run goes on where it stopped. cpu_seconds is user and system time
of the process: for one that renders many frames its own count around each frame (Cycles), or an equal share of all of it (Afterglow);
a row without frame is what Cycles spends once on starting and reading the scene. --only: runs whose key contains PART.
"""
import argparse
import csv
import json
import os
import pathlib
import shutil
import subprocess
import sys
from dataclasses import dataclass

import povray_scene
from gltf_scene import Scene

here = pathlib.Path(__file__).resolve().parent
data = here.parents[1] / "data"
FIELDS = ["scene", "renderer", "setting", "seed", "edge", "frame", "cpu_seconds", "picture"]

ANIMATIONS = {"cornell-slide": range(0, 49), "living-room": range(0, 96)}
ONE_FRAME = {"cornell-slide": [12], "living-room": [24]}
FOLLOWING = range(6, 18)  # for flicker, as in solver/sequence/README.md
AT_REST = {"cornell-slide": range(50, 54), "living-room": range(98, 102)}  # all motion has ended
EDGE, SMALL_EDGE = 256, 128

CYCLES_SAMPLES = [16, 64, 256]
PATH_SAMPLES = [16, 64, 256]
RADIOSITY = {  # count, nearest count, error bound, end of the pretrace, points along a lamp's edge
    "low": (50, 5, 0.8, 0.02, 3), "middle": (200, 10, 0.5, 0.01, 5), "high": (800, 16, 0.25, 0.005, 7)}


@dataclass(frozen=True)
class Run:
    scene: str
    renderer: str
    setting: str
    seed: str  # fixed, changing or a number
    edge: int
    frames: tuple

    @property
    def key(self):
        return f"{self.scene}-{self.renderer}-{self.setting}-{self.seed}-{self.edge}-{self.frames[0]}-{self.frames[-1]}".replace(" ", "_")


def runs():
    """In order of weight: an interrupted run leaves what matters most."""
    for scene in ONE_FRAME:
        whole, one = tuple(ANIMATIONS[scene]), tuple(ONE_FRAME[scene])
        yield Run(scene, "afterglow", "preview", "fixed", EDGE, whole)
        yield Run(scene, "afterglow", "preview", "fixed", EDGE, whole[:1])
        for samples in CYCLES_SAMPLES:
            yield Run(scene, "cycles", str(samples), "fixed", EDGE, one)
        for quality in ("low", "middle"):
            yield Run(scene, "pov-ray", quality, "fixed", EDGE, one)
        for samples in PATH_SAMPLES:
            yield Run(scene, "path tracer", str(samples), "fixed", EDGE, one)
        yield Run(scene, "full", "preview", "fixed", EDGE, (one[0], one[0] + 1))
    for scene in ONE_FRAME:
        whole = tuple(ANIMATIONS[scene])
        yield Run(scene, "afterglow", "final", "fixed", EDGE, whole)
        yield Run(scene, "afterglow", "final", "fixed", EDGE, whole[:1])
        yield Run(scene, "pov-ray", "high", "fixed", EDGE, tuple(ONE_FRAME[scene]))
        yield Run(scene, "full", "final", "fixed", EDGE, tuple(ONE_FRAME[scene]))
    for scene in ONE_FRAME:
        for frames in (tuple(FOLLOWING), tuple(AT_REST[scene])):
            for seed in ("11", "12") if len(frames) > 4 else ():
                yield Run(scene, "afterglow", "final", seed, SMALL_EDGE, frames)
            yield Run(scene, "afterglow", "preview", "fixed", SMALL_EDGE, frames)
            yield Run(scene, "afterglow", "final", "fixed", SMALL_EDGE, frames)
            yield Run(scene, "full", "preview", "fixed", SMALL_EDGE, frames)
            for quality in ("low", "middle"):
                yield Run(scene, "pov-ray", quality, "fixed", SMALL_EDGE, frames)
            for seed in ("fixed", "changing"):
                yield Run(scene, "cycles", "64", seed, SMALL_EDGE, frames)
                yield Run(scene, "path tracer", "64", seed, SMALL_EDGE, frames)
    for scene in ONE_FRAME:
        for error in ("3%", "1.4%"):
            yield Run(scene, "afterglow", f"error {error}", "fixed", EDGE, tuple(ANIMATIONS[scene]))
            yield Run(scene, "afterglow", f"error {error}", "fixed", EDGE, (0,))


class Rows:
    """rows.csv, read and appended to."""

    def __init__(self, path):
        self.path, self.done = path, set()
        if path.exists():
            with open(path, encoding="utf-8", newline="") as table:
                self.done = {r["picture"] for r in csv.DictReader(table) if r["picture"]}
        else:
            path.write_text(",".join(FIELDS) + "\n", encoding="utf-8")

    def missing(self, run):
        return [f for f in run.frames if picture(run, f) not in self.done]

    def add(self, run, frame, seconds):
        name = picture(run, frame) if frame is not None else ""
        with open(self.path, "a", encoding="utf-8", newline="") as table:
            csv.writer(table).writerow([run.scene, run.renderer, run.setting, run.seed, run.edge,
                                        "" if frame is None else frame, f"{seconds:.4f}", name])
        self.done.add(name)


def picture(run, frame):
    return f"{run.key}/frame_{frame:04}.exr"


def cpu_seconds(command, log):
    """Runs a program to its end; its user and system time."""
    with open(log, "w", encoding="utf-8") as out:
        process = subprocess.Popen([str(c) for c in command], stdout=out, stderr=subprocess.STDOUT)
        _, status, used = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        sys.exit(f"rivals.py: {command[0]} failed with {process.returncode}, see {log}")
    return used.ru_utime + used.ru_stime


def by_afterglow(run, _, rows, folder, programs):
    """The whole range in one process: later frames stand on earlier ones."""
    first, last = run.frames[0], run.frames[-1]
    how = ["--error", run.setting.split()[1]] if run.setting.startswith("error") else ["--quality", run.setting]
    how += ["--method", "full"] if run.renderer == "full" else []
    how += ["--seed", run.seed] if run.seed.isdigit() else []
    seconds = cpu_seconds([programs / "afterglowd", "render", data / f"{run.scene}.glb", "--frames", f"{first}-{last}", "--size",
                           f"{run.edge}x{run.edge}", *how, "--threads", 1, "--cache", "none", "--quiet", "--out", folder,
                           "--report", folder / "report.json"], folder / "log")
    for frame in run.frames:
        rows.add(run, frame, seconds / len(run.frames))


def by_path_tracer(run, missing, rows, folder, programs):
    for frame in missing:
        seed = 1 + frame if run.seed == "changing" else 1
        seconds = cpu_seconds([programs / "path_trace", data / f"{run.scene}.glb", frame, run.setting, run.edge,
                               folder / f"frame_{frame:04}.exr", seed], folder / "log")
        rows.add(run, frame, seconds)


def by_cycles(run, _, rows, folder, __):
    job, told = folder / "job.json", folder / "rows.json"
    scene = Scene(data / f"{run.scene}.glb")
    collect(run, rows, told, scene)  # what an interrupted run left
    missing = rows.missing(run)
    if not missing:
        return
    job.write_text(json.dumps({"scene": str(data / f"{run.scene}.glb"), "frames": missing, "samples": int(run.setting), "seed": run.seed,
                               "edge": run.edge, "vertical_angle": scene.camera(0).vertical_angle, "folder": str(folder),
                               "rows": str(told)}), encoding="utf-8")
    cpu_seconds(["blender", "-b", "--factory-startup", "--python-exit-code", 1, "--python", here / "cycles.py", "--", job], folder / "log")
    collect(run, rows, told, scene)


def collect(run, rows, told, scene):
    """Takes over the rows that Cycles wrote, once."""
    if not told.exists():
        return
    for line in told.read_text(encoding="utf-8").splitlines():
        row = json.loads(line)
        if "frame" in row:
            check_positions(scene, row)
        rows.add(run, row.get("frame"), row.get("cpu_seconds", row.get("startup_cpu_seconds")))
    told.unlink()


def check_positions(scene, row):
    """What moves is where the file says: Blender's z is up."""
    names = [n["name"] for n in scene.document["nodes"]]
    placed = dict(scene.placed_nodes(row["frame"] / scene.frames_per_second))
    for name, (x, y, z) in row["positions"].items():
        if abs(placed[names.index(name)][:3, 3] - (x, z, -y)).max() > 1e-3:
            sys.exit(f"rivals.py: Blender has {name} elsewhere at frame {row['frame']}")


def by_povray(run, missing, rows, folder, _):
    count, nearest, bound, pretrace_end, grid = RADIOSITY[run.setting]
    radiosity = (f"pretrace_start 0.08 pretrace_end {pretrace_end} count {count} nearest_count {nearest} error_bound {bound} recursion_limit 8 "
                 "low_error_factor 0.5 gray_threshold 0 minimum_reuse 0.01 brightness 1 adc_bailout 0.0005")
    scene = Scene(data / f"{run.scene}.glb")
    for frame in missing:
        source = folder / "frame.pov"
        source.write_text(povray_scene.text(scene, frame, radiosity, grid), encoding="utf-8")
        seconds = cpu_seconds(["povray", f"+I{source}", f"+O{folder}/frame_{frame:04}.exr", f"+W{run.edge}", f"+H{run.edge}", "+FE", "-D",
                               "+WT1", "+A0.01", "+AM1", "+R3", "-J"], folder / "log")
        rows.add(run, frame, seconds)


RENDERERS = {"afterglow": by_afterglow, "full": by_afterglow, "path tracer": by_path_tracer, "cycles": by_cycles, "pov-ray": by_povray}
PROGRAMS = {"cycles": "blender", "pov-ray": "povray"}


def measure(programs, folder, only):
    folder.mkdir(parents=True, exist_ok=True)
    rows = Rows(folder / "rows.csv")
    absent = {name for name, program in PROGRAMS.items() if shutil.which(program) is None}
    for name in sorted(absent):
        print(f"{name} is not installed (Debian package {PROGRAMS[name]}): left out")
    for run in runs():
        missing = rows.missing(run)
        if run.renderer in absent or only not in run.key or not missing:
            continue
        print(f"{run.key}: {len(missing)} frames", flush=True)
        where = folder / run.key
        where.mkdir(exist_ok=True)
        RENDERERS[run.renderer](run, missing, rows, where, programs)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs", type=pathlib.Path)
    parser.add_argument("folder", type=pathlib.Path)
    parser.add_argument("--only", default="")
    parser.add_argument("--list", action="store_true")
    options = parser.parse_args()
    if options.list:
        print("\n".join(run.key for run in runs()))
    else:
        measure(options.programs.resolve(), options.folder.resolve(), options.only)


if __name__ == "__main__":
    main()
