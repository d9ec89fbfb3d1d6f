"""Material "measured": how well a table repeats its leaf, and what it costs (section "measured" of docs/measured.md)

The table is that of a goniometer. Takes a minute.
  --quick   few samples, into build/measured_report
"""

import os
import pathlib
import shutil
import tempfile

import numpy

import frond

from .shared import charts
from .shared.tools import ROOT, arguments, machine, program, program_csv, table, write_section

LEAF, NM = "leaf_solved", 550
GRIDS = ((10, "20x40"), (5, "20x40"), (5, "40x80"))
INCIDENCES = (30, 35, 60, 65, 75, 145)


def measure(material, incidences, patches, *words):
    return program_csv("goniophotometer", material, "--angles", ",".join(map(str, incidences)), "--wavelengths", NM, "--integrate",
                       "--patches", patches, "--csv", "-", *words)


def repetition(folder):
    """RMS difference of f from the leaf's over each hemisphere, relative to the RMS of the leaf's f."""
    body, whole = [], measure(LEAF, INCIDENCES, "20x40")
    for step, patches in GRIDS:
        path = folder / f"{step}_{patches}.csv"
        path.write_text(program("goniophotometer", LEAF, "--angles", f"0:180:{step}", "--wavelengths", NM, "--integrate", "--patches",
                                patches, "--csv", "-"), encoding="utf-8")
        found = measure(f"measured,filename={path}", INCIDENCES, "20x40")
        for kind in ("BRDF", "BTDF"):
            row = [f"{step}°, {patches.replace('x', ' × ')}", kind]
            for incidence in INCIDENCES:
                use = (whole.kind == kind) & (whole.incidence_deg == incidence)
                weight, f, g = whole.projected_solid_angle_sr[use], whole.f_per_sr[use], found.f_per_sr[use]
                row.append(f"{100 * numpy.sqrt((weight * (g - f) ** 2).sum() / (weight * f**2).sum()):.1f}")
            body.append(row)
    return table(["table", ""] + [f"{i}°" for i in INCIDENCES], body)


def chart(path, points):
    """Relative variance of a sample against the time of a hit, by the label of a material. On a dashed line their product, the time
    to a given noise, is the same."""
    of, [[panel]] = charts.figure(640, 400)
    for hue, (label, (time, variance)) in zip(charts.COLORS, points.items()):
        panel.loglog(time, variance, "o", color=hue)
        panel.annotate(label.replace("`", ""), (time, variance), (0, 8), textcoords="offset points", ha="center", color=hue)
    times = numpy.array([30, 2000])
    for product in (10, 30, 100, 300, 1000):
        panel.plot(times, product / times, color="#aaaaaa", linewidth=1, linestyle="--", zorder=0)
    panel.annotate("dashed: equal time to equal noise", (0.02, 0.04), xycoords="axes fraction", color="#666666",
                   bbox={"color": "#ffffff", "pad": 1})
    panel.set(xlabel="CPU time of a hit, four wavelengths (ns)", ylabel="relative variance of a sample under the sky",
              xlim=times, ylim=(0.08, 1.5))
    charts.plain_ticks(panel.xaxis, [50, 100, 200, 500, 1000, 2000])
    charts.plain_ticks(panel.yaxis, [0.1, 0.2, 0.5, 1])
    charts.save(of, path)


def cost(folder, options):
    path = folder / "leaf.csv"
    path.write_text(program("goniophotometer", LEAF, "--angles", "0:180:10", "--wavelengths", "430:640:30", "--integrate", "--csv", "-"),
                    encoding="utf-8")
    shutil.copy(ROOT / "tests" / "pbrt_reference" / "metal.bsdf", folder)
    names = {LEAF: f"`{LEAF}`", "measured,filename=leaf.csv": "`measured`, table of this leaf",
             "measured,filename=metal.bsdf": "`measured`, metal.bsdf",
             "conductor,reflectance=0.6,roughness=0.4,remaproughness=false": "`conductor`, the same roughness"}
    first, *others = names
    os.chdir(folder)  # the names of materials are short
    result = frond.bench(first, with_=others, angles=45, lanes=4, samples=20000 if options.quick else 400000,
                         repetitions=3 if options.quick else 10)
    times, worth = (result.tables[name].set_index("material") for name in ("times", "worths"))
    chart(options.docs / "images" / "measured.svg",
          {label: (times.hit_ns[name], worth.sky_variance[name] / worth.sky[name] ** 2) for name, label in names.items()})
    body = [[label, *(f"{times[c][name]:.0f}" for c in ("sample_ns", "f_ns", "pdf_ns", "hit_ns")),
             f"{worth.sky_variance[name] / worth.sky[name] ** 2:.3f}"] for name, label in names.items()]
    return table(["material", "`sample`, ns", "`f`, ns", "`pdf`, ns", "hit, ns", "relative variance under the sky"], body)


def main():
    options = arguments("measured")
    page = options.docs / "measured.md"
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name).resolve()
        write_section(page, "measured", f"""A table of `{LEAF}` (soybean, {NM} nm), as `frond goniophotometer` integrates it at angles of
incidence in steps of 10° or 5° and with 20 × 40 or 40 × 80 patches, is measured again. Numbers are RMS differences of f from that
of the leaf, in patches of 20 × 40, in per cent of the RMS of f, by angle of incidence: 30° and 60° are
angles of every table, the others of those in steps of 5°.

{repetition(folder)}
The errors are those of linear interpolation: they are largest for the BRDF toward the horizon, where the reflection at the surface
is narrow, and fall with the square of the size of the patches. R and T are those of the table at its own angles.

Cost at 45°, four wavelengths ([frond bench](performance.md#frond-bench-cost-and-noise-of-a-material)); {machine()}.

{cost(folder, options)}
![Variance against time of measured and modelled materials](images/measured.svg)
""")


if __name__ == "__main__":
    main()
