"""The leaf benchmark: its checks find planted faults, its measures separate bias from noise, a made-up program is run through its
interface, and its page has the figures of record."""

import pathlib
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

import numpy

from leaf_benchmark import __main__ as benchmark, checks, measures, page
from leaf_benchmark.programs import interface

TASK = interface.Task(ROOT / "leaf_benchmark" / "tasks" / "leaf")


def lambertian(fault=""):
    """The table of a leaf with the task's R and T at 8 degrees, that a program with this fault would write."""
    shares = {side: [numpy.array(v) for v in TASK.near_normal(side)] for side in ("front", "back")}
    if fault == "swapped":
        shares = {"front": shares["back"], "back": shares["front"]}
    change = {"squared": lambda v: v * v, "energy": lambda v: 1.05 * v}.get(fault, lambda v: v)
    shares = {side: [change(v) for v in of] for side, of in shares.items()}
    if fault == "opaque":
        shares = {side: [r, 0 * t] for side, (r, t) in shares.items()}
    theta, _ = interface.views(TASK)
    front = theta < 90

    def f(light):
        r, t = shares["front" if light < 90 else "back"]
        same = (front == (light < 90))[..., None]
        value = numpy.where(same, r, t) / numpy.pi
        return value * abs(numpy.cos(numpy.radians(light))) if fault == "cosine" else value

    side = lambda angle: shares["front" if angle < 90 else "back"]
    table = {name: [side(angle)[i] for angle in TASK.theta] for i, name in enumerate("RT")}
    table["S"] = [sum(side(angle)) for angle in TASK.theta]
    if fault == "density":  # directions of one side alone are drawn, with the density of both
        table["R"] = [2 * v for v in table["R"]]
        table["T"] = [0 * v for v in table["T"]]
    return measures.frame(interface.rows_of(TASK, f, table))


def failed(fault=""):
    return {found["check"] for found in checks.check(lambertian(fault), TASK.leaf) if not found["passed"]}


class Checks(unittest.TestCase):
    def test_a_right_table_passes(self):
        self.assertEqual(failed(), set())

    def test_planted_faults_are_found(self):
        for fault, named in (("cosine", "cosine, R of the front"), ("density", "T of the front"), ("squared", "R of the front"),
                             ("swapped", "R of the back"), ("energy", "R of the back"), ("opaque", "T of the front")):
            with self.subTest(fault):
                self.assertIn(named, failed(fault))


PROGRAM = """#!{python}
import numpy
from leaf_benchmark.programs import interface

def image(task, samples, seed, out):
    r, _ = task.near_normal()
    numpy.save(out.removesuffix(".exr") + ".npy", numpy.broadcast_to([1.1 * r[0], r[1], 0.9 * r[2]], (task.height, task.width, 3)))
    return 0.25

def table(task, samples, seed):
    raise NotImplementedError("evaluates no BSDF")

interface.main(image, table, {{"made-up renderer": "1"}})
"""


class Interface(unittest.TestCase):
    def test_a_program_that_multiplies_the_colours_of_a_lambertian_leaf(self):
        with tempfile.TemporaryDirectory() as temporary:
            folder = pathlib.Path(temporary)
            (folder / "entry").write_text(PROGRAM.format(python=sys.executable), encoding="utf-8")
            (folder / "entry").chmod(0o755)
            out = folder / "1.exr"
            took = benchmark.run(folder, interface.Task(ROOT / "leaf_benchmark" / "tasks" / "front"), 1, 1, out)
            self.assertEqual((took["cpu_s"], took["versions"]), (0.25, {"made-up renderer": "1"}))
            self.assertEqual(numpy.load(benchmark.written(out)).shape, (128, 128, 3))
            with self.assertRaisesRegex(benchmark.Cannot, "evaluates no BSDF"):
                benchmark.run(folder, TASK, 1, 1, out)


    def test_a_program_that_is_not_installed(self):
        with tempfile.TemporaryDirectory() as temporary:
            folder = pathlib.Path(temporary)
            (folder / "entry").write_text("#!/usr/bin/env a-program-that-nobody-has\n", encoding="utf-8")
            (folder / "entry").chmod(0o755)
            with self.assertRaisesRegex(FileNotFoundError, "a-program-that-nobody-has"):
                benchmark.run(folder, TASK, 1, 1, folder / "1.csv")


class Measures(unittest.TestCase):
    def test_bias_is_separate_from_noise(self):
        # 1e4 pixels of fixed seed: the interval misses the bias by chance in one of twenty seeds.
        random, leaf = numpy.random.default_rng(1), numpy.ones((100, 100), bool)
        truth = random.random((100, 100, 3))
        noisy = lambda image, error: [image + random.normal(0, error, image.shape) for _ in range(2)]
        value, low, high = measures.bias(noisy(truth + 0.02, 0.05), noisy(truth, 0.01), leaf)
        self.assertTrue(low < 0.02 < high and high - low < 0.003, (low, high))
        self.assertEqual(measures.bias(noisy(truth, 0.05), noisy(truth, 0.01), leaf)[1], 0)

    def test_the_interval_of_all_colours_covers_correlated_noise(self):
        # 200 pairs of renders whose colours have the same noise: fewer than 180 of 95 % intervals contain the bias in one of 500 seeds.
        random, leaf, inside = numpy.random.default_rng(2), numpy.ones((30, 30), bool), 0
        truth = random.random((30, 30, 3))
        for _ in range(200):
            images = [truth + 0.02 + random.normal(0, 0.02, (30, 30, 1)) for _ in range(2)]
            _, low, high = measures.bias(images, (truth, truth), leaf)
            inside += low < 0.02 < high
        self.assertGreaterEqual(inside, 180)

    def test_time_for_an_error(self):
        points = [{"cpu_s": 1, "rms": 0.04}, {"cpu_s": 4, "rms": 0.02}]
        self.assertAlmostEqual(measures.time_to(points, 0, 0.02), 4)
        self.assertAlmostEqual(measures.time_to(points, 0, 0.01), 16)
        self.assertIsNone(measures.time_to(points, 0.015, 0.01))


    def test_absorbed_light_is_the_row_beyond_the_views(self):
        truth, found = numpy.full((8, 4), 0.5), numpy.full((8, 4), 0.5)
        found[7] = 0.55
        errors = measures.of_brf([found, found], [truth, truth], [450, 550, 670, 800], 7)
        self.assertAlmostEqual(errors["absorbed"]["670"], 0.1)
        self.assertEqual(errors["rms"], 0)
        self.assertNotIn("absorbed", measures.of_brf([found[:7]] * 2, [truth] * 2, [450, 550, 670, 800], 7))

    def test_points_of_other_numbers_of_samples_stay(self):
        of = lambda samples, value: {"points": [{"samples": samples, "cpu_s": value}], "bias": value}
        kept = benchmark.merged(of(64, 1), of(8, 2))
        self.assertEqual(([p["samples"] for p in kept["points"]], kept["bias"]), ([8, 64], 1))
        self.assertEqual(benchmark.merged(of(64, 1), of(64, 2)), of(64, 2))
        self.assertEqual(benchmark.merged(of(8, 1) | {"again": 3}, of(64, 2))["again"], 3)


class Page(unittest.TestCase):
    def test_a_second_run_has_the_same_order(self):
        counts, _ = page.repeated(page.results())
        for same, pairs in counts.values():
            self.assertGreater(pairs, 50)
            self.assertEqual(same, pairs)

    def test_figures_are_those_of_record(self):
        text = page.PAGE.read_text(encoding="utf-8")
        self.assertEqual(page.page(text, page.results()), text)


if __name__ == "__main__":
    unittest.main()
