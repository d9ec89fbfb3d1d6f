"""Renders for measurements/run race with Mitsuba 3, in a separate process of the Python that Mitsuba is installed in.

Arguments: variant, scene (JSON of scenes.py), threads, 1 for robust intersections of Embree. Each line of standard input
requests a render, as JSON; for each request one line of JSON with its CPU and wall-clock time is printed.
"""

import json
import sys
import time

START = time.perf_counter()

import drjit as dr
import mitsuba as mi


def diffuse_leaf():
    """Lambertian reflector and transmitter, which Mitsuba does not have. Not for scalar variants."""

    class DiffuseLeaf(mi.BSDF):
        def __init__(self, properties):
            mi.BSDF.__init__(self, properties)
            self.reflectance = properties["reflectance"]
            self.transmittance = properties["transmittance"]
            self.share = self.reflectance / (self.reflectance + self.transmittance)
            sides = mi.BSDFFlags.FrontSide | mi.BSDFFlags.BackSide
            self.m_components = [mi.BSDFFlags.DiffuseReflection | sides, mi.BSDFFlags.DiffuseTransmission | sides]
            self.m_flags = self.m_components[0] | self.m_components[1]

        def value(self, wi, wo):
            """f times the cosine, and the density of wo."""
            cosine = dr.abs(wo.z) * dr.inv_pi
            reflected = wi.z * wo.z > 0
            return (dr.select(reflected, self.reflectance, self.transmittance) * cosine,
                    dr.select(reflected, self.share, 1 - self.share) * cosine)

        def sample(self, ctx, si, sample1, sample2, active):
            wo = mi.warp.square_to_cosine_hemisphere(sample2)
            reflected = sample1 < self.share
            wo.z = dr.select(reflected == (si.wi.z > 0), wo.z, -wo.z)
            sample = mi.BSDFSample3f()
            sample.wo = wo
            sample.pdf = self.value(si.wi, wo)[1]
            sample.eta = 1
            sample.sampled_type = dr.select(reflected, mi.UInt32(+mi.BSDFFlags.DiffuseReflection),
                                            mi.UInt32(+mi.BSDFFlags.DiffuseTransmission))
            sample.sampled_component = dr.select(reflected, mi.UInt32(0), mi.UInt32(1))
            return sample, mi.Spectrum(self.reflectance + self.transmittance) & (active & (sample.pdf > 0))

        def eval(self, ctx, si, wo, active):
            return mi.Spectrum(self.value(si.wi, wo)[0]) & active

        def pdf(self, ctx, si, wo, active):
            return self.value(si.wi, wo)[1] & active

        def eval_pdf(self, ctx, si, wo, active):
            value, pdf = self.value(si.wi, wo)
            return mi.Spectrum(value) & active, pdf & active

        def to_string(self):
            return "DiffuseLeaf"

    return DiffuseLeaf


def spectrum(value, light=False):
    if light:
        return {"type": "d65", "scale": value} if mi.is_spectral else {"type": "rgb", "value": value}
    return {"type": "uniform", "value": value} if mi.is_spectral else {"type": "rgb", "value": value}


def matrix(values):
    return mi.ScalarTransform4f([values[i:i + 4] for i in (0, 4, 8, 12)])


def shape_of(shape, materials):
    transform = matrix(shape["to_world"])
    p = shape["parameters"]
    made = {"bsdf": materials[shape["material"]]}
    if shape["radiance"]:
        made["emitter"] = {"type": "area", "radiance": spectrum(shape["radiance"], light=True)}
    if shape["kind"] == "disk":
        transform = transform @ mi.ScalarTransform4f().scale(p["radius"][0])
        if shape["reversed"]:
            transform = transform @ mi.ScalarTransform4f().rotate([1, 0, 0], 180)
        return made | {"type": "disk", "to_world": transform}
    return made | {"type": "ply", "filename": p["filename"], "to_world": transform, "face_normals": True}


def load(scene, leaf=None, robust=False):
    """The scene with its own leaves, or with the BSDF `leaf` for all leaves. `robust`: of Embree's intersections."""
    two_sided = lambda value: {"type": "twosided", "bsdf": {"type": "diffuse", "reflectance": spectrum(value)}}
    reflectance, transmittance = scene["leaf"]
    if leaf is None and transmittance:
        mi.register_bsdf("diffuse_leaf", diffuse_leaf())
        leaf = {"type": "diffuse_leaf", "reflectance": reflectance, "transmittance": transmittance}
    materials = {name: two_sided(value) for name, value in scene["grey"].items()} | {"leaf": leaf or two_sided(reflectance)}
    world = {"type": "scene", "embree_use_robust_intersections": robust,
             "integrator": {"type": "path", "max_depth": scene["depth"] + 1}}
    groups = {}
    for i, shape in enumerate(scene["shapes"]):
        made = shape_of(shape, materials)
        if shape["object"]:
            groups.setdefault(shape["object"], {"type": "shapegroup"})[f"shape{i}"] = made
        else:
            world[f"shape{i}"] = made
    world |= {f"object-{name}": group for name, group in groups.items()}
    for i, (name, values) in enumerate(scene["instances"]):
        world[f"instance{i}"] = {"type": "instance", "to_world": matrix(values),
                                 "group": {"type": "ref", "id": f"object-{name}"}}
    for i, (toward, irradiance) in enumerate(scene["distant"]):
        world[f"sun{i}"] = {"type": "directional", "direction": [-v for v in toward],
                            "irradiance": spectrum(irradiance, light=True)}
    if scene["sky"]:
        world["sky"] = {"type": "constant", "radiance": spectrum(scene["sky"], light=True)}
    origin, target, up = scene["camera"]["look"]
    # Mitsuba's Gaussian has a radius of four standard deviations.
    filters = {"box": {"type": "box"}, "gaussian": {"type": "gaussian", "stddev": scene["gaussian"]["sigma"]}}
    for name, reconstruction in filters.items():
        world[f"sensor-{name}"] = {
            "type": "perspective", "id": name, "fov": scene["camera"]["fov"], "fov_axis": "smaller",
            "near_clip": 0.1, "far_clip": 1e6,
            "to_world": mi.ScalarTransform4f().look_at(origin=origin, target=target, up=up),
            "sampler": {"type": "multijitter"},
            "film": {"type": "hdrfilm", "width": scene["size"], "height": scene["size"], "rfilter": reconstruction,
                     "component_format": "float32"}}
    return mi.load_dict(world)


def main():
    variant, file, threads, robust = sys.argv[1:]
    mi.set_variant(variant)
    dr.set_thread_count(int(threads))
    mi.set_log_level(mi.LogLevel.Error)
    with open(file, encoding="utf-8") as text:
        scene = load(json.load(text), robust=robust == "1")
    sensors = {sensor.id(): sensor for sensor in scene.sensors()}
    say = lambda **what: print(json.dumps(what), flush=True)
    say(cpu=time.process_time(), wall=time.perf_counter() - START, version=mi.__version__)
    for line in sys.stdin:
        ask = json.loads(line)
        cpu, wall = time.process_time(), time.perf_counter()
        image = mi.render(scene, sensor=sensors[ask["filter"]], spp=ask["samples"], seed=ask["seed"])
        dr.eval(image)
        dr.sync_thread()
        took = {"cpu": time.process_time() - cpu, "wall": time.perf_counter() - wall}
        mi.Bitmap(image).write(ask["out"])
        say(**took)


if __name__ == "__main__":
    main()
