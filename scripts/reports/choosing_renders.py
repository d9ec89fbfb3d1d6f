"""Renders of the chooser's scenes and how they are judged."""

import json
import math
import re

from tools import ROOT, frond

CHANNELS = ("red", "green", "blue")
# Nobody who is judged shares a seed with the judge.
REFERENCE_SEEDS, CANDIDATE_SEEDS, CHOICE_SEEDS, FULL_SEEDS = (901, 902), (903, 904), range(1, 100), range(1001, 1100)
ABM = ["--swap", "*=leaf,model=abm", "--wavelengths", "hero"]


def sized(path, size, folder):
    """A copy of a scene at another size, which finds its parts where they are."""
    source = ROOT / "scenes" / path
    text = re.sub(r'("integer [xy]resolution") \d+', rf"\1 {size}", source.read_text())
    text = re.sub(r'(Include|"string filename") "(?=[^"]*\.(?:pbrt|ply|png)")', rf'\1 "{source.parent}/', text)
    copy = folder / f"{source.parent.name}-{source.stem}-{size}.pbrt"
    copy.write_text(text)
    return copy


def mean(values):
    values = list(values)
    return sum(values) / len(values)


class Render:
    """Two renders with seeds of their own."""

    def __init__(self, scene, words, samples, seeds, folder, name):
        self.images = [folder / f"{name}-{seed}.exr" for seed in seeds]
        reports = [json.loads(frond("render", scene, *words, "--spp", samples, "--seed", seed, "-o", image, "--json"))
                   for seed, image in zip(seeds, self.images)]
        self.seconds = mean(r["cpu_seconds"] for r in reports)  # of CPU time, each
        self.seconds_per_sample = self.seconds / samples


class Error:
    """Mean squares over all pixels and channels of how one render differs from the reference."""

    def __init__(self, render, reference):
        j = json.loads(frond("difference", *render.images, *reference.images, "--json"))
        self.bias = mean(j[f"bias_squared_{c}"] for c in CHANNELS)
        self.bias_error = mean(j[f"bias_squared_error_{c}"] for c in CHANNELS)  # too large, as channels are alike
        self.noise, self.reference_noise = (mean(j[f"noise_{which}_{c}"] ** 2 for c in CHANNELS) for which in "ab")

    def bounds(self):
        """Of the RMS of the bias alone, 95 %."""
        return self.bounds_with(0)

    def total_bounds(self):
        """Of the RMS of one render, bias and noise."""
        return self.bounds_with(self.noise)

    def bounds_with(self, noise):
        return [root(noise + self.bias + z * self.bias_error) for z in (-1.96, 1.96)]


def root(square):
    return math.sqrt(max(0.0, square))


def total_rms(image, reference):
    """Of one render against what the reference converges to: the reference's own noise is taken out."""
    j = json.loads(frond("difference", image, image, *reference.images, "--json"))
    return root(mean(j[f"rms_{c}"] ** 2 - j[f"noise_b_{c}"] ** 2 for c in CHANNELS))


def choose(scene, request, seed, samples=None):
    """What the pilot says to a request, for a render of so many samples or of the scene's own."""
    return json.loads(frond("render", scene, "--swap", f"*=leaf,model=auto,maxrms={request}", "--seed", seed, "--pilot",
                            "--json", *(("--spp", samples) if samples else ())))


def words_of(choice):
    """What of the command line names what was chosen, as an option has it."""
    words = []
    for leaf in choice["leaves"]:
        name = "leaf" if leaf["name"].startswith("leaf in line") else leaf["name"]
        words += ["--swap", f"{name}=leaf,model={leaf['chosen']}"]
    return words + ["--wavelengths", choice["wavelengths"][0]["chosen"]]


def name_of(choice):
    leaves = choice["leaves"]
    models = leaves[0]["chosen"] if len(leaves) == 1 else ", ".join(f"{l['name']}: {l['chosen']}" for l in leaves)
    return f"{models}; {choice['wavelengths'][0]['chosen']}"
