"""LESS 3 (PyPI less3d), by Embree. The canopy is a mesh, and its leaves are Lambertian: R of each side and one T."""

import contextlib
import importlib.metadata
import os
import pathlib
import sys
import tempfile

import less
import numpy

from measurements.shared import ply

from . import interface

PIXELS = 32  # of an image of the target, along each side
PATHS = 1_000_000  # of the absorbed light, the least number


def azimuth(toward_sun, seed):
    """In degrees clockwise from north. LESS draws the same numbers in each run: another seed turns the scene."""
    return ((90 if toward_sun else 270) - 90 * seed) % 360


def scene(task, folder, seed, periodic):
    """The canopy in the middle of a square, and its highest point. LESS takes an OBJ as y up, with x to the west and z to the north; its
    fronts turn clockwise; it moves a mesh to its lowest point, and an oblique view to its highest."""
    points, triangles = ply.read(task.mesh(task.surfaces[0]))
    x, y, z = points.T
    for _ in range(seed % 4):
        x, y = -y, x
    with open(path := pathlib.Path(folder, "leaf.obj"), "w", encoding="ascii") as file:
        file.write("g leaf\n")
        numpy.savetxt(file, numpy.stack([-x, z, y], axis=1), fmt="v %.7g %.7g %.7g")
        numpy.savetxt(file, triangles[:, ::-1] + 1, fmt="f %d %d %d")
    (r, t), (back_r, back_t) = task.near_normal("front"), task.near_normal("back")
    leaf = less.Object("leaf", mesh=str(path))
    leaf.set_property(less.Lambertian(reflectance=r, back_reflectance=back_r, transmittance=[(a + b) / 2 for a, b in zip(t, back_t)],
                                      wavelengths=task.wavelengths_nm))
    world = less.Scene(backend="embree")
    world.size, world.repetitive = float(task.period[0]), periodic
    world.terrain = less.Terrain(property=less.Lambertian(reflectance=0.0))
    world.add(leaf, positions=numpy.array([[world.size / 2, world.size / 2, z.min()]]))
    world.illumination = less.Illumination(source=less.Sun(zenith=task.sun_zenith, azimuth=azimuth(True, seed), irradiance=[1.0]), atmosphere=less.NoAtmosphere())
    world.build()
    return world, z.max()


def brf(task, samples, seed):
    """The target is in the middle of the canopy."""
    x0, x1, _, _, height = task.target
    values, seconds = [], 0
    with tempfile.TemporaryDirectory() as folder, contextlib.redirect_stdout(sys.stderr):
        world, top = scene(task, folder, seed, False)
        for zenith in task.view_zenith:
            toward = numpy.radians(azimuth(zenith > 0, seed))
            shift = (top - height) * numpy.tan(numpy.radians(abs(zenith)))
            center = world.size / 2 + shift * numpy.sin(toward), world.size / 2 - shift * numpy.cos(toward)  # to the east and the south
            view = less.Orthographic(image_size=PIXELS, extent=x1 - x0, center=center, view_zenith=abs(zenith), view_azimuth=azimuth(zenith > 0, seed))
            start = interface.cpu()
            found = world.simulate(less.OpticalImager(view, bands=task.wavelengths_nm, quality=samples // PIXELS**2), scattering_order=task.scattering_events)
            seconds += interface.cpu() - start
            values.append(numpy.pi * numpy.asarray(found.data).mean(axis=(0, 1)) / found.irradiance)
        world, _ = scene(task, folder, seed, True)
        found = world.simulate(less.RadiationFieldSensor(bands=task.wavelengths_nm, photons_per_m2=int(PATHS / world.size**2)))
        values.append(found.absorption_per_leaf.sum(axis=0) / found.irradiance / found.scene_area)
    return numpy.array(values), seconds


def main():
    def cannot(*_):
        raise NotImplementedError("the runner measures canopies alone")
    interface.main(cannot, cannot, {"LESS (less3d)": importlib.metadata.version("less3d")}, brf)
