"""Two ways to the same figures: walks against walks, f against sample."""

import json
import math

from tools import BUILD, frond, number, rows, run, table
from validation_report import LEAVES


def readings(material, angles, wavelengths, rays, *options):
    text = frond("spectrophotometer", material.replace(" ", ","), "--angles", angles, "--wavelengths", wavelengths, "--rays", rays,
                 "--csv", "-", "-q", *options)
    return {(r["theta_deg"], r["wavelength_nm"]): r for r in rows(text)}


def z_scores(a, b, names=("R", "T")):
    return [(a[k][n] - b[k][n]) / math.hypot(a[k][n + "_se"], b[k][n + "_se"]) for k in a for n in names]


def walks(report):
    rays = report.rays(1e7)
    body = []
    for leaf in LEAVES:
        measured = [readings(f"abm specimen={leaf} mode={mode}", "0,30,60,85,120,180", "455,551,608,800", rays)
                    for mode in ("analog", "weighted")]
        z = z_scores(*measured)
        body.append([f"{leaf}: weighted against analog absorption, R and T", f"{rays} rays each", len(z),
                     f"{sum(x * x for x in z):.0f}", f"{max(map(abs, z)):.1f}"])
    body += heroes(report)
    report.add("""
## Walks against walks

Each row compares two ways to the same figures: the sum of squared differences in standard errors should be near the
number of comparisons (its own standard deviation is the root of twice that number).

Hero wavelengths: four wavelengths whose indices differ far more than any leaf's (cuticle 1.3 to 1.7) on one walk, in
detectors all over the sphere, against walks of one wavelength; "wide" is soybean with lobes of exponent 0.
""")
    report.add(table(["comparison", "effort", "comparisons", "chi-square", "largest, in standard errors"], body))


def heroes(report):
    """The test's own figures, with more rays."""
    path = report.folder / "heroes.json"
    run("env", f"FROND_HERO_RAYS={'1e5' if report.quick else '3e6'}", BUILD / "tests" / "test_leaf",
        "--gtest_filter=*SpectralWalk.Fills*", f"--gtest_output=json:{path}")
    found = json.loads(path.read_text())
    path.unlink()
    body = []
    for suite in found["testsuites"]:
        for case in suite["testsuite"]:
            body.append([f"{case['leaf']}: hero walks, {case['absorption']}, light at {case['theta_deg']}°",
                         f"{number(case['rays']):.0e} rays each", case["comparisons"],
                         f"{number(case['chi_square']):.0f}", f"{number(case['largest']):.1f}"])
    return body


def f_against_sample(report):
    body = []
    samples = report.rays(1e6).replace("e+0", "e")
    for material in ("abm", "abm mode=weighted", "abm specimen=maize", "abm incident=light", "leaf_solved",
                     "leaf_solved specimen=maize", "leaf_solved incident=light", "leaf_simplified",
                     "leaf_simplified incident=light", "diffusetransmission"):
        text = frond("conform", material.replace(" ", ","), "--samples", samples, "--json", "-")
        for law in json.loads(text)["laws"]:
            if law["law"] in ("sampling", "unbiasedness", "energy") and law["worst_p"] is not None:
                body.append([f"`{material}`", law["law"], law["tests"], f"{law['worst_p']:.2g}", law["verdict"]])
    report.add(f"""
## `f` against `sample`

The laws of `frond conform`, {samples} samples for each direction of incidence (0, 30, 60, 80, 89° on both sides), at
608, 551 and 455 nm. *Unbiasedness*: in every bin of the sphere the mean weight of `sample` is the integral of `f` times
the cosine. *Sampling*: directions are distributed as `pdf`. *Energy*: no more comes out than went in. The p-value is
the smallest of so many tests: about one over their number is what chance gives.
""")
    report.add(table(["material", "law", "tests", "smallest p", ""], body))
