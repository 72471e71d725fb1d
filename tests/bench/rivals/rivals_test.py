"""What the scripts beside this file reckon: scenes as read and written, errors, flicker, costs at equal error."""
import pathlib
import re
import sys
import tempfile
import unittest

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent))
import pictures  # noqa: E402
import povray_scene  # noqa: E402
from figures import cost_at  # noqa: E402
from gltf_scene import Scene  # noqa: E402
from rivals import Rows, Run, check_positions, collect, data, picture, runs  # noqa: E402

CORNELL = Scene(data / "cornell-slide.glb")


def surface(scene, name, frame):
    return next(s for s in scene.surfaces(frame) if s.name == name)


class Scenes(unittest.TestCase):
    def test_an_actor_is_where_its_track_says(self):
        start, later = (surface(CORNELL, "short_block", frame).triangles for frame in (0, 12))
        np.testing.assert_allclose(later - start, np.broadcast_to([-0.5, 0, 0], start.shape), atol=1e-5)
        between = surface(CORNELL, "short_block", 11.5).triangles - start
        self.assertLess(-0.5, between[0, 0, 0])

    def test_every_track_of_several_animations_is_read(self):
        room = Scene(data / "living-room.glb")
        for name, offset in (("walker", (0.48, 0, 0.9)), ("visitor", (-0.2, 0, 0.48)), ("robot", (0.72, 0, 0))):
            moved = surface(room, name, 24).triangles - surface(room, name, 0).triangles
            np.testing.assert_allclose(moved, np.broadcast_to(offset, moved.shape), atol=1e-4)

    def test_turned_furniture_keeps_its_shape(self):
        room = Scene(data / "living-room.glb")
        extents = [np.ptp(surface(room, name, 0).triangles.reshape(-1, 3), axis=0) for name in ("chair0", "chair2")]
        np.testing.assert_allclose(*extents, atol=1e-5)

    def test_lamps_and_surfaces(self):
        lamp, wall = surface(CORNELL, "light", 0), surface(CORNELL, "left", 0)
        np.testing.assert_allclose(lamp.radiance, [17, 12, 4], rtol=1e-5)
        self.assertEqual(wall.radiance.max(), 0)
        np.testing.assert_allclose(wall.reflectance, [0.63, 0.065, 0.05], rtol=1e-5)
        _, u, v, normal = povray_scene.rectangle(lamp.triangles)
        self.assertAlmostEqual(np.linalg.norm(np.cross(u, v)), 1.3 * 1.05, 4)
        np.testing.assert_allclose(normal, [0, -1, 0], atol=1e-6)

    def test_what_is_no_rectangle_is_no_area_lamp(self):
        with self.assertRaises(ValueError):
            povray_scene.rectangle(surface(CORNELL, "short_block", 0).triangles)

    def test_all_triangles_are_written_for_povray(self):
        written = povray_scene.text(CORNELL, 0, "count 10", 3)
        triangles = sum(len(s.triangles) for s in CORNELL.surfaces(0))
        blocker = len(surface(CORNELL, "light", 0).triangles)  # a lamp's black back
        faces = [int(n) for n in re.findall(r"face_indices \{ (\d+),", written)]
        self.assertEqual(sum(faces), triangles + blocker)
        self.assertEqual(written.count("light_source"), 1)
        self.assertEqual(povray_scene.text(CORNELL, 0, "count 10", 0).count("light_source"), 0)


class Pictures(unittest.TestCase):
    def setUp(self):
        random = np.random.default_rng(1)
        self.noise = lambda size, share: 1 + share * random.standard_normal(size)

    def test_noise_of_one_percent_flickers_one_percent_beside_noisy_truth(self):
        size = (12, 64, 64, 3)
        truth = [self.noise(size, 0.02), self.noise(size, 0.02)]
        self.assertAlmostEqual(pictures.flicker(self.noise(size, 0.01), truth, 1), 0.01, 3)
        self.assertAlmostEqual(pictures.flicker(self.noise(size, 0.08), truth, 8), 0.01, 3)

    def test_errors_that_stay_or_change_evenly_do_not_flicker(self):
        truth = [np.ones((5, 8, 8, 3))] * 2
        wrong = self.noise((8, 8, 3), 0.3) * np.arange(1, 6).reshape(5, 1, 1, 1)
        self.assertLess(pictures.flicker(wrong, truth, 1), 1e-9)

    def test_pixels_are_constantly_lit_where_nothing_changes_and_no_lamp_is_near(self):
        truth = np.ones((3, 8, 8, 3))
        truth[1, 0, 0] = 1.01
        truth[:, 5, 5] = 9
        keep = pictures.lit_within([truth, truth], 0, pictures.CONSTANT)
        self.assertFalse(keep[0, 0])
        self.assertFalse(keep[4, 6])
        self.assertEqual(keep.sum(), 64 - 1 - 9)
        self.assertEqual(pictures.lit_within([truth, truth], pictures.CONSTANT, 0.1).sum(), 1)

    def test_only_chosen_pixels_flicker(self):
        truth, shown = np.ones((4, 8, 8, 3)), np.ones((4, 8, 8, 3))
        shown[2, 3, 3] = 1.1
        keep = np.ones((8, 8), dtype=bool)
        keep[3, 3] = False
        self.assertGreater(pictures.flicker(shown, [truth, truth], 1), 1e-3)
        self.assertEqual(pictures.flicker(shown, [truth, truth], 1, keep), 0)
        self.assertGreater(pictures.flicker_of_constant(shown, 1), 1e-3)
        self.assertEqual(pictures.flicker_of_constant(truth, 1), 0)

    def test_a_dimmed_reference_is_off_by_as_much(self):
        a, b = pictures.reference("cornell-slide", 12)
        rmse, ratio = pictures.error(0.5 * (a + b), "cornell-slide", 12)
        self.assertLess(rmse, 0.02)
        self.assertAlmostEqual(ratio, 1)
        self.assertAlmostEqual(pictures.error(0.9 * 0.5 * (a + b), "cornell-slide", 12)[0], 0.1, 2)


class Costs(unittest.TestCase):
    def test_between_points_along_the_line(self):
        self.assertEqual(cost_at([(1, 0.08), (4, 0.04), (16, 0.02)], 0.04), (4, False))
        seconds, beyond = cost_at([(1, 0.08), (4, 0.04)], 0.08 / np.sqrt(2))
        self.assertAlmostEqual(seconds, 2)
        self.assertFalse(beyond)

    def test_beyond_them_by_the_root_or_faster(self):
        for points, rmse, cost in (([(1, 0.08), (4, 0.04)], 0.01, 64), ([(1, 0.05), (4, 0.04)], 0.01, 64),
                                   ([(1, 0.16), (4, 0.04)], 0.01, 16), ([(4, 0.04)], 0.02, 16), ([(1, 0.08)], 0.16, 0.25)):
            seconds, beyond = cost_at(points, rmse)
            self.assertAlmostEqual(seconds, cost)
            self.assertTrue(beyond)


class Resuming(unittest.TestCase):
    def test_rows_written_are_not_rendered_again(self):
        run = Run("cornell-slide", "cycles", "64", "fixed", 32, (3, 4, 5))
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "rows.csv"
            rows = Rows(path)
            rows.add(run, None, 2)
            rows.add(run, 4, 1.5)
            again = Rows(path)
            self.assertEqual(again.missing(run), [3, 5])
            self.assertIn(picture(run, 4), path.read_text(encoding="utf-8"))

    def test_what_an_interrupted_run_of_cycles_left_is_taken_over_once(self):
        run = Run("cornell-slide", "cycles", "64", "fixed", 32, (3, 12))
        with tempfile.TemporaryDirectory() as folder:
            told, rows = pathlib.Path(folder) / "rows.json", Rows(pathlib.Path(folder) / "rows.csv")
            told.write_text('{"startup_cpu_seconds": 2}\n{"frame": 12, "cpu_seconds": 1.5, "positions": {"short_block": [-0.2, 0, 0]}}\n',
                            encoding="utf-8")
            collect(run, rows, told, CORNELL)
            self.assertEqual(rows.missing(run), [3])
            self.assertFalse(told.exists())

    def test_an_actor_elsewhere_is_an_error(self):
        with self.assertRaises(SystemExit):
            check_positions(CORNELL, {"frame": 12, "positions": {"short_block": [0.3, 0, 0]}})

    def test_every_run_has_its_own_folder(self):
        keys = [run.key for run in runs()]
        self.assertEqual(len(keys), len(set(keys)))


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], "--verbose"])
