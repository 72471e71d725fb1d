#!/usr/bin/env python3
"""Draws what visibility strategies cost against actors, faces and speed.

usage: visibility_families.py VISIBILITY_FAMILIES.csv OUTPUT.svg

The table is what the program visibility_families prints. "Times retrace" is what retracing all frames costs against a
strategy's static pass, work ahead and all frames.
"""
import csv
import math
import sys

colours = {"back-buffer": "#999999", "temporal-graph": "#e69f00", "events": "#0072b2"}
speeds = ["slow", "normal", "fast"]
metres_per_s = {"slow": "0.3", "normal": "1.2", "fast": "5"}
actors = [1, 3, 10, 30]
low, high = 0.3, 80
left, top, wide, tall, gap = 78, 70, 190, 130, 22


def read(path):
    """Times retrace, by (faces, speed, strategy, actors)."""
    with open(path, encoding="utf-8") as table:
        rows = list(csv.DictReader(table))
    whole = {(int(r["faces"]), r["speed"], r["strategy"], int(r["actors"])): float(r["all_ms"]) for r in rows}
    return {key: whole[key[0], key[1], "retrace", key[3]] / ms for key, ms in whole.items() if key[2] != "retrace"}


def text(x, y, words, **more):
    attributes = "".join(f' {name.replace("_", "-")}="{value}"' for name, value in more.items())
    return f'<text x="{x:.1f}" y="{y:.1f}"{attributes}>{words}</text>'


def panel(ratios, faces, speed, x0, y0):
    def x(n):
        return x0 + 12 + (wide - 24) * math.log(n / actors[0]) / math.log(actors[-1] / actors[0])

    def y(ratio):
        return y0 + tall - tall * math.log(min(max(ratio, low), high) / low) / math.log(high / low)

    parts = [f'<rect x="{x0}" y="{y0}" width="{wide}" height="{tall}" fill="none" stroke="#bbb"/>']
    for ratio in (1, 3, 10, 30):
        parts.append(f'<path d="M{x0} {y(ratio):.1f}H{x0 + wide}" stroke="{"#555" if ratio == 1 else "#ddd"}"/>')
        if x0 == left:
            parts.append(text(x0 - 6, y(ratio) + 4, f"{ratio}×", text_anchor="end"))
    if speed == speeds[-1]:
        parts += [text(x(n), y0 + tall + 17, n, text_anchor="middle") for n in actors]
    for strategy, colour in colours.items():
        points = [(x(n), y(ratios[faces, speed, strategy, n])) for n in actors if (faces, speed, strategy, n) in ratios]
        line = " ".join(f"{px:.1f},{py:.1f}" for px, py in points)
        parts.append(f'<polyline points="{line}" fill="none" stroke="{colour}" stroke-width="2"/>')
        parts += [f'<circle cx="{px:.1f}" cy="{py:.1f}" r="3" fill="{colour}"/>' for px, py in points]
    return parts


def draw(ratios):
    all_faces = sorted({key[0] for key in ratios})
    width, height = left + 3 * (wide + gap) + 50, top + 3 * (tall + gap) + 40
    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" font-family="sans-serif" font-size="12">',
             f'<rect width="{width}" height="{height}" fill="white"/>',
             text(left, 22, "What do strategies gain over retracing, 96 frames as a whole?", font_size=15)]
    for k, (strategy, colour) in enumerate(colours.items()):
        parts.append(f'<path d="M{left + 130 * k} 38h22" stroke="{colour}" stroke-width="2"/>')
        parts.append(text(left + 130 * k + 28, 42, strategy, fill=colour))
    for column, faces in enumerate(all_faces):
        x0 = left + column * (wide + gap)
        parts.append(text(x0 + wide / 2, top - 8, f"{faces:,} faces an actor", text_anchor="middle"))
        for row, speed in enumerate(speeds):
            y0 = top + row * (tall + gap)
            parts += panel(ratios, faces, speed, x0, y0)
            if column == len(all_faces) - 1:
                parts.append(text(x0 + wide + 8, y0 + tall / 2, speed))
                parts.append(text(x0 + wide + 8, y0 + tall / 2 + 15, f"{metres_per_s[speed]} m/s", fill="#666"))
    parts.append(text(left + 1.5 * wide + gap, height - 8, "actors", text_anchor="middle"))
    return parts + ["</svg>"]


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    found = read(sys.argv[1])
    with open(sys.argv[2], "w", encoding="utf-8") as picture:
        picture.write("\n".join(draw(found)) + "\n")
    for (faces, speed, strategy, count), ratio in sorted(found.items()):
        print(f"{faces},{speed},{count},{strategy},{ratio:.2f}")
