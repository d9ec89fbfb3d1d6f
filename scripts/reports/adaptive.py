"""docs/adaptive.md: error against time of even and of adaptive samples."""

import json
import math
import pathlib
import tempfile

from tools import COLORS, ROOT, block, frond, gnuplot, machine, table

SCENES = ["soybean-front", "soybean-back", "soybean-ambient", "hundred-leaves"]
EVEN = [32, 64, 128, 256]
REFERENCE = 512
COLORS_OF_PICTURE = ("red", "green", "blue")
SEEDS = (1, 2)
REFERENCE_SEEDS = (11, 12)


class Pair:
    """Two renders with seeds of their own: their mean cost, and by how they differ their noise."""

    def __init__(self, scene, folder, name, seeds, *options):
        self.images, runs = [], []
        for seed in seeds:
            self.images.append(folder / f"{scene}-{name}-{seed}.exr")
            runs.append(json.loads(frond(
                "render", ROOT / "scenes" / scene / "scene.pbrt", "-o", self.images[-1], "--seed", seed, "--quick",
                "--wavelengths", "smpte", "--swap", "*=leaf_simplified", "--json", "-q", *options)))
        self.cpu, self.rays, self.paths = (sum(run[key] for run in runs) / 2 for key in ("cpu_seconds", "rays", "paths"))

    def against(self, reference):
        """RMS noise of one render, and the upper 95 % bound of the bias: over pixels and colours."""
        found = json.loads(frond("difference", *self.images, *reference.images, "--json"))
        mean = lambda key: math.sqrt(sum(found[f"{key}_{c}"] ** 2 for c in COLORS_OF_PICTURE) / 3)
        return math.sqrt(2) * mean("noise_a"), mean("bias_upper")


def cost_at(points, rms, key):
    """What even samples take to this noise: a power law between two of them, or beyond the last two."""
    for (rms_0, pair_0), (rms_1, pair_1) in zip(points, points[1:]):
        if rms >= rms_1 or pair_1 is points[-1][1]:
            cost_0, cost_1 = key(pair_0), key(pair_1)
            return cost_0 * (rms / rms_0) ** (math.log(cost_1 / cost_0) / math.log(rms_1 / rms_0))
    raise ValueError("two points at least")


def measure(scene, folder):
    """Points of even samples, and a row for each request."""
    reference = Pair(scene, folder, "reference", REFERENCE_SEEDS, "--spp", REFERENCE)
    even = []
    for samples in EVEN:
        pair = Pair(scene, folder, f"even{samples}", SEEDS, "--spp", samples)
        even.append((pair.against(reference)[0], pair))
    adaptive = []
    for asked in (even[1][0], even[2][0]):
        asked = float(f"{asked:.2g}")
        pair = Pair(scene, folder, f"adaptive{asked}", SEEDS, "--max-rms", asked)
        rms, bias = pair.against(reference)
        work = lambda p: p.rays + p.paths
        adaptive.append({"asked": asked, "rms": rms, "bias": bias, "pair": pair,
                         "cpu": pair.cpu / cost_at(even, rms, lambda p: p.cpu),
                         "work": work(pair) / cost_at(even, rms, work)})
    return even, adaptive


def draw(results):
    script = "set multiplot layout 2,2\nset logscale xy\nset xlabel 'CPU time, s'\nset ylabel 'RMS noise'\nset format y '%g'\n"
    for scene, (even, adaptive) in results.items():
        script += block("even", [(p.cpu, rms) for rms, p in even])
        script += block("adaptive", [(a["pair"].cpu, a["rms"]) for a in adaptive])
        script += (f"set title '{scene}'\nplot $even with linespoints pt 7 lw 2 lc rgb '{COLORS[1]}' title 'even', "
                   f"$adaptive with linespoints pt 5 lw 2 lc rgb '{COLORS[2]}' title 'adaptive'\n")
    gnuplot(ROOT / "docs/images/adaptive.svg", script + "unset multiplot\n", (1000, 760))


PAGE = """# Adaptive sampling

Written by `scripts/adaptive`. {machine}

`frond render --max-rms 0.001` renders until the noise of the picture, the RMS over its pixels and linear colours, is below
0.001 with 95 % confidence, and puts samples where they do most against it: tile by tile, n proportional to the root of
variance over rays (`src/render/adaptive.h`). Noise is told from how blocks of 16 samples differ, which are spread evenly by
themselves; that larger sets are spread more evenly still it does not see, so that what comes is better than what was asked
for.

256 × 256 pixels, leaf_simplified, wavelengths smpte, two renders of each. **RMS**: their noise, by how they differ. **Bias**:
upper 95 % bound of what does not go away, against a reference of 2 × {reference} even samples. **CPU time** and **work** (rays
and paths, which no other program on the machine disturbs): over that of even samples for the same RMS.

{table}
![Error against time of even and adaptive samples](images/adaptive.svg)

Where noise is the same everywhere there is little to win: in ambient light every pixel has about as much, and of the hundred
leaves the sky, which has none, costs next to nothing with even samples either.

## What can go wrong

- A tile gets fewer samples where the first ones happened to be alike. What a pixel's own samples decide is small, since its
  tile has 256 and half of what counts is that of the nine tiles around it; the bias above bounds what is left of it.
- Noise that the first 32 samples of a tile do not meet is not known to anyone: a light that only one path in thousands finds
  leaves a picture that looks finished. More samples by `--spp` show it.
"""


def main():
    results = {}
    with tempfile.TemporaryDirectory(prefix="frond_adaptive.") as folder:
        for scene in SCENES:
            results[scene] = measure(scene, pathlib.Path(folder))
            print(scene, [(a["asked"], a["rms"], a["cpu"], a["work"]) for a in results[scene][1]], flush=True)
    draw(results)
    body = [[scene, f"{a['asked']:g}", f"{a['rms']:.5f}", f"{a['bias']:.5f}", f"{a['pair'].cpu:.1f} s", f"{a['cpu']:.2f}",
             f"{a['work']:.2f}"] for scene, (_, adaptive) in results.items() for a in adaptive]
    head = ["scene", "asked", "RMS", "bias at most", "CPU time", "of even samples'", "work"]
    page = PAGE.format(machine=machine(), reference=REFERENCE, table=table(head, body))
    (ROOT / "docs/adaptive.md").write_text(page)


if __name__ == "__main__":
    main()
