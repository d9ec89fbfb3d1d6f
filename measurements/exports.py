"""Exports: errors of the files, as read by the programs that they are for (section "exports" of docs/other_renderers.md)

Installs Radiance (pyradiance) and Blender (bpy, 370 MB) into build/exports by pip; if one cannot be installed, the section states
it and omits its measurements.
  --quick   fewer rays and samples, into build/exports_report
"""

import json
import os
import pathlib
import subprocess
import tempfile

import numpy
import pandas
from scipy.interpolate import RegularGridInterpolator

import frond

from .shared.tools import ROOT, arguments, machine, program, run, table, write_section

PYTHON = ROOT / "build" / "exports" / "bin" / "python"
LEAF = "leaf_solved"
ANGLES = (8, 45, 70)
NM = (608, 551, 455)  # red, green and blue of the OSL shader
STEP = 5  # degrees between the directions that are compared
STEEP = 60  # degrees from the normal; beyond this angle f rises toward grazing
LIGHTS = [(nm, front, angle) for nm in NM for front in (True, False) for angle in ANGLES]

# LBNL/Klems Full: limits of the rings in degrees, and the number of patches in each ring.
RING_ENDS = numpy.array([0, 5, 15, 25, 35, 45, 55, 65, 75, 90])
RING_PATCHES = numpy.array([1, 8, 16, 20, 24, 24, 24, 16, 12])
# Chromaticities of the primaries and the white of Radiance's colours (color.h) and of sRGB.
RADIANCE_PRIMARIES = ((0.640, 0.330), (0.290, 0.600), (0.150, 0.060), (1 / 3, 1 / 3))
SRGB_PRIMARIES = ((0.64, 0.33), (0.30, 0.60), (0.15, 0.06), (0.3127, 0.3290))


class Reference:
    """The leaf's f from the goniophotometer (means over 5 x 5 degrees); R and T from the spectrophotometer."""

    def __init__(self, rays):
        material, angles = f"{LEAF},incident=reciprocal", [*ANGLES, *(180 - a for a in ANGLES)]
        self.found = frond.goniophotometer(material, NM, angles, patches=(180 // STEP, 360 // STEP), integrate=True)
        shares = frond.spectrophotometer(material, NM, angles, rays=int(float(rays)))
        self.error = shares[["R_se", "T_se"]].to_numpy().max()
        self.of_angle = shares.set_index(["wavelength_nm", "theta_deg"])

    def shares(self, light):
        nm, front, angle = light
        return self.of_angle.loc[(nm, angle if front else 180 - angle), ["R", "T"]].to_numpy(float)

    def rms(self, light, of, most=90):
        """RMS of pi times the error of f, weighted by projected solid angle, over views up to an angle: reflected, transmitted."""
        nm, front, angle = light
        f = self.found["f"][list(self.found["theta_i_deg"]).index(angle if front else 180 - angle), NM.index(nm)]
        theta, phi, weight = (self.found[name] for name in ("theta_o_deg", "phi_o_deg", "projected_solid_angle_sr"))
        from_normal = numpy.minimum(theta, 180 - theta)
        result = []
        for reflected in (True, False):
            seen = (((theta < 90) == front) == reflected) & (from_normal <= most)
            off = numpy.pi * (of.f(light, reflected, from_normal[seen], phi[seen]) - f[seen])
            result.append(numpy.sqrt(numpy.average(off**2, weights=weight[seen])))
        return result


class Klems:
    """A file for each wavelength, read as Radiance reads it: the value of the pair of patches that contain the two directions."""

    def __init__(self, folder):
        self.values = {}
        for nm in NM:
            path = folder / f"{nm}.xml"
            program("export", LEAF, "--format", "radiance", "--wavelengths", nm, "-o", path, "-q")
            for block in path.read_text().split("<WavelengthDataDirection>")[1:]:
                kind, side = block.split("<", 1)[0].split()
                data = block.split("<ScatteringData>")[1].split("<")[0].replace(",", " ").split()
                # The file's back is the surface's front.
                self.values[nm, side == "Back", kind == "Reflection"] = numpy.array(data, float).reshape(145, 145)

    @staticmethod
    def patch(theta, phi):
        ring = numpy.searchsorted(RING_ENDS[1:], theta, side="right")
        phis = RING_PATCHES[ring]
        return numpy.cumsum([0, *RING_PATCHES])[ring] + numpy.rint(phi / 360 * phis).astype(int) % phis

    def of_light(self, light, reflected):
        # The light's azimuth is opposite to that of its patch.
        return self.values[light[0], light[1], reflected][:, self.patch(light[2], 180)]

    def f(self, light, reflected, theta, phi):
        return self.of_light(light, reflected)[self.patch(theta, phi)]

    def shares(self, light):
        ring = -numpy.pi * numpy.diff(numpy.cos(numpy.radians(RING_ENDS))**2)
        projected = numpy.repeat(ring / RING_PATCHES, RING_PATCHES)
        return [projected @ self.of_light(light, reflected) for reflected in (True, False)]


class Table:
    """The default table, with linear interpolation between nodes and constant extrapolation."""

    def __init__(self, folder):
        path = folder / "t.csv"
        program("export", LEAF, "--format", "csv", "--wavelengths", ",".join(map(str, sorted(NM))), "-o", path, "-q")
        self.bytes, self.between, self.of_angle = path.stat().st_size, {}, {}
        for (name, nm, side), rows in pandas.read_csv(path, comment="#").groupby(["quantity", "wavelength_nm", "side"]):
            key = (name, nm, side == "front")
            if name in "RT":
                self.of_angle[key] = rows.theta_i_deg.to_numpy(float), rows.value.to_numpy(float)
                continue
            rows = rows.assign(phi_o_deg=rows.phi_o_deg % 360)
            rows = pandas.concat([rows, rows[rows.phi_o_deg == 0].assign(phi_o_deg=360)])
            grid = rows.drop_duplicates(axes := ["theta_i_deg", "theta_o_deg", "phi_o_deg"]).set_index(axes).value.sort_index()
            ticks = [level.to_numpy(float) for level in grid.index.levels]
            self.between[key] = RegularGridInterpolator(ticks, grid.to_numpy().reshape([len(t) for t in ticks]))

    def f(self, light, reflected, theta, phi):
        between = self.between["f_r" if reflected else "f_t", light[0], light[1]]
        inside = lambda angle: numpy.clip(angle, 0, between.grid[0][-1])
        return between(numpy.stack(numpy.broadcast_arrays(inside(light[2]), inside(theta), phi), axis=-1))

    def shares(self, light):
        return [numpy.interp(light[2], *self.of_angle[name, light[0], light[1]]) for name in "RT"]


class Cycles:
    """The shader, rendered by Cycles of Blender."""

    def __init__(self, folder, rays, samples):
        shader = folder / "leaf.osl"
        program("export", LEAF, "--format", "osl", "--wavelengths", ",".join(map(str, NM)), "--rays", rays, "-o", shader, "-q")
        sides = [(front, angle) for front in (True, False) for angle in ANGLES]
        views = [(front, angle, seen) for front, angle in sides for seen in (True, False)]
        questions = [{"shares": [angle, front], "samples": samples} for front, angle in sides]
        questions += [{"f": [angle, front, seen], "step": STEP} for front, angle, seen in views]
        run(PYTHON, ROOT / "tests" / "exports" / "osl_render.py", shader, folder / "answers.json", input=json.dumps(questions))
        answers = json.loads((folder / "answers.json").read_text())
        self.of_light, self.values = dict(zip(sides, answers)), {}
        for (front, angle, seen), found in zip(views, answers[len(sides):]):
            colors = numpy.full((90 // STEP, 360 // STEP, 3), numpy.nan)
            for theta, phi, color in found:
                colors[self.index(theta, phi)] = color
            self.values[front, angle, seen == front] = colors
        self.version = run(PYTHON, "-c", "import bpy; print(bpy.app.version_string)").split()[-1]

    @staticmethod
    def index(theta, phi):
        """Array indices of the patches with these centres."""
        return numpy.asarray(theta // STEP, int), numpy.asarray(numpy.rint(phi) % 360 // STEP, int)

    def f(self, light, reflected, theta, phi):
        return self.values[light[1], light[2], reflected][self.index(theta, phi)][..., NM.index(light[0])]

    def of(self, light, name):
        return self.of_light[light[1:]][name][NM.index(light[0])]

    def shares(self, light):
        return [self.of(light, name) for name in "RT"]


def comparison(reference, of):
    """A table with a row for each light, and a sentence with the largest errors."""
    body, errors = [], []
    for light in LIGHTS:
        shares, true = of.shares(light), reference.shares(light)
        found = reference.rms(light, of)
        errors.append([*abs(numpy.subtract(shares, true)), *found, max(reference.rms(light, of, STEEP))])
        numbers = [true[0], shares[0], true[1], shares[1], *found]
        body.append([light[0], "front" if light[1] else "back", f"{light[2]}°", *(f"{x:.4f}" for x in numbers)])
    text = table(["nm", "side", "angle", "R", "R of the export", "T", "T of the export", "RMS π Δf, reflected", "transmitted"], body)
    r, t, reflected, transmitted, steep = numpy.max(errors, axis=0)
    return text, (f"Largest errors: R {r:.4f}, T {t:.4f}; RMS of π Δf {reflected:.4f} reflected, {transmitted:.4f} transmitted, "
                  f"{steep:.4f} for views up to {STEEP}° from the normal.\n")


def xyz_over_white(primaries, rgb):
    """X, Y and Z relative to those of (1, 1, 1), in the colour space with these primaries and white."""
    *columns, white = ((x / y, 1, (1 - x - y) / y) for x, y in primaries)
    matrix = numpy.transpose(columns)
    return rgb * numpy.linalg.solve(matrix, white) @ matrix.T / white


class Scene:
    """A leaf that fills the image, under parallel light, rendered by rtrace and by frond."""

    SIZE, FOV, LIGHT, VIEW = 48, 40, 40, 30  # pixels; degrees; LIGHT and VIEW from the normal, in opposite azimuths
    TIMES = 32  # number of times that rtrace traces each ray, because its estimate for one ray is random

    def __init__(self, folder, material, samples):
        self.folder, self.material = folder, material
        home = pathlib.Path(run(PYTHON, "-c", "import pyradiance; print(pyradiance.__path__[0])").strip())
        self.environment = dict(os.environ, RAYPATH=f".:{home / 'lib'}", PATH=f"{home / 'bin'}:{os.environ['PATH']}")
        program("export", ",".join(material), "--format", "radiance", "-o", folder / "leaf.xml", "-q")
        self.report = self.radiance("checkBSDF", "leaf.xml")
        self.samples = samples

    def radiance(self, *words, **more):
        return run(*words, cwd=self.folder, env=self.environment, **more)

    @staticmethod
    def direction(theta_deg, front):
        theta = numpy.radians(theta_deg)
        return numpy.array([numpy.sin(theta), 0, numpy.cos(theta) * (1 if front else -1)])

    def by_radiance(self, lit_in_front, seen_in_front):
        half = 0.2
        radiance = 1 / (2 * numpy.pi * (1 - numpy.cos(numpy.radians(half))))
        toward = " ".join(map(str, self.direction(self.LIGHT, lit_in_front)))
        (self.folder / "scene.rad").write_text(
            f"void light sun\n0\n0\n3 {radiance} {radiance} {radiance}\nsun source s\n0\n0\n4 {toward} {2 * half}\n"
            "void BSDF leaf\n6 0 leaf.xml 0 1 0 .\n0\n0\nleaf polygon p\n0\n0\n12 -90 -90 0  90 -90 0  90 90 0  -90 90 0\n")
        (self.folder / "scene.oct").write_bytes(self.radiance("oconv", "scene.rad", text=False))
        back = self.direction(-self.VIEW, seen_in_front)
        right, up = numpy.array([0, 1, 0]), numpy.array([-back[2], 0, back[0]])
        across = (2 * (numpy.arange(self.SIZE) + 0.5) / self.SIZE - 1) * numpy.tan(numpy.radians(self.FOV / 2))
        toward = -back + across[None, :, None] * right + across[:, None, None] * up
        rays = numpy.concatenate([numpy.broadcast_to(3 * back, toward.shape), toward], axis=2).reshape(-1, 6)
        lines = "".join(" ".join(map(str, ray)) + "\n" for ray in rays.tolist()) * self.TIMES
        found = self.radiance("rtrace", "-h", "-ab", 0, "-dj", 0, "-lw", 1e-6, "scene.oct", input=lines)
        return xyz_over_white(RADIANCE_PRIMARIES, numpy.array(found.split(), float).reshape(self.TIMES, -1, 3).mean(axis=0))

    def by_frond(self, lit_in_front, seen_in_front):
        words = lambda v: " ".join(map(str, v))
        scene = frond.loads(f"""LookAt {words(3 * self.direction(-self.VIEW, seen_in_front))}  0 0 0  1 0 0
Camera "perspective" "float fov" {self.FOV}
Film "rgb" "integer xresolution" {self.SIZE} "integer yresolution" {self.SIZE}
PixelFilter "box"
WorldBegin
LightSource "distant" "point3 from" [{words(self.direction(self.LIGHT, lit_in_front))}] "point3 to" [0 0 0] "spectrum L" "stdillum-D65"
Material "{self.material[0]}" {"" if len(self.material) == 1 else '"string incident" "reciprocal"'}
Shape "trianglemesh" "point3 P" [-90 -90 0  90 -90 0  90 90 0  -90 90 0] "integer indices" [0 1 2  0 2 3]
""")
        return xyz_over_white(SRGB_PRIMARIES, scene.render(self.samples).rgb.reshape(-1, 3).astype(float))

    def comparison(self):
        """A table, and the largest differences of the means of X, Y and Z in per cent."""
        body, worst = [], []
        ends = lambda xyz: "{:.4f} to {:.4f}".format(*numpy.sort(xyz[:, 1])[[len(xyz) // 20, -1 - len(xyz) // 20]])
        for lit in (True, False):
            for seen in (True, False):
                theirs, ours = self.by_radiance(lit, seen), self.by_frond(lit, seen)
                assert theirs.shape == ours.shape
                means = numpy.stack([ours.mean(axis=0), theirs.mean(axis=0)], axis=1)
                worst.append(100 * abs(means[:, 1] / means[:, 0] - 1))
                body.append(["front" if lit else "back", "front" if seen else "back",
                             *("{:.4f}, {:.4f}".format(*pair) for pair in means), ends(ours), ends(theirs)])
        return table(["lit", "seen", "X", "Y", "Z", "Y of 90 % of the pixels, frond", "Radiance"], body), numpy.max(worst, axis=0)


def has(module):
    return PYTHON.exists() and subprocess.run([PYTHON, "-c", f"import {module}"], capture_output=True, check=False).returncode == 0


SECTION = """### Errors of exported files

Measured by `measurements/run exports` on {machine}.

The material is the reciprocal `{leaf}` (soybean). R and T are compared with `frond spectrophotometer --rays {rays}` (standard
errors up to {se:.5f}). f is compared with `frond goniophotometer --integrate` with patches of {step}° by {step}°: "RMS π Δf" is the RMS
difference of π f over all directions of a side, weighted by projected solid angle. For a white Lambertian reflector, π f is 1.

#### Errors of Klems patches

R and T of an export are those of the patch that contains the angle of incidence, with light from the whole patch. 8° is in the
ring from 5 to 15°, 70° in the ring from 65 to 75°, and 45° is the lower edge of the ring from 45 to 55°.

{klems}
{radiance}
#### Errors of tables

The values at the nodes are frond's own. The errors below are those of the default table ({megabytes:.1f} MB of CSV for three
wavelengths), read with linear interpolation in θi, θo and φo. Beyond the last angle its values are used.

{values}
#### Errors of the OSL shader

{cycles}"""

RADIANCE = """Radiance's `checkBSDF` reports on the file with colour, which `wrapBSDF` reads as well (`tests/exports/readers_test.py`):

```
{report}
```

**The same scene in both renderers.** A leaf fills an image of {size} × {size} pixels. Parallel D65 light of irradiance 1 arrives at
{light}° from the normal; a perspective camera with a field of view of {fov}° is at {view}° from the normal, in the opposite azimuth.
The table has X, Y and Z relative to those of white, as means over the image: first `frond render` ({spp} samples per
pixel), then Radiance (`rtrace -ab 0`, {times} rays per pixel). The means of Y differ by up to {y:.1f} %, those of X and Z by up to
{xyz:.1f} %. With `diffusetransmission` in place of the leaf, whose f the patches represent exactly, they differ by up to
{diffuse_y:.1f} and {diffuse_xyz:.1f} %.

{images}"""

CYCLES = """Rendered by Cycles of Blender {version}. R and T are the leaf's radiance under a hemisphere of radiance 1 ({paths}
paths), f is its radiance under parallel light. Under a full sphere of radiance 1 (a furnace), R + T is off by up to {furnace:.4f}.

{body}
{errors}"""


def radiance_text(folder, spp):
    if not has("pyradiance"):
        return "Radiance (pyradiance) could not be installed: no image was rendered.\n"
    scene = Scene(folder, (LEAF, "incident=reciprocal"), spp)
    images, worst = scene.comparison()
    _, diffuse = Scene(folder, ("diffusetransmission",), spp).comparison()
    return RADIANCE.format(report=scene.report[scene.report.index("Type:"):].strip(), size=Scene.SIZE, light=Scene.LIGHT,
                           fov=Scene.FOV, view=Scene.VIEW, spp=spp, times=Scene.TIMES, y=worst[1], xyz=max(worst),
                           diffuse_y=diffuse[1], diffuse_xyz=max(diffuse), images=images)


def cycles_text(folder, reference, rays, samples):
    if not has("bpy"):
        return "Blender (bpy) could not be installed: the shader was not rendered.\n"
    cycles = Cycles(folder, rays, samples)
    body, errors = comparison(reference, cycles)
    furnace = max(abs(cycles.of(light, "furnace") - sum(reference.shares(light))) for light in LIGHTS)
    return CYCLES.format(version=cycles.version, paths=64 * samples, furnace=furnace, body=body, errors=errors)


def main():
    options = arguments("exports")
    rays, samples, spp = ("1e4", 64, 64) if options.quick else ("1e6", 4096, 1024)
    reference = Reference(rays)
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        values = Table(folder)
        text = SECTION.format(
            machine=machine(), leaf=LEAF, rays=rays, step=STEP, se=reference.error, megabytes=values.bytes / 1e6,
            klems="\n".join(comparison(reference, Klems(folder))), radiance=radiance_text(folder, spp),
            values="\n".join(comparison(reference, values)), cycles=cycles_text(folder, reference, rays, samples))
    write_section(options.docs / "other_renderers.md", "exports", text)


if __name__ == "__main__":
    main()
