"""Measured leaves by frond fit and by PROSPECT-D: docs/fit.md."""

import json
import os
import time
from importlib.metadata import version

os.environ.setdefault("OMP_NUM_THREADS", "1")  # CPU time of one core

import numpy
import pandas
import prosail
import scipy.optimize

import charts
import frond
from tools import FROND, ROOT, Use, arguments, machine, program_csv, rms, table, write

REFERENCE = ROOT / "tests" / "reference"

PAGE = """# A leaf of your own

`frond fit` makes a leaf of measured reflectance and transmittance: the leaf whose solved walk comes nearest to them.

```
frond fit leaf.csv -o leaf.pbrt --plot leaf.svg
frond render scene.pbrt        # with: Include "leaf.pbrt"
```

**What it takes.** CSV as `frond spectrophotometer` writes it, or as spectroradiometers export it: a line of names (`wavelength`,
`R` or `reflectance`, `T` or `transmittance`, and if there are such `theta_deg`, `side`, `leaf`; other columns are passed over), or
two or three columns without names; between commas, semicolons, tabs or spaces; shares or percent, nanometres or micrometres. R
alone, T alone or both, any range within 360 to 2500 nm (the rest is left out, with a warning), one or more angles, one side or
both. `--angle` is the angle of incidence where the file does not say it, 8° as in an integrating sphere.

**What it finds.** Chlorophyll, carotenoids, protein, cellulose with lignin and the thickness, which tells the water; what else
absorbs, at every wavelength alike (`otherabsorption`: the published model has none, and leaves of starch, sugars and tannins are
too bright in the infrared by it); the aspect ratios of the cells' caps; bifacial or unifacial, with or without the sieve effect,
whichever fits better (`--structure`, `--sieve` say it). `--fix chlorophylla=3.9` keeps what is known. `--like soybean` expects numbers near that specimen's, within a
third or so.

**What it gives.** A `Material` line (`-o`; `--material` names another than `leaf`), a table for people, `--json`, `--csv`, and a
chart. Errors are reported by band. Each number has its standard error, which is wider where residuals go together along the spectrum,
as a model's errors do; numbers that the data do not tell are named, as are pairs that cannot be told apart. These are no measurement: a
number with "not told by the data" behind it only completes the leaf. Chlorophylls a and b absorb alike in this model, as do
cellulose and lignin: the second follows the first by the specimen's ratio. The thickness and `mesophyllfraction` act by their
product, so the fraction is the specimen's. What the cuticle does, R and T do not tell.

**How.** All of the chemistry acts through one optical depth at each wavelength. For one structure R and T are solved over depth and
refractive indices, twelve depths by nine wavelengths for the search, 24 by 21 for its end; derivatives by every concentration
follow from their slopes. Levenberg and Marquardt's method begins with three structures of each kind of leaf, chemistry alone free; the two best
kinds go on with the structure free, the best one by the finer table. A residual beyond 0.06 counts by its distance, not
by its square. At the end R and T are solved anew at every reading.

**Specimens.** The seven leaves below are in the library: `"string specimen" "walnut"` (`frond list specimens`). A leaf of your own is
the file that `-o` writes, by `Include`.

## Beside PROSPECT-D

Written by `scripts/fit`. {machine}. PROSPECT-D (prosail {version}) has seven numbers to fit: N, chlorophyll, carotenoids, anthocyanins,
brown pigments, water, dry matter; by SciPy's `least_squares` within their ranges, from four starts. Its coefficients were found by
fitting measured leaves; frond's constants are those that the model's authors use. All leaves but grape and toyon are of LOPEX93.
RMSE of R and T together, 400 to 2500 nm; CPU time of a fit on one core, of frond with starting the program.

{leaves}
{summary}

{charts}
## Of six numbers

What a multispectral camera has of a leaf: R of LOPEX93's soybean at 450, 550, 660, 720, 840 and 1650 nm, no T. Fitted with
`--like soybean`, the leaf of Baranoski 2006, it tells chlorophyll a as {six_chlorophyll}; all of the spectrum, {all_chlorophyll}. All that was
measured from 400 to 2500 nm, T included, the leaf of six numbers meets to an RMSE of {six_rmse:.4f}; the soybean of Baranoski 2006
to {like_rmse:.4f}; the leaf of all numbers to {all_rmse:.4f}.

## What it cannot do

- At the red edge, 700 to 750 nm, R of all fits but grape's is too dark by about 0.02. Tried and not kept: chlorophyll's absorption
  shifted by 2 or 3 nm, without the carotenoids' tail beyond 560 nm, or steeper. Each moves the median RMSE by less than 0.0004.
- Grape and toyon are darker in the visible, and maize is brighter, than any structure of the model with the right infrared.
- Bad points are the measurements' own: grape has R = 0 beyond 2450 nm, toyon 0.16 at 400 nm. They count by their distance.
- Every number may be off by more than its standard error says where the model itself is: the errors are those of the fit.
- The structure is hardly told by R and T from one side: aspect ratios trade with each other, as the correlations say.
"""


def leaves():
    """By name: wavelength_nm, R and T."""
    spectra = dict(iter(pandas.read_csv(REFERENCE / "leaf_spectra.csv", comment="#").groupby("leaf")))
    soybean = pandas.read_csv(REFERENCE / "lopex93_soybean.csv", comment="#")
    spectra["soybean"] = soybean.rename(columns={"R_mean": "R", "T_mean": "T"})
    return {name: spectra[name][["wavelength_nm", "R", "T"]] for name in sorted(spectra)}


def by_frond(name):
    """What the program finds, and its CPU time."""
    words = ["lopex93_soybean.csv"] if name == "soybean" else ["leaf_spectra.csv", "--leaf", name]
    use = Use(FROND, "fit", REFERENCE / words[0], *words[1:], "--json", "-", "-q", "--threads", 1)
    return json.loads(use.output), use.cpu


def draw(path, name, fitted):
    spectra = pandas.DataFrame(fitted["spectra"])
    of, [[panel]] = charts.figure(900, 600)
    panel.plot(spectra.wavelength_nm, spectra.R_fitted, color=charts.COLORS[1], label="fitted")
    panel.plot(spectra.wavelength_nm, 1 - spectra.T_fitted, color=charts.COLORS[1])
    panel.plot(spectra.wavelength_nm, spectra.R, ".", color=charts.COLORS[0], markersize=3, label="measured")
    panel.plot(spectra.wavelength_nm, 1 - spectra["T"], ".", color=charts.COLORS[0], markersize=3)
    panel.set(title=f"{name}: RMSE {fitted['rmse']:.4f}", xlabel="wavelength (nm)", ylabel="reflectance R (from below)", ylim=(0, 1))
    transmittance = panel.secondary_yaxis("right", functions=(lambda y: 1 - y, lambda y: 1 - y))
    transmittance.set_ylabel("transmittance T (from above)")
    charts.legend(of, panel, 2)
    charts.save(of, path)


# N, chlorophyll (ug/cm2), carotenoids, brown pigments, water (cm), dry matter (g/cm2), anthocyanins.
LEAST = numpy.array([1, 0, 0, 0, 1e-4, 1e-4, 0])
MOST = numpy.array([4, 150, 40, 5, 0.1, 0.05, 20])
STARTS = ([1.5, 40, 8, 0.1, 0.012, 0.005, 1], [2.2, 20, 5, 0.5, 0.02, 0.01, 1], [1.2, 60, 12, 0.01, 0.006, 0.003, 0.5],
          [3, 30, 8, 0.1, 0.015, 0.015, 1])


def by_prospect(spectra):
    """RMSE, and CPU time."""
    def residuals(x):
        *numbers, anthocyanins = x
        nm, r, t = prosail.run_prospect(*numbers, ant=anthocyanins, prospect_version="D")
        return numpy.concatenate([numpy.interp(spectra.wavelength_nm, nm, r) - spectra.R,
                                  numpy.interp(spectra.wavelength_nm, nm, t) - spectra["T"]])

    start = time.process_time()
    best = min((scipy.optimize.least_squares(residuals, s, bounds=(LEAST, MOST), x_scale=(MOST - LEAST) / 10) for s in STARTS),
               key=lambda found: found.cost)
    return rms(best.fun), time.process_time() - start


SIX_NM = (450, 550, 660, 720, 840, 1650)


def rmse_of(leaf, spectra):
    """Of the leaf's R and T at 8 degrees."""
    found = program_csv("table", *leaf, "--wavelengths", ",".join(f"{nm:g}" for nm in spectra.wavelength_nm), "--angles", "8",
                        "-q", "-o", "-")
    return rms([found.Rs + found.Rd - spectra.R.to_numpy(), found["T"] - spectra["T"].to_numpy()])


def six_numbers(soybean):
    """What six bands of R tell, beside all of the spectrum: values for the page."""
    bands = soybean[soybean.wavelength_nm.isin(SIX_NM)]
    six = frond.fit(bands.wavelength_nm, R=bands.R.to_numpy(), like="soybean")
    whole = frond.fit(path=REFERENCE / "lopex93_soybean.csv")

    def chlorophyll(fitted):
        number = fitted.numbers.set_index("name").loc["chlorophylla"]
        return f"{number.value:.2f} kg/m³ ± {100 * number.relative_standard_error:.0f} %"

    return {"six_chlorophyll": chlorophyll(six), "all_chlorophyll": chlorophyll(whole),
            "six_rmse": rmse_of(six.material, soybean), "all_rmse": rmse_of(whole.material, soybean),
            "like_rmse": rmse_of(["specimen=soybean"], soybean)}


def main():
    options = arguments("fit")
    measured, rows = leaves(), []
    by_prospect(measured["soybean"])  # compiles, which is nobody's fit
    for name, spectra in measured.items():
        if options.quick and name != "soybean":
            continue
        (found, seconds), (rmse, their_seconds) = by_frond(name), by_prospect(spectra)
        leaf = name.split("_")[0]
        draw(options.docs / "images" / "fit" / f"{leaf}.svg", leaf, found)
        rows.append({"leaf": leaf, "rmse": found["rmse"], "R": found["rmse_R"], "T": found["rmse_T"],
                     "as": found["structure"] + (", sieve" if found["sieve"] else ""), "cpu": seconds, "theirs": rmse,
                     "their_cpu": their_seconds})
        print(rows[-1], flush=True)
    found = pandas.DataFrame(rows)
    middle, worst = found.median(numeric_only=True), found.max()
    summary = (f"Median {middle.rmse:.4f}, worst {worst.rmse:.4f}, {middle.cpu:.1f} s; PROSPECT-D median {middle.theirs:.4f}, worst "
               f"{worst.theirs:.4f}, {middle.their_cpu:.1f} s. frond is nearer in {(found.rmse < found.theirs).sum()} of {len(found)}.")
    body = [[leaf, f"{rmse:.4f}", f"{r:.4f}", f"{t:.4f}", kind, f"{cpu:.1f} s", f"{theirs:.4f}", f"{their_cpu:.1f} s"]
            for leaf, rmse, r, t, kind, cpu, theirs, their_cpu in found.itertuples(index=False)]
    write(options.docs / "fit.md", PAGE.format(
        machine=machine(), version=version("prosail"), summary=summary,
        leaves=table(["leaf", "frond", "R", "T", "as", "CPU", "PROSPECT-D", "CPU"], body),
        charts="".join(f"![{leaf}, measured and fitted](images/fit/{leaf}.svg)\n" for leaf in found.leaf),
        **six_numbers(measured["soybean"])))


if __name__ == "__main__":
    main()
