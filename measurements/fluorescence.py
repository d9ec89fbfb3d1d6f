"""Fluorescence of solved leaves against the matrices of a plate model, Fluspect (docs/fluorescence.md)

The leaves have the same reflectance and transmittance. The matrices are not part of frond:
  --reference FOLDER   folder with emission_spectra.csv, and of each leaf NAME_leaf.csv and NAME_matrices.csv
  --quick              few wavelengths, into build/fluorescence_report
"""

import pathlib
import tempfile

import numpy
import pandas

from .shared import charts
from .shared.tools import FROND, Use, arguments, machine, program, program_csv, rms, table, write_section

LEAVES = {"shared_cab20": "20 µg/cm² of chlorophyll", "shared_cab40": "40 µg/cm²", "shared_cab80": "80 µg/cm²"}
YIELD = 0.01  # of the reference
TOLERANCE = 0.002  # of R + T
SATURATED_NM = (440, 685)
SIDES = ("Mb", "Mf")
EMITTED_NM = (685, 740)
CONE_DEG = 59  # the reference is lit diffusely within this angle of the normal
# Structure of a bifacial leaf with the sieve effect whose R and T are those of the reference (plates, N = 1.5) at any absorption,
# found by a random search over R and T alone.
STRUCTURE = ("specimen=soybean,sieve=true,epidermisaspect=6.121,spongyaspect=11.04,palisadeaspect=0.9904,"
             "cuticlerefractivity=0.8627,spongyshare=0.2885")
# All absorption is that of two pigments from files, in a mesophyll of 0.1 mm: coefficient (1/m) = optical depth x 10^4.
THICKNESS_M = 1e-4
EMPTY = (f"thickness={THICKNESS_M},mesophyllfraction=1,chlorophylla=0,chlorophyllb=0,carotenoids=0,protein=0,cellulose=0,lignin=0,"
         "otherabsorption=0")


def read(path):
    return pandas.read_csv(path, comment="#")


def cone():
    """Angles of incidence and their shares of diffuse light within the cone, by Gauss's rule in the squared sine."""
    nodes, weights = numpy.polynomial.legendre.leggauss(4)
    squares = numpy.sin(numpy.radians(CONE_DEG))**2 * (1 + nodes) / 2
    return numpy.degrees(numpy.arcsin(numpy.sqrt(squares))), weights / 2


def words(folder, nm, depth, share, emission):
    """A leaf of this optical depth, of which `share` fluoresces, as parameters of a material; writes its files."""
    for name, of in (("fluorescing", share), ("other", 1 - share)):
        pandas.DataFrame({"nm": nm, "m2_per_kg": depth * of / THICKNESS_M}).to_csv(folder / f"{name}.csv", index=False)
    files = ",".join(str(folder / f"{name}.csv") for name in ("fluorescing", "other"))
    return (f"{STRUCTURE},{EMPTY},pigments={files},pigmentconcentrations=1,1,fluorescingpigments=1,fluorescence={YIELD},"
            f"emission={emission}")


def listed(values):
    return ",".join(f"{v:.10g}" for v in values)


def shares(leaf, nm):
    """R and T of light within the cone, at each wavelength."""
    angles, weights = cone()
    found = program_csv("table", f"leaf_simplified,{leaf}", "--wavelengths", listed(nm), "--angles", listed(angles), "-o", "-", "-q")
    of = found.pivot(index="theta_deg", columns="wavelength_nm")
    return weights @ (of["Rs"] + of["Rd"]).values, weights @ of["T"].values


def matched_depth(folder, nm, reference, emission, steps, more=0):
    """Optical depths for which R + T is the reference's plus `more`: bisection at all wavelengths at once."""
    low, high = numpy.full(len(nm), numpy.log(1e-4)), numpy.full(len(nm), numpy.log(20))
    for _ in range(steps):
        middle = (low + high) / 2
        r, t = shares(words(folder, nm, numpy.exp(middle), reference["chl_share"].values, emission), nm)
        too_clear = r + t > (reference["R"] + reference["T"]).values + more
        low, high = numpy.where(too_clear, middle, low), numpy.where(too_clear, high, middle)
    return numpy.exp((low + high) / 2)


def matrices(material, excitation, emission):
    """Mb and Mf of light within the cone: an array of each, [excitation][emission]."""
    angles, weights = cone()
    found = program_csv("spectrophotometer", material, "--fluorescence", "--angles", listed(angles), "--excitation", listed(excitation),
                        "--emission", listed(emission), "--csv", "-", "-q")
    return {side: weights @ found[side].values.reshape(len(angles), -1) for side in SIDES}


def compare(folder, reference, name, excitation, emission, steps):
    nm = numpy.arange(400, 851, 5)
    leaf = read(reference / f"{name}_leaf.csv").set_index("wavelength_nm").loc[nm]
    shape = read(reference / "emission_spectra.csv")[["wavelength_nm", "phi"]]
    shape.to_csv(folder / "emission.csv", index=False)
    depth = matched_depth(folder, nm, leaf, folder / "emission.csv", steps)
    parameters = words(folder, nm, depth, leaf["chl_share"].values, folder / "emission.csv")
    r, t = shares(parameters, nm)
    theirs = read(reference / f"{name}_matrices.csv")
    theirs = theirs[theirs["excitation_nm"].isin(excitation) & theirs["emission_nm"].isin(emission)]
    shape = (len(excitation), len(emission))
    ours = {side: m.reshape(shape) for side, m in matrices(f"leaf_solved,{parameters}", excitation, emission).items()}
    theirs = {side: theirs[side].values.reshape(shape) for side in SIDES}
    for of in (ours, theirs):
        of["both"] = of["Mb"] + of["Mf"]
    some = leaf.loc[list(SATURATED_NM)]
    depths = [matched_depth(folder, numpy.array(SATURATED_NM), some, folder / "emission.csv", steps, more)
              for more in (TOLERANCE, 0, -TOLERANCE)]
    return {"nm": nm, "depths": depths, "R": r, "T": t, "leaf": leaf, "ours": ours, "theirs": theirs}


def chart(path, found, emission):
    of, panels = charts.figure(1200, 620, 2, 3, sharex=True)
    for column, (name, title) in zip(panels.T, LEAVES.items()):
        for color, side, label in ((charts.COLORS[1], "Mb", "lit side"), (charts.COLORS[2], "Mf", "other side")):
            ours, theirs = (found[name][whose][side].sum(axis=0) for whose in ("ours", "theirs"))
            column[0].plot(emission, 1e3 * ours, color=color, label=f"frond, {label}")
            column[0].plot(emission, 1e3 * theirs, "--", color=color, label=f"plates, {label}")
            lit = theirs > 0
            column[1].plot(numpy.array(emission)[lit], 100 * (ours[lit] / theirs[lit] - 1), color=color)
        column[0].set_title(title)
        column[1].set(xlabel="emission (nm)", ylim=(-45, 25))
        column[1].axhline(0, color="black", linewidth=0.8)
    panels[0, 0].set_ylabel("photons per nm (10⁻³)")
    panels[1, 0].set_ylabel("difference (%)")
    charts.legend(of, panels[0, 0], 4)
    charts.save(of, path)


def cost(folder, quick):
    """CPU time (s) and error (%) of the matrices of a leaf: of walks by their number, of tables by their step, and the time of the
    solution, to which the errors refer."""
    nm = {"excitation": range(405, 750, 40), "emission": range(645, 850, 20)}  # between the nodes of the tables

    def measured(material, at, *more):
        csv = folder / "cost.csv"
        use = Use(FROND, "spectrophotometer", material, "--fluorescence", *(w for k, v in at.items() for w in (f"--{k}", listed(v))),
                  "--threads", 1, "--no-cache", "-q", "--csv", csv, *more)
        return use.cpu, read(csv)[list(SIDES)].to_numpy()

    seconds, exact = measured("leaf_solved,fluorescence=0.01", nm)
    rows = {"walk": [], "table": [], "solution": seconds}
    for rays in (100, 1000) if quick else (100, 1000, 10000, 100000):
        time, found = measured("abm,fluorescence=0.01", nm, "--rays", rays)
        rows["walk"].append((rays, time, 100 * rms((found - exact).ravel()) / exact.mean()))
    for step in (50, 30, 10):
        measured("leaf_solved,fluorescence=0.01", {"excitation": range(400, 751, step), "emission": range(640, 851, step)})
        table_file = (folder / "cost.csv").rename(folder / f"every{step}.csv")
        time, found = measured(f"leaf_lambert,fluorescencematrices={table_file}", nm)
        rows["table"].append((step, time, 100 * rms((found - exact).ravel()) / exact.mean()))
    return rows


def cost_chart(path, rows):
    of, panels = charts.figure(760, 420)
    panel = panels[0, 0]
    for color, name, unit in ((charts.COLORS[1], "walk", "rays"), (charts.COLORS[2], "table", "nm")):
        steps, times, errors = zip(*rows[name])
        panel.loglog(times, errors, "o-", color=color, label={"walk": "walk, by rays for each pair", "table": "table, by its step"}[name])
        for step, time, error in zip(steps, times, errors):
            panel.annotate(f"{step:,} {unit}", (time, error), textcoords="offset points", xytext=(6, 5))
    panel.margins(0.16, 0.12)
    panel.axvline(rows["solution"], color="black", linestyle="--", label="solution, without noise")
    panel.set(xlabel="CPU time (s)", ylabel="RMS error over the mean of Mb and Mf (%)")
    charts.legend(of, panel, 3)
    charts.save(of, path)


def write_cost(options):
    with tempfile.TemporaryDirectory() as temporary:
        rows = cost(pathlib.Path(temporary), options.quick)
    cost_chart(options.docs / "images" / "fluorescence" / "cost.svg", rows)
    body = [["walk", f"{n:,} rays", f"{time:.2f} s", f"{error:.2g} %"] for n, time, error in rows["walk"]]
    body += [["table, every", f"{n} nm", f"{time:.2f} s", f"{error:.2g} %"] for n, time, error in rows["table"]]
    write_section(options.docs / "fluorescence.md", "fluorescence_cost", f"""## Error against time

Measured by `measurements/run fluorescence` on {machine()}: Mb and Mf of the soybean leaf for 9 wavelengths of excitation and 11 of
emission, on one thread, with the start of the program. The solution takes {rows["solution"]:.2f} s; errors are RMS differences from it,
relative to the mean.

{table(["method", "", "CPU time", "error"], body)}
![Error against CPU time of walk and table, and the time of the solution](images/fluorescence/cost.svg)
""", script="fluorescence")


def main():
    options = arguments("fluorescence", ("--reference", {"type": pathlib.Path, "required": True, "metavar": "FOLDER"}))
    write_cost(options)
    excitation = list(range(400, 751, 50 if options.quick else 5))
    emission = [640, 685, 740, 850] if options.quick else list(range(640, 851, 5))
    with tempfile.TemporaryDirectory() as temporary:
        found = {name: compare(pathlib.Path(temporary), options.reference, name, excitation, emission, 4 if options.quick else 12)
                 for name in LEAVES}
    chart(options.docs / "images" / "fluorescence" / "plates.svg", found, emission)

    def off(name, side, low, high):
        ours, theirs = (found[name][whose][side].sum(axis=0) for whose in ("ours", "theirs"))
        nm = numpy.array(emission)
        use = (nm >= low) & (nm <= high) & (theirs > 0)
        relative = 100 * (ours[use] / theirs[use] - 1)
        return f"{relative.min():+.1f} to {relative.max():+.1f} %"

    def at(name, excited, emitted):
        place = (excitation.index(excited), emission.index(emitted))
        return ", ".join(f"{100 * (found[name]['ours'][side][place] / found[name]['theirs'][side][place] - 1):+.0f}"
                         for side in (*SIDES, "both")) + " %"

    body, match, saturated, pairs = [], [], [], []
    chosen = [(e, f) for f in EMITTED_NM for e in (450, 550, 650)]
    for name, title in LEAVES.items():
        of = found[name]
        match.append([title, *(f"{max(abs(x)):.4f}" for x in (of["R"] - of["leaf"]["R"], of["T"] - of["leaf"]["T"],
                                                             of["R"] + of["T"] - of["leaf"]["R"] - of["leaf"]["T"]))])
        saturated.append([title, *(f"{deep[i]:.2f} ({clear[i]:.2f} to {opaque[i]:.2f})" for clear, deep, opaque in [of["depths"]]
                                   for i in range(len(SATURATED_NM)))])
        for low, high in ((640, 719), (720, 850)):
            body.append([title, f"{max(low, 645)} to {min(high, 845)}", off(name, "Mb", low, high), off(name, "Mf", low, high),
                         off(name, "both", low, high)])
        pairs.append([title, *(at(name, *pair) for pair in chosen)])
    program("goniophotometer", "abm,fluorescence=0.01", "--with", "leaf_solved,fluorescence=0.01", "--fluorescence", "-q",
            "--rays", "1e4" if options.quick else "1e6", "--plot", options.docs / "images/fluorescence/directions.svg")
    write_section(options.docs / "fluorescence.md", "fluorescence", f"""## Comparison with plates

Measured by `measurements/run fluorescence` on {machine()}, with matrices of the model Fluspect (SCOPE 2.x,
Christiaanvandertol/SCOPE @ e4c2e51, GPL-3.0, run as an oracle; no part of frond) for three leaves. The leaf here has the same
emission shape and share of chlorophyll, and at each wavelength the absorption that gives the same R + T for light within {CONE_DEG}° of the normal.
Largest differences of R and T that remain, from 400 to 850 nm:

{table(["leaf", "R", "T", "R + T"], match)}
Photons that leave each side, summed over excitation from 400 to 750 nm, relative to the plates:

{table(["leaf", "emission (nm)", "lit side, Mb", "other side, Mf", "both sides"], body)}
Mb, Mf and both sides for single wavelengths of excitation and emission:

{table(["leaf", *(f"{e} → {f} nm" for e, f in chosen)], pairs)}
From 720 nm on both sides together agree within a few percent; the share of each differs. A plate model scatters everywhere in the
mesophyll, the walk at its walls alone: light that is emitted in the mesophyll goes up or down with equal probability, and the
epidermis and the air space decide how much of it returns.

Below 720 nm up to about a third fewer photons leave the walk's leaf. There are two causes. First, R + T hardly determines
absorption where a leaf is nearly opaque. Optical depth of the mesophyll that gives R + T, and those that give {TOLERANCE} more and less:

{table(["leaf", *(f"{nm} nm" for nm in SATURATED_NM)], saturated)}
Second, a difference remains for excitation at 550 nm, where R + T determines absorption: absorption that gives the same R + T for
light from outside reabsorbs more of the light that is emitted inside. Short random searches over the structure (bifacial
leaves with and without the sieve effect, unifacial ones with it) found none that brings R, T, Mb and Mf together.

![Photons that leave each side of three leaves, and their difference from a plate model](images/fluorescence/plates.svg)
""")


if __name__ == "__main__":
    main()
