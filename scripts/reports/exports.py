"""What the formats of frond export keep of a leaf, read by the programs that they are for: docs/exports.md."""

import json
import os
import pathlib
import subprocess
import tempfile

import numpy
import pandas
from scipy.interpolate import RegularGridInterpolator

import frond
from tools import ROOT, arguments, machine, program, run, table, write

PYTHON = ROOT / "build" / "exports" / "bin" / "python"
LEAF = "leaf_solved"
ANGLES = (8, 45, 70)
NM = (608, 551, 455)  # red, green and blue of the OSL shader
STEP = 5  # degrees between the directions that are compared
STEEP = 60  # degrees from the normal: beyond, f rises toward grazing
LIGHTS = [(nm, front, angle) for nm in NM for front in (True, False) for angle in ANGLES]

# LBNL/Klems Full: where rings begin and end, and how many patches each has.
RING_ENDS = numpy.array([0, 5, 15, 25, 35, 45, 55, 65, 75, 90])
RING_PATCHES = numpy.array([1, 8, 16, 20, 24, 24, 24, 16, 12])
# Primaries and white of Radiance's colours (color.h), of sRGB.
RADIANCE_PRIMARIES = ((0.640, 0.330), (0.290, 0.600), (0.150, 0.060), (1 / 3, 1 / 3))
SRGB_PRIMARIES = ((0.64, 0.33), (0.30, 0.60), (0.15, 0.06), (0.3127, 0.3290))


class Reference:
    """f of the leaf by the goniophotometer, mean over 5 x 5 degrees, R and T by the spectrophotometer."""

    def __init__(self, rays):
        material, angles = f"{LEAF} incident=reciprocal", [*ANGLES, *(180 - a for a in ANGLES)]
        self.found = frond.goniophotometer(material, NM, angles, patches=(180 // STEP, 360 // STEP), integrate=True)
        shares = frond.spectrophotometer(material, NM, angles, rays=int(float(rays)))
        self.error = shares[["R_se", "T_se"]].to_numpy().max()
        self.of_angle = shares.set_index(["wavelength_nm", "theta_deg"])

    def shares(self, light):
        nm, front, angle = light
        return self.of_angle.loc[(nm, angle if front else 180 - angle), ["R", "T"]].to_numpy(float)

    def rms(self, light, of, most=90):
        """Of pi times the difference, by projected solid angle, over views up to an angle: reflected and transmitted."""
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
    """A file of one wavelength each, read as Radiance does: the value of the pair of patches that two directions lie in."""

    def __init__(self, folder):
        self.values = {}
        for nm in NM:
            path = folder / f"{nm}.xml"
            program("export", LEAF, "--format", "radiance", "--wavelengths", nm, "-o", path, "-q")
            for block in path.read_text().split("<WavelengthDataDirection>")[1:]:
                kind, side = block.split("<", 1)[0].split()
                data = block.split("<ScatteringData>")[1].split("<")[0].replace(",", " ").split()
                # The back of the file is the front of the surface.
                self.values[nm, side == "Back", kind == "Reflection"] = numpy.array(data, float).reshape(145, 145)

    @staticmethod
    def patch(theta, phi):
        ring = numpy.searchsorted(RING_ENDS[1:], theta, side="right")
        phis = RING_PATCHES[ring]
        return numpy.cumsum([0, *RING_PATCHES])[ring] + numpy.rint(phi / 360 * phis).astype(int) % phis

    def of_light(self, light, reflected):
        # Light comes from the other side of the axis than its patch's own direction.
        return self.values[light[0], light[1], reflected][:, self.patch(light[2], 180)]

    def f(self, light, reflected, theta, phi):
        return self.of_light(light, reflected)[self.patch(theta, phi)]

    def shares(self, light):
        ring = -numpy.pi * numpy.diff(numpy.cos(numpy.radians(RING_ENDS))**2)
        projected = numpy.repeat(ring / RING_PATCHES, RING_PATCHES)
        return [projected @ self.of_light(light, reflected) for reflected in (True, False)]


class Table:
    """The default table, linear between its numbers and constant beyond them."""

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
    """The shader, rendered by Blender's Cycles."""

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
                colors[self.place(theta, phi)] = color
            self.values[front, angle, seen == front] = colors
        self.version = run(PYTHON, "-c", "import bpy; print(bpy.app.version_string)").split()[-1]

    @staticmethod
    def place(theta, phi):
        """In the array: middles of the patches."""
        return numpy.asarray(theta // STEP, int), numpy.asarray(numpy.rint(phi) % 360 // STEP, int)

    def f(self, light, reflected, theta, phi):
        return self.values[light[1], light[2], reflected][self.place(theta, phi)][..., NM.index(light[0])]

    def of(self, light, name):
        return self.of_light[light[1:]][name][NM.index(light[0])]

    def shares(self, light):
        return [self.of(light, name) for name in "RT"]


def comparison(reference, of):
    """A row for each light; and the largest errors."""
    body, errors = [], []
    for light in LIGHTS:
        shares, true = of.shares(light), reference.shares(light)
        found = reference.rms(light, of)
        errors.append([*abs(numpy.subtract(shares, true)), *found, max(reference.rms(light, of, STEEP))])
        numbers = [true[0], shares[0], true[1], shares[1], *found]
        body.append([light[0], "front" if light[1] else "back", f"{light[2]}°", *(f"{x:.4f}" for x in numbers)])
    text = table(["nm", "side", "angle", "R", "R of the export", "T", "T of the export", "RMS π Δf, reflected", "transmitted"], body)
    r, t, reflected, transmitted, steep = numpy.max(errors, axis=0)
    return text, (f"Largest errors: R {r:.4f}, T {t:.4f}; RMS of π Δf {reflected:.4f} reflected, {transmitted:.4f} transmitted; over "
                  f"views up to {STEEP}° from the normal {steep:.4f}.\n")


def xyz_over_white(primaries, rgb):
    """X, Y and Z over those of (1, 1, 1), of a space with these primaries and this white."""
    *columns, white = ((x / y, 1, (1 - x - y) / y) for x, y in primaries)
    matrix = numpy.transpose(columns)
    return rgb * numpy.linalg.solve(matrix, white) @ matrix.T / white


class Scene:
    """A leaf that fills the image, under parallel light, by rtrace and by frond."""

    SIZE, FOV, LIGHT, VIEW = 48, 40, 40, 30  # pixels; degrees, the latter two from the normal, on both sides of it
    TIMES = 32  # that rtrace follows each ray: what it makes of one is random

    def __init__(self, folder, material, samples):
        self.folder, self.material = folder, material
        home = pathlib.Path(run(PYTHON, "-c", "import pyradiance; print(pyradiance.__path__[0])").strip())
        self.environment = dict(os.environ, RAYPATH=f".:{home / 'lib'}", PATH=f"{home / 'bin'}:{os.environ['PATH']}")
        program("export", *material, "--format", "radiance", "-o", folder / "leaf.xml", "-q")
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
        """A table, and by how much the means of X, Y and Z differ at most, in per cent."""
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


INTRODUCTION = """# Exports

Written by `scripts/exports`. {machine}

```
frond export NAME[,parameter=value...] --format radiance|csv|npz|netcdf|osl -o FILE
```

writes a material's BSDF for other programs. The material is named as for the [instruments](instruments.md). What is exported is
f as a renderer sees it: light from one direction, seen from another. Leaves are `reciprocal` where nothing is said of their
`incident`, as in `frond brf`: other programs follow light from either end ([reciprocal_leaf.md](reciprocal_leaf.md)).

Refused with a reason: materials whose f is a random estimate (`abm`; `leaf_solved` is its mean), that have a delta lobe, or that
refract light into another medium; wavelengths that the material's data do not reach; options that a format does not look at.
Files are written whole or not at all; `-` is standard output for formats that are text.

| format | for | keeps | error below |
|---|---|---|---|
| `radiance` | Radiance, WINDOW | f averaged over 145 × 145 pairs of patches, both sides | [patches](#klems-patches-for-radiance) |
| `csv`, `npz`, `netcdf` | everybody | R, T, and f at single directions, exactly | [between directions](#tables) |
| `osl` | Blender's Cycles | R and T by angle and side; f as three lobes | [lobes](#an-osl-shader-for-cycles) |

Errors are those of `{leaf}` (soybean): R and T beside `frond spectrophotometer --rays {rays}` (standard errors up to {se:.5f}), f
beside `frond goniophotometer --integrate` with patches of {step}° by {step}°: the RMS of π Δf over all directions of a side, by
projected solid angle; white paper has π f = 1.

"""

RADIANCE = """## Klems patches for Radiance

`--format radiance` writes XML as WINDOW 6 has it (LBNL/Klems Full), transmission and reflection from both sides. A value
is f averaged over both patches with respect to projected solid angle: by Gauss's rules of rising order until two agree within
2·10⁻⁵ and 2·10⁻⁴ of themselves, in π f; the file says by how much the last two differ at most.

- Light: by default 380 to 780 nm in steps of 10, or `--wavelengths`; linear in between, and the nearest beyond. Radiance's reader
  takes the blocks `Visible` (Y), `CIE-X` and `CIE-Z`: each is weighed by D65 and the CIE 1931 function, and divided by what
  white would have, so that grey stays grey. One wavelength alone makes one block, `Visible`.
- Sides: frond's front (adaxial side, +z) is the front of a Radiance surface, whose normal goes by the right-hand rule. WINDOW
  calls that side back. Of a material that is not the same all around, frond's x and y are Radiance's with the up vector
  `0 1 0` and the surface's normal along z.
- Solar blocks, which WINDOW wants for heat, are not written.
- A lobe that is narrower than a patch is spread over it: that is the format's error, and it goes for the direction of light
  as well. A warning tells where a lobe was too narrow to be integrated.

```
frond export leaf_solved,specimen=soybean --format radiance -o leaf.xml
```

and in the scene

```
void BSDF leaf
6 0 leaf.xml 0 1 0 .
0
0
```

An R or T of the export is that of the patch which the angle lies in, light from all over it: 8° is in the ring from 5 to 15, 70° in
that from 65 to 75, 45° at the lower edge of that from 45 to 55.

"""

TABLES = """## Tables

`--format csv`, `npz` and `netcdf` hold the same numbers: R and T over (wavelength, side, θi), and f over (wavelength, side, θi,
θo, φo, kind), kind being reflected or transmitted. `--wavelengths` has to be given; `--angles` (θi) and `--view-angles` (θo)
are every 5° up to 85° by default, `--view-azimuths` every 15° all around.

| axis | unit | |
|---|---|---|
| `wavelength` | nm | |
| `side` | | front (adaxial, +z) or back: where the light is |
| `theta_i`, `theta_o` | degree | from the normal, each on its own side |
| `phi_o` | degree | from the light's azimuth to the viewer's: the mirror direction is at 180 |
| `kind` | | reflected, transmitted |
| `R`, `T` | 1 | shares of the light, integrated to 10⁻⁴ of themselves |
| `f` | 1/sr | at single directions, as 32-bit floats |

- `csv`: long form, a line for each number; `quantity` is R, T, f_r or f_t.
- `npz`: `numpy.load("leaf.npz")["f_per_sr"]`; `axes` names the axes of it. Not compressed; the same input makes the same bytes.
- `netcdf`: classic, with attributes of the CF conventions (`units`, `long_name`, `flag_meanings`), which scipy, xarray and
  ncdump read. Debian's libnetcdf-dev has to be there when frond is built, else the format is refused; the library is opened
  when it is asked for.

At their nodes the numbers are frond's own. Read with linear interpolation in θi, θo and φo, and the last angle beyond it, the
default table ({megabytes:.1f} MB of CSV for three wavelengths) gives

"""

OSL = """## An OSL shader for Cycles

`--format osl` writes a shader `frond_leaf` of three lobes, as `leaf_simplified` has them: Cycles' `phong_ramp` for the surface,
`diffuse` for what comes back out of the leaf and `translucent` for what crosses it, weighed by tables of Rs, Rd and T over the
viewing angle (every 2.5°) and the side. Red, green and blue are 608, 551 and 455 nm, or three `--wavelengths` in that order, and
go into the renderer's own colours as they are.

- R and T are f integrated to 10⁻⁴ of themselves; the share of Rs in R is estimated by rays (`--rays`, 10⁶ each by default). A material
  that does not tell its surface from its body has no surface lobe, and a warning says so.
- The lobe's exponent follows from the surface's rays at normal incidence. Cycles weighs its lobe by the cosine with the
  normal besides, frond does not; the table divides by what Cycles' lobe alone sends on, so that Rs stays Rs.
- A closure's weight knows the viewer's angle and not the light's: R and T are kept, f is not reciprocal, and `incident=light` is
  refused.
- In Blender: render engine Cycles, Open Shading Language on, a Script node with the file, its BSDF to the material's Surface. The
  front is the side of the face's normal.

"""


def main():
    options = arguments("exports")
    rays, samples, spp = ("1e4", 64, 64) if options.quick else ("1e6", 4096, 1024)
    reference = Reference(rays)
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        text = INTRODUCTION.format(machine=machine(), leaf=LEAF, rays=rays, step=STEP, se=reference.error)
        text += RADIANCE + "\n".join(comparison(reference, Klems(folder)))
        if has("pyradiance"):
            scene = Scene(folder, (LEAF, "incident=reciprocal"), spp)
            images, worst = scene.comparison()
            _, of_paper = Scene(folder, ("diffusetransmission",), spp).comparison()
            text += f"""
`checkBSDF` of Radiance says of the file with colour, which `wrapBSDF` reads too (`tests/exports/readers_test.py`)

```
{scene.report[scene.report.index("Type:"):].strip()}
```

**A scene**: a leaf that fills an image of {Scene.SIZE} × {Scene.SIZE} pixels, parallel light of D65 of irradiance 1 across it at
{Scene.LIGHT}° from the normal, a perspective camera of {Scene.FOV}° at {Scene.VIEW}° on the other side of the normal. X, Y and Z over those of white, mean
over the image: `frond render` ({spp} samples a pixel), Radiance (`rtrace -ab 0`, {Scene.TIMES} rays a
pixel). Means of Y differ by up to {worst[1]:.1f} %, of X and Z by up to {max(worst):.1f} %; of a `diffusetransmission` in place of the
leaf, whose f patches do not change, by up to {of_paper[1]:.1f} and {max(of_paper):.1f} %:

{images}"""
        else:
            text += "\nRadiance (pyradiance) could not be installed: no image was rendered.\n"
        values = Table(folder)
        text += "\n" + TABLES.format(megabytes=values.bytes / 1e6) + "\n".join(comparison(reference, values)) + "\n" + OSL
        if has("bpy"):
            cycles = Cycles(folder, rays, samples)
            body, errors = comparison(reference, cycles)
            furnace = max(abs(cycles.of(light, "furnace") - sum(reference.shares(light))) for light in LIGHTS)
            text += f"""Rendered by Cycles of Blender {cycles.version}: R and T are what the sheet shows under half a sky of radiance 1 ({64 * samples}
paths), f what it shows under parallel light. In a furnace, under a whole sky, R + T is off by up to {furnace:.4f}.

{body}
{errors}"""
        else:
            text += "Blender (bpy) could not be installed: the shader was not rendered.\n"
    write(options.docs / "exports.md", text)


if __name__ == "__main__":
    main()
