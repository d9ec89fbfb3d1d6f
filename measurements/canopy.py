"""Errors of leaf models in the BRF and the absorbed light of canopies (section "canopy" of docs/radiometry.md)

Measures homogeneous canopies; writes docs/images/canopy.svg, too. Takes about 20 minutes on two cores.
  --rms X   relative standard error of the BRFs
  --quick   few samples, into build/canopy_report
"""

import itertools
import pathlib
import tempfile
import textwrap

import numpy
import pandas

import frond

from .shared import charts
from .shared.tools import arguments, machine, program, program_csv, rms, table, write_section

DIFFUSE = "leaf_lambert,bihemispherical=true"
MODELS = ["leaf_lambert", DIFFUSE, "leaf_simplified", "leaf_solved"]
REFERENCE = "leaf_solved"
SIMPLER = [model for model in MODELS if model != REFERENCE]
#: In the chart: colour, name, and position of the name in the first panel (degrees, % of difference).
STYLES = {"leaf_lambert": (charts.COLORS[2], "leaf_lambert", (10, 60)),
          DIFFUSE: (charts.COLORS[4], "leaf_lambert,\nbihemispherical", (-4, 235)),
          "leaf_simplified": (charts.COLORS[1], "leaf_simplified", (-42, -32))}
ANGLES = ["spherical", "planophile", "erectophile"]
INDICES = [1, 3, 5]
SUNS = [30, 45, 70]
BANDS = [450, 550, 670, 800, 1650, 2200]
ZENITH = range(-60, 61, 10)
RMS = 0.01
PLOT = 4  # metres
ENOUGH = 0.02  # of the BRF, in every band and direction

SCENE = """Option "float period" [{plot} {plot}]
WorldBegin
LightSource "distant" "point3 from" [{sun_x} 0 {sun_z}] "point3 to" [0 0 0] "spectrum L" "stdillum-E"
MakeNamedMaterial "soil" "string type" "diffuse" "spectrum reflectance"
  [300 0.05 450 0.08 550 0.12 670 0.16 800 0.22 1000 0.27 1400 0.30 1650 0.38 2200 0.35 2500 0.30]
MakeNamedMaterial "leaf" "string type" "leaf_solved" "string specimen" "soybean"
NamedMaterial "soil"
Shape "bilinearmesh" "point3 P" [0 0 0  {plot} 0 0  0 {plot} 0  {plot} {plot} 0]
NamedMaterial "leaf"
ObjectBegin "leaf" Shape "disk" ObjectEnd
Shape "instances" "string object" "leaf" "string filename" "leaves.npy"
"""


class Canopy:
    """A homogeneous canopy, measured with each leaf model: `brf` and `brf_se` by zenith angle and band, and `par`, the share of
    photons that leaves absorb, with its standard error."""

    def __init__(self, folder, angles, index, sun, asked, paths):
        self.angles, self.index, self.sun = angles, index, sun
        program("canopy", "-q", "-o", folder / "leaves.npy", "--lai", index, "--angles", angles, "--scale", 0.05, "--size",
                f"{PLOT},{PLOT}", "--heights", "0.05,1.5")
        scene, toward = folder / "scene.pbrt", numpy.radians(sun)
        scene.write_text(SCENE.format(plot=PLOT, sun_x=-numpy.sin(toward), sun_z=numpy.cos(toward)))
        self.brf, self.brf_se, self.par = {}, {}, {}
        for model in MODELS:
            found = frond.brf(scene, BANDS, zenith=ZENITH, rms=asked, swap={"leaf": model})
            found = found.pivot(index="zenith_deg", columns="wavelength_nm", values=["brf", "brf_se"])
            self.brf[model], self.brf_se[model] = found["brf"], found["brf_se"]
            # frond flux integrates the photons over 400 to 700 nm.
            flux = program_csv("flux", scene, "--wavelengths", "400:700:20", "--paths", paths, "--swap", f"leaf={model}", "--csv",
                               "-", "-q").set_index(["quantity", "material", "wavelength_nm"])
            self.par[model] = flux.loc[("absorbed", "leaf", "PAR"), ["share", "share_se"]].to_numpy(float)

    def difference(self, model):
        """Returns the difference of the BRF relative to the reference, and its standard error."""
        ratio = self.brf[model] / self.brf[REFERENCE]
        return ratio - 1, ratio * numpy.hypot(self.brf_se[model] / self.brf[model], self.brf_se[REFERENCE] / self.brf[REFERENCE])

    def par_difference(self, model):
        """Returns the difference of the absorbed photons relative to the reference, and its standard error."""
        (mean, error), (reference, of_reference) = self.par[model], self.par[REFERENCE]
        return mean / reference - 1, numpy.hypot(error / mean, of_reference / reference)

    def name(self):
        return f"{self.angles}, LAI {self.index}, sun {self.sun}°"


def chart(path, canopies):
    """Relative difference of the BRF against the view zenith angle: a panel for each band, a curve for each model, of spherical
    leaf angles. Panels of a row have one scale. The names stand beside the curves of the first panel."""
    canopy = next(c for c in canopies if (c.angles, c.index, c.sun) == ("spherical", 3, 45))
    of, panels = charts.figure(900, 620, 2, 3, sharex=True, sharey="row")
    for panel, band in zip(panels.flat, BANDS):
        panel.axhline(0, color="#000000", linewidth=1)
        panel.axvline(-canopy.sun, color="#888888", linewidth=1, linestyle="--")
        for model in SIMPLER:
            mean, error = (100 * x[band] for x in canopy.difference(model))
            panel.errorbar(mean.index, mean, error, color=STYLES[model][0], elinewidth=1)
        panel.set(title=f"{band} nm", xticks=range(-60, 61, 30))
    for color, name, place in STYLES.values():
        panels[0, 0].annotate(name, place, color=color)
    panels[0, 0].annotate("sun", (-canopy.sun, 0), (3, 5), xycoords=("data", "axes fraction"), textcoords="offset points",
                          color="#666666")
    panels[-1, 1].set_xlabel("view zenith angle (degrees), negative: from the sun's side")
    for row in panels:
        row[0].set_ylabel("BRF error (%)")
    charts.save(of, path)


SECTION = """## Measurements

Machine: {machine}.

### Accuracy of leaf models in homogeneous canopies

The canopies are soybean leaves, disks of radius 5 cm at random positions, over soil, lit by the sun alone. The views lie in the
principal plane, from −60 to 60°; negative angles are on the sun's side. The differences are relative to the BRF with `leaf_solved`,
the BSDF that the random walk converges to. They are the errors of three lobes scaled by a table (`leaf_simplified`) and of two
Lambertian leaves (`leaf_lambert`): one with the near-normal reflectance and transmittance of an integrating sphere (8°), as plant
codes use them, and one with the means under diffuse light (`bihemispherical`). The standard error of a difference is about
{noise:.1f} %. All leaves are reciprocal ([conventions](conventions.md)).

![BRF differences from leaf_solved against view zenith angle, for six bands](images/canopy.svg)

*Spherical leaf angles, leaf area index 3, sun zenith angle 45°. Bars: standard errors. The second table below has the range for
other leaf angles.*

{nadir}
*View from the nadir: spherical leaf angles, leaf area index 3, sun zenith angle 30°. BRF with `leaf_solved`, and differences from it.*

{extremes}
*Smallest and largest difference in %, over all directions, leaf area indices 1, 3 and 5, and sun zenith angles of 30, 45 and 70°.*

{verdict}

### Absorbed light by leaf model

fAPAR: photons from 400 to 700 nm that the leaves absorb, as a share of the incident photons, under direct light. The columns of the
models are differences relative to `leaf_solved`.

{par}"""


def extremes_table(canopies):
    body = []
    for model, angles in itertools.product(SIMPLER, ANGLES):
        differences = pandas.concat([c.difference(model)[0] for c in canopies if c.angles == angles])
        body.append([f"`{model}`", angles, *(f"{100 * low:+.0f} to {100 * high:+.0f}"
                                             for low, high in zip(differences.min(), differences.max()))])
    return table(["", "leaf angles", *(f"{band} nm" for band in BANDS)], body)


def nadir_table(canopies):
    canopy = next(c for c in canopies if (c.angles, c.index) == ("spherical", 3) and c.sun == min(x.sun for x in canopies))
    brf, error = canopy.brf[REFERENCE].loc[0], canopy.brf_se[REFERENCE].loc[0]
    body = []
    for band in BANDS:
        found = [[100 * x[band].loc[0] for x in canopy.difference(model)] for model in SIMPLER]
        body.append([f"{band} nm", f"{brf[band]:.4f} ± {error[band]:.4f}", *(f"{mean:+.1f} ± {se:.1f} %" for mean, se in found)])
    return table(["", "`leaf_solved`", *(f"`{m}`" for m in SIMPLER)], body)


def par_table(canopies):
    body = []
    for c in canopies:
        found = [c.par_difference(model) for model in SIMPLER]
        body.append([c.name(), "{:.4f} ± {:.4f}".format(*c.par[REFERENCE]),
                     *(f"{100 * mean:+.2f} ± {100 * error:.2f} %" for mean, error in found)])
    return table(["canopy", "`leaf_solved`", *(f"`{m}`" for m in SIMPLER)], body)


def verdict(canopies):
    """For each model: the largest errors, and in how many canopies it is accurate enough in every band and direction, and at 800 nm
    alone."""
    lines = []
    for model in SIMPLER:
        # Accurate enough: the difference less three standard errors is within the limit.
        enough = [abs(mean) - 3 * error <= ENOUGH for mean, error in (c.difference(model) for c in canopies)]
        worst, (zenith, band), canopy = max(((off := abs(c.difference(model)[0]).stack()).max(), off.idxmax(), c.name())
                                            for c in canopies)
        par = max(abs(c.par_difference(model)[0]) for c in canopies)
        lines.append(textwrap.fill(
            f"- `{model}`: the largest BRF error is {100 * worst:.0f} % ({canopy}, {band:g} nm, view {zenith:g}°). Every view "
            f"is within {100 * ENOUGH:.0f} %, to three standard errors, in {sum(e.all(axis=None) for e in enough)} of "
            f"{len(canopies)} canopies over all bands and in {sum(e[800].all() for e in enough)} at 800 nm alone. The largest "
            f"error of the absorbed photons is {100 * par:.1f} %.", 130, subsequent_indent="  ", break_on_hyphens=False))
    return "\n".join(lines)


def main():
    options = arguments("canopy", ("--rms", dict(type=float, help="relative standard error of the BRFs")))
    asked, paths = options.rms or (0.1 if options.quick else RMS), "1e4" if options.quick else "2e5"
    with tempfile.TemporaryDirectory(prefix="frond_canopy.") as name:
        folder = pathlib.Path(name)
        canopies = []
        for angles, index, sun in itertools.product(ANGLES, INDICES, SUNS):
            if not options.quick or (index, sun) == (3, 45):
                canopies.append(Canopy(folder, angles, index, sun, asked, paths))
                print(canopies[-1].name(), flush=True)
    noise = 100 * rms(numpy.stack([c.difference(MODELS[0])[1] for c in canopies]))
    print(nadir_table(canopies), extremes_table(canopies), par_table(canopies), verdict(canopies), sep="\n")
    chart(options.docs / "images" / "canopy.svg", canopies)
    write_section(options.docs / "radiometry.md", "canopy",
                  SECTION.format(machine=machine(), noise=noise, nadir=nadir_table(canopies), extremes=extremes_table(canopies),
                                 par=par_table(canopies), verdict=verdict(canopies)))


if __name__ == "__main__":
    main()
