"""The assessment's own parts: scenes are the same every time and fit their schema, measures measure, cells are told apart."""
import json
import pathlib
import sys
import unittest

import jsonschema
import numpy as np

here = pathlib.Path(__file__).resolve().parent
sys.path[:0] = [str(here), str(here.parent)]
import cells  # noqa: E402
import charts  # noqa: E402
import families  # noqa: E402
import measures  # noqa: E402
from reference_error import grown  # noqa: E402


class Scenes(unittest.TestCase):
    rooms = [families.member(family, value) for family, (_, values) in families.families.items() for value in values]
    rooms += [families.drawn(seed) for seed in range(1, 55)]

    def test_fit_the_schema(self):
        scene, paths = (json.loads((here.parents[1] / "schema" / f"{name}.schema.json").read_text(encoding="utf-8"))
                        for name in ("scene", "paths"))
        store = {"paths.schema.json": paths, paths.get("$id", ""): paths}
        validator = jsonschema.Draft202012Validator(scene, resolver=jsonschema.RefResolver.from_schema(scene, store=store))
        for room in self.rooms:
            self.assertIsNone(next(validator.iter_errors(families.scene(room)), None), room)

    def test_are_the_same_every_time_and_others_for_other_seeds(self):
        for room in self.rooms:
            self.assertEqual(families.scene(room), families.scene(room))
        self.assertNotEqual(families.scene(families.member("actors", 3)), families.scene(families.member("actors", 3, 2)))

    def test_move_at_their_speed_for_as_long_as_asked(self):
        for room in self.rooms:
            tracks = [t["translation"] for t in families.scene(room)["tracks"] if "node" in t]
            self.assertEqual(len(tracks), room.moving)
            for keys in tracks:
                self.assertGreaterEqual(keys[-1][0], room.frames / families.frames_per_second)
                for (t0, *a), (t1, *b) in zip(keys, keys[1:]):
                    self.assertAlmostEqual(float(np.linalg.norm(np.subtract(a, b))) / (t1 - t0), room.speed_m_per_s, delta=1e-3 * room.speed_m_per_s)

    def test_balls_are_closed(self):
        for faces in (80, 320, 5120):
            ball = families.ball(1, faces)
            self.assertEqual(len(ball["triangles"]), faces)
            self.assertEqual(len(ball["positions"]), faces // 2 + 2)


class Measures(unittest.TestCase):
    def test_error_does_not_count_the_noise_of_the_reference(self):
        random = np.random.default_rng(1)
        truth = random.uniform(0.5, 1, (96, 96, 3))
        picture = truth + 0.02 * truth.mean() * random.standard_normal(truth.shape)
        a, b = (truth + 0.05 * random.standard_normal(truth.shape) for _ in range(2))
        error, low, high = measures.error_with_interval(picture, a, b)
        exact = np.sqrt(((picture - truth) ** 2).mean() / (truth ** 2).mean())
        self.assertLess(low, exact)
        self.assertGreater(high, exact)
        self.assertLess(abs(error - exact), 0.5 * exact)

    def test_pixels_that_show_a_lamp_and_their_neighbours_do_not_count(self):
        truth, lamps = np.ones((16, 16, 3)), np.zeros((16, 16, 3))
        lamps[8, 8] = 0.01
        picture = truth.copy()
        picture[7:10, 7:10] = 5
        self.assertEqual(measures.error_with_interval(picture, truth, truth, lamps)[0], 0)
        self.assertEqual(grown(lamps[..., 0] > 0).sum(), 9)

    def test_flicker_of_noise_is_its_deviation_and_of_a_steady_error_none(self):
        random = np.random.default_rng(2)
        truth = [np.ones((32, 32, 3)) for _ in range(40)]
        self.assertAlmostEqual(measures.flicker([t + 0.01 * random.standard_normal(t.shape) for t in truth], truth), 0.01, delta=3e-4)
        self.assertAlmostEqual(measures.flicker([t + 0.1 for t in truth], truth), 0, places=12)


class Cells(unittest.TestCase):
    def test_no_two_cells_are_one(self):
        for form in cells.forms.values():
            names = [c.name + (c.arguments[0] if c.program == "path_trace" else "") for c in cells.all_cells(form)]
            self.assertEqual(len(names), len(set(names)))

    def test_axes_hold_what_they_were_made_for(self):
        values = [0.002, 0.5, 31]
        axis = charts.logarithmic(values)
        self.assertTrue(all(0 < axis.share(v) < 1 for v in values))
        self.assertTrue(all(axis.low <= t <= axis.high for t in axis.ticks))


if __name__ == "__main__":
    unittest.main()
