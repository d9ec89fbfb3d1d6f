"""pbrt-v4, a local build: the program of PBRT, or the pbrt on the PATH. Its film "spectral" has three bands, in each of which all spectra
are constant, so that a band is the radiance at one wavelength; a path carries four wavelengths."""

import os
import pathlib
import shutil
import tempfile

import numpy

from frond import read_image
from measurements.shared.tools import Use

from . import interface
from .frond import scene

PBRT = os.environ.get("PBRT") or shutil.which("pbrt")
EDGES = (380, 480, 580, 680)  # nm, of the bands blue, green and red


def color(nm, values):
    """A spectrum of three steps, for red, green and blue."""
    steps = zip(EDGES[:-1], EDGES[1:], values[::-1])
    return "[ " + " ".join(f"{a + 0.01:g} {v:.7g} {b - 0.01:g} {v:.7g}" for a, b, v in steps) + " ]"


WHITE = '"spectrum L" [ 300 1 900 1 ]'


def film(width, height):
    return (f'Film "spectral" "integer xresolution" {width} "integer yresolution" {height} "integer nbuckets" 3 '
            f'"float lambdamin" {EDGES[0]} "float lambdamax" {EDGES[-1]} "string sensor" "cie1931" "float iso" 100')


def render(text, samples, seed):
    """Red, green and blue, and CPU seconds of the process."""
    if not PBRT:
        raise FileNotFoundError("there is no pbrt: set PBRT to the path of the program")
    with tempfile.TemporaryDirectory() as folder:
        path, out = pathlib.Path(folder, "scene.pbrt"), pathlib.Path(folder, "out.exr")
        path.write_text(text, encoding="utf-8")
        use = Use(PBRT, "--quiet", "--nthreads", 1, "--spp", samples, "--seed", seed, "--outfile", out, path)
        names, pixels = read_image(out)
        bands = sorted((name for name in names if name.startswith("S0.")), key=lambda name: float(name.split(".")[1].replace(",", ".").rstrip("nm")))
        return numpy.stack([pixels[:, :, names.index(name)] for name in bands[::-1]], axis=-1), use.cpu


def image(leaf):
    def draw(task, samples, seed, out):
        text = scene(task, leaf(task), [film(task.width, task.height), 'Sampler "zsobol"'], color, WHITE)
        _, once = render(text, 1, seed)
        pixels, seconds = render(text, samples, seed) if samples > 1 else (_, once)
        numpy.save(pathlib.Path(out).with_suffix(".npy"), pixels)
        load = once - (seconds - once) / (samples - 1) if samples > 1 else once / 2
        return max(seconds - max(load, 0), 0)
    return draw


def table(leaf):
    def rows(task, samples, seed):
        seconds = 0

        def draw(sun, sky, front):
            nonlocal seconds
            z = 1 if front else -1
            lines = [f"LookAt 0 0 {z * 1e-3}  0 1 {z * 1e-3}  0 0 1", 'Camera "spherical" "string mapping" "equirectangular"',
                     f'Integrator "path" "integer maxdepth" {1 if sun is not None else 2}',
                     'PixelFilter "box" "float xradius" 0.001 "float yradius" 0.001', film(40, 20), 'Sampler "independent"', "WorldBegin"]
            if sun is not None:
                lines.append(f'LightSource "distant" {WHITE} "point3 from" [ {sun[0]} {sun[1]} {sun[2]} ] "point3 to" [ 0 0 0 ]')
            for up, radiance in zip((1, -1), sky):  # the inside of half a box
                if radiance:
                    lines += ["AttributeBegin", f'AreaLightSource "diffuse" {WHITE} "float scale" {radiance} "bool twosided" true',
                              'Material "diffuse" "spectrum reflectance" [ 300 0 900 0 ]']
                    for a, b, c in (((-9, -9, 9), (18, 0, 0), (0, 18, 0)), ((-9, -9, 0), (18, 0, 0), (0, 0, 9)), ((-9, 9, 0), (18, 0, 0), (0, 0, 9)),
                                    ((-9, -9, 0), (0, 18, 0), (0, 0, 9)), ((9, -9, 0), (0, 18, 0), (0, 0, 9))):
                        corners = [numpy.array(a) + p + q for p, q in (((0, 0, 0), (0, 0, 0)), (b, (0, 0, 0)), (c, b), (c, (0, 0, 0)))]
                        points = " ".join(f"{x} {y} {up * w}" for x, y, w in corners)
                        lines.append(f'Shape "trianglemesh" "integer indices" [ 0 1 2 0 2 3 ] "point3 P" [ {points} ]')
                    lines.append("AttributeEnd")
            lines += [f"Material {leaf(task)}", 'Shape "trianglemesh" "integer indices" [ 0 1 2 0 2 3 ] "point3 P" '
                      "[ -8.99 -8.99 0  8.99 -8.99 0  8.99 8.99 0  -8.99 8.99 0 ]"]
            pixels, used = render("\n".join(lines) + "\n", samples, seed)
            seconds += used
            return pixels[::-1, ::-1]  # of directions of sight, which are opposite to those of view
        return list(interface.rows_of_images(task, draw)), seconds
    return rows


def main(leaf):
    """`leaf(task)` is the leaf's Material without that word."""
    interface.main(image(leaf), table(leaf), {"pbrt-v4": os.environ.get("PBRT_COMMIT", "local build")})
