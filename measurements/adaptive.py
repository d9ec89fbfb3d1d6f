"""Adaptive sampling: noise against CPU time, requested and measured (section "adaptive" of docs/rendering.md)

Renders four scenes with uniform and with adaptive sampling (--max-rms). Takes some ten minutes on two cores.
  --quick   few samples, into build/adaptive_report
"""

import pathlib
import tempfile

import numpy

import frond

from .shared import charts
from .shared.tools import ROOT, arguments, machine, program_json, rms, table, write_section

SCENES = ["soybean-front", "soybean-back", "soybean-ambient", "hundred-leaves"]
UNIFORM = [32, 64, 128, 256]
REFERENCE = 512
SEEDS = (1, 2)
REFERENCE_SEEDS = (11, 12)


class Pair:
    """Two renders with different seeds: their mean cost, and their noise from the difference between them."""

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
        found = program_json("difference", *self.images, *reference.images, "--json", "-")
        noise, bias = (rms([found[f"{key}_{c}"] for c in ("red", "green", "blue")]) for key in ("noise_a", "bias_upper"))
        return numpy.sqrt(2) * noise, bias


def cost_at(noise, costs, wanted):
    """Cost of uniform sampling at the noise `wanted`: a power law between two measurements, or through the last two."""
    i = min(numpy.count_nonzero(wanted < numpy.array(noise[1:])), len(noise) - 2)
    power = numpy.log(costs[i + 1] / costs[i]) / numpy.log(noise[i + 1] / noise[i])
    return costs[i] * (wanted / noise[i]) ** power


def measure(scene, folder, scale):
    """Uniform sampling as (noise, CPU time), and a row for each request."""
    reference = Pair(scene, folder, "reference", REFERENCE_SEEDS, REFERENCE // scale)
    pairs = [Pair(scene, folder, f"uniform{samples}", SEEDS, samples // scale) for samples in UNIFORM]
    noise, adaptive = [pair.against(reference)[0] for pair in pairs], []
    for request in noise[1:3]:
        request = float(f"{request:.2g}")
        pair = Pair(scene, folder, f"adaptive{request}", SEEDS, max_rms=request)
        found, bias = pair.against(reference)
        relative = [getattr(pair, key) / cost_at(noise, [getattr(p, key) for p in pairs], found) for key in ("cpu", "work")]
        adaptive.append((request, found, bias, pair.cpu, *relative))
    return (noise, [pair.cpu for pair in pairs]), adaptive


def draw(path, results):
    of, panels = charts.figure(1000, 780, 2, 2)
    for panel, (scene, ((noise, cpu), adaptive)) in zip(panels.flat, results.items()):
        panel.loglog(cpu, noise, "o-", label="uniform")
        panel.loglog([a[3] for a in adaptive], [a[1] for a in adaptive], "s-", label="adaptive")
        panel.set(title=scene, xlabel="CPU time, s", ylabel="RMS noise")
    charts.legend(of, panels[0, 0], 2)
    charts.save(of, path)


SECTION = """## Noise target: measurements

Measured on {machine}.
Images of 256 × 256 pixels, `leaf_simplified`, wavelengths `smpte`, two renders of each setting. Uniform sampling takes the same
number of samples in every pixel.

- **requested**: the value of `--max-rms`. **RMS**: noise of one render, from the difference between the two renders.
- **bias at most**: upper 95 % bound of the error that no number of samples removes, measured against a reference of
  2 × {reference} samples in every pixel.
- **CPU time**: of one render. **CPU time, relative** and **work, relative** (rays and paths, a count that other programs on the
  machine do not disturb): divided by the CPU time and work of uniform sampling at the same RMS.

{table}
![Noise against CPU time of uniform and adaptive sampling](images/adaptive.svg)

Adaptive sampling gains little in two of the scenes. In ambient light every pixel has about the same noise. Among the hundred leaves
the sky has no noise, but its samples cost almost nothing under uniform sampling either.
"""


def main():
    options = arguments("adaptive")
    results = {}
    with tempfile.TemporaryDirectory(prefix="frond_adaptive.") as folder:
        for scene in SCENES:
            results[scene] = measure(scene, pathlib.Path(folder), 16 if options.quick else 1)
            print(scene, results[scene][1], flush=True)
    draw(options.docs / "images" / "adaptive.svg", results)
    body = [[scene, f"{request:g}", f"{found:.5f}", f"{bias:.5f}", f"{cpu:.1f} s", f"{of_cpu:.2f}", f"{of_work:.2f}"]
            for scene, (_, adaptive) in results.items() for request, found, bias, cpu, of_cpu, of_work in adaptive]
    head = ["scene", "requested", "RMS", "bias at most", "CPU time", "CPU time, relative", "work, relative"]
    write_section(options.docs / "rendering.md", "adaptive",
                  SECTION.format(machine=machine(), reference=REFERENCE, table=table(head, body)))


if __name__ == "__main__":
    main()
