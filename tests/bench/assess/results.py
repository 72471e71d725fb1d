"""What was measured, ready to be asked for: medians over rounds, errors of pictures, tables."""
import collections
import csv
import pathlib
import statistics

import cells
import measures


class Results:
    def __init__(self, assessment, rivals):
        self.assessment, self.form = assessment, assessment.form
        grouped = collections.defaultdict(list)
        for row in assessment.present_rows():
            kind = row.get("kind", "") or str(row.get("frame", "") if row["way"] == "path tracer" else "")
            extra = (row["asked"], row["frame"]) if "certificates" in row["chapter"] else ()
            grouped[(row["chapter"], row["scene"], row["way"], row["setting"], kind, *extra)].append(row)
        self.rows = {}
        for key, rows in grouped.items():
            self.rows[key] = {name: statistics.median(r[name] for r in rows if name in r) if isinstance(value, (int, float)) else value
                              for name, value in rows[0].items() if name not in ("build", "round")}
            self.rows[key]["rounds"] = len(rows)
        self.cell_of = {(c.chapter, c.scene, c.way, str(c.setting)): c for c in assessment.cells}
        self.errors, self.rivals = {}, [r for path in rivals for r in self.read_rival(path)]

    def chapter(self, name):
        """(scene, way, setting, kind, …) → medians."""
        return {key[1:]: row for key, row in self.rows.items() if key[0] == name}

    def one(self, chapter, scene, way, setting="", kind=""):
        return self.rows.get((chapter, scene, way, str(setting), kind))

    def folder(self, chapter, scene, way, setting=""):
        return self.assessment.out / "pictures" / cells.Cell(chapter, scene, way, setting, "", ()).name

    def error(self, chapter, scene, way, setting="", frame=None):
        """Of a cell's last picture: error, ends of its interval; None where there is no reference."""
        key = (chapter, scene, way, str(setting))
        if key not in self.errors:
            found = sorted(self.folder(*key).glob("frame_*.exr"))
            self.errors[key] = self.error_of(scene, found[-1]) if found else None
        return self.errors[key]

    def error_of(self, scene, picture):
        frame = int(picture.stem[-4:])
        for size in (256, 96):
            halves = self.assessment.halves(scene, frame, size)
            if halves and measures.read(picture).shape[0] == size:
                return measures.picture_error(picture, halves)
        return None

    def read_rival(self, path):
        """Rows of another renderer with their errors, where there is a reference of the scene and frame."""
        with open(path, newline="", encoding="utf-8") as table:
            for row in csv.DictReader(table):
                picture = pathlib.Path(path).parent / row["picture"]
                for size in (256, 96):
                    halves = self.assessment.halves(row["scene"], int(row["frame"]), size) if "=" in row["scene"] or row["scene"] in cells.samples else None
                    if halves and picture.exists() and measures.read(picture).shape[0] == size:
                        yield {**row, "cpu_seconds": float(row["cpu_seconds"]), "error": measures.picture_error(picture, halves)}

    def gain(self, scene, way, following=False):
        """How many times less than `full` a sequence takes."""
        full, other = self.one("families", scene, "full"), self.one("families", scene, way)
        if not full or not other:
            return None
        name = "follow_s" if following else "total_s"
        return full[name] / max(other[name], 1e-9)

    def apart(self, scene, way):
        """What the last pictures of a method and of `full` differ by."""
        pictures = [sorted(self.folder("families", scene, w).glob("frame_*.exr")) for w in (way, "full")]
        return measures.apart(pictures[0][-1], pictures[1][-1]) if all(pictures) else None

    def flicker(self, scene, way, setting):
        truths = [measures.sequence(self.folder("flicker", scene, "truth", seed)) for seed in (11, 12)]
        shown = measures.sequence(self.folder("flicker", scene, way, setting))
        if not shown or len(truths[0]) != len(shown) or len(truths[1]) != len(shown):
            return None
        return measures.flicker(shown, [0.5 * (a + b) for a, b in zip(*truths)])


def table(head, rows):
    """As Markdown."""
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(str(c) for c in row) + " |" for row in rows])


def number(value, digits=3):
    """Three digits that count."""
    if value is None:
        return ""
    if value == 0:
        return "0"
    if abs(value) >= 10 ** digits:
        return f"{value:,.0f}"
    return f"{value:.{digits}g}"


def share(value):
    return "" if value is None else f"{100 * value:.3g} %"
