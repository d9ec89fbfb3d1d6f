"""Fluorescence of two canopies against two other programs, and what a solved leaf changes (docs/fluorescence.md)

Leaves are Lambertian, with matrices from a file: those of the other programs. The figures are not part of frond:
  --reference FOLDER   folder with less3d_*.csv, canopy_inputs.csv, emission_spectra.csv and shared_cab40_*.csv
  --quick              few paths, into build/fluorescence_canopy_report
"""

import json
import math
import pathlib
import tempfile

import numpy
import pandas

from . import fluorescence
from .shared import charts
from .shared.tools import FROND, Use, arguments, machine, program, program_csv, table, write_section

EMITTED_NM = (685, 740, 760)
NADIR, HOT_SPOT = 0, -30
PLANE = list(range(-75, 76, 15))
PLOTS = (1, 2, 3, 4)  # seeds
# Turbid canopy, SCOPE: radiance at nadir and in the hot spot, mW/(m2 nm sr).
TURBID = {NADIR: (0.242, 1.392, 0.905), HOT_SPOT: (0.388, 1.828, 1.167)}
YIELD = 0.01
LESS3D_ERROR, LESS3D_CPU_S = 0.0045, 108
HC_NA = 6.62607015e-34 * 299792458 * 6.02214076e23 * 1e9 * 1e-6  # nm W/(umol/s)
SQUARE = math.sqrt(math.pi) / 2  # half the side of a square of a unit disc's area


def read(path):
    return pandas.read_csv(path, comment="#")


def save(path, **columns):
    pandas.DataFrame(columns).to_csv(path, index=False)
    return path


def photons(nm, irradiance):
    """From 400 to 750 nm, umol/(m2 s)."""
    use = (nm >= 400) & (nm <= 750)
    return numpy.trapezoid(irradiance[use] * nm[use], nm[use]) / HC_NA


class Scene:
    """A canopy of random leaves in a periodic plot. `lights`: (directive up to its spectrum, wavelengths, horizontal irradiance)."""

    def __init__(self, folder, name, leaf_shape, soil, lights, leaf):
        self.folder, self.path = folder, folder / f"{name}.pbrt"
        self.leaf_shape, self.soil, self.leaf = leaf_shape, soil, leaf
        self.lights = []
        for i, (directive, nm, irradiance) in enumerate(lights):
            file = save(folder / f"{name}-light{i}.csv", nm=nm, w=irradiance)
            # Lights have luminance 1: one alone shows the factor to its own unit.
            self.write([(directive, file, 1)], leaf)
            self.lights.append((directive, file, photons(nm, irradiance) / self.flux(paths=256)["incident_umol_m2_s"]))
        self.write(self.lights, leaf)

    def write(self, lights, leaf):
        text = "".join(f'{directive} "spectrum L" "{file}" "float scale" {scale:.9g}\n' for directive, file, scale in lights)
        self.path.write_text(f"""Option "float period" [ 10 10 ]
Integrator "path"
WorldBegin
{text}
MakeNamedMaterial "soil" "string type" "diffuse" "spectrum reflectance" {self.soil}
MakeNamedMaterial "leaf" {leaf}
NamedMaterial "soil"
Shape "bilinearmesh" "point3 P" [ 0 0 0  10 0 0  0 10 0  10 10 0 ]
NamedMaterial "leaf"
ObjectBegin "leaf" {self.leaf_shape} ObjectEnd
Shape "instances" "string object" "leaf" "string filename" "{self.folder / 'leaves.npy'}"
""", encoding="utf-8")

    def with_leaf(self, leaf):
        self.write(self.lights, leaf)

    def flux(self, paths):
        return json.loads(program("flux", self.path, "--fluorescence", "--emission", fluorescence.listed(EMITTED_NM), "--paths", paths, "--json",
                                  "-", "-q"))

    def absorbed(self, nm, paths):
        found = program_csv("flux", self.path, "--wavelengths", fluorescence.listed(nm), "--paths", paths, "--csv", "-", "-q")
        found = found[(found["quantity"] == "absorbed") & (found["material"] == "leaf")]
        return found["share"].values, found["share_se"].values

    def brf(self, views, nm, paths):
        found = program_csv("brf", self.path, "--zenith=" + fluorescence.listed(views), "--wavelengths", fluorescence.listed(nm), "--paths",
                            paths, "--csv", "-", "-q")
        column = "brf" if "brf" in found else "hdrf"
        return found.set_index(["zenith_deg", "wavelength_nm"])[[column, f"{column}_se"]].set_axis(["mean", "se"], axis=1)

    def radiance(self, views, paths, swap=None):
        found = program_csv("brf", self.path, "--fluorescence", "--emission", fluorescence.listed(EMITTED_NM),
                            "--zenith=" + fluorescence.listed(views), "--paths", paths, "--csv", "-", "-q", *(["--swap", swap] if swap else []))
        return found.set_index(["zenith_deg", "wavelength_nm"])[["radiance", "radiance_se"]].set_axis(["mean", "se"], axis=1)


def lambertian(folder, name, nm, r, t, matrices, scale):
    """The words of a Lambertian leaf that replays these shares and matrices."""
    file = save(folder / f"{name}-shares.csv", theta_deg=8.0, wavelength_nm=nm, Rs=0.0, Rd=r, T=t)
    return (f'"string type" "leaf_lambert" "string tablefile" "{file}" "string fluorescencematrices" "{matrices}" '
            f'"float fluorescencescale" {scale}')


def leaves(folder, seed=1):
    program("canopy", "--lai", 3, "--angles", "spherical", "--scale", 0.05, "--size", "10,10", "--heights", "0.05,1.95", "--seed", seed, "-o",
            folder / "leaves.npy")


SUN = 'LightSource "distant" "point3 from" [ 0.5 0 0.8660254 ] "point3 to" [ 0 0 0 ]'
SQUARES = f'Shape "bilinearmesh" "point3 P" [ {-SQUARE} {-SQUARE} 0  {SQUARE} {-SQUARE} 0  {-SQUARE} {SQUARE} 0  {SQUARE} {SQUARE} 0 ]'


def discrete(folder, reference, quick):
    of, absorbed = read(reference / "less3d_leaf_sun.csv"), read(reference / "less3d_absorbed.csv")
    nm = of["wavelength_nm"].values.astype(float)
    leaf = lambertian(folder, "discrete", nm, of["R"], of["T"], reference / "less3d_matrices.csv", YIELD)
    scene = Scene(folder, "discrete", SQUARES, "[ 300 0.15 2500 0.15 ]", [(SUN, nm, of["sun"].values * math.cos(math.radians(30)))], leaf)
    bands, plots = (455, 555, 675), []
    for seed in PLOTS:
        leaves(folder, seed)
        shares, _ = scene.absorbed(bands, 20_000 if quick else 1_000_000)
        plots.append([*shares, *scene.radiance([NADIR], 4096 if quick else 1 << 18).loc[NADIR]["mean"]])
    leaves(folder)
    # CPU time for the standard error of less3d's run, and of reflected light with as many paths.
    cost = [Use(FROND, "brf", scene.path, *words, "--zenith=0", "--threads", 1, "-q", "--csv", "-").cpu for words in
            (("--fluorescence", "--rms", LESS3D_ERROR), ("--wavelengths", fluorescence.listed(EMITTED_NM), "--rms", LESS3D_ERROR))]
    return {"bands": bands, "cost": cost, "plots": numpy.array(plots), "absorbed": absorbed.set_index("nm").loc[list(bands), "share_of_incident"],
            "toc": read(reference / "less3d_toc_nadir.csv").set_index("nm").loc[list(EMITTED_NM)],
            "flux": scene.flux(20_000 if quick else 1_000_000)}


def turbid(folder, reference, quick):
    of = read(reference / "canopy_inputs.csv")
    nm = of["wavelength_nm"].values.astype(float)
    leaf = lambertian(folder, "turbid", nm, of["R"], of["T"], reference / "shared_cab40_matrices.csv", 1)
    soil = "[ " + "  ".join(f"{n:g} {r:g}" for n, r in zip(nm, of["rho_soil"])) + " ]"
    lights = [(SUN, nm, of["E_sun"].values / 1e3), ('LightSource "infinite"', nm, of["E_sky"].values / 1e3)]
    scene = Scene(folder, "turbid", 'Shape "disk" "float radius" 1', soil, lights, leaf)
    bands, paths = (550, 650, *EMITTED_NM), 4096 if quick else 1 << 18
    at = of.set_index("wavelength_nm").loc[list(bands)]
    return {"bands": bands, "reflectance": scene.brf([NADIR, HOT_SPOT], bands, paths),
            "theirs": {NADIR: at["refl_vz0"], HOT_SPOT: at["refl_vz30_raz0"]}, "radiance": scene.radiance([NADIR, HOT_SPOT], paths),
            "flux": scene.flux(20_000 if quick else 1_000_000), "scene": scene}


def own_leaf(folder, reference, scene, quick):
    """Radiance by view of the turbid canopy: with the reference's matrices, and of a solved leaf of the same R + T its matrices alone, and
    its directions too."""
    nm = numpy.arange(400, 851, 5)
    leaf = read(reference / "shared_cab40_leaf.csv").set_index("wavelength_nm").loc[nm]
    emission = folder / "emission.csv"
    read(reference / "emission_spectra.csv")[["wavelength_nm", "phi"]].to_csv(emission, index=False)
    depth = fluorescence.matched_depth(folder, nm, leaf, emission, 4 if quick else 12)
    words = fluorescence.words(folder, nm, depth, leaf["chl_share"].values, emission)
    r, t = fluorescence.shares(words, nm)
    excitation, emitted = numpy.arange(400, 751, 50 if quick else 10), numpy.arange(640, 851, 30 if quick else 5)
    sides = fluorescence.matrices(f"leaf_solved,{words}", excitation, emitted)
    pairs = {"excitation_nm": numpy.repeat(excitation, len(emitted)), "emission_nm": numpy.tile(emitted, len(excitation))}
    matrices = save(folder / "own.csv", **pairs, **sides)
    paths = 1024 if quick else 1 << 16
    radiance = {"plates": scene.radiance(PLANE, paths)}
    scene.with_leaf(lambertian(folder, "own", nm.astype(float), r, t, matrices, 1))
    radiance["matrices"] = scene.radiance(PLANE, paths)
    scene.with_leaf('"string type" "leaf_solved"')  # --swap keeps parameters that both models have
    radiance["solved"] = scene.radiance(PLANE, paths, swap=f"leaf=leaf_solved,{words}")
    return radiance


def chart(path, radiance):
    of, panels = charts.figure(1100, 420, 1, len(EMITTED_NM), sharex=True)
    labels = {"plates": "plates, Lambertian", "matrices": "solved leaf's matrices, Lambertian", "solved": "solved leaf"}
    for panel, nm in zip(panels[0], EMITTED_NM):
        for color, (name, label) in zip(charts.COLORS, labels.items()):
            at = radiance[name].xs(nm, level="wavelength_nm")
            panel.errorbar(at.index, at["mean"], at["se"], color=color, label=label)
        panel.set(title=f"{nm} nm", xlabel="view zenith angle (degrees; sun at −30)", ylim=(0, None))
    panels[0, 0].set_ylabel("mW m⁻² sr⁻¹ nm⁻¹")
    charts.legend(of, panels[0, 0], 3)
    charts.save(of, path)


def off(ours, theirs):
    return f"{100 * (ours / theirs - 1):+.1f} %"


def escape(flux, nm):
    return next(f"{row['escape']:.4f} ± {row['escape_se']:.4f}" for row in flux["escape"] if row["wavelength_nm"] == nm)


def section(found, radiance):
    d, t = found["discrete"], found["turbid"]
    plots, count = d["plots"], len(PLOTS)
    spread = plots.std(axis=0, ddof=1)
    theirs = [*d["absorbed"], *d["toc"]["L_mW_m2_nm_sr"]]
    errors = [math.nan] * len(d["bands"]) + list(d["toc"]["se"])
    names = [f"absorbed, {nm} nm" for nm in d["bands"]] + [f"nadir, {nm} nm" for nm in EMITTED_NM]
    body = [[name, f"{plots[0, i]:.4g}", f"{plots[:, i].mean():.4g} ± {spread[i] / math.sqrt(count):.2g}",
             f"{theirs[i]:.4g}" + ("" if math.isnan(errors[i]) else f" ± {errors[i]:.2g}"), off(plots[0, i], theirs[i]),
             off(plots[:, i].mean(), theirs[i])] for i, name in enumerate(names)]
    rows = []
    for view, title in ((NADIR, "nadir"), (HOT_SPOT, "hot spot")):
        for i, nm in enumerate(t["bands"]):
            elastic, se = t["reflectance"].loc[(view, nm)]
            row = [title, f"{nm} nm", f"{elastic:.4f} ± {se:.4f}", off(elastic, t["theirs"][view][nm])]
            if nm in EMITTED_NM:
                mean, error = t["radiance"].loc[(view, nm)]
                row += [f"{mean:.4g} ± {error:.2g}", off(mean, TURBID[view][EMITTED_NM.index(nm)])]
            rows.append(row + [""] * (6 - len(row)))
    changes = []
    for view in PLANE:
        row = [f"{view}°"]
        for nm in (685, 740):
            plates = radiance["plates"].loc[(view, nm)]["mean"]
            row += [f"{100 * (radiance[name].loc[(view, nm)]['mean'] / plates - 1):+.1f}" for name in ("matrices", "solved")]
        changes.append(row)
    errors = max((r["se"] / r["mean"]).max() for r in radiance.values())
    turns = {nm: radiance["solved"].xs(nm, level="wavelength_nm")["mean"] / radiance["matrices"].xs(nm, level="wavelength_nm")["mean"] - 1
             for nm in EMITTED_NM}
    return f"""## Canopies against other programs

Measured by `measurements/run fluorescence_canopy` on {machine()}. Leaves at random in a periodic plot of 10 m, leaf area index 3,
leaf angles spherical, 0.05 to 1.95 m high, each of 0.00785 m²; the sun at 30°. The leaves are Lambertian, with reflectance, transmittance and matrices of the other program
(`leaf_lambert` with `tablefile` and `fluorescencematrices`). The figures of the other programs are no part of frond.

**A canopy of discrete leaves: less3d 3.0.1** (Embree backend; its matrices and the combined emission shape; no sky, soil of reflectance
0.15). Light that the leaves absorb, as a share of the incident light, and radiance at nadir in mW m⁻² sr⁻¹ nm⁻¹. Another plot of the
same statistics differs by more than the noise of the paths; the mean of {count} plots, less3d's among them, has the standard error that follows from their
spread.

{table(["", "less3d's plot", f"{count} plots", "less3d", "difference", f"of {count} plots"], body)}
less3d loses the parts of leaves that stick out of its tile, and edges that are then lit absorb more; its standard errors are almost the
same in all wavelengths. CPU time for a standard error of {100 * LESS3D_ERROR:.2f} %, with the loading of the scene: less3d {LESS3D_CPU_S} s,
frond {d["cost"][0]:.1f} s; reflected light alone at the same wavelengths and error takes frond {d["cost"][1]:.1f} s. Of the photons that leave the leaves {', '.join(f"{escape(d['flux'], nm)} at {nm} nm" for nm in EMITTED_NM)} escape upward.

**A turbid canopy: SCOPE 2.x** (Christiaanvandertol/SCOPE @ e4c2e51, GPL-3.0, run as an oracle; layers of leaves without size, four-stream scattering, hot spot
parameter 0.05; its sun, an isotropic sky, its soil, its leaf of 40 µg/cm² of chlorophyll). Reflectance factor without fluorescence, then
fluorescence in mW m⁻² sr⁻¹ nm⁻¹; each with the difference from SCOPE:

{table(["view", "", "reflectance factor", "", "fluorescence", ""], rows)}
Escape upward: {', '.join(f"{escape(t['flux'], nm)} at {nm} nm" for nm in EMITTED_NM)}; SCOPE, whose
diffuse light inside the canopy has two streams, has 0.30 at 685 nm and 0.47 at 740 nm.

**What the leaf's own matrices and directions change.** The turbid canopy with a solved leaf (`leaf_solved`) that has the R + T and the emission shape of the
plates, as [above](#comparison-with-plates): first only its matrices on a Lambertian leaf with its R and T, then the leaf itself. Differences in %
from the canopy with the plates' leaf, by view angle in the sun's plane (the sun stands at −30°); standard errors are at most {100 * errors:.1f} %:

{table(["view", "matrices, 685 nm", "solved leaf, 685 nm", "matrices, 740 nm", "solved leaf, 740 nm"], changes)}
The matrices decide how much: red light is reabsorbed more in the walk's leaf than in that of plates. The directions alone, on the same
matrices, change the radiance by {', '.join(f"{100 * turns[nm].min():+.1f} to {100 * turns[nm].max():+.1f} % at {nm} nm" for nm in EMITTED_NM)}.

![Radiance of fluorescence by view angle, with the leaf of plates and with a solved leaf](images/fluorescence/canopy.svg)
"""


def main():
    options = arguments("fluorescence_canopy", ("--reference", {"type": pathlib.Path, "required": True, "metavar": "FOLDER"}))
    with tempfile.TemporaryDirectory() as temporary:
        folder = pathlib.Path(temporary)
        leaves(folder)
        found = {"turbid": turbid(folder, options.reference, options.quick)}
        radiance = own_leaf(folder, options.reference, found["turbid"]["scene"], options.quick)
        found["discrete"] = discrete(folder, options.reference, options.quick)
    chart(options.docs / "images" / "fluorescence" / "canopy.svg", radiance)
    write_section(options.docs / "fluorescence.md", "fluorescence_canopy", section(found, radiance))


if __name__ == "__main__":
    main()
