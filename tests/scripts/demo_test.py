"""The table of scripts/demo: times to the same error, from a compare.csv."""

import pathlib
import subprocess
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
COLUMNS = "candidate,samples,cpu_seconds,region,channel,rms,noise,bias,bias_low,bias_high,setup_cpu_seconds,rays"


def runs(model, rms, noise, bias):
    """Runs of 1, 2 and 4 samples: a second each and 0.5 of set-up, a million rays for each sample."""
    return [f"{model},{n},{n + 0.5},all,rgb,{r},{noise},{','.join(map(str, bias))},0.5,{n * 1_000_000}" for n, r in zip((1, 2, 4), rms)]


class Costs(unittest.TestCase):
    def table(self, *lines):
        with tempfile.TemporaryDirectory() as folder:
            csv, rays = pathlib.Path(folder) / "compare.csv", pathlib.Path(folder) / "rays"
            other = lines[0].replace("all,rgb", "leaf,rgb").replace("0.0", "0.9")  # other pixels do not count
            csv.write_text("\n".join(("# frond", COLUMNS, other, *lines)) + "\n")
            r = subprocess.run(["awk", "-F,", "-v", "scene=front", "-v", f"rays={rays}", "-f", ROOT / "scripts/demo_costs.awk", csv],
                               capture_output=True, text=True, check=True)
            self.assertEqual(r.stderr, "")
            return [line.split(maxsplit=2) for line in r.stdout.splitlines()], rays.read_text()

    def test_times_are_those_of_the_same_error(self):
        abm = runs("abm", (0.08, 0.06, 0.04), 0.04, (0, 0, 0.001))
        (first, second), rays = self.table(*abm, *runs("leaf_simplified", (0.045, 0.03, 0.02), 0.01, (0.016, 0.015, 0.017)))
        # Between 1.5 s with 0.045 and 2.5 s with 0.03: 1.5 (2.5 / 1.5)^(log(0.045 / 0.04) / log(0.045 / 0.03)) = 1.74 s.
        self.assertEqual(first[:2] + first[2].split(), ["front", "0.0400", "4.5", "s", "1.7", "s"])
        # 0.008 is half the bias: abm needs 25 times the time of an error of 0.04.
        self.assertEqual(second[1], "0.0080")
        self.assertRegex(second[2], r"^11[23] s, extrapolated +not reached: its bias is 0\.0160$")
        self.assertEqual(rays.split(), ["front", "1.00", "1.00", "16"])

    def test_a_bias_that_is_not_found_is_bounded(self):
        abm = runs("abm", (0.08, 0.06, 0.04), 0.04, (0, 0, 0.001))
        (first, second), _ = self.table(*abm, *runs("leaf_simplified", (0.03, 0.02, 0.01), 0.01, (0, 0, 0.002)))
        self.assertEqual(first[2].split("  ")[-1].strip(), "at most 1.5 s")
        self.assertIn("the bias of leaf_simplified is at most 0.0020", " ".join(second))


if __name__ == "__main__":
    unittest.main()
