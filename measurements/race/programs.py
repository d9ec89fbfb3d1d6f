"""The programs that measurements/run race compares: how each renders a scene, and the CPU time that it takes."""

import glob
import json
import os
import pathlib
import shutil
import subprocess
import sys

import numpy

from ..shared.tools import FROND, Use, run
from . import scenes

MOST_TRACED = 10_000  # instances for Mitsuba's LLVM variants: with 100,000 the first image takes more than five minutes


class Command:
    """A program that renders one image per process."""

    suffix = ".pfm"

    def __init__(self, name):
        self.name = name

    def open(self, scene, leaf, setting, folder):
        self.setting, self.folder = setting, folder
        self.files = {f: folder / f"{self.name.replace(' ', '-')}-{leaf}-{f}.pbrt" for f in setting.filters}
        for reconstruction, file in self.files.items():
            scenes.write_pbrt(scene, file, leaf, reconstruction == "box", setting.size, tables=self.tables)

    def render(self, reconstruction, samples, seed, out):
        """CPU and wall time of the whole process."""
        use = Use(*self.words(self.files[reconstruction], samples, seed, out))
        return numpy.array([use.cpu, use.wall])

    def before(self, reconstruction):
        """CPU and wall time before the first measured render."""
        return numpy.zeros(2)

    def can(self, scene, leaf):
        return True

    def close(self):
        pass


class Frond(Command):
    suffix, tables = ".exr", True

    def __init__(self, name, wavelengths):
        super().__init__(name)
        self.wavelengths, self.spectral = wavelengths, wavelengths == "hero"

    def version(self):
        return run(FROND, "--version").strip()

    def words(self, file, samples, seed, out):
        return [FROND, "render", file, "-q", "--threads", self.setting.threads, "--spp", samples, "--seed", seed,
                "--wavelengths", self.wavelengths, "-o", out]


class Pbrt(Command):
    tables, spectral = False, True

    def __init__(self, path):
        super().__init__("pbrt-v4")
        self.path = path

    def version(self):
        return "pbrt-v4"

    def words(self, file, samples, seed, out):
        return [self.path, "--quiet", "--nthreads", self.setting.threads, "--spp", samples, "--seed", seed, "--outfile",
                out, file]


class Mitsuba:
    """One process per scene, which renders repeatedly; LLVM variants compile in the first render. `robust`: Embree's
    intersections miss no ray between triangles, as in frond and pbrt-v4; Mitsuba's default misses some."""

    suffix = ".pfm"

    def __init__(self, python, variant, robust=False):
        self.python, self.variant, self.robust = python, variant, robust
        self.name = f"Mitsuba {variant}{', robust' if robust else ''}"
        self.spectral = variant.endswith("spectral")

    def version(self):
        return "Mitsuba " + run(self.python, "-c", "import mitsuba; print(mitsuba.__version__)").strip()

    def can(self, scene, leaf):
        if self.variant.startswith("scalar"):
            return not scenes.LEAVES[leaf][1]
        return len(scene.instances) <= MOST_TRACED

    def open(self, scene, leaf, setting, folder):
        file = folder / f"{self.variant}-{self.robust:d}-{leaf}.json"
        scenes.write_json(scene, file, leaf, setting.size)
        home = folder / f"home-{self.variant}-{self.robust:d}"  # without cached kernels
        home.mkdir(exist_ok=True)
        words = [self.python, pathlib.Path(__file__).with_name("mitsuba_worker.py"), self.variant, file, setting.threads,
                 int(self.robust)]
        self.process = subprocess.Popen(list(map(str, words)), stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True,
                                        env=os.environ | {"HOME": str(home)})
        self.loaded, self.compiling = self.answer(), {}

    def answer(self):
        for line in self.process.stdout:
            if line.startswith("{"):
                took = json.loads(line)
                return numpy.array([took["cpu"], took["wall"]])
        raise SystemExit(f"{self.name} ended with {self.process.wait()}")

    def ask(self, reconstruction, samples, seed, out):
        question = {"filter": reconstruction, "samples": samples, "seed": seed, "out": str(out)}
        self.process.stdin.write(json.dumps(question) + "\n")
        self.process.stdin.flush()
        return self.answer()

    def render(self, reconstruction, samples, seed, out):
        """Times the second render of a kind, because the first one of each number of samples may compile."""
        if (reconstruction, samples) in self.compiling:
            return self.ask(reconstruction, samples, seed, out)
        first, second = (self.ask(reconstruction, samples, seed, out) for _ in range(2))
        self.compiling[reconstruction, samples] = first - second
        return second

    def before(self, reconstruction):
        """Time of loading, and of compiling once."""
        costs = [cost for (name, _), cost in self.compiling.items() if name == reconstruction]
        return self.loaded + numpy.maximum(0, max(costs, key=lambda cost: cost[0]))

    def close(self):
        self.process.stdin.close()
        self.process.wait()


def libllvm():
    """Path of an LLVM library for Dr.Jit; it aborts with versions 14 and 15."""
    found = [path for version in (19, 22, 16) for path in sorted(glob.glob(f"/usr/lib/*/libLLVM-{version}.so"))]
    return os.environ.get("DRJIT_LIBLLVM_PATH") or next(iter(found), None)


def present(pbrt, python):
    """The installed programs, and a message for each one that is missing."""
    programs, missing = [Frond("frond, three wavelengths", "smpte"), Frond("frond, hero wavelengths", "hero")], []
    python = python or sys.executable
    code = "import mitsuba; print(*mitsuba.variants())"
    done = subprocess.run([str(python), "-c", code], capture_output=True, text=True, check=False) \
        if pathlib.Path(python).exists() else None
    there = done.stdout.split() if done and done.returncode == 0 else []
    llvm = libllvm()
    if llvm:
        os.environ["DRJIT_LIBLLVM_PATH"] = llvm
    for variant in ("llvm_ad_rgb", "scalar_rgb", "llvm_ad_spectral", "scalar_spectral"):
        if variant not in there:
            missing.append(f"Mitsuba {variant}: not installed")
        elif variant.startswith("llvm") and not llvm:
            missing.append(f"Mitsuba {variant}: there is no LLVM library (DRJIT_LIBLLVM_PATH)")
        else:
            programs.append(Mitsuba(python, variant))
            if variant == "llvm_ad_rgb":
                programs.append(Mitsuba(python, variant, robust=True))
    found = pbrt or shutil.which("pbrt")
    if found:
        programs.append(Pbrt(found))
    else:
        missing.append("pbrt-v4: no pbrt on the PATH, none given by --pbrt")
    return programs, missing
