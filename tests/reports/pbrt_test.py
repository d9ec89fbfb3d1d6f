"""The list of scenes that agree with pbrt-v4 (scripts/reports/pbrt.py)."""
import subprocess
import sys
import unittest

import pbrt


class Agreeing(unittest.TestCase):
    def test_what_agrees_no_longer_stays_until_it_is_forgotten(self):
        results = {"a": None, "b": None, "c": None}
        self.assertEqual(pbrt.agreeing(["a", "b"], results, ["b"], False), ["a", "b", "c"])
        self.assertEqual(pbrt.agreeing(["a", "b"], results, ["b"], True), ["a", "c"])

    def test_one_seed_tells_no_noise(self):
        done = subprocess.run([sys.executable, "-B", pbrt.__file__, "--seeds", "1"], capture_output=True, text=True,
                              check=False)
        self.assertEqual(done.returncode, 2)
        self.assertIn("--seeds: 2 at least", done.stderr)


if __name__ == "__main__":
    unittest.main()
