"""The measurement race: statistics of images, scenes read and written again, a page."""

import pathlib
import struct
import tempfile
import unittest

import numpy
from measurements.race import luminance, page, scenes


def noisy(mean, deviation, seed, count=4, size=68):
    return numpy.random.default_rng(seed).normal(mean, deviation, (count, size, size))


class ImagesTest(unittest.TestCase):
    def test_variance_is_that_of_a_pixel(self):
        # 64 x 64 pixels of 4 seeds: a relative standard error of sqrt(2 / 12288) = 0.013; 5 of them, false alarms 6e-7.
        found = luminance.measure(noisy(1, 0.1, 1))
        self.assertAlmostEqual(found.variance, 0.01, delta=5 * 0.013 * 0.01)
        self.assertAlmostEqual(found.variance_error / 0.01, 0.013, delta=0.013)

    def test_a_shift_is_seen_in_the_mean_and_in_the_blocks(self):
        found = luminance.difference(luminance.measure(noisy(1.01, 0.1, 2)), luminance.measure(noisy(1, 0.1, 3)))
        self.assertAlmostEqual(found.mean, 0.01, delta=5 * found.error)
        self.assertAlmostEqual(found.error, 0.1 * (2 / 4 / 64**2)**0.5, delta=0.4 * found.error)
        self.assertAlmostEqual(found.blocks, 0.01, delta=0.003)

    def test_light_in_another_place_is_seen_in_the_blocks_alone(self):
        a, b = noisy(1, 0.01, 4), noisy(1, 0.01, 5)
        a += numpy.where(numpy.arange(68) < 34, 0.1, -0.1)
        found = luminance.difference(luminance.measure(a), luminance.measure(b))
        self.assertLess(abs(found.mean), 0.005)
        self.assertAlmostEqual(found.blocks, 0.1, delta=0.005)

    def test_pfm_is_read_from_the_top(self):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "a.pfm"
            path.write_bytes(b"PF\n2 2\n-1.0\n" + struct.pack("<12f", *[1] * 6, *[2] * 6))
            self.assertEqual(luminance.read(path).round(5).ravel().tolist(), [2, 2, 1, 1])


class ScenesTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def test_our_scenes_are_read(self):
        counts = {name: len(scenes.SCENES[name](self.folder).instances) for name in scenes.SCENES if name != "canopy"}
        self.assertEqual(counts["front"], 100)
        self.assertTrue(all(counts.values()), counts)

    def test_what_is_written_is_read_the_same(self):
        scene = scenes.SCENES["soybean-front"](self.folder)
        path = self.folder / "scene.pbrt"
        scenes.write_pbrt(scene, path, "leaf", True, 64)
        again = scenes.read(path, self.folder)
        self.assertEqual(again.camera, scene.camera)
        self.assertEqual(len(again.instances), len(scene.instances))
        for (a, m), (b, n) in zip(again.instances, scene.instances):
            self.assertEqual(a, b)
            numpy.testing.assert_allclose(m, n, rtol=0, atol=1e-6)
        for a, b in zip(again.shapes, scene.shapes):
            self.assertEqual((a.kind, a.material, a.object, a.reversed), (b.kind, b.material, b.object, b.reversed))
            self.assertAlmostEqual(a.radiance, b.radiance, places=4)

    def test_what_it_does_not_know_is_an_error(self):
        path = self.folder / "scene.pbrt"
        path.write_text('WorldBegin\nShape "sphere"\n', encoding="utf-8")
        with self.assertRaises(SystemExit):
            scenes.read(path, self.folder)

    def test_turns_and_moves(self):
        moved = scenes.affine(place=(5, 6, 7)) @ scenes.rotation(90, 0, 0, 1)
        numpy.testing.assert_allclose(moved @ (1, 2, 3, 1), (-2 + 5, 1 + 6, 3 + 7, 1))

    def test_a_lamp_faces_the_origin(self):
        lamp = scenes.lamp((0, -1, 0), 4, 0.5)
        self.assertEqual(lamp.to_world[:, 3].round(9).tolist(), [0, -4, 0, 1])
        self.assertEqual(lamp.to_world[:, 2].round(9).tolist(), [0, 1, 0, 0])


class PageTest(unittest.TestCase):
    def result(self, program, cpu, variance, difference=0.0):
        return {"program": program, "cpu": cpu, "wall": cpu, "set_up_cpu": 0.1, "variance": variance, "variance_error": 0,
                "difference": difference, "difference_error": 0.0001, "blocks": 0, "scene": "front", "leaf": "opaque",
                "filter": "box", "reference": "ours"}

    def test_efficiency_is_against_the_reference_of_the_same_round(self):
        ours, other = self.result("ours", [2, 4], 0.01), self.result("other", [1, 2], 0.02)
        self.assertEqual(page.efficiencies(other, ours), [1, 1])

    def test_other_images_are_marked(self):
        self.assertIn("!", page.mean(self.result("other", [1], 0.01, 0.01)))
        self.assertNotIn("!", page.mean(self.result("other", [1], 0.01, 0.0003)))


if __name__ == "__main__":
    unittest.main()
