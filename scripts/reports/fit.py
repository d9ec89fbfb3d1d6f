"""Section "fit" of docs/fit.md: measured leaves fitted by frond fit and by PROSPECT-D, and a fit to six bands."""

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
from tools import FROND, ROOT, Use, arguments, machine, program_csv, rms, table, write_section

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
"""


def leaves():
    """Returns the measured leaves by name: tables of wavelength_nm, R and T."""
    spectra = dict(iter(pandas.read_csv(REFERENCE / "leaf_spectra.csv", comment="#").groupby("leaf")))
    soybean = pandas.read_csv(REFERENCE / "lopex93_soybean.csv", comment="#")
    spectra["soybean"] = soybean.rename(columns={"R_mean": "R", "T_mean": "T"})
    return {name: spectra[name][["wavelength_nm", "R", "T"]] for name in sorted(spectra)}


def by_frond(name):
    """Fits a leaf with frond; returns the program's JSON and its CPU time."""
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
    panel.set(title=f"{name}: RMSE {fitted['rmse']:.4f}", xlabel="wavelength (nm)", ylabel="reflectance R (upward)", ylim=(0, 1))
    transmittance = panel.secondary_yaxis("right", functions=(lambda y: 1 - y, lambda y: 1 - y))
    transmittance.set_ylabel("transmittance T (downward)")
    charts.legend(of, panel, 2)
    charts.save(of, path)


# Order: N, chlorophyll (ug/cm2), carotenoids, brown pigments, water (cm), dry matter (g/cm2), anthocyanins.
LEAST = numpy.array([1, 0, 0, 0, 1e-4, 1e-4, 0])
MOST = numpy.array([4, 150, 40, 5, 0.1, 0.05, 20])
STARTS = ([1.5, 40, 8, 0.1, 0.012, 0.005, 1], [2.2, 20, 5, 0.5, 0.02, 0.01, 1], [1.2, 60, 12, 0.01, 0.006, 0.003, 0.5],
          [3, 30, 8, 0.1, 0.015, 0.015, 1])


def by_prospect(spectra):
    """Fits PROSPECT-D; returns the RMSE and the CPU time."""
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
    """Returns the RMSE of the leaf's R and T at 8 degrees."""
    found = program_csv("table", *leaf, "--wavelengths", ",".join(f"{nm:g}" for nm in spectra.wavelength_nm), "--angles", "8",
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


def main():
    options = arguments("fit")
    measured, rows = leaves(), []
    by_prospect(measured["soybean"])  # prosail compiles at its first call: not part of a measured time
    for name, spectra in measured.items():
        if options.quick and name != "soybean":
            continue
        (found, seconds), (rmse, their_seconds) = by_frond(name), by_prospect(spectra)
        leaf = name.split("_")[0]
        draw(options.docs / "images" / "fit" / f"{leaf}.svg", leaf, found)
        rows.append({"leaf": leaf, "rmse": found["rmse"], "R": found["rmse_R"], "T": found["rmse_T"],
                     "structure": found["structure"] + (", sieve" if found["sieve"] else ""), "cpu": seconds, "theirs": rmse,
                     "their_cpu": their_seconds})
        print(rows[-1], flush=True)
    found = pandas.DataFrame(rows)
    middle, worst = found.median(numeric_only=True), found.max()
    summary = (f"frond: median {middle.rmse:.4f}, worst {worst.rmse:.4f}, {middle.cpu:.1f} s. "
               f"PROSPECT-D: median {middle.theirs:.4f}, worst {worst.theirs:.4f}, {middle.their_cpu:.1f} s.\n"
               f"frond has the smaller RMSE for {(found.rmse < found.theirs).sum()} of {len(found)} leaves.")
    body = [[leaf, f"{rmse:.4f}", f"{r:.4f}", f"{t:.4f}", kind, f"{cpu:.1f} s", f"{theirs:.4f}", f"{their_cpu:.1f} s"]
            for leaf, rmse, r, t, kind, cpu, theirs, their_cpu in found.itertuples(index=False)]
    write_section(options.docs / "fit.md", "fit", SECTION.format(
        machine=machine(), version=version("prosail"), summary=summary,
        leaves=table(["leaf", "frond", "frond, R", "frond, T", "structure", "CPU of frond", "PROSPECT-D", "CPU of PROSPECT-D"],
                     body),
        charts="".join(f"![Reflectance and transmittance of {leaf}, measured and fitted](images/fit/{leaf}.svg)\n"
                       for leaf in found.leaf),
        **six_numbers(measured["soybean"])))


if __name__ == "__main__":
    main()
