"""Fits of measured leaves by frond fit and by PROSPECT-D (sections "fit" of docs/fit.md, "seasons" of docs/outdoors.md)

Leaves by PROSPECT's parameters are the section "prospect" of docs/leaf_models.md.
The section "reflectance" of docs/fit.md has the fits of R alone, with the leaf left out of their prior, and the prior of all leaves.
Also fits six bands, and a thousand leaves, and writes a chart of each leaf into docs/images/fit. Installs PROSPECT-D (prosail)
into build/fit by pip, and runs by that Python.
  --quick   one leaf, into build/fit_report
"""

import json
import os
import pathlib
import tempfile
import textwrap
import time
from importlib.metadata import version

os.environ.setdefault("OMP_NUM_THREADS", "1")  # CPU time of one core

import numpy
import pandas
import prosail
import scipy.optimize

import frond

from .rami import sun
from .shared import charts
from .shared.tools import FROND, ROOT, Use, arguments, machine, program, program_csv, rms, table, write_section
from .shared.turbid import turbid_layer

REFERENCE = ROOT / "tests" / "reference"

SECTION = """## Comparison with PROSPECT-D

Machine: {machine}.

All leaves except grape and toyon are from LOPEX93. PROSPECT-D (prosail {version}) has seven parameters to fit: N, chlorophyll,
carotenoids, anthocyanins, brown pigments, water and dry matter. SciPy's `least_squares` fits them within their ranges, from four
starts. Both models use the absorption spectra of PROSPECT-D, except for the plateau of dry matter. No number of frond is calibrated
with these seven leaves, so that leaving one out changes no fit of another.

RMSE of R and T together, and for frond also of R and of T alone, 400 to 2500 nm. CPU time of one fit on one core, for frond
including the start of the program:

{leaves}
{summary}

{charts}
## Fit to six bands

A multispectral camera measures few bands and no transmittance. The data of this fit are R of the LOPEX93 soybean at 450, 550, 660,
720, 840 and 1650 nm; the prior is `--like soybean`, the leaf of Baranoski 2006. RMSE is that of R and T together, over the full
measured spectrum from 400 to 2500 nm.

| leaf | chlorophyll a | RMSE |
|---|---|---|
| fitted to six bands of R | {six_chlorophyll} | {six_rmse:.4f} |
| fitted to the full spectrum of R and T | {all_chlorophyll} | {all_rmse:.4f} |
| soybean of Baranoski 2006, not fitted | – | {like_rmse:.4f} |

## A thousand leaves

{many}
"""

MANY = """`frond fit leaves.csv --all-leaves --csv fits.csv` of {count} made leaves took {minutes:.1f} CPU minutes, {each:.2f} s a leaf, on the
machine above. {failed} Each has R and T at 8° from 400 to 2500 nm in steps of 10 nm, as `frond table` solves
them, and noise with a standard deviation of {noise} (normal, independent, seed {seed}). Two thirds are bifacial, half have the sieve
effect; contents, structures and cuticles are drawn evenly in their logarithms:
{ranges}.

The RMSE of the fits has a median of {median:.4f} and is at most {largest:.4f}. Structure and sieve effect are those of the made leaf
for {kinds:.0f} % of the leaves. "Determined" counts the leaves whose relative standard error is below 50 %; the last two columns
are about these.

{recovered}"""


def leaves():
    """Returns the measured leaves by name: tables of wavelength_nm, R and T."""
    spectra = {name: table for file in ("lopex93_leaves.csv", "davis_leaves.csv")
               for name, table in pandas.read_csv(REFERENCE / file, comment="#").groupby("leaf")}
    soybean = pandas.read_csv(REFERENCE / "lopex93_soybean.csv", comment="#")
    spectra["soybean"] = soybean.rename(columns={"R_mean": "R", "T_mean": "T"})
    return {name: spectra[name][["wavelength_nm", "R", "T"]] for name in sorted(spectra)}


def by_frond(name):
    """Fits a leaf with frond; returns the program's JSON and its CPU time."""
    file = "davis_leaves.csv" if name in ("grape_0000", "toyon_0000") else "lopex93_leaves.csv"
    words = ["lopex93_soybean.csv"] if name == "soybean" else [file, "--leaf", name]
    use = Use(FROND, "fit", REFERENCE / words[0], *words[1:], "--json", "-", "-q", "--threads", 1)
    return json.loads(use.output), use.cpu


def draw(path, name, fitted):
    spectra = pandas.DataFrame(fitted["spectra"])
    of, [panels] = charts.figure(900, 340, 1, 2, sharey=True)
    for panel, quantity, what in zip(panels, "RT", ("reflectance R", "transmittance T")):
        panel.plot(spectra.wavelength_nm, spectra[quantity + "_fitted"], color=charts.COLORS[1])
        panel.plot(spectra.wavelength_nm, spectra[quantity], ".", color=charts.COLORS[0], markersize=3)
        panel.set(title=what, xlabel="wavelength (nm)", ylim=(0, 0.6))
    for row, (text, color) in enumerate((("dots: measured", charts.COLORS[0]), ("curve: fitted", charts.COLORS[1]))):
        panels[1].annotate(text, (0.97, 0.93 - 0.07 * row), xycoords="axes fraction", ha="right", color=color)
    panels[0].set_ylabel("share of the light")
    of.suptitle(f"{name}: RMSE {fitted['rmse']:.4f}", fontsize=10.5)
    charts.save(of, path)


# Order: N, chlorophyll (ug/cm2), carotenoids, brown pigments, water (cm), dry matter (g/cm2), anthocyanins.
LEAST = numpy.array([1, 0, 0, 0, 1e-4, 1e-4, 0])
MOST = numpy.array([4, 150, 40, 5, 0.1, 0.05, 20])
STARTS = ([1.5, 40, 8, 0.1, 0.012, 0.005, 1], [2.2, 20, 5, 0.5, 0.02, 0.01, 1], [1.2, 60, 12, 0.01, 0.006, 0.003, 0.5],
          [3, 30, 8, 0.1, 0.015, 0.015, 1])


def by_prospect(spectra, quantities="RT"):
    """Fits PROSPECT-D to R, T or both; returns the solution of SciPy."""
    def residuals(x):
        *numbers, anthocyanins = x
        nm, *shares = prosail.run_prospect(*numbers, ant=anthocyanins, prospect_version="D")
        return numpy.concatenate([numpy.interp(spectra.wavelength_nm, nm, share) - spectra[q]
                                  for q, share in zip("RT", shares) if q in quantities])

    return min((scipy.optimize.least_squares(residuals, s, bounds=(LEAST, MOST), x_scale=(MOST - LEAST) / 10) for s in STARTS),
               key=lambda found: found.cost)


#: Contents that R alone is to give, with their units and their places among PROSPECT's numbers.
ALONE = {"chlorophyll": ("µg/cm²", 1), "water": ("g/cm²", 4)}


def reflectance_alone(measured):
    """Fits each leaf's R alone, with the prior of the other leaves; returns the section of docs/fit.md."""
    rows, ratios, covered = [], {c: [] for c in ALONE}, {c: 0 for c in ALONE}
    with tempfile.TemporaryDirectory() as folder:
        for name, spectra in measured.items():
            others = pathlib.Path(folder) / "others.csv"
            pandas.concat([table.assign(leaf=other) for other, table in measured.items() if other != name]).to_csv(others, index=False)
            both = frond.fit(spectra.wavelength_nm, R=spectra.R, T=spectra["T"]).contents.set_index("name")
            alone = frond.fit(spectra.wavelength_nm, R=spectra.R, prior=others).contents.set_index("name")
            theirs = [by_prospect(spectra, quantities).x for quantities in ("RT", "R")]
            row = [name.split("_")[0]]
            for content, (_, place) in ALONE.items():
                value, error = alone.loc[content, ["value", "relative_standard_error"]]
                ratio = value / both.value[content]
                ratios[content].append(ratio)
                covered[content] += abs(numpy.log(ratio)) < 1.96 * error
                row += [f"{both.value[content]:.3g}", f"{value:.3g} ± {100 * error:.0f} %", f"{ratio:.2f}",
                        f"{theirs[1][place] / theirs[0][place]:.2f}"]
            rows.append(row)
        learned = frond.fit(spectra.wavelength_nm, R=spectra.R, prior=[others, write_leaf(folder, name, spectra)]).result
    within = {c: sum(abs(r - 1) < most for r in ratios[c]) for c, most in (("chlorophyll", 0.25), ("water", 0.2))}
    head = ["leaf"]
    for content, (unit, _) in ALONE.items():
        head += [f"{content}, R and T ({unit})", "R alone", "ratio", "ratio of PROSPECT-D"]
    prior = learned.tables["structure_prior"]
    return f"""{table(head, rows)}
The ratio is that of the fits to R alone and to R and T. Chlorophyll is within 25 % for {within["chlorophyll"]} of {len(rows)} leaves, water within 20 % for
{within["water"]}; the interval of 1.96 standard errors contains the fit of R and T for {covered["chlorophyll"]} and {covered["water"]}.

The built-in prior is that of all {len(rows)} leaves:

{table(["coordinate", "mean", "standard deviation"], [[row.name, f"{row.mean:.3f}", f"{row.deviation:.3f}"] for row in
       prior.set_axis(["name", "mean", "deviation"], axis=1).itertuples(index=False)])}
The residuals of these fits have an RMS of {learned.facts["prior_rmse"]:.4f} and are correlated over {learned.facts["prior_reach_nm"]:.0f} nm, so that few of them are independent. This is
the weight of the measurements beside the prior.
"""


#: Measurements in one direction: angles of incidence and view in degrees, and the azimuth between them.
CLIPS = {"12°, view 35° in the specular plane": (12, 35, 180), "12°, view 35° on the side of the light": (12, 35, 0),
         "35°, view 0°": (35, 0, 0), "12°, view 0°": (12, 0, 0)}
CLIP_LEAVES = ("soybean-lopex", "walnut", "lettuce", "tomato", "maize-lopex", "toyon")


def clips():
    """Fits reflectance factors in one direction of leaf_solved as if they were R; returns the section of docs/fit.md."""
    def direction(theta, phi):
        theta, phi = numpy.radians([theta, phi])
        return [numpy.sin(theta) * numpy.cos(phi), numpy.sin(theta) * numpy.sin(phi), numpy.cos(theta)]

    nm = numpy.arange(400, 2501, 20)
    offsets, ratios = {c: [] for c in CLIPS}, {c: [] for c in CLIPS}
    for specimen in CLIP_LEAVES:
        solved = program_csv("table", f"specimen={specimen}", "--wavelengths", ",".join(map(str, nm)), "--angles", "8", "-q", "-o", "-")
        r = (solved.Rs + solved.Rd).to_numpy()
        of_r = frond.fit(nm, R=r).contents.set_index("name").value
        leaf = frond.bsdf(f"leaf_solved,specimen={specimen}", nm)
        for clip, (incidence, view, azimuth) in CLIPS.items():
            factor = numpy.pi * numpy.asarray(leaf.f([direction(incidence, 0)], [direction(view, azimuth)]))[0]
            found = frond.fit(nm, R=factor).contents.set_index("name").value
            offsets[clip].append((factor - r).mean())
            ratios[clip].append([found[c] / of_r[c] for c in ALONE])
    body = []
    for clip in CLIPS:
        least, most = numpy.min(ratios[clip], axis=0), numpy.max(ratios[clip], axis=0)
        body.append([clip, f"{min(offsets[clip]):.3f} to {max(offsets[clip]):.3f}",
                     *(f"{low:.2f} to {high:.2f}" for low, high in zip(least, most))])
    return table(["incidence", "mean of factor - R", "chlorophyll over that of R", "water over that of R"], body)


def write_leaf(folder, name, spectra):
    path = pathlib.Path(folder) / "leaf.csv"
    spectra.assign(leaf=name).to_csv(path, index=False)
    return path


#: Leaves that PROSPECT-D computes: the numbers of run_prospect, and the anthocyanins.
SEASONS = {"green": ([1.5, 40, 8, 0, 0.01, 0.009], 0), "red": ([1.5, 20, 6, 0, 0.01, 0.009], 20),
           "brown": ([2.2, 5, 3, 0.8, 0.004, 0.012], 2)}
BANDS = ((500, 600), (600, 680), (680, 760))  # nm, where the leaves differ by their pigments


def seasons():
    """Fits leaves that PROSPECT-D computes; returns the section of docs/outdoors.md."""
    rows, spectra = [], {}
    for name, (numbers, anthocyanins) in SEASONS.items():
        nm, r, t = (v[::10] for v in prosail.run_prospect(*numbers, ant=anthocyanins, prospect_version="D"))
        fitted = frond.fit(nm, R=r, T=t)
        spectra[name] = fitted.spectra
        contents = fitted.contents.set_index("name")

        def found(content, contents=contents):
            value, error = contents.loc[content, ["value", "relative_standard_error"]]
            return f"{value:.2g}" if error < 0.5 else f"{value:.2g}, not determined"

        _, chlorophyll, carotenoids, brown, water, dry = numbers
        rows.append((f"{name}, as computed", chlorophyll, carotenoids, anthocyanins, brown, water, dry, ""))
        rows.append((f"{name}, as fitted", *map(found, ("chlorophyll", "carotenoids", "anthocyanins", "brownpigments", "water",
                                                        "drymatter")), f"{fitted.rmse:.4f}"))
    differences = []
    for name in ("red", "brown"):
        for least, most in BANDS:
            band = spectra["green"].wavelength_nm.between(least, most)

            def change(r, t, name=name, band=band):
                return [(spectra[name][q] - spectra["green"][q])[band].mean() for q in (r, t)]

            computed, fitted = change("R", "T"), change("R_fitted", "T_fitted")
            differences.append((f"{name}, {least} to {most} nm", *(f"{v:.3f}" for pair in zip(computed, fitted) for v in pair),
                                f"{sum(fitted) / sum(computed):.2f}"))
    return f"""PROSPECT-D by prosail {version("prosail")}, every 10 nm from 400 to 2500 nm. Contents:

{table(("leaf", "chlorophyll (µg/cm²)", "carotenoids", "anthocyanins", "brown pigments", "water (g/cm²)", "dry matter", "RMSE"), rows)}
Mean differences from the green leaf, and the ratio of their sums, that is of the absorptance:

{table(("leaf, band", "R, computed", "R, fitted", "T, computed", "T, fitted", "fitted over computed, R + T"), differences)}"""


SIX_NM = (450, 550, 660, 720, 840, 1650)


def rmse_of(leaf, spectra):
    """Returns the RMSE of the leaf's R and T at 8 degrees."""
    found = program_csv("table", ",".join(leaf), "--wavelengths", ",".join(f"{nm:g}" for nm in spectra.wavelength_nm), "--angles", "8",
                        "-q", "-o", "-")
    return rms([found.Rs + found.Rd - spectra.R.to_numpy(), found["T"] - spectra["T"].to_numpy()])


def six_numbers(soybean):
    """Fits the soybean to six bands of R and to the full spectrum; returns values for the page."""
    bands = soybean[soybean.wavelength_nm.isin(SIX_NM)]
    six = frond.fit(bands.wavelength_nm, R=bands.R.to_numpy(), like="soybean")
    whole = frond.fit(path=REFERENCE / "lopex93_soybean.csv")

    def chlorophyll(fitted):
        number = fitted.numbers.set_index("name").loc["chlorophylla"]
        return f"{number.value:.2f} kg/m³ ± {100 * number.relative_standard_error:.0f} %"

    return {"six_chlorophyll": chlorophyll(six), "all_chlorophyll": chlorophyll(whole),
            "six_rmse": rmse_of(six.material, soybean), "all_rmse": rmse_of(whole.material, soybean),
            "like_rmse": rmse_of(["specimen=soybean"], soybean)}


# Made leaves: contents per leaf area, and parameters of the materials.
RANGES = {"chlorophyll": (15, 70, "ug/cm2"), "carotenoids": (4, 15, "ug/cm2"), "anthocyanins": (0.3, 5, "ug/cm2"),
          "water": (0.005, 0.025, "g/cm2"), "drymatter": (0.15, 0.6, "of the water"), "otherabsorption": (60, 250, "1/m"),
          "epidermisaspect": (1, 12, ""), "spongyaspect": (1, 12, ""), "palisadeaspect": (1, 12, ""), "spongyshare": (0.02, 0.5, ""),
          "cuticlerefractivity": (0.85, 1.25, "")}
SEED, NOISE, WAVELENGTHS = 1, 0.003, "400:2500:10"
MESOPHYLL = 0.5  # share of the thickness, as the specimens have it


def made_leaf(rng):
    """Draws a leaf; returns its numbers as in RANGES, its kind (structure, sieve), and its words for frond table."""
    of = {name: float(numpy.exp(rng.uniform(numpy.log(low), numpy.log(high)))) for name, (low, high, _) in RANGES.items()}
    for name in of:
        if name.endswith("aspect"):
            of[name] = round(of[name])  # solved faster
    of["drymatter"] *= of["water"]
    kind = ("bifacial" if rng.random() < 2 / 3 else "unifacial", bool(rng.random() < 0.5))
    area = of["water"] * 10 / 1000  # m: water is 1000 kg/m3
    per_volume = {"chlorophyll": 1e-5, "carotenoids": 1e-5, "anthocyanins": 1e-5, "drymatter": 10}  # kg/m2 of a unit per area
    density = {name: of[name] * scale / area for name, scale in per_volume.items()}
    words = {"specimen": "soybean" if kind[0] == "bifacial" else "maize", "absorption": "prospect", "sieve": str(kind[1]).lower(),
             "thickness": area / MESOPHYLL, "mesophyllfraction": MESOPHYLL, "chlorophylla": 0.75 * density["chlorophyll"],
             "chlorophyllb": 0.25 * density["chlorophyll"], "protein": 0, "cellulose": 0, "lignin": 0,
             **{name: density[name] for name in ("carotenoids", "anthocyanins", "drymatter")},
             **{name: of[name] for name in ("otherabsorption", "epidermisaspect", "spongyaspect", "cuticlerefractivity")}}
    if kind[0] == "bifacial":
        words |= {name: of[name] for name in ("palisadeaspect", "spongyshare")}
    return of, kind, ",".join(f"{name}={value}" for name, value in words.items())


def many_leaves(count):
    """Makes and fits leaves; returns the text of the section about them."""
    rng = numpy.random.default_rng(SEED)
    made, spectra = [], []
    for i in range(count):
        of, kind, words = made_leaf(rng)
        made.append({"leaf": f"leaf{i}", "kind": kind, **of})
        solved = program_csv("table", words, "--wavelengths", WAVELENGTHS, "--angles", "8", "--nodes", "6", "--threads", 1, "-q",
                             "-o", "-")
        noise = NOISE * rng.standard_normal((2, len(solved)))
        spectra.append(pandas.DataFrame({"leaf": f"leaf{i}", "wavelength_nm": solved.wavelength_nm,
                                         "R": solved.Rs + solved.Rd + noise[0], "T": solved["T"] + noise[1]}))
    with tempfile.TemporaryDirectory() as folder:
        data, fits = pathlib.Path(folder) / "leaves.csv", pathlib.Path(folder) / "fits.csv"
        pandas.concat(spectra).to_csv(data, index=False, float_format="%.5f")
        use = Use(FROND, "fit", data, "--all-leaves", "--csv", fits, "-q", "--threads", 1)
        found = pandas.read_csv(fits, comment="#")
    fitted = found[found.status == "fitted"].merge(pandas.DataFrame(made), on="leaf", suffixes=("", "_made"))
    kinds = [(row.structure, row.sieve) == row.kind for row in fitted.itertuples()]
    return MANY.format(
        count=count, minutes=use.cpu / 60, each=use.cpu / count,
        failed="All were fitted." if len(fitted) == count else f"{len(found) - len(fitted)} could not be fitted.",
        noise=NOISE, seed=SEED, median=fitted.rmse.median(), largest=fitted.rmse.max(), kinds=100 * numpy.mean(kinds),
        ranges=textwrap.fill(", ".join(f"{name} {low:g} to {high:g} {unit}".rstrip() for name, (low, high, unit) in RANGES.items()), 130),
        recovered=recovered(fitted))


def recovered(fitted):
    """Returns a table of how the fits have found the numbers of the made leaves again."""
    body = []
    for name in RANGES:
        column = next((c for c in (f"{name}_ug_cm2", f"{name}_g_cm2") if c in fitted), name)
        truth = fitted[f"{name}_made"] if f"{name}_made" in fitted else fitted[name]
        value, error = fitted[column], fitted[f"{column}_se"] / fitted[column]
        there = value.notna() & (error < 0.5)
        if name in ("palisadeaspect", "spongyshare"):
            there &= numpy.array([structure == "bifacial" for structure, _ in fitted.kind])
        off = numpy.log(value[there] / truth[there])
        body.append([name, f"{100 * there.sum() / value.notna().sum():.0f} %", f"{100 * off.abs().median():.2g} %" if there.any() else "–",
                     f"{100 * (off.abs() < 1.96 * error[there]).mean():.0f} %" if there.any() else "–"])
    return table(["number", "determined", "median error", "within 1.96 standard errors (95 % expected)"], body)


PLATE_NAMES = ("N", "Cab", "Car", "Cbrown", "Cw", "Cm", "Cant")  # in the order of run_prospect


#: A layer of small disks of a leaf by PROSPECT's parameters, repeated periodically.
LAYER = """Option "float period" [ 2 2 ]
WorldBegin
{sun}
Material "diffuse" "spectrum reflectance" [ 300 {soil} 2500 {soil} ]
Shape "bilinearmesh" "point3 P" [ 0 0 0  2 0 0  0 2 0  2 2 0 ]
Material "leaf_lambert" {leaf}
ObjectBegin "leaf" Shape "disk" ObjectEnd
Shape "instances" "string object" "leaf" "string filename" "layer.npy"
"""
CANOPY_LEAF = {"N": 1.5, "Cab": 40, "Car": 8, "Cw": 0.01, "Cm": 0.009}
LAI, SOIL, SUN, RADIUS, HEIGHT, RED_NIR = 3, 0.15, 30, 0.0125, 2, (670, 800)


def ndvi(r, t, draws, paths):
    """NDVI at the nadir of a canopy of this leaf, whose R and T at RED_NIR are given: mean and standard error over draws of leaves,
    and the solution of the turbid layer by doubling."""
    index = lambda brf: (brf[1] - brf[0]) / (brf[1] + brf[0])
    solution = index([turbid_layer(LAI, *shares, SOIL, SUN, [(0, 0)])[2][0] for shares in zip(r, t)])
    found = []
    with tempfile.TemporaryDirectory() as folder:
        scene = pathlib.Path(folder) / "layer.pbrt"
        leaf = " ".join(f'"float {name}" {value}' for name, value in CANOPY_LEAF.items())
        scene.write_text(LAYER.format(sun=sun(SUN), soil=SOIL, leaf=leaf))
        for seed in range(1, draws + 1):
            program("canopy", "-q", "-o", scene.with_name("layer.npy"), "--lai", LAI, "--angles", "spherical", "--scale", RADIUS,
                    "--size", "2,2", "--heights", f"{RADIUS},{HEIGHT - RADIUS}", "--seed", seed)
            found.append(index(frond.brf(scene, RED_NIR, zenith=[0], paths=paths, seed=seed).brf.to_numpy()))
    return numpy.mean(found), numpy.std(found, ddof=1) / draws**0.5, solution


def plates(count):
    """Compares leaves by PROSPECT's parameters with prosail; returns the section of docs/leaf_models.md."""
    rng, off, walks = numpy.random.default_rng(SEED), [], []
    for numbers in rng.uniform([1, 5, 0, 0, 0.002, 0.001, 0], [3, 90, 20, 1, 0.04, 0.02, 10], (count, 7)):
        *first, anthocyanins = numbers
        nm, r, t = (v[::10] for v in prosail.run_prospect(*first, ant=anthocyanins, prospect_version="D"))
        words = ",".join(f"{name}={value!r}" for name, value in zip(PLATE_NAMES, numbers.tolist()))
        leaf = frond.bsdf(f"leaf_lambert,{words}", nm)
        shares = numpy.pi * leaf.f([[0, 0, 1], [0, 0, 1]], [[0, 0.6, 0.8], [0, 0.6, -0.8]])
        off.append(max(abs(shares[0] - r).max(), abs(shares[1] - t).max()))
        walk = frond.fit(nm, R=r, T=t).spectra
        walks.append(numpy.abs(numpy.concatenate([walk.R_fitted - walk.R, walk.T_fitted - walk["T"]])))
    rmse, largest = [rms(w) for w in walks], [w.max() for w in walks]
    one = CANOPY_LEAF
    nm, r, t = prosail.run_prospect(one["N"], one["Cab"], one["Car"], 0, one["Cw"], one["Cm"], ant=0, prospect_version="D")
    mean, error, solution = ndvi(*([float(v[nm == at][0]) for at in RED_NIR] for v in (r, t)), *((4, 65536) if count > 5 else (2, 4096)))
    return f"""Measured by `measurements/run fit`, with {count} random leaves (N 1 to 3, Cab 5 to 90 µg/cm², Car up to 20, Cant up to 10, Cbrown up to 1,
Cw 0.002 to 0.04 cm, Cm 0.001 to 0.02 g/cm²), every 10 nm from 400 to 2500 nm. Largest difference of R and T from prosail
{version("prosail")}: {max(off):.1g}. The nearest walk differs by {numpy.median(rmse):.4f} (median of the leaves' RMS; worst {max(rmse):.4f}); the largest
difference of a leaf is {numpy.median(largest):.3f} (median; worst {max(largest):.3f}).

NDVI ({RED_NIR[0]} and {RED_NIR[1]} nm) at the nadir of a canopy of `leaf_lambert,{",".join(f"{k}={v}" for k, v in one.items())}`, disks of {100 * RADIUS:g} cm, leaf area
index {LAI}, spherical leaf angles, soil of reflectance {SOIL}, sun at {SUN}°: {mean:.4f} ± {error:.4f}. A turbid layer of leaves with prosail's R
and T, solved by doubling, has {solution:.4f}.
"""


def main():
    options = arguments("fit")
    measured, rows = leaves(), []
    by_prospect(measured["soybean"])  # prosail compiles at its first call: not part of a measured time
    for name, spectra in measured.items():
        if options.quick and name != "soybean":
            continue
        found, seconds = by_frond(name)
        start = time.process_time()
        rmse, their_seconds = rms(by_prospect(spectra).fun), time.process_time() - start
        leaf = name.split("_")[0]
        draw(options.docs / "images" / "fit" / f"{leaf}.svg", leaf, found)
        rows.append({"leaf": leaf, "rmse": found["rmse"], "R": found["rmse_R"], "T": found["rmse_T"],
                     "structure": found["structure"] + (", sieve" if found["sieve"] else ""), "cpu": seconds, "theirs": rmse,
                     "their_cpu": their_seconds})
        print(rows[-1], flush=True)
    found = pandas.DataFrame(rows)
    middle, worst = found.median(numeric_only=True), found.max()
    summary = (f"frond: median {middle.rmse:.4f}, worst {worst.rmse:.4f}, {middle.cpu:.2f} s. "
               f"PROSPECT-D: median {middle.theirs:.4f}, worst {worst.theirs:.4f}, {middle.their_cpu:.2f} s.\n"
               f"frond has the smaller RMSE for {(found.rmse < found.theirs).sum()} of {len(found)} leaves.")
    body = [[leaf, f"{rmse:.4f}", f"{r:.4f}", f"{t:.4f}", kind, f"{cpu:.2f} s", f"{theirs:.4f}", f"{their_cpu:.2f} s"]
            for leaf, rmse, r, t, kind, cpu, theirs, their_cpu in found.itertuples(index=False)]
    write_section(options.docs / "outdoors.md", "seasons", seasons(), script="fit")
    write_section(options.docs / "leaf_models.md", "prospect", plates(5 if options.quick else 50), script="fit")
    if not options.quick:
        write_section(options.docs / "fit.md", "reflectance", reflectance_alone(measured), script="fit")
        write_section(options.docs / "fit.md", "clips", clips(), script="fit")
    write_section(options.docs / "fit.md", "fit", SECTION.format(
        machine=machine(), version=version("prosail"), summary=summary,
        leaves=table(["leaf", "frond", "frond, R", "frond, T", "structure", "CPU of frond", "PROSPECT-D", "CPU of PROSPECT-D"],
                     body),
        charts="".join(f"![Reflectance and transmittance of {leaf}, measured and fitted](images/fit/{leaf}.svg)\n"
                       for leaf in found.leaf),
        **six_numbers(measured["soybean"]), many=many_leaves(20 if options.quick else 1000).strip()))


if __name__ == "__main__":
    main()
