"""Mitsuba 3: frond_leaf there and in frond (section "mitsuba" of docs/other_renderers.md)

Writes an image, too. Installs Mitsuba and other Python packages into build/python-venv by pip, libllvm 19 from Debian.
  --quick   few samples, into build/mitsuba_report
"""

import json
import time

import numpy

import mitsuba as mi

mi.set_variant("llvm_ad_rgb")
import drjit as dr

import frond
import frond.mitsuba

from .race import mitsuba_worker, scenes
from .shared.tools import ROOT, arguments, machine, rms, table, write_section

RGB_NM = [608, 551, 455]
ANGLES = [8, 45, 70]
SIZE, SAMPLES = 256, 256
FOLDER = ROOT / "build" / "mitsuba"

SECTION = """### Agreement of Mitsuba with frond

Measured by `measurements/run mitsuba` on {machine}; Mitsuba {version}, `llvm_ad_rgb`, frond {frond_version}.

**f** at {pairs:,} random pairs of directions on both sides, at most 89.4° from the normal. The table has the RMS and the largest
difference of π f from `leaf_solved`. For a white Lambertian reflector, π f is 1.

{f_table}
**R and T** at 8, 45 and 70°, both sides, {rgb} nm: the plug-in's estimates from 10⁶ samples (`traced`) less those of
frond's goniophotometer, which integrates f. The RMS difference is {share_rms:.1e}; the RMS standard error of the estimates is
{share_error:.1e}. The largest of the {shares} differences is {share_z:.1f} standard errors.

**Images** of a hundred leaves ([scenes](performance.md): {size} x {size} pixels, {samples} samples per pixel, 16 scattering events, box
filter). The table has the means over all pixels, with standard errors from two renders by each program. Rows with a colour are for
reciprocal soybean leaves. Rows `diffuse` are for Lambertian surfaces: they show how the programs differ without frond's leaf model.

{image_table}
![A hundred leaves in Mitsuba, and in frond](images/mitsuba/hundred-leaves.png)

### Speed of Mitsuba and frond

CPU time per path for a plane of leaf under a uniform sky: camera rays and one scattering event, median of {rounds} renders, without
compilation. `leaf, over depth` has `differentiable` set.

{cost_table}"""


def random_pairs(count):
    w = numpy.random.default_rng(1).normal(size=(2, count, 3))
    length = numpy.linalg.norm(w, axis=2)
    w[:, :, 2] = numpy.copysign(numpy.maximum(abs(w[:, :, 2]), 0.01 * length), w[:, :, 2])
    return (w / numpy.linalg.norm(w, axis=2)[:, :, None]).astype(numpy.float32)


def differences_of_f(pairs):
    wo, wi = random_pairs(pairs)
    rows = []
    for specimen in ("soybean", "maize"):
        for incident in ("traced", "light", "reciprocal"):
            bsdf = mi.load_dict({"type": "frond_leaf", "specimen": specimen, "incident": incident})
            si = dr.zeros(mi.SurfaceInteraction3f, pairs)
            si.wi = mi.Vector3f(wo.T)
            found = numpy.array(bsdf.eval(mi.BSDFContext(), si, mi.Vector3f(wi.T))).T / abs(wi[:, 2:])
            ours = frond.bsdf(f"leaf_solved,specimen={specimen},incident={incident}", RGB_NM).f(wo, wi)
            difference = numpy.pi * (found - ours)
            rows.append([specimen, f"`{incident}`", f"{rms(difference):.1e}", f"{abs(difference).max():.1e}"])
    return table(["leaf", "`incident`", "RMS", "largest"], rows)


def differences_of_shares(count):
    """R and T estimated from samples less R and T integrated by frond, and the standard errors."""
    bsdf = mi.load_dict({"type": "frond_leaf"})
    found, errors = [], []
    angles = ANGLES + [180 - a for a in ANGLES]
    ours = frond.goniophotometer("leaf_solved", RGB_NM, angles, patches=(60, 60), integrate=True)
    for a, theta_deg in enumerate(angles):
        theta = numpy.radians(theta_deg)
        si = dr.zeros(mi.SurfaceInteraction3f, count)
        si.wi = mi.Vector3f(float(numpy.sin(theta)), 0, float(numpy.cos(theta)))
        random = mi.PCG32(count, initstate=a)
        bs, weight = bsdf.sample(mi.BSDFContext(), si, random.next_float32(),
                                 mi.Point2f(random.next_float32(), random.next_float32()))
        weight, reflects = numpy.array(weight), numpy.array(bs.wo.z) * numpy.cos(theta) > 0
        lit = (ours["theta_o_deg"] < 90) == (theta_deg < 90)
        for lane in range(3):
            share = ours["f"][a, lane] * ours["projected_solid_angle_sr"]
            for side, mask in ((lit, reflects), (~lit, ~reflects)):
                values = (weight[lane] * mask).astype(numpy.float64)
                found.append(values.mean() - share[side].sum())
                errors.append(values.std() / numpy.sqrt(count))
    return numpy.array(found), numpy.array(errors)


def images(image, samples):
    rows, shown = [], []
    solved = {"type": "frond_leaf", "incident": "reciprocal"}, {"leaf": "leaf_solved,incident=reciprocal"}
    for name, (leaf, swap) in (("front", solved), ("ambient", solved), ("front", (None, None)), ("ambient", (None, None))):
        scene = scenes.SCENES[name](FOLDER)
        scenes.write_pbrt(scene, FOLDER / f"{name}.pbrt", "leaf", True, SIZE)
        scenes.write_json(scene, FOLDER / f"{name}.json", "leaf", SIZE)
        document = json.loads((FOLDER / f"{name}.json").read_text())
        theirs = mitsuba_worker.load(document, leaf)
        sensor = next(s for s in theirs.sensors() if s.id() == "box")
        in_mitsuba = [numpy.array(mi.render(theirs, sensor=sensor, spp=samples, seed=seed))[:, :, :3] for seed in (1, 2)]
        loaded = [frond.load(FOLDER / f"{name}.pbrt", swap=swap, wavelengths="smpte", seed=seed) for seed in (1, 2)]
        in_frond = [scene.render(samples).rgb for scene in loaded]
        for lane, color in enumerate(("red", "green", "blue")):
            means, errors = [], []
            for pair in (in_mitsuba, in_frond):
                a, b = (p[:, :, lane].astype(numpy.float64) for p in pair)
                means.append(((a + b) / 2).mean())
                # Pixels are independent; the difference of the two renders estimates each pixel's variance.
                errors.append(numpy.sqrt(((a - b) ** 2 / 4).sum()) / a.size)
            error = numpy.hypot(*errors)
            if lane == 1 or leaf:  # the diffuse leaves are grey
                rows.append([name, color if leaf else "diffuse", f"{means[0]:.6f}", f"{means[1]:.6f}", f"{means[0] - means[1]:+.6f} ± {error:.6f}"])
        if leaf:
            shown.append([sum(pair) / 2 for pair in (in_mitsuba, in_frond)])
    image.parent.mkdir(parents=True, exist_ok=True)
    sheet = numpy.concatenate([numpy.concatenate(row, axis=1) for row in shown], axis=0)
    mi.Bitmap(sheet).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.UInt8, srgb_gamma=True).write(str(image))
    return table(["scene", "", "Mitsuba", "frond", "difference"], rows)


def costs(rounds, size, samples):
    def scene(bsdf):
        to_world = mi.ScalarTransform4f()
        film = {"type": "hdrfilm", "width": size, "height": size, "rfilter": {"type": "box"}}
        sensor = {"type": "orthographic", "to_world": to_world.look_at([0, 0, 3], [0, 0, 0], [0, 1, 0]), "film": film}
        return mi.load_dict({"type": "scene", "integrator": {"type": "path", "max_depth": 2}, "sensor": sensor,
                             "sky": {"type": "constant"}, "leaf": {"type": "rectangle", "to_world": to_world.scale(2), "bsdf": bsdf}})

    text = """Camera "orthographic" "float screenwindow" [ -1 1 -1 1 ]
Film "rgb" "integer xresolution" {0} "integer yresolution" {0}
PixelFilter "box"
Integrator "path" "integer maxdepth" 1
WorldBegin
LightSource "infinite" "spectrum L" "stdillum-D65"
MakeNamedMaterial "leaf" "string type" "{1}"
NamedMaterial "leaf"
Shape "bilinearmesh" "point3 P" [ -2 -2 1  2 -2 1  -2 2 1  2 2 1 ]
"""
    kinds = [("diffuse", {"type": "diffuse"}, "diffuse"),
             ("leaf, traced", {"type": "frond_leaf"}, "leaf_solved"),
             ("leaf, reciprocal", {"type": "frond_leaf", "incident": "reciprocal"}, 'leaf_solved" "string incident" "reciprocal'),
             ("leaf, over depth", {"type": "frond_leaf", "differentiable": True}, None)]
    rows = []
    for label, theirs, ours in kinds:
        loaded = scene(theirs)
        times = []
        for seed in range(rounds + 1):  # the first render compiles
            start = time.process_time()
            numpy.array(mi.render(loaded, spp=samples, seed=seed))
            times.append(time.process_time() - start)
        paths = size * size * samples
        cells = [label, f"{1e6 * numpy.median(times[1:]) / paths:.2f} µs"]
        if ours:
            of_ours = frond.loads(text.format(size, ours), wavelengths="smpte")
            seconds = [of_ours.render(samples).statistics["cpu_seconds"] for _ in range(rounds)]
            cells.append(f"{1e6 * numpy.median(seconds) / paths:.2f} µs")
        rows.append(cells + [""] * (3 - len(cells)))
    return table(["", "Mitsuba", "frond"], rows)


def main():
    options = arguments("mitsuba")
    pairs, count, samples = (2000, 10_000, 4) if options.quick else (200_000, 1_000_000, SAMPLES)
    rounds, size, of_pixel = (2, 64, 4) if options.quick else (5, 512, 64)
    FOLDER.mkdir(parents=True, exist_ok=True)
    mi.set_log_level(mi.LogLevel.Error)
    f_table = differences_of_f(pairs)
    print(f_table)
    found, errors = differences_of_shares(count)
    figures = {"share_rms": rms(found), "share_error": rms(errors), "share_z": abs(found / errors).max(), "shares": len(found)}
    print(figures)
    image_table = images(options.docs / "images" / "mitsuba" / "hundred-leaves.png", samples)
    print(image_table)
    cost_table = costs(rounds, size, of_pixel)
    print(cost_table)
    write_section(options.docs / "other_renderers.md", "mitsuba", SECTION.format(
        machine=machine(), version=mi.__version__, frond_version=frond.__version__, pairs=pairs, f_table=f_table,
        rgb=", ".join(map(str, RGB_NM)), size=SIZE, samples=2 * samples, image_table=image_table, rounds=rounds,
        cost_table=cost_table, **figures))


if __name__ == "__main__":
    main()
