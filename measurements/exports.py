"""Exports: errors of the files, as read by the programs that they are for (section "exports" of docs/other_renderers.md)

Radiance, Cycles and numpy read the files by the runners of the leaf benchmark, whose environment this measurement shares.
  --quick   fewer rays and samples, into build/exports_report
"""

import pathlib
import tempfile
import types

import numpy
import pandas
from scipy.interpolate import RegularGridInterpolator

from leaf_benchmark import measures
from leaf_benchmark.programs import cycles, frond as by_frond, interface, radiance

from .shared.tools import arguments, machine, program, table, write_section

LEAF = "leaf_solved"
STEP = 5  # degrees between the directions that are compared
STEEP = 60  # degrees from the normal; beyond this angle f rises toward grazing
TASK = types.SimpleNamespace(kind="leaf", wavelengths_nm=[608, 551, 455], light_theta=[8, 45, 70],
                             theta=[STEP * (i + 0.5) for i in range(180 // STEP)], phi=[STEP * (i + 0.5) for i in range(360 // STEP)])
NM = ",".join(map(str, TASK.wavelengths_nm))


def by_radiance(samples):
    klems = [by_frond.exported(f"{nm}.xml", "--format", "radiance", "--wavelengths", nm) for nm in TASK.wavelengths_nm]
    return radiance.table(lambda _: [radiance.primitive("BSDF", "leaf", words=[0, path, 0, 1, 0, "."]) for path in klems])(TASK, samples, 1)[0]


def by_cycles(samples):
    return cycles.table(lambda _: cycles.script(by_frond.exported("leaf.osl", "--format", "osl", "--wavelengths", NM)))(TASK, samples, 1)[0]


def by_interpolation(path):
    """The default table, with linear interpolation between nodes and constant extrapolation."""
    between, of_angle = {}, {}
    for (name, nm, side), rows in pandas.read_csv(path, comment="#").groupby(["quantity", "wavelength_nm", "side"]):
        key = (name, nm, side == "front")
        if name in "RT":
            of_angle[key] = rows.theta_i_deg.to_numpy(float), rows.value.to_numpy(float)
            continue
        rows = rows.assign(phi_o_deg=rows.phi_o_deg % 360)
        rows = pandas.concat([rows, rows[rows.phi_o_deg == 0].assign(phi_o_deg=360)])
        grid = rows.drop_duplicates(axes := ["theta_i_deg", "theta_o_deg", "phi_o_deg"]).set_index(axes).value.sort_index()
        ticks = [level.to_numpy(float) for level in grid.index.levels]
        between[key] = RegularGridInterpolator(ticks, grid.to_numpy().reshape([len(t) for t in ticks]))
    theta, phi = interface.views(TASK)
    normal = lambda angle: numpy.minimum(angle, 180 - numpy.asarray(angle))

    def f(light):
        values = []
        for nm in TASK.wavelengths_nm:
            of = [between[name, nm, light < 90] for name in ("f_r", "f_t")]
            last = of[0].grid[0][-1]
            at = numpy.stack(numpy.broadcast_arrays(min(normal(light), last), numpy.minimum(normal(theta), last), phi), axis=-1)
            values.append(numpy.where((theta < 90) == (light < 90), of[0](at), of[1](at)))
        return numpy.stack(values, axis=-1)

    shares = {name: [[numpy.interp(normal(angle), *of_angle[name, nm, angle < 90]) for nm in TASK.wavelengths_nm] for angle in TASK.theta]
              for name in "RT"}
    return interface.rows_of(TASK, f, shares)


def comparison(found, true):
    """A table with a row for each light, and a sentence with the largest errors."""
    found = measures.frame(found)
    ours, right = (rows[rows.quantity == "f"].reset_index(drop=True) for rows in (found, true))
    off, weight = numpy.pi * (measures.colors(ours) - measures.colors(right)), abs(numpy.sin(2 * numpy.radians(right.theta)))
    reflected, near = (right.light < 90) == (right.theta < 90), numpy.minimum(right.theta, 180 - right.theta) < STEEP
    rms = lambda where: numpy.sqrt(numpy.average(off[where]**2, axis=0, weights=weight[where]))
    body, steep = [], 0
    for light in interface.lights(TASK):
        sides = [(right.light == light) & (reflected == seen) for seen in (True, False)]
        each = [rms(side) for side in sides]
        steep = max(steep, *(rms(side & near).max() for side in sides))
        for i, nm in enumerate(TASK.wavelengths_nm):
            body.append([nm, "front" if light < 90 else "back", f"{min(light, 180 - light)}°", *(f"{values[i]:.4f}" for values in each)])
    shares = {name: abs(measures.colors(measures.ours_of(found, name)) - measures.colors(measures.ours_of(true, name))) for name in "RT"}
    inside = [STEEP <= min(angle, 180 - angle) for angle in TASK.theta]
    largest = ", ".join(f"{name} {values.max():.4f} ({values[~numpy.array(inside)].max():.4f})" for name, values in shares.items())
    text = table(["nm", "side", "angle", "RMS π Δf, reflected", "transmitted"], body)
    return (f"{text}\nLargest errors of R and T by angle, and up to {STEEP}° from the normal: {largest}. Largest RMS of π Δf for views up to "
            f"{STEEP}°: {steep:.4f}.\n")


SECTION = """### Errors of exported files

Measured by `measurements/run exports` on {machine}; Radiance {radiance}, Blender {blender}.

The material is the reciprocal `{leaf}` (soybean), evaluated by frond in directions {step}° apart. "RMS π Δf" is the RMS difference of
π f, for light at the angle, over these directions on a side, weighted by projected solid angle. For a white Lambertian reflector,
π f is 1.

#### Errors of Klems patches

As Radiance shows them: f under parallel light, R and T under half a sky ({samples} rays each). A patch has one value; R and T are those of
the patch that contains the angle.

{klems}
Radiance's `checkBSDF` reports on the file with colour, which `wrapBSDF` reads as well (`tests/exports/readers_test.py`):

```
{report}
```

#### Errors of tables

The values at the nodes are frond's own. The errors below are those of the default table ({megabytes:.1f} MB of CSV for three
wavelengths), read with linear interpolation in θi, θo and φo. Beyond the last angle its values are used.

{values}
#### Errors of the OSL shader

As Cycles shows it: f under parallel light, R and T under half a sky. In a sky of radiance 1 on all sides (a furnace), the radiance differs
from R + T by up to {furnace:.4f}.

{cycles}"""


def main():
    options = arguments("exports")
    rays, samples, of_radiance = (64, 64, 4) if options.quick else (1024, 1024, 64)
    true = measures.frame(by_frond.table(f"{LEAF},incident=reciprocal")(TASK, rays, 1)[0])
    osl = measures.frame(by_cycles(samples))
    furnace = numpy.array([measures.colors(measures.ours_of(osl, name)) for name in "STR"])
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder, "t.csv")
        program("export", LEAF, "--format", "csv", "--wavelengths", ",".join(map(str, sorted(TASK.wavelengths_nm))), "-o", path, "-q")
        values, megabytes = comparison(by_interpolation(path), true), path.stat().st_size / 1e6
        program("export", LEAF, "--format", "radiance", "-o", pathlib.Path(folder, "leaf.xml"), "-q")
        report = radiance.run(folder, "checkBSDF", "leaf.xml").decode()
    write_section(options.docs / "other_renderers.md", "exports", SECTION.format(
        machine=machine(), radiance=radiance.version(), blender=cycles.bpy.app.version_string, leaf=LEAF, step=STEP, samples=of_radiance,
        klems=comparison(by_radiance(of_radiance), true), report=report[report.index("Type:"):].strip(), megabytes=megabytes, values=values,
        furnace=abs(furnace[0] - furnace[1] - furnace[2]).max(), cycles=comparison(osl.itertuples(index=False), true)))


if __name__ == "__main__":
    main()
