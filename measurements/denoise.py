"""Denoising: RMS error before and after (section "denoise" of docs/rendering.md)

Runs the recipe of that page with Open Image Denoise (pyoidn, installed into build/denoise by pip) on several scenes with 16
samples per pixel. Takes some ten minutes on two cores.
  --quick   few samples, into build/denoise_report
"""

import importlib.metadata
import pathlib
import re
import shutil
import tempfile

import numpy

import frond
import pyoidn

from .shared.tools import ROOT, arguments, machine, program, sized, table, write_section

PAGE = ROOT / "docs" / "rendering.md"
SAMPLES = 16
# Scene, width and height of its film (None: the scene's own), and samples per pixel of each of the two references.
SCENES = {
    "pot": ("scenes/pot/scene.pbrt", None, 128),
    "soybean-front": ("scenes/soybean-front/scene.pbrt", (256, 256), 256),
    "hundred-leaves": ("scenes/hundred-leaves/scene.pbrt", (256, 256), 256),
    "soybean-field": ("scenes/canopy/soybean-field/scene.pbrt", (256, 144), 64),
}


def recipe():
    """The command and the Python script that the page gives, in this order."""
    section = PAGE.read_text(encoding="utf-8").split("## Denoising\n")[1].split("\n## ")[0]
    shell, script = (re.search(rf"```{language}\n(.*?)```", section, re.DOTALL)[1] for language in ("sh", "python"))
    return shell, script


def channels(path, names):
    have, pixels = frond.read_image(path)
    return numpy.ascontiguousarray(pixels[:, :, [have.index(name) for name in names]])


def rms(image, references):
    """RMS error over pixels and colours. Two independent references leave out their own noise."""
    a, b = references
    return float(numpy.sqrt(max(numpy.mean((image - a) * (image - b)), 0)))


def measure(scene, size, reference_samples, folder):
    if size:
        scene = sized(ROOT / scene, folder, *size)
    scene = ROOT / scene
    references = []
    for seed in (101, 102):
        program("render", scene, "--spp", reference_samples, "--seed", seed, "-q", "-o", folder / "reference.exr")
        references.append(channels(folder / "reference.exr", "RGB"))
    shell, script = recipe()
    words = shell.replace("scenes/pot/scene.pbrt", str(scene)).replace("pot.exr", str(folder / "pot.exr")).split()
    assert words[:2] == ["frond", "render"] and f"--spp {SAMPLES}" in shell, shell
    program(*words[1:], "-q")
    exec(script.replace('"pot.exr"', f'r"{folder}/pot.exr"').replace('"clean.exr"', f'r"{folder}/clean.exr"'), {})
    program("render", scene, "--spp", SAMPLES, "--channels", "albedo,normal", "-q", "-o", folder / "default.exr")
    features = [tuple(f"albedo.{c}" for c in "RGB"), tuple(f"normal.{c}" for c in "XYZ")]
    default = channels(folder / "default.exr", "RGB")
    noisy = channels(folder / "pot.exr", "RGB")
    albedo, normal = (channels(folder / "default.exr", names) for names in features)
    of_default = pyoidn.denoise(default, pyoidn.denoise(albedo), normal, hdr=True, clean_aux=True)
    return {"default": rms(default, references), "default, denoised": rms(of_default, references),
            "noisy": rms(noisy, references), "colours alone": rms(pyoidn.denoise(noisy, hdr=True), references),
            "denoised": rms(channels(folder / "clean.exr", "RGB"), references)}


def page(results):
    number = lambda value: f"{value:.4f}"
    body = [(f"`{scene}`", *(number(r[k]) for k in ("default", "default, denoised", "noisy", "colours alone", "denoised")),
             f"{r['denoised'] / r['noisy']:.2f}", f"{r['denoised'] / r['default']:.2f}") for scene, r in results.items()]
    return f"""## Denoising: measurements

RMS error over pixels and linear colours, {SAMPLES} samples per pixel, the scenes' own leaves and wavelengths. The references are two
renders of many samples, whose own noise is left out. `pot` has the size of its film, the other images are 256 pixels wide.

- **default**: `frond render` without options, noisy and denoised with albedo and normal.
- **`--for-denoiser`**: noisy; denoised by the colours alone; denoised by the [recipe](#denoising), with albedo and normal.

{table(("scene", "default, noisy", "default, denoised", "`--for-denoiser`, noisy", "colours alone", "recipe", "recipe over its noisy image",
        "recipe over the default, noisy"), body)}
Machine: {machine()}; Open Image Denoise {importlib.metadata.version("pyoidn")}.
"""


def main():
    options = arguments("denoise")
    results = {}
    for name, (scene, size, samples) in SCENES.items():
        if options.quick and name == "soybean-field":
            continue
        with tempfile.TemporaryDirectory() as folder:
            results[name] = measure(scene, size or ((128, 160) if options.quick else None), samples // (16 if options.quick else 1),
                                    pathlib.Path(folder))
    if options.quick:
        options.docs.mkdir(parents=True, exist_ok=True)
        shutil.copy(PAGE, options.docs)
    write_section(options.docs / "rendering.md", "denoise", page(results))


if __name__ == "__main__":
    main()
