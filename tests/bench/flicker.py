#!/usr/bin/env python3
"""Draws how much pictures flicker, by method, beside path tracing.

usage: flicker.py FLICKER.csv… OUTPUT.svg

The tables are what the program flicker prints, one a scene. Flicker is in units of noise: independent noise of 1 % in every
pixel and frame has a flicker of 1 %.
"""
import csv
import math
import sys

methods = ["full", "baum86", "chen90", "tost-pueyo93", "events"]
paths = ["paths-16", "paths-64", "paths-256"]
colours = {"draft": "#e69f00", "preview": "#0072b2", "paths": "#777777"}
low, high = 1e-4, 1.0
left, top, wide, row, gap = 122, 74, 290, 19, 40


def read(files):
    """Flicker (a pixel, a block), by (scene, quality, method)."""
    found = {}
    for name in files:
        with open(name, encoding="utf-8") as table:
            for r in csv.DictReader(table):
                found[r["scene"], r["quality"], r["method"]] = float(r["pixels"]), float(r["blocks"])
    return found


def text(x, y, words, **more):
    attributes = "".join(f' {name.replace("_", "-")}="{value}"' for name, value in more.items())
    return f'<text x="{x:.1f}" y="{y:.1f}"{attributes}>{words}</text>'


def panel(found, scene, x0, rows):
    def x(value):
        return x0 + wide * math.log(min(max(value, low), high) / low) / math.log(high / low)

    height = row * len(rows)
    parts = [f'<rect x="{x0}" y="{top}" width="{wide}" height="{height}" fill="none" stroke="#bbb"/>',
             text(x0 + wide / 2, top - 10, scene, text_anchor="middle")]
    for value in (1e-3, 1e-2, 1e-1):
        parts.append(f'<path d="M{x(value):.1f} {top}V{top + height}" stroke="#ddd"/>')
    for value in (1e-4, 1e-3, 1e-2, 1e-1, 1):
        parts.append(text(x(value), top + height + 16, f"{100 * value:g} %", text_anchor="middle"))
    floor = found.get((scene, "truth", "truth"))
    if floor:
        for value, dash in zip(floor, ("", "3 3")):
            parts.append(f'<path d="M{x(value):.1f} {top}V{top + height}" stroke="#009e73" stroke-dasharray="{dash}"/>')
    for k, (quality, method) in enumerate(rows):
        y = top + row * (k + 0.5)
        if x0 == left:
            parts.append(text(x0 - 8, y + 4, method.replace("paths-", "path tracer, "), text_anchor="end"))
        if (scene, quality, method) not in found:
            continue
        pixels, blocks = found[scene, quality, method]
        colour = colours[quality]
        parts.append(f'<path d="M{x(blocks):.1f} {y:.1f}H{x(pixels):.1f}" stroke="{colour}"/>')
        parts.append(f'<circle cx="{x(pixels):.1f}" cy="{y:.1f}" r="4" fill="{colour}"/>')
        parts.append(f'<circle cx="{x(blocks):.1f}" cy="{y:.1f}" r="3.5" fill="white" stroke="{colour}" stroke-width="1.5"/>')
    return parts


def draw(found):
    rows = [(quality, method) for quality in ("draft", "preview") for method in methods] + [("paths", p) for p in paths]
    scenes = sorted({key[0] for key in found})
    width, height = left + len(scenes) * (wide + gap), top + row * len(rows) + 46
    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" font-family="sans-serif" font-size="12">',
             f'<rect width="{width}" height="{height}" fill="white"/>',
             text(left, 20, "Flicker beside true pictures: a pixel (full) and in blocks of 8 × 8 (hollow)", font_size=15)]
    for k, (name, colour) in enumerate([*colours.items(), ("what is called true", "#009e73")]):
        parts.append(f'<circle cx="{left + 8 + 80 * k}" cy="38" r="4" fill="{colour}"/>')
        parts.append(text(left + 16 + 80 * k, 42, name, fill=colour))
    for k, scene in enumerate(scenes):
        parts += panel(found, scene, left + k * (wide + gap), rows)
    return parts + ["</svg>"]


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    with open(sys.argv[-1], "w", encoding="utf-8") as picture:
        picture.write("\n".join(draw(read(sys.argv[1:-1]))) + "\n")
