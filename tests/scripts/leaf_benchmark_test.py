"""The leaf benchmark: its checks find planted faults in tables of a Lambertian leaf."""

import json
import pathlib
import sys
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
sys.path.insert(0, str(ROOT))

try:
    import numpy
    import pandas
except ImportError as missing:
    raise unittest.SkipTest(str(missing)) from None

from leaf_benchmark import checks
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
    rows = pandas.DataFrame(list(interface.rows_of(TASK, f, table)), columns=interface.COLUMNS)
    return rows.apply(pandas.to_numeric, errors="coerce").assign(quantity=rows.quantity)


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


if __name__ == "__main__":
    unittest.main()
