"""Mitsuba 3, variant llvm_ad_rgb, on two threads."""

import os
import types

import numpy

from measurements.race.programs import libllvm

from . import interface

SCALE = 100  # units per metre: Mitsuba offsets ray origins from surfaces by 0.1 mm or more if 1 is a metre
os.environ.setdefault("DRJIT_LIBLLVM_PATH", libllvm() or "")

import drjit as dr
import mitsuba as mi

mi.set_variant("llvm_ad_rgb")
dr.set_thread_count(2)  # with one thread, mi.render of 3.9.1 does not return; figures are CPU time
mi.set_log_level(mi.LogLevel.Error)
import frond.mitsuba  # registers frond_leaf and frond_diffuse, the Lambertian reflector and transmitter, which Mitsuba lacks


def rgb(values):
    return {"type": "rgb", "value": list(values)}


def scene(task, leaf):
    c = task.camera
    scaled = lambda v: [SCALE * x for x in v]
    film = {"type": "hdrfilm", "width": task.width, "height": task.height, "rfilter": {"type": "box"}, "component_format": "float32"}
    world = {"type": "scene", "integrator": {"type": "path", "max_depth": task.scattering_events + 1},
             "camera": {"type": "perspective", "fov": c["fov"], "fov_axis": "smaller", "near_clip": 0.1, "far_clip": 1e6,
                        "to_world": mi.ScalarTransform4f().look_at(origin=scaled(c["position"]), target=scaled(c["target"]), up=c["up"]),
                        "sampler": {"type": "multijitter"}, "film": film}}
    for i, lamp in enumerate(task.lamps):
        center = numpy.array(scaled(lamp["center"]))
        up = [0, 0, 1] if abs(lamp["toward"][2]) < 0.9 else [1, 0, 0]
        place = mi.ScalarTransform4f().look_at(origin=center, target=center + lamp["toward"], up=up).scale(SCALE * lamp["radius"])
        world[f"lamp{i}"] = {"type": "disk", "to_world": place, "emitter": {"type": "area", "radiance": rgb([lamp["radiance"]] * 3)}}
    if task.sky:
        world["sky"] = {"type": "constant", "radiance": rgb([task.sky] * 3)}
    for surface in task.surfaces:
        other = surface["reflectance"] and {"type": "twosided", "bsdf": {"type": "diffuse", "reflectance": rgb(surface["reflectance"])}}
        world[surface["name"]] = {"type": "ply", "filename": task.mesh(surface), "face_normals": True, "bsdf": other or leaf,
                                  "to_world": mi.ScalarTransform4f().scale(SCALE)}
    return mi.load_dict(world)


def image(leaf_of):
    def render(task, samples, seed, out):
        world = scene(task, leaf_of(task))
        for _ in range(2):  # the first one compiles
            start = interface.cpu()
            pixels = mi.render(world, spp=samples, seed=seed)
            dr.eval(pixels)
            dr.sync_thread()
            seconds = interface.cpu() - start
        mi.Bitmap(pixels).write(str(out))
        return seconds
    return render


def table(leaf_of):
    def rows(task, samples, seed):
        start, bsdf = interface.cpu(), mi.load_dict(leaf_of(task))
        sampler = mi.load_dict({"type": "independent"})

        def at(wo):
            si = dr.zeros(mi.SurfaceInteraction3f, len(wo))
            si.wi = mi.Vector3f(numpy.ascontiguousarray(wo.T))
            return si

        def f(wo, wi):
            value = numpy.array(bsdf.eval(mi.BSDFContext(), at(wo), mi.Vector3f(numpy.ascontiguousarray(wi.T)))).T
            return value / abs(wi[:, 2:])

        def sample(wo):
            sampler.seed(seed, len(wo))
            found, weight = bsdf.sample(mi.BSDFContext(), at(wo), sampler.next_1d(), sampler.next_2d())
            return numpy.array(found.wo).T, numpy.array(weight).T
        return list(interface.rows_of_bsdf(task, f, sample, seed, 4096 * samples)), interface.cpu() - start
    return rows


def brf(leaf_of):
    """By a distant sensor for each view. A variant for colours carries three wavelengths."""
    def measure(task, samples, seed):
        seconds, columns = 0, {}
        x0, x1, y0, y1, z = task.target
        toward = lambda zenith: [numpy.sin(numpy.radians(zenith)), 0, numpy.cos(numpy.radians(zenith))]
        square = mi.ScalarTransform4f().translate([SCALE * (x0 + x1) / 2, SCALE * (y0 + y1) / 2, SCALE * z]).scale(
            [SCALE * (x1 - x0) / 2, SCALE * (y1 - y0) / 2, 1])
        for of in (slice(0, 3), slice(1, 4)):
            part = types.SimpleNamespace(kind=task.kind, wavelengths_nm=task.wavelengths_nm[of], near_normal=lambda side="front", of=of: tuple(
                values[of] for values in task.near_normal(side)))
            world = {"type": "scene", "integrator": {"type": "path", "max_depth": task.scattering_events + 1},
                     "sun": {"type": "directional", "direction": [-v for v in toward(task.sun_zenith)], "irradiance": rgb([1, 1, 1])},
                     "leaf": {"type": "ply", "filename": task.mesh(task.surfaces[0]), "face_normals": True, "bsdf": leaf_of(part),
                              "to_world": mi.ScalarTransform4f().scale(SCALE)}}
            for view, zenith in enumerate(task.view_zenith):
                world[f"view{view}"] = {"type": "distant", "direction": [-v for v in toward(zenith)], "target": {"type": "rectangle", "to_world": square},
                                        "sampler": {"type": "independent"},
                                        "film": {"type": "hdrfilm", "width": 1, "height": 1, "rfilter": {"type": "box"}, "component_format": "float32"}}
            world = mi.load_dict(world)
            for repeat in range(2):  # the first one compiles
                start = interface.cpu()
                values = [numpy.array(mi.render(world, sensor=i, spp=samples, seed=seed * 100 + i)).ravel()[:3] for i in range(len(task.view_zenith))]
                used = interface.cpu() - start
            seconds += used
            columns |= dict(zip(part.wavelengths_nm, numpy.transpose(values)))
        values = numpy.stack([columns[nm] for nm in task.wavelengths_nm], axis=1)
        return numpy.pi * values / numpy.cos(numpy.radians(task.sun_zenith)), seconds
    return measure


def main(leaf_of):
    """`leaf_of(task)` is the leaf's BSDF, a dictionary."""
    interface.main(image(leaf_of), table(leaf_of), {"Mitsuba": mi.__version__, "frond": frond.__version__}, brf(leaf_of))
