"""What abm converges to, as leaf_solved has it, against walks."""

import json
import math

from tools import BUILD, number, run, table
from validation_plane import plane_chart
from validation_report import LEAVES

CHART_ANGLES = {"adaxial": (0, 30, 45, 60, 80), "abaxial": (180, 150, 135, 120, 100)}


def solution(report):
    rays = report.rays(1e8)
    cases = patch_cases(report, rays)
    squares, freedom, default = (sum(number(c[k]) for c in cases) for k in ("chi_square", "freedom", "default_chi_square"))
    worst, default_worst = (max(number(c[k]) for c in cases) for k in ("largest", "default_largest"))
    report.add(f"""
## The solution against walks

`leaf_solved` is what `abm` converges to (docs/solved_leaf.md). Here f is integrated over each of 20 x 40 patches and set
beside the rays that the goniophotometer of `abm` catches there, analog and in single precision: nothing is left but the
noise of the walks, whose variance the solution tells too. At 30, 60 and 80° on both sides, four wavelengths, both leaves,
{rays} rays each, and ten times as many at one setting of each leaf. The solution is at a tolerance of 1e-5.

Counts are multinomial: one chi-square a run, over the patches (pooled until they expect 5 rays) and the rays that were
absorbed, and the patch that is furthest off, by its exact binomial chance as standard errors of a normal variable. With
other seeds a sound program would have a chi-square beyond the test's limit in 1 % of 48 runs, and a patch of
{len(cases) - 2} x 800 beyond 5.2 standard errors in 0.8 %. L2: relative difference of f over the sphere, and what the walks'
noise alone makes of it. What the solution or the walk's single precision had wrong would grow with the rays.

All {len(cases)} runs together: chi-square {squares:.0f} of {freedom:.0f} ({(squares - freedom) / math.sqrt(2 * freedom):+.1f} standard
deviations), the furthest patch {worst:.1f} standard errors off. The table of the default tolerance, 5e-4:
{default:.0f} ({(default - freedom) / math.sqrt(2 * freedom):+.1f}) and {default_worst:.1f}.
""")
    report.add(table(["leaf", "light at", "nm", "rays", "degrees of freedom", "chi-square", "p", "furthest patch", "L2",
                      "of noise", "chi-square of the default table"],
                     [[c["leaf"], c["theta_deg"] + "°", c["nm"], c["rays"], c["freedom"], f"{number(c['chi_square']):.0f}",
                       f"{number(c['p']):.2g}", f"{number(c['largest']):.1f}", f"{100 * number(c['l2']):.2f} %",
                       f"{100 * number(c['l2_noise']):.2f} %", f"{number(c['default_chi_square']):.0f}"] for c in cases]))
    chart_rays = report.rays(1e6)
    report.add(f"""
In the plane of incidence: lines are `leaf_solved`, integrated over the patches, points `abm` by {chart_rays} rays. Bars are
one standard error; below each panel stand the differences in standard errors. These are estimated from the rays caught,
and come out too small where those are few: the largest differences are negative.
""")
    for leaf in LEAVES:
        for side, angles in CHART_ANGLES.items():
            plane_chart(report, leaf, side, angles, chart_rays)


def patch_cases(report, rays):
    """The test's own figures."""
    path = report.folder / "patches.json"
    run("env", "FROND_SLOW_TESTS=1", f"FROND_PATCH_RAYS={rays}", BUILD / "tests" / "test_instruments",
        "--gtest_filter=*SolvedLeafAgainst*", f"--gtest_output=json:{path}")
    found = json.loads(path.read_text())
    path.unlink()
    return [case for suite in found["testsuites"] for case in suite["testsuite"]]
