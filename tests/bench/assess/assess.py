#!/usr/bin/env python3
"""Measures all methods on all families of scenes and draws what came out.

usage: assess.py BIN_FOLDER [--quick | --long] [--out FOLDER] [--workers 1|2] [--rivals CSV]… [--only CHAPTER]… [--draw] [--publish]

Cells that the table in the output folder already has, from the same programs, are not run again. --draw only draws;
--publish also brings the tables of tests/bench/ASSESSMENT.md and the charts of docs/ up to date. A rival's table has the columns
scene, renderer, setting, seed, frame, cpu_seconds, picture (a path, relative to the table's folder).
"""
import argparse
import concurrent.futures
import csv
import hashlib
import json
import os
import pathlib
import platform
import subprocess
import sys
import threading
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
import cells  # noqa: E402

key_columns = ["build", "chapter", "scene", "way", "setting", "round"]


def run_process(command):
    """Standard output and CPU seconds of a program."""
    with subprocess.Popen([str(c) for c in command], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        output, errors = process.stdout.read(), process.stderr.read()
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        raise RuntimeError(f"{' '.join(map(str, command))}: {errors.strip() or process.returncode}")
    return output, usage.ru_utime + usage.ru_stime


class Assessment:
    def __init__(self, programs, out, form, workers, only):
        self.programs, self.out, self.form, self.workers = programs, out, form, workers
        self.lock = threading.Lock()
        out.mkdir(parents=True, exist_ok=True)
        self.build = hashlib.sha256(b"".join((programs / p).read_bytes() for p in ("sequence_cell", "parts_cell"))).hexdigest()[:10]
        self.rows = self.read_rows()
        self.cells = [c for c in cells.all_cells(form) if not only or c.chapter.split(":")[0] in only]
        self.only = only

    def read_rows(self):
        """Every line of the table is one JSON object in the column `row` beside its key: rows differ in what they hold."""
        path = self.out / "cells.csv"
        if not path.exists():
            return []
        with open(path, newline="", encoding="utf-8") as table:
            return [{**{k: line[k] for k in key_columns}, **json.loads(line["row"])} for line in csv.DictReader(table)]

    def write_rows(self, key, rows):
        path = self.out / "cells.csv"
        with self.lock:
            is_new = not path.exists()
            with open(path, "a", newline="", encoding="utf-8") as table:
                writer = csv.DictWriter(table, [*key_columns, "row"])
                if is_new:
                    writer.writeheader()
                for row in rows:
                    writer.writerow({**key, "row": json.dumps(row)})
                    self.rows.append({**key, **row})

    def half(self, scene, frame, size, number):
        document = cells.scene_file(scene, self.out / "scenes")
        mark = hashlib.sha256(document.read_bytes()).hexdigest()[:8]
        return self.out / "references" / f"{scene}_{frame:04}_{size}_{self.form.reference_samples}_{mark}_{number}.exr"

    def halves(self, scene, frame, size):
        """Both halves of a reference, and where lamps are in it; None where there is none."""
        if scene in cells.samples:
            if frame != cells.samples[scene] or size != 256:
                return None
            return [cells.data / "reference" / f"{scene}_{frame:04}_{k}.exr" for k in (1, 2)]
        all_three = [self.half(scene, frame, size, k) for k in (1, 2, "lamps")]
        if not all(h.exists() for h in all_three[:2]):
            return None
        if not all_three[2].exists():
            self.trace_lamps(scene, frame, size)
        return all_three

    def trace_lamps(self, scene, frame, size):
        run_process([self.programs / "path_trace", cells.lamps_file(scene, self.out / "scenes"), frame, 256, size,
                     self.half(scene, frame, size, "lamps"), 1])

    def trace_half(self, scene, frame, size, number):
        path = self.half(scene, frame, size, number)
        path.parent.mkdir(parents=True, exist_ok=True)
        unfinished = path.with_suffix(".part.exr")
        run_process([self.programs / "path_trace", cells.scene_file(scene, self.out / "scenes"), frame, self.form.reference_samples,
                     size, unfinished, 1000 + number])
        unfinished.rename(path)

    def picture_folder(self, cell):
        return self.out / "pictures" / cell.name

    def run_cell(self, cell, number):
        scene = cells.scene_file(cell.scene, self.out / "scenes")
        arguments = list(cell.arguments)
        folder = self.picture_folder(cell)
        key = {"build": self.build, "chapter": cell.chapter, "scene": cell.scene, "way": cell.way, "setting": cell.setting, "round": number}
        if cell.program == "parts_cell":
            output, _ = run_process([self.programs / cell.program, arguments[0], scene, *arguments[1:]])
            rows = [json.loads(line) for line in output.splitlines()]
            for row in rows:
                row["kind"] = row.pop("way")
        elif cell.program == "path_trace":
            folder.mkdir(parents=True, exist_ok=True)
            frame, count, size, _, seed = arguments
            output, seconds = run_process([self.programs / cell.program, scene, frame, count, size, folder / f"frame_{int(frame):04}.exr", seed])
            rows = [{"total_s": seconds, "first_s": seconds, "rays_first": int(output.split()[0]), "frame": int(frame)}]
        else:
            output, seconds = run_process([self.programs / cell.program, scene, *arguments, *([f"pictures={folder}"] if cell.pictures else [])])
            rows = [{**json.loads(output), "process_s": seconds}]
        self.write_rows(key, rows)

    def todo(self):
        """References first, then all cells round by round, so that all methods meet the machine's moods alike."""
        jobs = []
        for scene, frame, size in cells.references(self.form):
            if not self.only or any(cell.scene == scene and cell.pictures for cell in self.cells):
                jobs += [(f"reference {scene}", self.trace_half, (scene, frame, size, k)) for k in (1, 2)
                         if not self.half(scene, frame, size, k).exists()]
        done = {(r["chapter"], r["scene"], r["way"], r["setting"], int(r["round"]), str(r.get("frame", "")) if r["way"] == "path tracer" else "")
                for r in self.rows if r["build"] == self.build}
        for number in range(self.form.rounds):
            for cell in self.cells:
                frame = cell.arguments[0] if cell.program == "path_trace" else ""
                if number < cell.most_rounds and (cell.chapter, cell.scene, cell.way, str(cell.setting), number, frame) not in done:
                    jobs.append((cell.name, self.run_cell, (cell, number)))
        return jobs

    def run(self):
        jobs, begun, failed = self.todo(), time.time(), []
        with concurrent.futures.ThreadPoolExecutor(self.workers) as pool:
            running = {pool.submit(work, *arguments): name for name, work, arguments in jobs}
            for count, future in enumerate(concurrent.futures.as_completed(running), 1):
                if future.exception():
                    failed.append(f"{running[future]}: {future.exception()}")
                    print(f"\n{failed[-1]}", file=sys.stderr)
                left = (time.time() - begun) * (len(jobs) - count) / count
                print(f"\r{count}/{len(jobs)}  about {left / 60:.1f} min left  {running[future][:70]:70}", end="", file=sys.stderr, flush=True)
        print(file=sys.stderr)
        return failed

    def present_rows(self):
        """Of these programs and these cells alone: settings may have changed since others were run."""
        wanted = {(c.chapter, c.scene, c.way, str(c.setting)) for c in self.cells}
        return [r for r in self.rows if r["build"] == self.build and (r["chapter"], r["scene"], r["way"], r["setting"]) in wanted]


def machine():
    """What everything was measured on."""
    model = next((line.split(":")[1].strip() for line in open("/proc/cpuinfo", encoding="utf-8") if line.startswith("model name")), "unknown")
    source = pathlib.Path(__file__).resolve().parent
    revision = subprocess.run(["git", "-C", source, "describe", "--always", "--dirty"], capture_output=True, text=True, check=False).stdout.strip()
    return {"processor": model, "cores": os.cpu_count(), "system": f"{platform.system()} {platform.release().split('-')[0]}", "python": platform.python_version(), "revision": revision}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs", type=pathlib.Path)
    parser.add_argument("--quick", dest="form", action="store_const", const="quick", default="medium")
    parser.add_argument("--long", dest="form", action="store_const", const="long")
    parser.add_argument("--out", type=pathlib.Path)
    parser.add_argument("--workers", type=int, choices=(1, 2), default=1)
    parser.add_argument("--rivals", type=pathlib.Path, action="append", default=[])
    parser.add_argument("--only", action="append", default=[])
    parser.add_argument("--draw", action="store_true")
    parser.add_argument("--publish", action="store_true")
    options = parser.parse_args()
    out = options.out or pathlib.Path("build/assess" if options.form == "quick" else "out/assess")
    assessment = Assessment(options.programs, out, cells.forms[options.form], options.workers, options.only)
    failed = [] if options.draw else assessment.run()
    import figures  # not before: it needs much memory, which would be counted with the programs that are started
    figures.draw_all(assessment, machine(), options.rivals, options.publish)
    print(f"charts and tables are in {out.resolve()}")
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
