"""Black-box tests of `afterglowd render`. AFTERGLOWD names the program to test."""

import json
import os
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

import OpenImageIO as oiio

AFTERGLOWD = os.environ["AFTERGLOWD"]
SCENE = Path(__file__).resolve().parents[1] / "data" / "cornell-slide.glb"
LAST_FRAME = 48  # of the scene
# As little work as the limits allow.
COARSE = ["--size", "40x30", "--rays", "16", "--patch-size", "0.6", "--quality", "draft", "--error", "20%",
          "--cache", "none"]


class Case(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="afterglow-cli-")
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def start(self, *arguments):
        return subprocess.Popen([AFTERGLOWD, *map(str, arguments)], cwd=self.folder, text=True,
                                stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                env=os.environ | {"XDG_CACHE_HOME": str(self.folder / "cache")})

    def run_it(self, *arguments):
        """The status, standard output and standard error."""
        process = self.start(*arguments)
        out, err = process.communicate(timeout=300)
        return process.returncode, out, err

    def render(self, *arguments, scene=SCENE):
        status, out, err = self.run_it("render", scene, *COARSE, *arguments)
        self.assertEqual(status, 0, err)
        self.assertEqual(out, "")
        return err

    def names(self, folder="out"):
        return sorted(p.name for p in (self.folder / folder).iterdir())

    def bytes_of(self, folder):
        return {p.name: p.read_bytes() for p in (self.folder / folder).iterdir()}

    def picture(self, path):
        picture = oiio.ImageBuf(str(self.folder / path))
        self.assertFalse(picture.has_error, picture.geterror())
        return picture


def frame_names(first, last):
    return [f"frame_{n:04}.{ending}" for n in range(first, last + 1) for ending in ("exr", "png")]


class Frames(Case):
    def test_the_frames_asked_for_and_nothing_else(self):
        self.render("--frames", "3-5")
        self.assertEqual(self.names(), frame_names(3, 5))
        self.assertEqual(self.names("."), ["out"])

    def test_the_whole_animation(self):
        self.render("--out", "deep/er")
        self.assertEqual(self.names("deep/er"), frame_names(0, LAST_FRAME))

    def test_a_paths_file_moves_things_and_dims_the_lamp(self):
        examples = SCENE.parent / "examples"
        paths = ["--paths", examples / "study-paths.json", "--fps", "1"]
        self.render("--frames", "0-3", "--out", "still", scene=examples / "study.json")
        self.render("--frames", "0-3", *paths, "--out", "moved", scene=examples / "study.json")
        means = [oiio.ImageBufAlgo.computePixelStats(self.picture(f"moved/frame_{n:04}.exr")).avg[0] for n in range(4)]
        # The paths file holds the lamp at a quarter at 2 s (a step), and gives it back before 3 s.
        self.assertLess(means[2], 0.6 * means[0])
        self.assertGreater(means[3], 1.5 * means[2])
        moved, still = self.bytes_of("moved"), self.bytes_of("still")
        self.assertNotEqual(moved["frame_0001.exr"], still["frame_0001.exr"])

    def test_pictures_are_float_radiance_and_srgb(self):
        self.render("--frames", "0")
        exr = self.picture("out/frame_0000.exr").spec()
        self.assertEqual((exr.width, exr.height, exr.channelnames, str(exr.format)),
                         (40, 30, ("R", "G", "B"), "float"))
        png = self.picture("out/frame_0000.png").spec()
        self.assertEqual((png.width, png.height, png.nchannels, str(png.format)), (40, 30, 3, "uint8"))

    def test_the_picture_is_neither_black_nor_blown_out(self):
        self.render("--frames", "0")
        mean = oiio.ImageBufAlgo.computePixelStats(self.picture("out/frame_0000.png")).avg
        for channel in mean:
            self.assertGreater(channel, 0.1)
            self.assertLess(channel, 0.9)

    def test_exposure_changes_the_shown_picture_only(self):
        self.render("--frames", "0", "--exposure", "-2", "--out", "dark")
        self.render("--frames", "0", "--exposure", "1.5", "--out", "bright")
        dark, bright = self.bytes_of("dark"), self.bytes_of("bright")
        self.assertEqual(dark["frame_0000.exr"], bright["frame_0000.exr"])
        mean = [sum(oiio.ImageBufAlgo.computePixelStats(self.picture(f"{f}/frame_0000.png")).avg)
                for f in ("dark", "bright")]
        self.assertGreater(mean[1], mean[0])

    def test_same_bytes_for_any_number_of_threads_and_with_the_cache(self):
        self.render("--frames", "4-5", "--threads", "1", "--out", "one")
        self.render("--frames", "4-5", "--threads", "2", "--out", "two")
        arguments = [SCENE, *COARSE[:-2], "--frames", "4-5"]
        for out in ("filled", "cached"):
            self.assertEqual(self.run_it("render", *arguments, "--out", out)[0], 0)
        self.assertTrue((self.folder / "cache" / "afterglow").is_dir())
        for out in ("two", "filled", "cached"):
            self.assertEqual(self.bytes_of("one"), self.bytes_of(out), out)

    def test_a_frame_does_not_depend_on_the_frames_asked_for(self):
        # To the bit where every frame is solved anew; what follows the last frame keeps to its certificate.
        same = ("--exposure", "0", "--method", "baum86")
        self.render("--frames", "4-6", *same, "--out", "several")
        self.render("--frames", "6", *same, "--out", "alone")
        self.assertEqual(self.bytes_of("several")["frame_0006.exr"], self.bytes_of("alone")["frame_0006.exr"])

    def test_every_method_renders(self):
        for method in ("full", "baum86", "chen90", "tost-pueyo93", "events", "auto"):
            self.render("--frames", "2", "--method", method, "--out", method, "--report", f"{method}.json")
            # A single frame has nothing to reuse.
            used = "full" if method == "auto" else method
            report = json.loads((self.folder / f"{method}.json").read_text())
            self.assertEqual(report["method"], used)
            self.assertEqual(report["method_reason"] != "", method == "auto")

    def test_older_frames_are_replaced_and_other_files_stay(self):
        (self.folder / "out").mkdir()
        for name in ("frame_0000.png", "frame_0007.png", "notes.txt"):
            (self.folder / "out" / name).write_text("old")
        self.render("--frames", "0")
        self.assertEqual(self.names(), ["frame_0000.exr", "frame_0000.png", "frame_0007.png", "notes.txt"])
        self.picture("out/frame_0000.png")
        self.assertEqual((self.folder / "out" / "notes.txt").read_text(), "old")

    def test_progress_is_lines_off_a_terminal_and_quiet_on_request(self):
        err = self.render("--frames", "1-3")
        self.assertEqual([line.split(":")[0] for line in err.splitlines() if line.startswith("frame ")],
                         ["frame 1 (1 of 3)", "frame 2 (2 of 3)", "frame 3 (3 of 3)"])
        self.assertNotIn("\r", err)
        quiet = self.render("--frames", "1", "--quiet")
        self.assertEqual([line for line in quiet.splitlines() if "warning: " not in line], [])

    def test_report(self):
        self.check_report("baum86")

    def test_report_of_a_method_that_works_ahead(self):
        precompute = self.check_report("events")["precompute"]
        self.assertEqual([(p["first_frame"] <= 2, p["last_frame"] >= 4) for p in precompute], [(True, True)])
        self.assertGreater(precompute[0]["ms"], 0)

    def check_report(self, method):
        begin = time.monotonic()
        self.render("--frames", "2-4", "--method", method, "--report", "report.json")
        wall_ms = 1000 * (time.monotonic() - begin)
        report = json.loads((self.folder / "report.json").read_text())
        self.assertEqual(set(report), {"scene", "method", "patches", "actor_patches", "sight_lines", "rays_per_patch",
                                       "load_ms", "static_ms", "precompute", "peak_rss_mb", "frames",
                                       "made_for_error", "method_reason"})
        self.assertEqual(report["scene"], str(SCENE))
        self.assertGreater(report["patches"], report["actor_patches"])
        self.assertGreater(report["actor_patches"], 0)
        self.assertEqual(report["rays_per_patch"], 16)
        self.assertGreaterEqual(report["sight_lines"], 16 * (report["patches"] - report["actor_patches"]))
        self.assertEqual([f["frame"] for f in report["frames"]], [2, 3, 4])
        total = report["load_ms"] + report["static_ms"] + sum(p["ms"] for p in report["precompute"])
        for frame in report["frames"]:
            self.assertEqual(set(frame), {"frame", "ms", "rays_traced", "visibility_changes", "shots",
                                          "active_patches", "residual", "error_bound", "picture_error",
                                          "picture_error_spread", "line_noise"})
            self.assertIsNone(frame["picture_error"])
            ms = frame["ms"]
            self.assertLessEqual(ms["visibility"] + ms["solve"] + ms["image"], ms["total"])
            self.assertGreater(frame["rays_traced"], 0)
            self.assertLessEqual(frame["error_bound"], 0.2)
            total += ms["total"]
        # No part may be counted twice.
        self.assertLessEqual(total, wall_ms)
        return report

    def test_estimate(self):
        self.render("--frames", "2", "--report", "report.json", "--estimate", "probes")
        frame = json.loads((self.folder / "report.json").read_text())["frames"][0]
        self.assertGreater(frame["picture_error"], 0.005)
        self.assertLess(frame["picture_error"], 1)
        self.assertLess(frame["picture_error_spread"], frame["picture_error"])

    def test_help_and_version(self):
        for arguments in (["--help"], ["render", "--help"], ["version"]):
            status, out, err = self.run_it(*arguments)
            self.assertEqual((status, err), (0, ""))
            self.assertIn("fterglow", out)


class BadInput(Case):
    def refused(self, place, *arguments):
        """Status 2, one line that names the place, and nothing written."""
        before = self.names(".")
        status, out, err = self.run_it(*arguments)
        self.assertEqual(status, 2, f"{arguments}: {err}")
        self.assertEqual(out, "")
        errors = [line for line in err.splitlines() if not line.startswith("afterglowd: warning: ")]
        self.assertEqual(len(errors), 1, err)
        self.assertTrue(errors[0].startswith("afterglowd: "), err)
        self.assertIn(place, errors[0])
        self.assertEqual(self.names("."), before)

    def test_commands(self):
        self.refused("no command")
        self.refused('"paint"', "paint")

    def test_options(self):
        for option, value in [("--frames", "5-3"), ("--fps", "fast"), ("--size", "40"), ("--size", "0x30"),
                              ("--quality", "superb"), ("--method", "magic"), ("--visibility", "x-ray"),
                              ("--solution", "homeopathic"), ("--rays", "8"), ("--patch-size", "-1"),
                              ("--error", "120%"), ("--threads", "none"), ("--seed", "1.5"), ("--exposure", "nan"),
                              ("--background", "1,2"), ("--unit", "parsec"), ("--up", "x"),
                              ("--punctual-lights", "dim")]:
            self.refused(option.removeprefix("--"), "render", SCENE, option, value)
        self.refused("--colour", "render", SCENE, "--colour", "red")
        self.refused("SCENE", "render")

    def test_an_unknown_camera_is_named(self):
        self.refused("balcony", "render", SCENE, *COARSE, "--camera", "balcony")

    def test_scenes(self):
        (self.folder / "folder.glb").mkdir()
        (self.folder / "empty.glb").write_bytes(b"")
        (self.folder / "text.glb").write_text("not a scene")
        (self.folder / "cut.glb").write_bytes(SCENE.read_bytes()[:5000])
        (self.folder / "broken.json").write_text('{"materials": [}')
        (self.folder / "room.blend").write_text("BLENDER")
        for scene in ("missing.glb", "folder.glb", "empty.glb", "text.glb", "cut.glb", "broken.json", "room.blend"):
            self.refused(scene, "render", scene, *COARSE)

    def test_paths(self):
        (self.folder / "broken.json").write_text("[1, 2")
        for paths in ("missing.json", "broken.json"):
            self.refused(paths, "render", SCENE, *COARSE, "--paths", paths)

    def test_places_that_cannot_be_written(self):
        (self.folder / "file").write_text("in the way")
        (self.folder / "folder").mkdir()
        self.refused("file", "render", SCENE, *COARSE, "--out", "file")
        self.refused("file", "render", SCENE, *COARSE, "--out", "file/deeper")
        self.refused("folder", "render", SCENE, *COARSE, "--report", "folder")
        self.refused("nowhere", "render", SCENE, *COARSE, "--report", "nowhere/report.json")
        self.refused("null", "render", SCENE, *COARSE, "--report", "/dev/null")
        self.assertEqual((self.folder / "file").read_text(), "in the way")

    def test_control_characters_in_names_stay_out_of_the_terminal(self):
        self.refused("a?b", "render", "a\nb.glb", *COARSE)


class Stopping(Case):
    def stop(self, sent, expected):
        process = self.start("render", SCENE, *COARSE, "--frames", "0-100000", "--report", "report.json")
        while process.poll() is None and not (self.folder / "out" / "frame_0002.png").exists():
            time.sleep(0.01)
        process.send_signal(sent)
        err = process.communicate(timeout=60)[1]
        self.assertEqual(process.returncode, expected, err)
        self.assertIn("stopped on request", err.splitlines()[-1])
        names = self.names()
        self.assertEqual(names, frame_names(0, len(names) // 2 - 1))
        for name in names:
            self.picture(f"out/{name}").read()
        self.assertEqual(self.names("."), ["out"])

    def test_interrupt_leaves_whole_frames(self):
        self.stop(signal.SIGINT, 128 + signal.SIGINT)

    def test_terminate_leaves_whole_frames(self):
        self.stop(signal.SIGTERM, 128 + signal.SIGTERM)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "--verbose", *sys.argv[1:]])
