#!/usr/bin/env python3
"""What rivals.py measured, as tables and charts: cost at equal error, flicker.

usage: figures.py FOLDER CHART_FOLDER

FOLDER is the output folder of rivals.py. Prints the tables in Markdown; writes rivals-error.svg and rivals-flicker.svg.
"""
import collections
import csv
import pathlib
import sys

import numpy as np

from pictures import CONSTANT, NEARLY_CONSTANT, REFERENCE_FRAMES, error, flicker, flicker_of_constant, lit_within, read
from rivals import AT_REST, EDGE, FOLLOWING, SMALL_EDGE
from rivals_charts import draw_error, draw_flicker

# Programs that Debian does not carry: CPU seconds a frame and relative RMSE of cornell-slide at 256×256, measured once,
# when Cycles took 6.5, 26 and 110 s with 64, 256 and 1,024 samples (7.1, 3.4 and 1.6 %).
PUBLISHED = {"RenderPark": [(0.23, 0.11), (1.0, 0.065), (2.35, 0.037), (11.5, 0.025)],
             "irradiance cache": [(3.9, 0.032), (21, 0.016)]}


def load(folder):
    """Rows by (scene, renderer, setting, seed, edge, first frame, last frame): {frame: row}."""
    groups = collections.defaultdict(dict)
    with open(folder / "rows.csv", encoding="utf-8", newline="") as table:
        for row in csv.DictReader(table):
            if row["picture"]:
                run = row["picture"].split("/")[0]
                groups[run][int(row["frame"])] = row
    return groups


def costs(folder, groups):
    """(scene, renderer, setting) → (CPU s a frame, relative RMSE, ratio of means, CPU s of the first frame alone)."""
    out, first = {}, {}
    for rows in groups.values():
        some = next(iter(rows.values()))
        key, scene = (some["scene"], some["renderer"], some["setting"]), some["scene"]
        if int(some["edge"]) != EDGE:
            continue
        seconds = float(np.mean([float(r["cpu_seconds"]) for r in rows.values()]))
        if some["renderer"] == "afterglow" and len(rows) == 1:
            first[key] = seconds
            continue
        measured = [error(read(folder / rows[f]["picture"]), scene, f) for f in REFERENCE_FRAMES[scene] if f in rows]
        rmse, ratio = np.sqrt(np.mean([e * e for e, _ in measured])), np.mean([m for _, m in measured])
        out[key] = (seconds, float(rmse), float(ratio), len(rows))
    return {key: (*value, first.get(key)) for key, value in out.items()}


def cost_at(points, rmse):
    """CPU seconds at an error along a line of (seconds, error), and whether beyond what was measured.

    Beyond the dearest point the error falls as the root of the time, the law of random sampling, or as it did between the last two
    points, whichever is faster: generous to those whose line is flatter.
    """
    points = sorted(points)
    for (near, high), (far, low) in zip(points, points[1:]):
        if low <= rmse <= high:
            return float(np.exp(np.interp(-np.log(rmse), [-np.log(high), -np.log(low)], np.log([near, far])))), False
    if rmse > points[0][1]:
        return points[0][0] * (points[0][1] / rmse) ** 2, True
    power = 0.5
    if len(points) > 1:
        (near, high), (far, low) = points[-2:]
        power = max(power, np.log(high / low) / np.log(far / near))
    return float(points[-1][0] * (points[-1][1] / rmse) ** (1 / power)), True


def print_costs(measured):
    print("| scene | renderer | setting | CPU s a frame | relative RMSE | mean beside the reference | first frame alone, CPU s |\n"
          "|---|---|---|---|---|---|---|")
    for (scene, renderer, setting), (seconds, rmse, ratio, _, first) in sorted(measured.items()):
        alone = "" if first is None else f"{first:.3g}"
        print(f"| {scene} | {renderer} | {setting} | {seconds:.3g} | {100 * rmse:.2f} % | {ratio:.4f} | {alone} |")


def lines(measured, scene):
    found = collections.defaultdict(list)
    for (where, renderer, _), (seconds, rmse, *_) in measured.items():
        if where == scene and renderer not in ("afterglow", "full"):
            found[renderer].append((seconds, rmse))
    if scene == "cornell-slide":
        found.update(PUBLISHED)
    return found


def print_equal_error(measured):
    print("\n| scene | setting, error | ours: a frame of all / a following frame | rival | its frame at that error | times ours |\n"
          "|---|---|---|---|---|---|")
    for (scene, renderer, setting), (seconds, rmse, _, count, first) in sorted(measured.items()):
        if renderer != "afterglow" or first is None:
            continue
        following = (seconds * count - first) / (count - 1)
        ours = f"{seconds:.3g} / {following:.3g} s"
        if (scene, "full", setting) in measured:
            full = measured[scene, "full", setting]
            print(f"| {scene} | {setting}, {100 * rmse:.2f} % | {ours} | full, {100 * full[1]:.2f} % | {full[0]:.3g} s | "
                  f"{full[0] / seconds:.3g} / {full[0] / following:.3g} |")
        for rival, points in lines(measured, scene).items():
            cost, beyond = cost_at(points, rmse)
            print(f"| {scene} | {setting}, {100 * rmse:.2f} % | {ours} | {rival} | {cost:.3g} s{' (extrapolated)' if beyond else ''} | "
                  f"{cost / seconds:.3g} / {cost / following:.3g} |")


def sequence(folder, rows, frames):
    return np.array([read(folder / rows[f]["picture"]) for f in frames])


def flickers(folder, groups):
    """(scene, renderer, setting, seed) → flicker of pixels, of blocks, of pixels lit (nearly) constantly, while all rests; shares of such pixels."""
    out, shares = {}, {}
    chosen = {run: rows for run, rows in groups.items() if int(next(iter(rows.values()))["edge"]) == SMALL_EDGE}
    for scene in AT_REST:
        prefix = f"{scene}-afterglow-final-"
        names = [f"{prefix}{seed}-{SMALL_EDGE}-{FOLLOWING[0]}-{FOLLOWING[-1]}" for seed in ("11", "12")]
        if any(len(chosen.get(name, {})) != len(FOLLOWING) for name in names):
            continue
        pair = [sequence(folder, chosen[name], FOLLOWING) for name in names]
        mean, constant = float(np.mean(pair)), lit_within(pair, 0, CONSTANT)
        nearly = lit_within(pair, CONSTANT, NEARLY_CONSTANT)
        shares[scene] = float(constant.mean()), float(nearly.mean())
        for rows in chosen.values():
            some = next(iter(rows.values()))
            key = (scene, some["renderer"], some["setting"], some["seed"])
            if some["scene"] != scene or some["seed"].isdigit():
                continue
            if all(f in rows for f in FOLLOWING):
                shown = sequence(folder, rows, FOLLOWING)
                out.setdefault(key, {}).update(
                    pixels=flicker(shown, pair, 1), blocks=flicker(shown, pair, 8),
                    constant=flicker(shown, pair, 1, constant), nearly=flicker(shown, pair, 1, nearly))
            elif all(f in rows for f in AT_REST[scene]):
                out.setdefault(key, {})["rest"] = flicker_of_constant(sequence(folder, rows, AT_REST[scene]), mean)
    return out, shares


def print_flickers(found, shares):
    def percent(values, name):
        return f"{100 * values[name]:.3g} %" if name in values else ""

    for scene, (constant, nearly) in shares.items():
        print(f"\n{scene}: {100 * constant:.3g} % of pixels constantly lit, {100 * nearly:.3g} % nearly\n\n"
              "| renderer | setting | seed | pixels | blocks of 8×8 | constantly lit | nearly | all at rest |\n|---|---|---|---|---|---|---|---|")
        for (where, renderer, setting, seed), values in sorted(found.items()):
            if where == scene:
                columns = [percent(values, name) for name in ("pixels", "blocks", "constant", "nearly", "rest")]
                print(f"| {renderer} | {setting} | {seed} | " + " | ".join(columns) + " |")


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    measurements, charts = pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2])
    charts.mkdir(parents=True, exist_ok=True)
    by_run = load(measurements)
    table = costs(measurements, by_run)
    print_costs(table)
    print_equal_error(table)
    by_renderer, constant_shares = flickers(measurements, by_run)
    print_flickers(by_renderer, constant_shares)
    draw_error(table, PUBLISHED, charts / "rivals-error.svg")
    draw_flicker(by_renderer, charts / "rivals-flicker.svg")
