"""frond: renders a task by `frond render`; the table by its Python module."""

import json
import os
import pathlib
import tempfile

import numpy

import frond
from measurements.shared.tools import FROND, ROOT, run

from . import interface


def exported(name, *words):
    """The path of a file of `frond export leaf_solved`, which is written once."""
    path = ROOT / "build" / "leaf_benchmark" / name
    if not path.exists():
        part = path.with_name(f"{os.getpid()}-{name}")
        run(FROND, "export", "leaf_solved,specimen=soybean", *words, "-q", "-o", part)
        part.replace(path)
    return path


def spectrum(nm, values):
    return "[ " + " ".join(f"{w} {v:.7g}" for w, v in sorted(zip(nm, values))) + " ]"


def numbers(values):
    return " ".join(f"{v:.9g}" for v in values)


def scene(task, leaf, head, color=spectrum, white='"spectrum L" "stdillum-D65"'):
    """The task in pbrt-v4's format. `leaf` is the leaf's Material without that word; pbrt-v4 has other lines in `head` and other spectra."""
    c = task.camera
    lines = ["Scale -1 1 1", f"LookAt {numbers(c['position'] + c['target'] + c['up'])}", f'Camera "perspective" "float fov" {c["fov"]}',
             f'Integrator "path" "integer maxdepth" {task.scattering_events}', 'PixelFilter "box"', *head, "WorldBegin"]
    if task.sky:
        lines.append(f'LightSource "infinite" {white} "float scale" {task.sky}')
    for lamp in task.lamps:
        center, toward = numpy.array(lamp["center"]), numpy.array(lamp["toward"])
        x = numpy.cross(toward, [0, 0, 1] if abs(toward[2]) < 0.9 else [1, 0, 0])
        x /= numpy.linalg.norm(x)
        matrix = numpy.concatenate([v for axis, w in ((x, 0), (numpy.cross(toward, x), 0), (toward, 0), (center, 1)) for v in (axis, [w])])
        lines += ["AttributeBegin", f"Transform [ {numbers(matrix)} ]", f'AreaLightSource "diffuse" {white} "float scale" {lamp["radiance"]}',
                  f'Shape "disk" "float radius" {lamp["radius"]}', "AttributeEnd"]
    for surface in task.surfaces:
        material = leaf if surface["reflectance"] is None else f'"diffuse" "spectrum reflectance" {color(task.wavelengths_nm, surface["reflectance"])}'
        lines += [f"Material {material}", f'Shape "plymesh" "string filename" "{task.mesh(surface)}"']
    return "\n".join(lines) + "\n"


def image(leaf, options=()):
    def render(task, samples, seed, out):
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "scene.pbrt"
            film = f'Film "rgb" "integer xresolution" {task.width} "integer yresolution" {task.height}'
            path.write_text(scene(task, leaf, [film]), encoding="utf-8")
            words = [FROND, "render", path, "-q", "--threads", 1, "--wavelengths", "smpte", "--spp", samples, "--seed", seed, *options,
                     "-o", out, "--json", f"{folder}/use.json"]
            run(*words)
            return json.loads(pathlib.Path(folder, "use.json").read_text())["cpu_seconds"]
    return render


def table(leaf):
    def rows(task, samples, seed):
        start, bsdf = interface.cpu(), frond.bsdf(leaf, task.wavelengths_nm)
        seeds = iter(range(seed << 16, (seed + 1) << 16))

        def f(wo, wi):
            times = samples if bsdf.is_stochastic and len(wo) < 10_000 else 1
            return numpy.mean([bsdf.f(wo, wi, seed=next(seeds)) for _ in range(times)], axis=0)

        def sample(wo):
            wi, weight, _ = bsdf.sample(wo, seed=next(seeds))
            return wi, weight
        found = list(interface.rows_of_bsdf(task, f, sample, seed, 4096 * samples))
        return found, interface.cpu() - start
    return rows


def brf(leaf):
    def measure(task, samples, seed):
        sun = numpy.radians(task.sun_zenith)
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "canopy.pbrt"
            path.write_text(f'WorldBegin LightSource "distant" "point3 from" [ {numpy.sin(sun)} 0 {numpy.cos(sun)} ] "point3 to" [ 0 0 0 ] '
                            f'"spectrum L" "stdillum-E" Material {leaf} Shape "plymesh" "string filename" "{task.mesh(task.surfaces[0])}"\n')
            scene = frond.load(path)
            start = interface.cpu()
            found = frond.brf(scene, task.wavelengths_nm, zenith=[-z for z in task.view_zenith],  # frond's are negative on the sun's side
                              target=tuple(task.target), seed=seed, paths=samples)
            seconds = interface.cpu() - start
            shares = frond.flux(scene, task.wavelengths_nm, period=tuple(task.period), seed=seed, paths=min(16 * samples, 1 << 20))
        brf = numpy.reshape(found["brf"], (len(task.view_zenith), -1))
        return numpy.vstack([brf, shares[shares.quantity == "absorbed"].share]), seconds
    return measure


def main(leaf, *options):
    """`leaf` as in frond's instruments, leaf_solved,incident=reciprocal."""
    name, *words = leaf.split(",")
    parameters = "".join(f' "string {key}" "{value}"' for key, value in (word.split("=") for word in words))
    material = f'"{name}" "string specimen" "soybean"{parameters}'
    interface.main(image(material, options), table(leaf + ",specimen=soybean"), {"frond": frond.__version__}, brf(material))
