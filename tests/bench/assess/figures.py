"""The charts of the assessment, and the page they stand on. Each answers the question in its title."""
import pathlib
import re
import shutil

import cells
import tables
from charts import Axis, Chart, Names, Panel, colour_of, logarithmic, percent, plain, times
from results import Results

rivals_colours = ["#d55e00", "#cc79a7", "#e69f00", "#56b4e9"]
knob_words = {"actors": "actors", "faces": "faces of an actor", "speed": "speed, m/s", "moving": "of 24 things, how many move",
              "reflectance": "reflectance", "occlusion": "screens across the room", "camera": "camera"}


def gain_panels(results, chart, following):
    """One panel a knob: how many times less than `full` each method takes."""
    ways = [w for w in [*cells.methods, "auto"] if w != "full"]
    low, high = (0.5, 60) if following else (0.3, 20)
    axis = Axis(low, high, [t for t in (0.3, 1, 3, 10, 30) if low <= t <= high], times)
    wide, tall, gap_x, gap_y, left, top = 165, 130, 26, 74, 66, 84
    for k, (family, values) in enumerate(results.form.values.items()):
        place = (left + (k % 4) * (wide + gap_x), top + (k // 4) * (tall + gap_y))
        panel = chart.add(Panel(place, (wide, tall), Names(values), axis, knob_words[family], "", "", k % 4 == 0))
        panel.rule(1)
        for way in ways:
            points = [(v, gain) for v in values if (gain := results.gain(f"{family}={v}", way, following))]
            panel.line(points, colour_of(way), "2 3" if way == "auto" else "none", way != "auto")
    k = len(results.form.values)
    place = (left + (k % 4) * (wide + gap_x), top + (k // 4) * (tall + gap_y))
    return place, (wide, tall), axis, ways


def frames_panel(results, chart, place, size, axis, ways):
    """What the first n frames cost together, beside `full`."""
    full = results.one("frames", "frames=128", "full")
    if not full:
        return
    counts = [n for n in (1, 2, 4, 8, 16, 32, 64, 128, 256, 512) if n <= len(full["frame_s"])]
    panel = chart.add(Panel(place, size, Axis(1, counts[-1], [n for n in counts if n in (1, 4, 16, 64, 256)]), axis, "number of frames", "", "", False))
    panel.rule(1)
    for way in ways:
        row = results.one("frames", "frames=128", way)
        if row:
            panel.line([(n, (full["setup_s"] + sum(full["frame_s"][:n])) / (row["setup_s"] + sum(row["frame_s"][:n]))) for n in counts],
                       colour_of(way))


def gain(results):
    chart = Chart("How many times less than computing every frame anew does each method take, all frames together?", 830, 512)
    place, size, axis, ways = gain_panels(results, chart, False)
    frames_panel(results, chart, place, size, axis, ways)
    chart.legend(66, 52, [(w, colour_of(w), "2 3" if w == "auto" else "none") for w in ways])
    chart.note(66, 484, f"A generated room, {results.form.frames} frames; 3 actors that are boxes, at 1.2 m/s, unless a knob says otherwise.")
    chart.note(66, 500, "CPU time of one thread, first frame and all work ahead included.")
    return chart


def following(results):
    chart = Chart("How many times less does a following frame take? (mean over all but the first, work ahead included)", 830, 512)
    _, _, _, ways = gain_panels(results, chart, True)
    chart.legend(66, 52, [(w, colour_of(w), "2 3" if w == "auto" else "none") for w in ways])
    return chart


def error_time(results):
    scenes = [*results.form.sample_scenes, *results.form.hard_scenes]
    chart = Chart("How exact is a frame for its time: cold, following, and by path tracing?", 860, 560)
    x_axis = Axis(0.002, 60, [0.01, 0.1, 1, 10], plain)
    y_axis = Axis(0.005, 1, [0.01, 0.03, 0.1, 0.3, 1], percent)
    rivals = sorted({r["renderer"] for r in results.rivals})
    for k, scene in enumerate(scenes):
        panel = chart.add(Panel((74 + 266 * (k % 3), 92 + 222 * (k // 3)), (236, 160), x_axis, y_axis, scene,
                                "CPU s a frame" if k > 2 else "", "relative RMSE" if k % 3 == 0 else "", k % 3 == 0))
        for way, colour, dashes in (("cold", "#777777", "none"), ("events", "#0072b2", "none"), ("path tracer", "#d55e00", "5 4")):
            points = []
            for (s, w, setting, _), row in results.chapter("quality").items():
                error = results.error("quality", s, w, setting) if s == scene and w == way else None
                if error:
                    seconds = row["follow_s"] if way == "events" else row["first_s"]
                    points.append((seconds, error[0]))
                    panel.interval(seconds, max(error[1], y_axis.low), error[2], colour)
            panel.line(sorted(points), colour, dashes)
        for number, renderer in enumerate(rivals):
            panel.line(sorted((r["cpu_seconds"], r["error"][0]) for r in results.rivals if r["scene"] == scene and r["renderer"] == renderer),
                       rivals_colours[number % 4], "2 2")
    entries = [("a cold frame", "#777777", "none"), ("a following frame, events", "#0072b2", "none"), ("path tracer", "#d55e00", "5 4")]
    chart.legend(74, 56, entries + [(r, rivals_colours[k % 4], "2 2") for k, r in enumerate(rivals)], 180)
    return chart


def certificate(results):
    chart = Chart("Does the certificate hold, and how much does it leave? (below the line: it holds)", 640, 380)
    axis = Axis(1e-4, 0.2, [1e-4, 1e-3, 1e-2, 1e-1], percent)
    scenes = sorted({key[0] for key in results.chapter("parts: certificates")})
    panel = chart.add(Panel((80, 60), (340, 260), axis, axis, "", "certificate", "what the solution is off by"))
    panel.diagonal()
    for k, scene in enumerate(scenes):
        rows = [row for key, row in results.chapter("parts: certificates").items() if key[0] == scene]
        panel.dots([(r["certificate"], r["most"]) for r in rows], colour_of("", k))
        panel.dots([(r["certificate"], r["rms"]) for r in rows], colour_of("", k), hollow=range(len(rows)))
    chart.legend(440, 80, [(s, colour_of("", k), "none") for k, s in enumerate(scenes)], down=True)
    chart.note(440, 240, "full: the patch that is worst")
    chart.note(440, 258, "hollow: root mean square")
    return chart


def patches(results):
    found = results.chapter("patches")
    chart = Chart("How do a following frame's time and the memory grow with patches? (living room, 64 lines each)", 860, 350)
    x_axis = logarithmic([r["patches"] for r in found.values()] or [1, 2], lambda v: f"{v:,.0f}")
    for k, (name, scale, label) in enumerate((("follow_s", 1, "CPU s a following frame"), ("peak_mb", 1, "most memory, MB"))):
        y_axis = logarithmic([r[name] * scale for r in found.values()] or [1, 2])
        panel = chart.add(Panel((90 + 420 * k, 74), (320, 210), x_axis, y_axis, "", "patches", label))
        for way in cells.methods:
            panel.line(sorted((r["patches"], r[name]) for key, r in found.items() if key[1] == way), colour_of(way))
    chart.legend(90, 52, [(w, colour_of(w), "none") for w in cells.methods])
    return chart


def factors(results):
    found = results.chapter("parts: factors")
    scenes = sorted({key[0] for key in found})
    chart = Chart("Which way of computing form factors is how exact for its time?", 840, 340)
    x_axis = logarithmic([r["ms_a_row"] for r in found.values()] or [1, 2])
    y_axis = logarithmic([r["error"] for r in found.values()] or [1, 2], percent)
    kinds = {"ray cast": "#0072b2", "hemicube": "#e69f00", "analytic": "#009e73"}
    for k, scene in enumerate(scenes):
        panel = chart.add(Panel((74 + 190 * k, 80), (166, 190), x_axis, y_axis, scene, "ms a row", "error of a row" if k == 0 else "", k == 0))
        for kind, colour in kinds.items():
            rows = [(r["ms_a_row"], r["error"]) for key, r in found.items() if key[0] == scene and key[3].startswith(kind)]
            panel.line(sorted(rows), colour)
    chart.legend(74, 50, [(k, c, "none") for k, c in kinds.items()])
    return chart


def asked(results):
    judged = [j for j in tables.judged(results) if j["way"] == "asked"]
    scenes = list(dict.fromkeys(j["scene"] for j in judged)) or [""]
    chart = Chart("Is the asked error kept on scenes nobody tuned for, and what does it cost?", 860, 340)
    names = [s.split("=")[-1] for s in scenes]
    for k, (label, low, high) in enumerate((("actual error / asked", 0.2, 3), ("time / best fixed setting's", 0.1, 10))):
        axis = Axis(low, high, [t for t in (0.1, 0.2, 0.5, 1, 2, 5, 10) if low <= t <= high], times)
        panel = chart.add(Panel((80 + 400 * k, 76), (330, 210), Names(names), axis, "", "scene", label))
        panel.rule(1)
        for asked_error, colour in ((0.05, "#e69f00"), (0.02, "#0072b2")):
            for j in judged:
                if j["asked"] != asked_error:
                    continue
                place = j["scene"].split("=")[-1]
                if k == 0:
                    panel.interval(place, max(low, j["error"][1] / asked_error), j["error"][2] / asked_error, colour)
                    panel.dots([(place, j["error"][0] / asked_error)], colour)
                elif j["best"]:
                    panel.dots([(place, j["seconds"] / j["best"][0])], colour)
    chart.legend(80, 52, [("asked 5 %", "#e69f00", "none"), ("asked 2 %", "#0072b2", "none")])
    return chart


all_charts = {"assess-gain": gain, "assess-following": following, "assess-error-time": error_time, "assess-certificate": certificate,
              "assess-patches": patches, "assess-factors": factors, "assess-asked": asked}
# What the README and ASSESSMENT.md show, and the chapter that it is drawn from.
published = {"assess-gain": "families", "assess-error-time": "quality", "assess-certificate": "parts", "assess-patches": "patches",
             "assess-asked": "asked"}


def provenance(results, machine):
    form = results.form
    counts = [row["rounds"] for row in results.rows.values()] or [0]
    rounds = f"{min(counts)} to {max(counts)} rounds" if min(counts) < max(counts) else f"{counts[0]} round" + "s" * (counts[0] > 1)
    return (f"Measured on {machine['cores']} cores of {machine['processor']}, {machine['system']}, Python {machine['python']}, Afterglow "
            f"{machine['revision']} (programs {results.assessment.build}). Form `{form.name}`: {rounds}, all methods interleaved; times are "
            f"CPU seconds of one thread, medians. Seeds: 1 for scenes and lines, their number for drawn scenes, 1001 and 1002 for the halves "
            f"of references ({form.reference_samples} samples a pixel each), 11 and 12 for what flicker is told by.")


def fill_in(page, made, words):
    """Puts tables between their marks in a page."""
    text = page.read_text(encoding="utf-8")
    for name, table in {**made, **words}.items():
        text = re.sub(rf"(<!-- {name} -->\n).*?(<!-- end -->)", lambda m, t=table: f"{m[1]}{t}\n{m[2]}", text, flags=re.S)
    page.write_text(text, encoding="utf-8")


def draw_all(assessment, machine, rivals, publish):
    results, out = Results(assessment, rivals), assessment.out
    (out / "charts").mkdir(exist_ok=True)
    for name, make in all_charts.items():
        make(results).write(out / "charts" / f"{name}.svg")
    made = {name: make(results) for name, make in tables.all_tables.items()}
    words = provenance(results, machine)
    parts = ["# Assessment", words, *(f"![](charts/{name}.svg)" for name in all_charts)]
    parts += [f"## {name}\n\n{table}" for name, table in made.items()]
    (out / "README.md").write_text("\n\n".join(parts) + "\n", encoding="utf-8")
    if not publish:
        return
    bench = pathlib.Path(__file__).resolve().parents[1]
    measured = {key[0].split(":")[0] for key in results.rows}
    made = {name: made[name] for name, chapter in tables.chapter_of.items() if chapter in measured}
    for name, chapter in published.items():
        if chapter in measured:
            shutil.copy(out / "charts" / f"{name}.svg", bench.parents[1] / "docs" / f"{name}.svg")
    # Asked errors may have been judged with other programs than the rest was measured with.
    only_asked = measured == {"asked"}
    fill_in(bench / "ASSESSMENT.md", made, {"asked_provenance" if only_asked else "provenance": words})
