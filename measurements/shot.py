"""Map of chlorophyll from a photo: its error against the known one (section "shot" of docs/shot.md)

Runs the recipes of that page, and writes its images.
  --quick   few samples, into build/shot_report
"""

import contextlib
import os
import pathlib
import re
import shutil
import tempfile

import numpy
from PIL import Image

import frond

from .shared.tools import FROND, ROOT, arguments, machine, program, rms, run, table, write_section

PAGE = ROOT / "docs" / "shot.md"
VEINS = ROOT / "scenes" / "canopy" / "soybean-field" / "veins" / "terminal-1.png"
BASE, TIP = 5, 0.5  # kg/m3 of chlorophyll a where the map of the veins is 1: examples/shot/photo.pbrt


def blocks(page=PAGE):
    """Language and text of what the page tells to run."""
    return re.findall(r"^```(sh|python)\n(.*?)^```$", page.read_text(encoding="utf-8"), re.M | re.S)


def channel(names, pixels, name):
    return pixels[:, :, names.index(name)]


def known_chlorophyll(uv):
    """Chlorophyll a of the photo's leaf by pixel, from an EXR with the channel uv, and where the whole pixel is leaf."""
    names, pixels = frond.read_image(uv)
    veins = numpy.asarray(Image.open(VEINS), float) / 255
    height, width = veins.shape
    u, v = channel(names, pixels, "u"), channel(names, pixels, "v")
    x, y = numpy.clip(u * width - 0.5, 0, width - 1.001), numpy.clip((1 - v) * height - 0.5, 0, height - 1.001)
    left, top = x.astype(int), y.astype(int)
    x, y = x - left, y - top
    upper = veins[top, left] * (1 - x) + veins[top, left + 1] * x
    lower = veins[top + 1, left] * (1 - x) + veins[top + 1, left + 1] * x
    return (upper * (1 - y) + lower * y) * (BASE * (1 - v) + TIP * v), channel(names, pixels, "leaf") > 0.999


def errors(found, known):
    """Content, number of pixels, mean error and RMS error by range of content, and of all."""
    ranges = [(low, low + 1) for low in range(BASE)] + [(0, BASE)]
    for low, high in ranges:
        of = (known >= low) & (known < high)
        difference = (found - known)[of]
        yield f"{low} to {high}", int(of.sum()), float(difference.mean()), rms(difference)


def heat(values, most):
    """Values from 0 to `most` as colours from yellow to dark green."""
    t = numpy.clip(values / most, 0, 1)[..., None]
    return (1 - t) * numpy.array([250, 235, 130]) + t * numpy.array([10, 70, 30])


def srgb(linear):
    linear = numpy.clip(linear, 0, 1)
    return 255 * numpy.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)


def beside(path, images):
    """Writes images of one height beside each other."""
    gap = numpy.full((images[0].shape[0], 6, 3), 255.0)
    row = numpy.concatenate([part for image in images for part in (gap, image)][1:], axis=1)
    path.parent.mkdir(parents=True, exist_ok=True)
    Image.fromarray(row.round().astype(numpy.uint8)).save(path, quality=88)


def color_of(name):
    """A colour for a name, of any hash."""
    random = numpy.random.default_rng(sum(name.encode()) * 7919)
    return 60 + 195 * random.random(3)


def mattes(names, pixels):
    """Colours of a layer's mattes, by the coverage of each."""
    image = numpy.zeros(pixels.shape[:2] + (3,))
    for rank in ("00.R 00.G", "00.B 00.A", "01.R 01.G", "01.B 01.A", "02.R 02.G", "02.B 02.A"):
        ids, coverage = (channel(names, pixels, f"CryptoObject{c}") for c in rank.split())
        for identity in numpy.unique(ids[coverage > 0]):
            image += numpy.where(ids == identity, coverage, 0)[..., None] * color_of(f"{identity:.9g}")
    return image


def images(folder, samples):
    """Of the shot, and of its channels: alpha over a plate, mattes, albedo."""
    scene = "examples/shot/leaf.pbrt"
    program("render", scene, "--spp", samples, "-q", "-o", "leaf.png")
    beside(folder / "leaf.jpg", [numpy.asarray(Image.open("leaf.png").convert("RGB"), float)])
    words = re.search(r"--integrator (\S+) \\\n  --channels (\S+) -o leaf.exr", PAGE.read_text(encoding="utf-8"))
    program("render", scene, "--quick", "--spp", samples, "--integrator", words[1], "--channels", words[2], "-q", "-o", "leaf.exr")
    names, pixels = frond.read_image("leaf.exr")
    plate = numpy.where((numpy.indices(pixels.shape[:2]).sum(axis=0) // 12 % 2)[..., None], 0.5, 0.35)
    color = numpy.stack([channel(names, pixels, c) for c in "RGB"], axis=2)
    albedo = numpy.stack([channel(names, pixels, f"albedo.{c}") for c in "RGB"], axis=2)
    alpha = channel(names, pixels, "A")[..., None]
    beside(folder / "channels.jpg", [srgb(color + (1 - alpha) * plate), mattes(names, pixels), srgb(albedo)])


def measured(names):
    """The section of the page."""
    program("render", "examples/shot/photo.pbrt", "--spp", 4, "--channels", "uv", "-q", "-o", "uv.exr")
    known, leaf = known_chlorophyll("uv.exr")
    of = leaf & names["mask"]
    rows = [(content, count, f"{mean:+.2f}", f"{error:.2f}") for content, count, mean, error in
            errors(names["chlorophyll"][of], known[of])]
    ramp, content = names["falling"], names["content"]
    at = [(f"{c:g}", f"{numpy.interp(c, content, ramp):.3f}", f"{numpy.interp(c, content, names['ramp'][:, 0] / names['ramp'][:, 1]):.2f}")
          for c in (0.1, 0.5, 1, 2, 3, 4, 5, 6, 7)]
    curve = [(head, *(row[i] for row in at)) for i, head in ((1, "green"), (2, "red over green"))]
    return f"""![The photo, the map that is found, and the map that is known](images/shot/map.jpg)

*The photo; chlorophyll a as found, and as it is, from 0 (yellow) to {BASE} kg/m³ (dark green).*

{table(("chlorophyll a (kg/m³)", *(row[0] for row in at)), curve)}
Error of the map, by the content that is known: an 8-bit photo, with the noise of 16 samples a pixel, of a leaf that is not quite flat.
{machine()}.

{table(("chlorophyll a (kg/m³)", "pixels", "mean error", "RMS error"), rows)}""", known, leaf


def main():
    options = arguments("shot")
    folder = options.docs / "images" / "shot"
    with tempfile.TemporaryDirectory() as work, contextlib.chdir(work):
        for name in ("scenes", "examples"):
            pathlib.Path(name).symlink_to(ROOT / name)
        (language, photo), (_, script) = blocks()[:2]
        assert language == "sh" and "photo.pbrt" in photo, photo
        run("bash", "-euc", photo, env=os.environ | {"PATH": f"{FROND.parent}:{os.environ['PATH']}"})
        names = {}
        exec(compile(script, "docs/shot.md", "exec"), names)
        text, known, leaf = measured(names)
        found = numpy.where(names["mask"], names["chlorophyll"], 0)
        shown = [numpy.where(where[..., None], heat(values, BASE), 30)[::2, ::2]
                 for values, where in ((found, names["mask"]), (known, leaf))]
        beside(folder / "map.jpg", [numpy.asarray(Image.open("photo.png").convert("RGB"), float)[::2, ::2], *shown])
        images(folder, 8 if options.quick else 48)
    if options.quick:
        shutil.copy(PAGE, options.docs)
    write_section(options.docs / "shot.md", "shot", text)


if __name__ == "__main__":
    main()
