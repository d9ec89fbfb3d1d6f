"""R and T of leaves from 400 to 2500 nm, beside measured ones."""

from tools import COLORS, ROOT, block, frond, rows, table
from validation_report import LEAVES, rms


def spectrum(leaf, sieve):
    """R and T of both sides at 8 degrees, by wavelength: {(nm, theta): (R, T)}."""
    text = frond("table", "--specimen", leaf, f"sieve={'true' if sieve else 'false'}", "--wavelengths", "400:2500:10",
                 "--angles", "8,172", "-q", "-o", "-")
    return {(r["wavelength_nm"], r["theta_deg"]): (r["Rs"] + r["Rd"], r["T"]) for r in rows(text)}


def measured_leaf():
    """LOPEX93, mean and range of five soybean leaves."""
    return rows((ROOT / "tests" / "reference" / "lopex93_soybean.csv").read_text())


def spectra(report):
    report.add(f"""
## Spectra, 400 to 2500 nm

Reflectance R and transmittance T at 8° from the normal, solved at every 10 nm with the optical constants of Baranoski
(2006). R is drawn from below, T from above: what lies between the curves is absorbed. Grey: the mean and the range of
five soybean leaves (LOPEX93, Hosgood et al. 1994), which have their own thickness and chemistry; no parameter of the
model was fitted to them. "Sieve" is the later form of Beer's law (Baranoski and Eng 2007).
""")
    lopex = measured_leaf()
    figures = []
    for leaf in LEAVES:
        curves = {sieve: spectrum(leaf, sieve) for sieve in (False, True)}
        draw_spectra(report, leaf, curves, lopex)
        for sieve, curve in curves.items():
            for theta, side in ((8, "adaxial"), (172, "abaxial")):
                cells = [leaf, side, "on" if sieve else "off"]
                for low, high in ((400, 700), (700, 1300), (1300, 2500)):
                    inside = [r for r in lopex if low <= r["wavelength_nm"] <= high]
                    for i, name in enumerate(("R_mean", "T_mean")):
                        cells.append(f"{rms(curve[r['wavelength_nm'], theta][i] - r[name] for r in inside):.3f}")
                if leaf == "soybean":
                    figures.append(cells)
    report.add("RMS difference from the measured soybean leaves, by band:\n")
    report.add(table(["leaf", "side", "sieve", "R 400-700", "T 400-700", "R 700-1300", "T 700-1300", "R 1300-2500",
                      "T 1300-2500"], figures))


def draw_spectra(report, leaf, curves, lopex):
    data, plots = "", []
    if leaf == "soybean":
        data += block("lopex", [(r["wavelength_nm"], r["R_min"], r["R_max"], 1 - r["T_max"], 1 - r["T_min"],
                                 r["R_mean"], 1 - r["T_mean"]) for r in lopex])
        plots += ["$lopex using 1:2:3 with filledcurves fc rgb '#d0d0d0' title 'LOPEX93 soybean, range'",
                  "$lopex using 1:4:5 with filledcurves fc rgb '#d0d0d0' notitle",
                  "$lopex using 1:6 with lines lw 1.5 lc rgb '#808080' title 'LOPEX93 soybean, mean'",
                  "$lopex using 1:7 with lines lw 1.5 lc rgb '#808080' notitle"]
    for s, (sieve, curve) in enumerate(curves.items()):
        for t, (theta, side) in enumerate(((8, "adaxial"), (172, "abaxial"))):
            name = f"c{s}{t}"
            data += block(name, [(nm, r, 1 - tr) for (nm, th), (r, tr) in sorted(curve.items()) if th == theta])
            style = f"lines lw 2 lc rgb '{COLORS[1 + t]}'" + (" dt (6,4)" if sieve else "")
            plots += [f"${name} using 1:2 with {style} title '{side}{', sieve' if sieve else ''}'",
                      f"${name} using 1:3 with {style} notitle"]
    report.chart(f"spectra-{leaf}", f"R and 1 - T of {leaf}", data + f"""
set title '{leaf}, light at 8°'
set xlabel 'wavelength (nm)'
set ylabel 'reflectance R'
set y2label 'transmittance T'
set xrange [400:2500]
set yrange [0:1]
set y2range [1:0]
set ytics 0.2 nomirror
set y2tics 0.2
set key at screen 0.5,0.015 bottom center horizontal nobox maxrows 2
set bmargin 7
plot {', '.join(plots)}
""", (900, 640))
