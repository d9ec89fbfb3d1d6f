"""The measurement rami: its reference solution and its scenes."""

import pathlib
import tempfile
import unittest

import numpy
import pandas

from measurements import rami
from measurements.shared.turbid import turbid_layer


class TurbidLayerTest(unittest.TestCase):
    def test_what_absorbs_nothing_returns_all(self):
        albedo, absorbed, _ = turbid_layer(3, 0.5, 0.5, 1.0, 30, [(0, 0)], 16, 1)
        self.assertAlmostEqual(albedo, 1, delta=1e-4)
        self.assertEqual(absorbed, 0)

    def test_it_is_reciprocal(self):
        there, back = (turbid_layer(2, 0.4, 0.1, 0.2, sun, [(view, 60)], 16, 16)[2] for sun, view in ((20, 50), (50, 20)))
        self.assertAlmostEqual(float(there[0]), float(back[0]), delta=1e-6)

    def test_black_leaves_over_soil_are_beers_law(self):
        _, _, brf = turbid_layer(1.5, 0, 0, 0.3, 40, [(60, 180)], 16, 1)
        paths = 1 / numpy.cos(numpy.radians(40)) + 1 / numpy.cos(numpy.radians(60))
        self.assertAlmostEqual(float(brf[0]), 0.3 * numpy.exp(-0.75 * paths), delta=1e-5)

    def test_thin_layers_scatter_once(self):
        lai, r, t, sun, view = 1e-4, 0.4, 0.1, 30, 50
        _, _, brf = turbid_layer(lai, r, t, 0, sun, [(view, 180)], 16, 32)
        b = numpy.pi - numpy.radians(view - sun)  # back to the sun's side
        gamma = (r + t) * (numpy.sin(b) - b * numpy.cos(b)) / (3 * numpy.pi) + t * numpy.cos(b) / 3
        single = lai * gamma / numpy.cos(numpy.radians(sun)) / numpy.cos(numpy.radians(view))
        self.assertAlmostEqual(float(brf[0]) / single, 1, delta=1e-3)


class ForestTest(unittest.TestCase):
    def test_trees_are_apart_and_needles_in_their_crown(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name)
            rami.trees(folder / "trees.npy", 1, count=300, half=50)
            at = pandas.read_csv(folder / "trees.csv")[["x", "y"]].to_numpy()
            distances = numpy.hypot(*(at[:, None] - at).transpose(2, 0, 1)) + 1e3 * numpy.eye(len(at))
            self.assertEqual(len(at), 300)
            self.assertGreaterEqual(distances.min(), 3.6 - 1e-9)
            rami.crown(folder / "crown.npy", 1)
            needles = pandas.read_csv(folder / "crown.csv")
            self.assertEqual(len(needles), 6480)
            self.assertTrue((numpy.hypot(needles.x, needles.y) <= 1.8 * (13.5 - needles.z) / 12 + 1e-9).all())
            # Uniform in a cone: the mean height is a quarter of it, 5 standard errors of 0.19 * 12 / sqrt(6480) m.
            self.assertAlmostEqual(needles.z.mean(), 1.5 + 3, delta=0.15)


if __name__ == "__main__":
    unittest.main()
