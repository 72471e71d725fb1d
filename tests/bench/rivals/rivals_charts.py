"""The two charts of figures.py."""
import collections
import math
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from charts import Axis, Chart, Panel, percent  # noqa: E402

COLOURS = {"afterglow": "#0072b2", "full": "#56b4e9", "cycles": "#d55e00", "path tracer": "#777777", "pov-ray": "#009e73",
           "RenderPark": "#cc79a7", "irradiance cache": "#b8860b"}
DASHES = {"cornell-slide": "none", "living-room": "5 4"}


def draw_error(table, published, path):
    chart = Chart("Error against CPU time a frame, animations of 49 and 96 frames", 760, 360)
    panel = chart.add(Panel((70, 50), (510, 250), Axis(0.03, 300, (0.1, 1, 10, 100)),
                            Axis(0.005, 0.32, (0.005, 0.01, 0.02, 0.04, 0.08, 0.16, 0.32), percent), "",
                            "CPU seconds a frame of 256×256, all work ahead included", "relative RMSE"))
    names = []
    for scene, dashes in DASHES.items():
        found = collections.defaultdict(list)
        for (where, renderer, setting), (seconds, rmse, *_) in sorted(table.items()):
            if where == scene and not setting.startswith("error"):
                found[renderer].append((seconds, rmse))
        if scene == "cornell-slide":
            found.update(published)
        for renderer in (name for name in COLOURS if name in found):
            inside = sorted(p for p in found[renderer] if p[1] < 0.32)
            if inside:
                panel.line(inside, COLOURS[renderer], dashes)
                name = renderer if renderer in published else f"{renderer}, {scene.split('-')[0]}"
                names.append((name, COLOURS[renderer], dashes))
    chart.legend(592, 66, names, down=True)
    chart.write(path)


def draw_flicker(found, path):
    low, high, left, wide, row, top = 1e-4, 0.3, 225, 420, 19, 60

    def x(value):
        return left + wide * math.log(min(max(value, low), high) / low) / math.log(high / low)

    bottom = top + row * len(found)
    parts = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {left + wide + 30} {bottom + 30}" font-family="sans-serif" font-size="11">',
             f'<rect width="{left + wide + 30}" height="{bottom + 30}" fill="white"/>',
             '<text x="10" y="18" font-size="15">Flicker over twelve frames</text>',
             '<text x="10" y="38">full: a pixel; hollow: blocks of 8 × 8; bar: pixels whose light changes by 0.1 to 1 %</text>']
    for value in (1e-4, 1e-3, 1e-2, 1e-1):
        parts.append(f'<path d="M{x(value):.1f} {top}V{bottom}" stroke="#ddd"/>'
                     f'<text x="{x(value):.1f}" y="{bottom + 18}" text-anchor="middle">{100 * value:g} %</text>')
    for k, ((scene, renderer, setting, seed), values) in enumerate(sorted(found.items())):
        y = top + row * (k + 0.5)
        colour = COLOURS[renderer]
        parts.append(f'<text x="{left - 8}" y="{y + 4:.1f}" text-anchor="end">{scene.split("-")[0]}: {renderer} {setting}'
                     f'{", new seeds" if seed == "changing" else ""}</text>')
        if "pixels" in values:
            parts.append(f'<circle cx="{x(values["pixels"]):.1f}" cy="{y:.1f}" r="4" fill="{colour}"/>'
                         f'<circle cx="{x(values["blocks"]):.1f}" cy="{y:.1f}" r="3.5" fill="white" stroke="{colour}"/>'
                         f'<path d="M{x(values["nearly"]):.1f} {y - 6:.1f}v12" stroke="{colour}" stroke-width="2"/>')
    pathlib.Path(path).write_text("\n".join(parts + ["</svg>"]) + "\n", encoding="utf-8")
