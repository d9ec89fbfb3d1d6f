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
        import frond.mitsuba  # registers a Lambertian reflector and transmitter, which Mitsuba lacks; not for scalar variants
        leaf = {"type": "frond_diffuse", "reflectance": reflectance, "transmittance": transmittance}
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
