"""The tables of the assessment, each by name."""
import statistics

import cells
from results import number, share, table


def gains(results):
    """Whole sequences and following frames of all methods: each knob's ends and what is between; and what the last pictures are off by."""
    rows = []
    scenes = [f"{family}={value}" for family, values in results.form.values.items()
              for value in ([values[0], values[len(values) // 2], values[-1]] if len(values) > 3 else values)]
    scenes += list(results.form.sample_scenes)
    ways = [w for w in [*cells.methods, "auto"] if w != "full"]
    for scene in scenes:
        full = results.one("families", scene, "full")
        if not full:
            continue
        error = results.error("families", scene, "full")
        row = [scene, number(full["patches"]), f"{share(error[0])} ({share(error[1])} to {share(error[2])})" if error else "",
               number(1000 * full["follow_s"])]
        best = max(ways, key=lambda w: results.gain(scene, w) or 0)
        for way in ways:
            whole, following = results.gain(scene, way), results.gain(scene, way, True)
            words = f"{number(whole, 2)} / {number(following, 2)}" if whole else ""
            row.append(f"**{words}**" if way == best and words else words)
        rows.append(row)
    return table(["scene", "patches", "error of `full` (95 %)", "`full`, ms a frame", *(f"`{w}`" for w in ways)], rows)


def work(results):
    """Counts and memory by method on some scenes."""
    rows = []
    for scene in ("actors=3", "moving=24", "living-room"):
        for way in cells.methods:
            row = results.one("families", scene, way)
            if row:
                rows.append([scene, f"`{way}`", number(row["first_s"]), number(1000 * row["follow_s"]), number(row["rays_follow"]),
                             number(row["changes_follow"]), number(row["pushes_follow"]), share(row["certificate"]),
                             number(row.get("peak_mb")), share(results.apart(scene, way))])
    return table(["scene", "method", "first frame, s", "following, ms", "rays", "changes", "pushes", "largest certificate", "peak MB",
                  "picture apart from `full`"], rows)


def axes(results):
    rows = []
    scenes = ("actors=3", "moving=12", "living-room")
    for kind, names in (("under residual", cells.visibilities), ("on events", cells.solutions)):
        for name in names:
            found = [results.one("axes", scene, name, kind) for scene in scenes]
            if any(found):
                rows.append([f"`{name}`", kind, *(f"{number(r['first_s'])} s / {number(1000 * r['follow_s'])} ms" if r else "" for r in found)])
    return table(["", "", *scenes], rows)


def coherences(results):
    """Milliseconds of a following frame, and of all frames together, as things are reused."""
    rows = []
    for visibility in cells.visibilities:
        for solution in ("progressive", "incremental", "residual"):
            row = [f"`{visibility}`", f"`{solution}`"]
            for scene, picture in (("camera=creeps", "pictures anew"), ("camera=rests", "pictures kept")):
                found = results.one("coherences", scene, f"{visibility}+{solution}", picture)
                row += [number(1000 * found["follow_s"]), number(found["total_s"])] if found else ["", ""]
            rows.append(row)
    return table(["visibility", "light", "pictures anew: a frame, ms", "all, s", "kept: a frame, ms", "all, s"], rows)


def lines(results):
    found = results.chapter("parts: lines")
    scenes = sorted({key[0] for key in found})
    kinds = list(dict.fromkeys(key[3] for key in found))
    return table(["ns a ray", *scenes], [[kind, *(number(found[s, "all", "", kind]["ns_a_ray"]) if (s, "all", "", kind) in found else ""
                                                  for s in scenes)] for kind in kinds])


def orders(results):
    found = results.chapter("parts: orders")
    scenes = sorted({key[0] for key in found})
    kinds = list(dict.fromkeys(key[3] for key in found))
    rows = []
    for kind in kinds:
        cells_of = [found.get((s, "all", "", kind)) for s in scenes]
        rows.append([kind, *(f"{number(r['shots'])}, {number(r['work'])}, {number(r['ms'])}" if r else "" for r in cells_of)])
    return table(["shots, work in sweeps, ms", *scenes], rows)


def factors(results):
    found = results.chapter("parts: factors")
    scenes = sorted({key[0] for key in found})
    kinds = list(dict.fromkeys(key[3] for key in found))
    return table(["error of a row, ms", *scenes],
                 [[kind, *(f"{share(r['error'])}, {number(r['ms_a_row'])}" if (r := found.get((s, "all", "", kind))) else "" for s in scenes)]
                  for kind in kinds])


def mesh(results):
    rows = []
    for (scene, way, setting, _), row in sorted(results.chapter("mesh").items(), key=lambda item: (item[0][0], item[1]["patches"])):
        error = results.error("mesh", scene, way, setting)
        rows.append([scene, f"{way}, {setting}" + (" m" if way == "even" else ""), number(row["patches"]),
                     f"{share(error[0])} ({share(error[1])} to {share(error[2])})" if error else "", number(row["first_s"])])
    return table(["scene", "patches", "how many", "error (95 %)", "CPU s"], rows)


def flicker(results):
    rows = []
    for scene in ("actors=3", "living-room"):
        for way in cells.methods:
            rows.append([scene, f"`{way}`", share(results.flicker(scene, way, "preview"))])
        rows.append([scene, "path tracer, 64 samples, another seed a frame", share(results.flicker(scene, "path tracer", "64 samples"))])
    return table(["scene", "", "flicker of pixels"], rows)


def quality(results):
    rows = []
    for (scene, way, setting, _), row in results.chapter("quality").items():
        error = results.error("quality", scene, way, setting)
        if error and (way in ("cold", "full", "events") or way == "path tracer"):
            rows.append([scene, way, setting, f"{share(error[0])} ({share(error[1])} to {share(error[2])})", number(row["first_s"]),
                         number(row.get("follow_s") or None)])
    return table(["scene", "", "setting", "error (95 %)", "first, CPU s", "following, CPU s"], rows)


def judged(results):
    """Asked errors: (scene, asked, error, low, high, seconds, best fixed setting of the same error and its seconds)."""
    out = []
    for scene in (f"drawn={k}" for k in results.form.drawn):
        fixed = [(row["total_s"], setting, results.error("asked", scene, "fixed", setting))
                 for (s, way, setting, _), row in results.chapter("asked").items() if s == scene and way == "fixed"]
        for asked in (0.05, 0.02):
            for way in ("asked", "asked, following"):
                row, error = results.one("asked", scene, way, asked), results.error("asked", scene, way, asked)
                if not row or not error:
                    continue
                good = [(seconds, setting) for seconds, setting, e in fixed if e and e[0] <= error[0]]
                enough = [(seconds, setting) for seconds, setting, e in fixed if e and e[0] <= asked]
                out.append({"scene": scene, "asked": asked, "way": way, "error": error, "seconds": row["total_s"],
                            "patches": row["patches"], "best": min(good, default=None), "enough": min(enough, default=None)})
    return out


def missed(results):
    """Asked errors that were not kept."""
    return asked(results, [j for j in judged(results) if j["way"] == "asked" and j["error"][0] > j["asked"]])


def asked(results, chosen=None):
    rows = []
    for j in chosen if chosen is not None else [j for j in judged(results) if j["way"] == "asked"]:
        best = j["best"]
        rows.append([j["scene"], share(j["asked"]), f"{share(j['error'][0])} ({share(j['error'][1])} to {share(j['error'][2])})",
                     "within" if j["error"][0] <= j["asked"] else f"**{number(j['error'][0] / j['asked'])} × asked**", number(j["patches"]),
                     number(j["seconds"]), f"{best[1]}: {number(best[0])}" if best else "none reaches it",
                     number(j["seconds"] / best[0]) if best else ""])
    return table(["scene", "asked", "error (95 %)", "", "patches", "CPU s", "best fixed setting of that error, CPU s", "time ratio"], rows)


def asked_summary(results):
    rows = []
    for value in (0.05, 0.02):
        for way in ("asked", "asked, following"):
            of_value = [j for j in judged(results) if j["asked"] == value and j["way"] == way]
            if not of_value:
                continue
            within = sum(j["error"][0] <= value for j in of_value)
            ratios = [j["seconds"] / j["best"][0] for j in of_value if j["best"]]
            cold = way == "asked"
            rows.append([share(value), "the first frame" if cold else "the ninth of a sequence begun later", f"{within} of {len(of_value)}",
                         number(max(j["error"][0] / value for j in of_value)),
                         number(statistics.median(ratios)) if ratios and cold else "", number(max(ratios)) if ratios and cold else "",
                         len(of_value) - len(ratios) if cold else ""])
    return table(["asked", "", "within", "worst error / asked", "median time ratio", "worst time ratio", "scenes where no fixed setting reaches the error"], rows)


chapter_of = {"gains": "families", "work": "families", "axes": "axes", "coherences": "coherences", "lines": "parts", "orders": "parts",
              "factors": "parts", "mesh": "mesh", "quality": "quality", "flicker": "flicker", "asked_summary": "asked", "missed": "asked", "asked": "asked"}
all_tables = {name: globals()[name] for name in chapter_of}
