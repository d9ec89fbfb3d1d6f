"""The list of scenes that agree with pbrt-v4 (measurements/pbrt)."""
import pathlib
import subprocess
import sys
import tempfile
import unittest

import numpy

from measurements.pbrt import __main__ as pbrt
from measurements.pbrt import scenes as scene_files


class Agreeing(unittest.TestCase):
    def test_what_agrees_no_longer_stays_until_it_is_forgotten(self):
        results = {"a": None, "b": None, "c": None}
        self.assertEqual(pbrt.agreeing(["a", "b"], results, ["b"], False), ["a", "b", "c"])
        self.assertEqual(pbrt.agreeing(["a", "b"], results, ["b"], True), ["a", "c"])

    def test_one_seed_tells_no_noise(self):
        done = subprocess.run([sys.executable, "-B", "-m", "measurements.pbrt", "--seeds", "1"], capture_output=True, text=True,
                              check=False)
        self.assertEqual(done.returncode, 2)
        self.assertIn("--seeds: 2 at least", done.stderr)


class Scenes(unittest.TestCase):
    def test_each_root_file_has_a_row_and_refused_ones_their_error(self):
        with tempfile.TemporaryDirectory() as name:
            folder = pathlib.Path(name) / "some"
            (folder / "a").mkdir(parents=True)
            head = 'Film "rgb" "integer xresolution" 4 "integer yresolution" 4\nCamera "perspective"\nWorldBegin\n'
            (folder / "a" / "good.pbrt").write_text(f'{head}LightSource "infinite"\nInclude "part.pbrt"\n')
            (folder / "a" / "part.pbrt").write_text('# WorldBegin\nShape "sphere"\n')
            (folder / "bad.pbrt").write_text(f"{head}Foo\n")
            output = folder.parent / "table.md"
            scene_files.scenes(folder, 1, None, output)
            page = output.read_text()
            self.assertIn("1 of 2 scene files render as they are; 1 of 2 folders", page)
            self.assertIn("| `a/good.pbrt` | rendered |", page)
            self.assertIn("| `bad.pbrt` | refused: bad.pbrt:4:1: unknown directive Foo |", page)
            self.assertTrue((folder.parent / "table" / "a-good-1.exr").exists())

    def test_the_error_of_a_difference_comes_from_two_seeds(self):
        random = numpy.random.default_rng(1)
        z = []
        for _ in range(200):
            images = [[1 + random.normal(0, 0.1, (8, 8, 3)) for _ in range(2)] for _ in range(2)]
            relative, error = scene_files.difference(*images)
            z.append(relative / error)
        # 200 values of unit variance: their standard deviation is 1 +- 0.05; beyond 4 of these once in 16,000 by chance.
        self.assertAlmostEqual(numpy.std(z), 1, delta=0.2)

    def test_messages_lose_colours_and_folders(self):
        self.assertEqual(scene_files.first_error("\x1b[1mError\x1b[0m: /a/b.pbrt:2:0: Unknown directive: Foo"),
                         "b.pbrt:2:0: Unknown directive: Foo")
        self.assertEqual(scene_files.first_error("frond: /a/b.pbrt:2:1: x"), "b.pbrt:2:1: x")


if __name__ == "__main__":
    unittest.main()
