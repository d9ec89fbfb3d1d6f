"""docs/adaptive.md: error against time of even and of adaptive samples."""

import pathlib
import tempfile

import numpy

import charts
import frond
from tools import ROOT, arguments, machine, program_json, rms, table, write

SCENES = ["soybean-front", "soybean-back", "soybean-ambient", "hundred-leaves"]
EVEN = [32, 64, 128, 256]
REFERENCE = 512
SEEDS = (1, 2)
REFERENCE_SEEDS = (11, 12)


class Pair:
    """Two renders with seeds of their own: their mean cost, and by how they differ their noise."""

    def __init__(self, scene, folder, name, seeds, samples=None, max_rms=None):
        self.images, costs = [], []
        for seed in seeds:
            image = frond.load(ROOT / "scenes" / scene / "scene.pbrt", seed=seed, quick=True, wavelengths="smpte",
                                 swap="leaf_simplified", adaptive=max_rms is not None).render(samples, max_rms=max_rms)
            self.images.append(folder / f"{scene}-{name}-{seed}.exr")
            image.save(self.images[-1])
            costs.append([image.statistics[key] for key in ("cpu_seconds", "rays", "paths")])
        self.cpu, rays, paths = numpy.mean(costs, axis=0)
        self.work = rays + paths

    def against(self, reference):
        """RMS noise of one render, and the upper 95 % bound of the bias: over pixels and colours."""
        found = program_json("difference", *self.images, *reference.images, "--json")
        noise, bias = (rms([found[f"{key}_{c}"] for c in ("red", "green", "blue")]) for key in ("noise_a", "bias_upper"))
        return numpy.sqrt(2) * noise, bias


def cost_at(noise, costs, asked):
    """What even samples take to this noise: a power law between two of them, or beyond the last two."""
    i = min(numpy.count_nonzero(asked < numpy.array(noise[1:])), len(noise) - 2)
    power = numpy.log(costs[i + 1] / costs[i]) / numpy.log(noise[i + 1] / noise[i])
    return costs[i] * (asked / noise[i]) ** power


def measure(scene, folder, scale):
    """Even samples as (noise, CPU time), and a row for each request."""
    reference = Pair(scene, folder, "reference", REFERENCE_SEEDS, REFERENCE // scale)
    pairs = [Pair(scene, folder, f"even{samples}", SEEDS, samples // scale) for samples in EVEN]
    noise, adaptive = [pair.against(reference)[0] for pair in pairs], []
    for asked in noise[1:3]:
        asked = float(f"{asked:.2g}")
        pair = Pair(scene, folder, f"adaptive{asked}", SEEDS, max_rms=asked)
        found, bias = pair.against(reference)
        of_even = [getattr(pair, key) / cost_at(noise, [getattr(p, key) for p in pairs], found) for key in ("cpu", "work")]
        adaptive.append((asked, found, bias, pair.cpu, *of_even))
    return (noise, [pair.cpu for pair in pairs]), adaptive


def draw(path, results):
    of, panels = charts.figure(1000, 780, 2, 2)
    for panel, (scene, ((noise, cpu), adaptive)) in zip(panels.flat, results.items()):
        panel.loglog(cpu, noise, "o-", label="even")
        panel.loglog([a[3] for a in adaptive], [a[1] for a in adaptive], "s-", label="adaptive")
        panel.set(title=scene, xlabel="CPU time, s", ylabel="RMS noise")
    charts.legend(of, panels[0, 0], 2)
    charts.save(of, path)


PAGE = """# Adaptive sampling

Written by `scripts/adaptive`. {machine}

`frond render --max-rms 0.001` renders until the noise of the image, the RMS over its pixels and linear colours, is below
0.001 with 95 % confidence, and puts samples where they do most against it: tile by tile, n proportional to the root of
variance over rays (`src/render/film/adaptive.h`). Noise is estimated from how blocks of 16 samples differ, which are spread evenly by
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
  leaves an image that looks finished. More samples by `--spp` show it.
"""


def main():
    options = arguments("adaptive")
    results = {}
    with tempfile.TemporaryDirectory(prefix="frond_adaptive.") as folder:
        for scene in SCENES:
            results[scene] = measure(scene, pathlib.Path(folder), 16 if options.quick else 1)
            print(scene, results[scene][1], flush=True)
    draw(options.docs / "images" / "adaptive.svg", results)
    body = [[scene, f"{asked:g}", f"{found:.5f}", f"{bias:.5f}", f"{cpu:.1f} s", f"{of_cpu:.2f}", f"{of_work:.2f}"]
            for scene, (_, adaptive) in results.items() for asked, found, bias, cpu, of_cpu, of_work in adaptive]
    head = ["scene", "asked", "RMS", "bias at most", "CPU time", "of even samples'", "work"]
    write(options.docs / "adaptive.md", PAGE.format(machine=machine(), reference=REFERENCE, table=table(head, body)))


if __name__ == "__main__":
    main()
