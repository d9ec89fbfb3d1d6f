"""The renders of docs/results/paper.md, each kept as a file so that an interrupted run can continue."""

import dataclasses
import io
import json
import pathlib

import pandas
from matplotlib import font_manager
from PIL import Image, ImageDraw, ImageFont

from ..shared.tools import ROOT, frond_table, program, program_json


@dataclasses.dataclass(frozen=True)
class Set:
    """One of the paper's three settings and its row of Table 2."""

    name: str
    title: str
    order: str
    figure: int
    graph: int
    foliar_percent: float
    rms: tuple  # red, green, blue
    speed_up: float
    stops: int  # exposure of the shown images; leaves are dark where a white surface in the light is 1

    def scene(self):
        return ROOT / "scenes" / f"soybean-{self.name}" / "scene.pbrt"


SETS = [
    Set("front", "front lit", "1st", 5, 8, 24.97, (0.009, 0.009, 0.012), 5.14, 2),
    Set("back", "back lit", "2nd", 6, 9, 19.42, (0.011, 0.014, 0.010), 4.47, 1),
    Set("ambient", "ambient light", "3rd", 7, 10, 37.61, (0.020, 0.016, 0.012), 9.77, 0),
]
MODELS = ["abm", "leaf_simplified"]
CHANNELS = ("red", "green", "blue")
CANDIDATES = ["abm", "leaf_simplified", "leaf_solved", "leaf_lambert", "abm,mode=weighted"]
PUBLISHED = "leaf_simplified,surfacedirect=false"  # the paper's rule for shadow rays


def candidate(comparison, label):
    return next(c for c in comparison["candidates"] if c["label"] == label)


def last_errors(comparison, label):
    """Errors by channel, over all pixels, at the largest number of samples, whose rows are the last ones."""
    return {r["channel"]: r for r in comparison["comparison"] if r["candidate"] == label and r["region"] == "all"}


@dataclasses.dataclass(frozen=True)
class Setting:
    """Amount of work: arguments of frond compare and of frond render, and samples per pixel."""

    compare: tuple
    manner: tuple
    image: tuple
    image_samples: int  # of each of the two halves
    ends: tuple
    ends_samples: int
    table_rays: int


FULL = Setting((), ("--spp", 8, "--reference-spp", 1), ("--quick",), 200, (), 8, 10**6)
QUICK = Setting(("--quick",), ("--size", 128, "--spp", 8, "--reference-spp", 1), ("--quick",), 8, ("--quick",), 4, 10**4)
# Tests that everything runs; the results are meaningless.
SMOKE = Setting(("--size", 16, "--spp", 2, "--reference-spp", 2), ("--size", 16, "--spp", 2, "--reference-spp", 1), ("--pixels", "240,272,240,272"), 1,
                ("--pixels", "192,320,192,320"), 1, 100)


class Runs:
    def __init__(self, setting, folder, threads, keep):
        self.setting, self.folder, self.keep = setting, pathlib.Path(folder), keep
        self.threads = ("--threads", threads) if threads else ()
        self.folder.mkdir(parents=True, exist_ok=True)

    def kept(self, name, measure):
        """The JSON of this name; it is measured unless an earlier run has stored it."""
        path = self.folder / f"{name}.json"
        if not (self.keep and path.exists()):
            print(name, flush=True)
            path.write_text(measure())
        return json.loads(path.read_text())

    def table(self, method):
        """Shares and CPU time of the paper's soybean table: every degree from 0 to 180 at three wavelengths."""

        def measure():
            rays = ["--rays", self.setting.table_rays] if method == "montecarlo" else []
            text, seconds, _ = frond_table("--method", method, *rays, "--wavelengths", "608,551,455", *self.threads)
            shares = pandas.read_csv(io.StringIO(text), comment="#")[["Rs", "Rd", "T"]].to_numpy().ravel().tolist()
            return json.dumps({"cpu_seconds": seconds, "shares": shares})

        return self.kept(f"table-{method}", measure)

    def comparison_words(self, name, s):
        """Arguments of frond for a comparison. `manner` is by the paper's method, which needs few samples for its times; it is
        separate, because one candidate has more noise than all others together."""
        candidates, arguments = {"comparison": (CANDIDATES, self.setting.compare),
                                 "manner": (CANDIDATES + [PUBLISHED], self.setting.manner)}[name]
        return ["compare", s.scene(), "--materials", ";".join(candidates), "--wavelengths", "smpte", "--target", s.name, *arguments]

    def compared(self, name, s):
        def measure():
            report = self.folder / f"{name}-{s.name}-report"
            program(*self.comparison_words(name, s), "-o", report, *self.threads, "-q")
            return (report / "compare.json").read_text()

        return self.kept(f"{name}-{s.name}", measure)

    def ends(self, s, model, cutoff):
        """Report of a render whose paths are cut off at this attenuation; 0: never."""
        integrator = f"path,termination=attenuation,cutoff={cutoff:.3g},maxdepth=63"
        name = f"ends-{s.name}-{model}-{cutoff:.3g}"
        return self.kept(name, lambda: program(
            "render", s.scene(), "--wavelengths", "smpte", "--swap", f"leaf={model}", "--integrator", integrator, "--spp",
            self.setting.ends_samples, *self.setting.ends, *self.threads, "-o", self.folder / "ends.exr", "--json", "-", "-q"))

    def half(self, s, model, half):
        return self.folder / f"{s.name}-{model}-{half}.exr"

    def images(self, s):
        """Reports of the two halves of each model's image, {model: [first, second]}; the image is their mean."""
        reports = {model: [] for model in MODELS}
        for half in (1, 2):
            for model in MODELS:  # in turn, so that other load affects both equally
                reports[model].append(self.kept(f"{s.name}-{model}-{half}", lambda: program(
                    "render", s.scene(), "--wavelengths", "smpte", "--swap", f"leaf={model}", "--spp",
                    self.setting.image_samples, "--seed", half, *self.setting.image, *self.threads, "-o",
                    self.half(s, model, half), "--json", "-", "-q")))
        return reports

    def difference(self, s):
        """Noise and bias of the difference of the two models' images."""
        halves = [self.half(s, model, half) for model in MODELS for half in (1, 2)]
        return program_json("difference", *halves, "--json", "-")

    def sheet(self, path):
        """Figures 5 to 7: a row for each set, a column for each model."""
        font, size, gap = ImageFont.truetype(font_manager.findfont("DejaVu Sans"), 15), None, 8
        for row, s in enumerate(SETS):
            for column, (letter, model) in enumerate(zip("ab", MODELS)):
                file = self.folder / f"{s.name}-{model}.png"
                program("convert", self.half(s, model, 1), self.half(s, model, 2), "--exposure", s.stops, "-o", file)
                image = Image.open(file).convert("RGB")
                if size is None:
                    size = image.size
                    sheet = Image.new("RGB", (2 * size[0] + gap, 3 * size[1] + 2 * gap))
                ImageDraw.Draw(image).text((8, 6), f"{s.figure}{letter}  {model}", font=font, stroke_width=1, stroke_fill="black")
                sheet.paste(image, (column * (size[0] + gap), row * (size[1] + gap)))
        path.parent.mkdir(parents=True, exist_ok=True)
        sheet.save(path, quality=90)
