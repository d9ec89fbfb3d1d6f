"""Radiance, by oconv and rtrace of pyradiance, on one thread. Rays are drawn here, because rpict distributes its own by its cache."""

import os
import pathlib
import subprocess
import tempfile

import numpy
import pyradiance

from . import interface

HOME = pathlib.Path(pyradiance.__path__[0])
ENVIRONMENT = os.environ | {"RAYPATH": f".:{HOME / 'lib'}", "PATH": f"{HOME / 'bin'}:{os.environ['PATH']}"}
# Paths without a cache: one ambient ray at each hit, Russian roulette below a weight of 0.01; one shadow ray to each lamp.
OPTIONS = "-h -fff -n 1 -u+ -aa 0 -ad 1 -as 0 -lr -64 -lw 0.01 -dj 1 -ds 0 -dt 0 -dr 0 -ss 1 -st 0".split()


def primitive(kind, name, numbers=(), words=(), modifier="void"):
    return f"{modifier} {kind} {name}\n{len(words)} {' '.join(map(str, words))}\n0\n{len(numbers)} {' '.join(f'{v:.9g}' for v in numbers)}\n"


def run(folder, *words, **more):
    return subprocess.run(list(map(str, words)), cwd=folder, env=ENVIRONMENT, capture_output=True, check=True, **more).stdout


class World:
    """A scene in a folder; `trace` returns radiance in three colours, and counts its CPU time."""

    def __init__(self, folder, text):
        self.folder, self.cpu = folder, 0
        (folder / "scene.rad").write_text(text, encoding="ascii")
        (folder / "scene.oct").write_bytes(run(folder, "oconv", "scene.rad"))

    def trace(self, rays, bounces, seed):
        """The rays in random order, because rtrace draws the same numbers in each run."""
        order = numpy.random.default_rng(seed).permutation(len(rays))
        start = interface.cpu()
        found = run(self.folder, "rtrace", *OPTIONS, "-ab", bounces, "scene.oct", input=rays[order].astype(numpy.float32).tobytes())
        self.cpu += interface.cpu() - start
        values = numpy.empty((len(rays), 3))
        values[order] = numpy.frombuffer(found, numpy.float32).reshape(-1, 3)
        return values


def world(task, folder, leaf):
    text = leaf
    for i, lamp in enumerate(task.lamps):
        text += primitive("light", f"light{i}", [lamp["radiance"]] * 3)
        text += primitive("ring", f"lamp{i}", [*lamp["center"], *lamp["toward"], 0, lamp["radius"]], modifier=f"light{i}")
    if task.sky:
        text += primitive("glow", "glow", [task.sky] * 3 + [0]) + primitive("source", "sky", [0, 0, 1, 360], modifier="glow")
    for surface in task.surfaces:
        name = surface["name"]
        if surface["reflectance"]:
            text += primitive("plastic", name, [*surface["reflectance"], 0, 0])
        if not (folder / f"{name}.rtm").exists():
            run(folder, "obj2mesh", task.mesh(surface, "obj"), f"{name}.rtm")
        text += primitive("mesh", f"mesh-{name}", words=[f"{name}.rtm"], modifier=name)
    return World(folder, text)


def camera_rays(task, samples, seed):
    """Rays of all pixels, `samples` of each in a row; jittered over the pixel."""
    c, random = task.camera, numpy.random.default_rng(seed)
    position, target, up = map(numpy.array, (c["position"], c["target"], c["up"]))
    forward = (target - position) / numpy.linalg.norm(target - position)
    right = numpy.cross(forward, up) / numpy.linalg.norm(numpy.cross(forward, up))
    y, x = numpy.divmod(numpy.repeat(numpy.arange(task.width * task.height), samples), task.width)
    at = lambda pixel, count: (2 * (pixel + random.random(len(pixel))) / count - 1) * numpy.tan(numpy.radians(c["fov"] / 2))
    toward = forward + at(x, task.width)[:, None] * right - at(y, task.height)[:, None] * numpy.cross(right, forward)
    return numpy.concatenate([numpy.broadcast_to(position, toward.shape), toward], axis=1)


def image(leaves):
    def render(task, samples, seed, out):
        rays, seconds, channels = camera_rays(task, samples, seed), 0, []
        with tempfile.TemporaryDirectory() as folder:
            for channel, leaf in enumerate(leaves(task)):
                scene = world(task, pathlib.Path(folder), leaf)
                channels.append(scene.trace(rays, 16, seed + channel).reshape(task.height, task.width, samples, 3).mean(axis=2))
                seconds += scene.cpu
        pixels = channels[0] if len(channels) == 1 else numpy.stack([c[..., i] for i, c in enumerate(channels)], axis=-1)
        numpy.save(pathlib.Path(out).with_suffix(".npy"), pixels)
        return seconds
    return render


def table(leaves):
    def rows(task, samples, seed):
        seconds, theta_phi, half = 0, interface.views(task), 0.1
        seeds = iter(range(seed << 16, (seed + 1) << 16))

        def render(sun, sky, front):
            nonlocal seconds
            text, channels = primitive("polygon", "sheet", [-90, -90, 0, 90, -90, 0, 90, 90, 0, -90, 90, 0], modifier="leaf"), []
            if sun is not None:
                text += primitive("light", "sun", [1 / (2 * numpy.pi * (1 - numpy.cos(numpy.radians(half))))] * 3)
                text += primitive("source", "disk", [*sun, 2 * half], modifier="sun")
            for z, radiance in ((1, sky[0]), (-1, sky[1])):
                text += primitive("glow", f"glow{z}", [radiance] * 3 + [0]) + primitive("source", f"sky{z}", [0, 0, z, 180], modifier=f"glow{z}")
            toward = interface.direction(*theta_phi).reshape(-1, 3)
            ends = numpy.where((toward[:, 2:] > 0) == front, toward, [0, 0, 1 if front else -1])
            rays = numpy.repeat(numpy.concatenate([0.001 * ends, -ends], axis=1), samples, axis=0)
            for leaf in leaves(task):
                with tempfile.TemporaryDirectory() as folder:
                    scene = World(pathlib.Path(folder), leaf + text)
                    channels.append(scene.trace(rays, 0 if sun is not None else 1, next(seeds)).reshape(*theta_phi[0].shape, samples, 3).mean(axis=2))
                    seconds += scene.cpu
            return channels[0] if len(channels) == 1 else numpy.stack([c[..., i] for i, c in enumerate(channels)], axis=-1)
        return list(interface.rows_of_images(task, render)), seconds
    return rows


def version():
    return " ".join(run(pathlib.Path("."), "rtrace", "-version").decode().split()[1:3])


def main(leaves):
    """`leaves(task)` is a list of descriptions of the material `leaf`: one, or one for each colour."""
    interface.main(image(leaves), table(leaves), {"Radiance": version()})
