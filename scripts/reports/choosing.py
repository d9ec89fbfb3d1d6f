"""Measurements in docs/selection.md: errors and costs of the selected models, in scenes that were not used to design it."""

import argparse
import pathlib
import tempfile

import numpy

import frond
from tools import ROOT, arguments, machine, program_json, sized, table, write_section

SCENES = {
    "near and far": "choosing/near-and-far.pbrt",
    "maize": "choosing/maize.pbrt",
    "dark": "choosing/dark.pbrt",
    "spotted": "choosing/spotted.pbrt",
    "hundred leaves": "hundred-leaves/scene.pbrt",
    "shade": "choosing/shade.pbrt",
}
TEXTURED = ["spotted"]  # leaf_lambert has no textures
REQUESTS = [0.02, 0.01, 0.005, 0.002, 0.001]
# One for each scene at full size: small enough that models differ, large enough for a short render of abm.
FULL_SIZE_REQUESTS = {"near and far": 0.005, "maize": 0.01, "dark": 0.002, "spotted": 0.005, "hundred leaves": 0.002,
                      "shade": 0.005}
RESOLUTION = 96
RESOLUTIONS = [64, 128, 256, 512]
MOST_ABM_SAMPLES = 4096
CHANNELS = ("red", "green", "blue")
# No pilot or candidate has a seed of the reference.
REFERENCE_SEEDS, CANDIDATE_SEEDS, CHOICE_SEEDS, FULL_SEEDS = (901, 902), (903, 904), range(1, 100), range(1001, 1100)
ABM = {"swap": "leaf,model=abm", "wavelengths": "hero"}

ERROR_HEAD = ("scene", "requested", "selected", "pilot's bound", "measured bias", "samples needed", "RMS with these samples",
              "pilot, CPU s")
FULL_SIZE_HEAD = ("scene", "requested", "selected", "samples", "RMS (95 %)", "pilots, CPU s", "render, CPU s", "`abm`: samples",
                  "RMS", "CPU s", "`abm` / selected")


class Render:
    """Two renders with different seeds."""

    def __init__(self, scene, models, samples, seeds, folder, name):
        self.images = [folder / f"{name}-{seed}.exr" for seed in seeds]
        self.seconds = numpy.mean([render(scene, models, samples, *pair) for pair in zip(seeds, self.images)])  # of CPU time, each


def render(scene, models, samples, seed, image):
    """Writes the image; the CPU seconds."""
    rendered = frond.load(scene, seed=seed, **models).render(samples)
    rendered.save(image)
    return rendered.statistics["cpu_seconds"]


class Error:
    """Mean square errors against the reference, over all pixels and channels."""

    def __init__(self, render, reference):
        j = program_json("difference", *render.images, *reference.images, "--json")
        # Channels are correlated: their mean standard error is an upper bound for that of their mean.
        self.bias, self.bias_error = (mean_of(j, key) for key in ("bias_squared", "bias_squared_error"))
        self.noise, self.reference_noise = (mean_of(j, f"noise_{which}", 2) for which in "ab")

    def bounds(self, noise=0):
        """95 % interval of the RMS: of the bias alone, or with this variance of the noise."""
        return [root(noise + self.bias + z * self.bias_error) for z in (-1.96, 1.96)]


def mean_of(difference, key, power=1):
    return numpy.mean([difference[f"{key}_{c}"] ** power for c in CHANNELS])


def root(square):
    return max(0.0, square) ** 0.5


def choose(scene, request, seed, samples=0):
    """The pilot's selection for a request, for a render of `samples` samples per pixel (0: the scene's own)."""
    return frond.load(scene, swap=f"leaf,model=auto,maxrms={request}", seed=seed, samples=samples).choice


def models_of(choice):
    """The selection as parameters of frond.load."""
    names = {leaf["name"]: leaf["chosen"] for leaf in choice["leaves"]}
    return {"swap": {"leaf" if name.startswith("leaf in line") else name: f"leaf,model={model}" for name, model in names.items()},
            "wavelengths": choice["wavelengths"][0]["chosen"]}


def name_of(choice):
    leaves = choice["leaves"]
    models = leaves[0]["chosen"] if len(leaves) == 1 else ", ".join(f"{l['name']}: {l['chosen']}" for l in leaves)
    return f"{models}; {choice['wavelengths'][0]['chosen']}"


def samples_for(request):
    """A number of samples per pixel that gives noise of about this size."""
    return round(min(2048, max(64, 0.002 / request**2)))


class Bench:
    """One scene, its reference, and the errors of all selections for it."""

    def __init__(self, path, options, folder):
        self.scene = sized(ROOT / "scenes" / path, folder, RESOLUTION)
        self.options, self.folder = options, folder
        self.reference = Render(self.scene, ABM, options.reference_samples, REFERENCE_SEEDS, folder, "reference")
        self.errors = {}

    def error_of(self, choice):
        """Error of the selected models, measured once."""
        models = models_of(choice)
        if str(models) not in self.errors:
            found = Render(self.scene, models, self.options.candidate_samples, CANDIDATE_SEEDS, self.folder, "candidate")
            self.errors[str(models)] = Error(found, self.reference)
        return self.errors[str(models)]

    def full_render(self, choice, seed):
        """RMS error of a render with the number of samples that the pilot reported to be needed. The reference's noise is
        subtracted. None if there are too many samples."""
        samples, image = int(choice["samples_needed"]), self.folder / "full.exr"
        if samples > self.options.most_full_samples:
            return None
        render(self.scene, models_of(choice), samples, seed, image)
        j = program_json("difference", image, image, *self.reference.images, "--json")
        return root(mean_of(j, "rms", 2) - mean_of(j, "noise_b", 2))


class Case:
    """One request on one scene."""

    def __init__(self, scene, bench, request, options):
        self.scene, self.request = scene, request
        choices = [choose(bench.scene, request, seed, samples_for(request)) for seed in list(CHOICE_SEEDS)[:options.seeds]]
        self.outcomes = [self.outcome(c, bench) for c in choices]
        self.names = sorted({name_of(c) for c in choices})
        choice = choices[0]
        self.choice, self.name, self.error = choice, name_of(choice), bench.error_of(choice)
        self.pilot = numpy.mean([c["pilot"]["cpu_seconds"] for c in choices])
        full = [bench.full_render(c, seed) for c, seed in zip(choices, FULL_SEEDS)]
        self.full = [rms for rms in full if rms is not None]
        print(scene, request, self.name, self.outcomes, self.error.bounds(), self.full, flush=True)

    def outcome(self, choice, bench):
        low, high = bench.error_of(choice).bounds()
        return "missed" if low > self.request else "met" if high <= self.request else "unclear"

    def row(self):
        low, high = self.error.bounds()
        full = ", ".join(f"{rms:.5f}" for rms in self.full)
        others = len(self.names) - 1
        name = f"{self.name}{f' (other seeds: {others} more)' if others else ''}"
        return (self.scene, f"{self.request:g}", name, f"{self.choice['bias_high']:.5f}", f"{low:.5f} to {high:.5f}",
                f"{int(self.choice['samples_needed'])}", full, f"{self.pilot:.1f}")


def by_resolution(path, samples, folder):
    """RMS difference between leaf_lambert and leaf_solved at every resolution, with equal numbers of samples per image."""
    values = []
    for size in RESOLUTIONS:
        spp = max(4, samples * RESOLUTION**2 // size**2)
        scene = sized(ROOT / "scenes" / path, folder, size)
        lambert, solved = (Render(scene, {"swap": f"leaf,model={model}", "wavelengths": "smpte"}, spp, seeds, folder, model)
                           for model, seeds in (("leaf_lambert", (1, 2)), ("leaf_solved", (3, 4))))
        values.append(root(Error(lambert, solved).bias))
    return values


class FullSize:
    """One request on one scene at full size, from the first pilot to the image."""

    def __init__(self, name, path, request, size, folder):
        self.name, self.request = name, request
        scene = sized(ROOT / "scenes" / path, folder, size)
        seed = CHOICE_SEEDS[0]
        # As a user would: run the pilot, read the number of samples that is needed, and run it again for this number.
        first = choose(scene, request, seed)
        choice = choose(scene, request, seed, int(first["samples_needed"]))
        self.chosen = name_of(choice)
        self.pilots = sum(c["pilot"]["cpu_seconds"] for c in (first, choice))
        self.samples, self.abm_samples = int(choice["samples_needed"]), int(choice["reference_samples_needed"])
        if self.abm_samples > MOST_ABM_SAMPLES:
            raise SystemExit(f"{path} at {request}: abm needs {self.abm_samples} samples, too many to render here")
        chosen = Render(scene, models_of(choice), self.samples, FULL_SEEDS[:2], folder, "chosen")
        abm = Render(scene, ABM, self.abm_samples, REFERENCE_SEEDS, folder, "abm")
        error = Error(chosen, abm)
        self.seconds, self.abm_seconds = chosen.seconds, abm.seconds
        self.low, self.high = error.bounds(error.noise)
        self.abm_rms = root(error.reference_noise)
        print(self.row(), flush=True)

    def faster(self):
        return self.abm_seconds / (self.pilots + self.seconds)

    def row(self):
        return (self.name, f"{self.request:g}", self.chosen, self.samples, f"{self.low:.5f} to {self.high:.5f}",
                f"{self.pilots:.1f}", f"{self.seconds:.1f}", self.abm_samples, f"{self.abm_rms:.5f}", f"{self.abm_seconds:.1f}",
                f"{self.faster():.1f}")


SECTION = """## Measurements

None of these scenes was used to design the selection. The first is not quite independent: its early runs revealed an error in
the count of samples.
The scenes are two leaves close to the camera and far away, maize lit from behind, dark leaves in a strong light, a leaf with a map
of its chlorophyll, leaves in the shade of others (`scenes/choosing`), and `scenes/hundred-leaves`.
Machine: {machine}.

### Errors of the selected models

Images of {resolution} x {resolution} pixels, {seeds} seeds for every request. The pilot may use a quarter of the paths of the
render: {samples} samples per pixel for the requests from {first:g} to {last:g}.

A check then renders the selected models twice with {candidate_samples} samples per pixel at all pixels, and `abm` with weighted
walks twice with {reference_samples}, with seeds that no pilot had.

- **pilot's bound**: upper bound of the bias, as the pilot reports it.
- **measured bias**: RMS over all pixels and channels that remains with any number of samples, as a 95 % interval of the check.
- **RMS with these samples**: error, noise included, of one render per seed with the number of samples that the pilot reported to be
  needed, if it is {most_full_samples} or less.

{errors}
**{missed} of {choices} selections missed the request**: the lower bound of their measured bias is above it. The specified rate is
at most 1 in 20. {met} selections met the request at the upper bound as well; for {unclear} the check was inconclusive. In {unmet}
of {cases} rows no model cheaper than `abm` could be shown to meet the request, and `abm` was selected: these rows prove nothing.
Of {full} renders with the number of samples that was reported to be needed, {exceeded} had an RMS above the request; the largest
was {largest:.2f} times the request.

The pilot took {least:.1f} to {most:.1f} s of CPU time, {median:.1f} in the median, which is more than it saves in most images of
this small size.

### Time at full size

One request on each scene at {size} x {size} pixels. A first pilot was run for the scene's own 64 samples per pixel, and a second
one for the number of samples that the first reported to be needed. The models that the second selected were rendered with the
number of samples that it reported. `abm` with weighted walks and hero wavelengths (the reference) was rendered with the number
that the pilot reported for it. Both were rendered twice, with seeds that the pilots did not use.

- **RMS**: bias and noise together, from these renders; for `abm` it is noise alone.
- **CPU s**: of one render. **`abm` / selected**: CPU time of `abm` divided by the CPU time of both pilots and the render together.

{full_size}
`abm` took {least_faster:.1f} to {most_faster:.1f} times the CPU time, {whole:.1f} times over all scenes together. The upper end of
the interval is above the request in {full_exceeded} of {full_cases} renders. Numbers of samples are powers of two for both, so
that a single ratio is accurate to a factor of two, and the RMS may be far below the request.

### Resolution

RMS difference between `leaf_lambert` and `leaf_solved` if the whole image is rendered at a lower resolution:

{resolutions}
At a low resolution, differences whose sign varies over the image cancel, most of all with glints, and the RMS is too small. The
pilot therefore renders pixels of the full image.
"""


def section(cases, resolutions, large, options):
    outcomes = [o for c in cases for o in c.outcomes]
    full = [rms / c.request for c in cases for rms in c.full]
    pilots = sorted(c.pilot for c in cases)
    faster = sorted(c.faster() for c in large)
    sizes = [(name, *(f"{v:.5f}" for v in values), f"{values[-1] / values[0]:.2f}") for name, values in resolutions.items()]
    return SECTION.format(
        machine=machine(), resolution=RESOLUTION, seeds=options.seeds, samples=", ".join(str(samples_for(r)) for r in REQUESTS),
        first=REQUESTS[0], last=REQUESTS[-1], candidate_samples=options.candidate_samples,
        reference_samples=options.reference_samples, most_full_samples=options.most_full_samples,
        errors=table(ERROR_HEAD, [c.row() for c in cases]),
        missed=outcomes.count("missed"), choices=len(outcomes), met=outcomes.count("met"), unclear=outcomes.count("unclear"),
        unmet=sum(not c.choice["met"] for c in cases), cases=len(cases), full=len(full), exceeded=sum(ratio > 1 for ratio in full),
        largest=max(full), least=pilots[0], most=pilots[-1], median=pilots[len(pilots) // 2], size=options.full_size,
        full_size=table(FULL_SIZE_HEAD, [c.row() for c in large]), least_faster=faster[0], most_faster=faster[-1],
        whole=sum(c.abm_seconds for c in large) / sum(c.pilots + c.seconds for c in large),
        full_exceeded=sum(c.high > c.request for c in large), full_cases=len(large),
        resolutions=table(("scene", *(f"{s} x {s}" for s in RESOLUTIONS), "largest over smallest"), sizes))


def main():
    quick = (command := arguments("choosing")).quick
    options = argparse.Namespace(seeds=3, reference_samples=192, candidate_samples=128, most_full_samples=256, full_size=512)
    if quick:
        options = argparse.Namespace(seeds=1, reference_samples=64, candidate_samples=32, most_full_samples=16, full_size=64)
    cases, resolutions, large = [], {}, []
    for name, path in SCENES.items():
        with tempfile.TemporaryDirectory() as folder:
            folder = pathlib.Path(folder)
            if name not in TEXTURED:
                resolutions[name] = by_resolution(path, 4 if quick else 16, folder)
            bench = Bench(path, options, folder)
            cases += [Case(name, bench, request, options) for request in REQUESTS]
            large.append(FullSize(name, path, FULL_SIZE_REQUESTS[name], options.full_size, folder))
    write_section(command.docs / "selection.md", "choosing", section(cases, resolutions, large, options))


if __name__ == "__main__":
    main()
