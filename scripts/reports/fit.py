"""Measured leaves by frond fit and by PROSPECT-D: docs/fit.md."""

import csv
import json
import os
import statistics
import time

os.environ.setdefault("OMP_NUM_THREADS", "1")  # CPU time of one core

import numpy
import prosail
import scipy.optimize

from tools import ROOT, cpu_seconds, frond, machine, rows, table

REFERENCE = ROOT / "tests" / "reference"
CHARTS = ROOT / "docs" / "images" / "fit"

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
chart. Errors are told by band. Each number has its standard error, which is wider where residuals go together along the spectrum,
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
    """Name and rows (wavelength, R, T) of each."""
    spectra = {}
    with open(REFERENCE / "leaf_spectra.csv", encoding="utf-8") as file:
        for row in csv.DictReader(line for line in file if not line.startswith("#")):
            spectra.setdefault(row["leaf"], []).append((float(row["wavelength_nm"]), float(row["R"]), float(row["T"])))
    with open(REFERENCE / "lopex93_soybean.csv", encoding="utf-8") as file:
        rows = csv.DictReader(line for line in file if not line.startswith("#"))
        spectra["soybean"] = [(float(r["wavelength_nm"]), float(r["R_mean"]), float(r["T_mean"])) for r in rows]
    return dict(sorted(spectra.items()))


def by_frond(name):
    words = ["fit", REFERENCE / "lopex93_soybean.csv"] if name == "soybean" else ["fit", REFERENCE / "leaf_spectra.csv", "--leaf", name]
    chart = CHARTS / f"{name.split('_')[0]}.svg"
    text, seconds = cpu_seconds(lambda: frond(*words, "--json", "-", "-q", "--threads", 1))
    frond(*words, "--plot", chart, "-q")
    return json.loads(text), seconds


# N, chlorophyll (ug/cm2), carotenoids, brown pigments, water (cm), dry matter (g/cm2), anthocyanins.
LEAST = numpy.array([1, 0, 0, 0, 1e-4, 1e-4, 0])
MOST = numpy.array([4, 150, 40, 5, 0.1, 0.05, 20])
STARTS = ([1.5, 40, 8, 0.1, 0.012, 0.005, 1], [2.2, 20, 5, 0.5, 0.02, 0.01, 1], [1.2, 60, 12, 0.01, 0.006, 0.003, 0.5],
          [3, 30, 8, 0.1, 0.015, 0.015, 1])


def by_prospect(rows):
    nm, r, t = (numpy.array(column) for column in zip(*rows))

    def residuals(x):
        n, cab, car, brown, water, dry, ant = x
        wavelengths, rho, tau = prosail.run_prospect(n, cab, car, brown, water, dry, ant=ant, prospect_version="D")
        return numpy.concatenate([numpy.interp(nm, wavelengths, rho) - r, numpy.interp(nm, wavelengths, tau) - t])

    start = time.process_time()
    best = min((scipy.optimize.least_squares(residuals, s, bounds=(LEAST, MOST), x_scale=(MOST - LEAST) / 10) for s in STARTS),
               key=lambda found: found.cost)
    seconds = time.process_time() - start
    return float(numpy.sqrt(numpy.mean(best.fun**2))), seconds


SIX_NM = (450, 550, 660, 720, 840, 1650)


def rmse_of(leaf, rows_):
    """Of the leaf's R and T at 8 degrees against rows (wavelength, R, T)."""
    nm = ",".join(f"{w:g}" for w, _, _ in rows_)
    found = rows(frond("table", "--specimen", "soybean", *leaf, "--wavelengths", nm, "--angles", "8", "-q", "-o", "-"))
    differences = [d for f, (_, r, t) in zip(found, rows_) for d in (f["Rs"] + f["Rd"] - r, f["T"] - t)]
    return float(numpy.sqrt(numpy.mean(numpy.square(differences))))


def numbers_of(fitted):
    return [f"{row['name']}={row['value']}" for row in fitted["leaf"]] + [f"sieve={'true' if fitted['sieve'] else 'false'}"]


def six_numbers(soybean):
    """What six bands of R tell, beside all of the spectrum: values for the page."""
    folder = ROOT / "build" / "fit"
    path = folder / "six_bands.csv"
    path.write_text("wavelength_nm,R\n" + "".join(f"{w:g},{r}\n" for w, r, _ in soybean if w in SIX_NM))
    six = json.loads(frond("fit", path, "--like", "soybean", "--json", "-", "-q"))
    whole = json.loads(frond("fit", REFERENCE / "lopex93_soybean.csv", "--json", "-", "-q"))

    def chlorophyll(fitted):
        number = next(n for n in fitted["numbers"] if n["name"] == "chlorophylla")
        return f"{number['value']:.2f} kg/m³ ± {100 * number['relative_standard_error']:.0f} %"

    return {"six_chlorophyll": chlorophyll(six), "all_chlorophyll": chlorophyll(whole),
            "six_rmse": rmse_of(numbers_of(six), soybean), "all_rmse": rmse_of(numbers_of(whole), soybean),
            "like_rmse": rmse_of([], soybean)}


def main():
    CHARTS.mkdir(parents=True, exist_ok=True)
    by_prospect(next(iter(leaves().values())))  # compiles, which is nobody's fit
    body, ours, theirs, times, their_times = [], [], [], [], []
    for name, rows in leaves().items():
        found, seconds = by_frond(name)
        rmse, their_seconds = by_prospect(rows)
        ours.append(found["rmse"]), theirs.append(rmse), times.append(seconds), their_times.append(their_seconds)
        body.append([name.split("_")[0], f"{found['rmse']:.4f}", f"{found['rmse_R']:.4f}", f"{found['rmse_T']:.4f}",
                     found["structure"] + (", sieve" if found["sieve"] else ""), f"{seconds:.1f} s", f"{rmse:.4f}",
                     f"{their_seconds:.1f} s"])
        print(*body[-1], flush=True)
    summary = (f"Median {statistics.median(ours):.4f}, worst {max(ours):.4f}, {statistics.median(times):.1f} s; PROSPECT-D median "
               f"{statistics.median(theirs):.4f}, worst {max(theirs):.4f}, {statistics.median(their_times):.1f} s. frond is nearer in "
               f"{sum(a < b for a, b in zip(ours, theirs))} of {len(ours)}.")
    charts = "".join(f"![{row[0]}, measured and fitted](images/fit/{row[0]}.svg)\n" for row in body)
    version = __import__("importlib.metadata", fromlist=["version"]).version("prosail")
    text = PAGE.format(machine=machine(), version=version, leaves=table(["leaf", "frond", "R", "T", "as", "CPU", "PROSPECT-D", "CPU"], body), summary=summary,
                       charts=charts, **six_numbers(leaves()["soybean"]))
    (ROOT / "docs" / "fit.md").write_text(text, encoding="utf-8")
    print("Written: docs/fit.md")


if __name__ == "__main__":
    main()
