"""Writes docs/paper.md: the experiments of Baranoski and Rokne's paper, their figures beside ours."""

import argparse
import math
import pathlib
import re
import shutil

from convergence import PAPER_RATIO, Ends
from paper_runs import CANDIDATES, FULL, MODELS, QUICK, SETS, SMOKE, Runs
from tools import BUILD, COLORS, ROOT, block, gnuplot, machine, table

CHANNELS = ("red", "green", "blue")
SHOWN = {"abm": "`abm`", "leaf_simplified": "`leaf_simplified`",
         "published": "`leaf_simplified`, `surfacedirect` false", "leaf_solved": "`leaf_solved`",
         "leaf_lambert": "`leaf_lambert`", "weighted": "`abm`, `mode` weighted"}
# Title, model, cutoff (None: solved for the set), and how gnuplot draws it.
CURVES = (
    ("abm, cutoff 0.01", "abm", 0.01, f"lc rgb '{COLORS[0]}' pt 7"),
    ("abm, no cutoff", "abm", 0, f"lc rgb '{COLORS[0]}' pt 6 dt 3"),
    ("leaf\\_simplified, cutoff 0.01", "leaf_simplified", 0.01, f"lc rgb '{COLORS[1]}' pt 5"),
    ("leaf\\_simplified, cutoff solved", "leaf_simplified", None, f"lc rgb '{COLORS[2]}' pt 9 dt 2"),
)


def triple(values, digits=4):
    return [f"{v:.{digits}f}" for v in values]


def thousands(count):
    return f"{count:,}"


def candidate(comparison, label):
    return next(c for c in comparison["candidates"] if c["label"] == label)


def last_errors(comparison, label):
    """By channel, of all pixels, on the last rung."""
    return candidate(comparison, label)["rungs"][-1]["all"]


# --- Figures 5 to 7 ----------------------------------------------------------------------------------------------------


def pictures(runs, images, measured):
    runs.sheet(images / "figures-5-7.jpg")
    samples = 2 * runs.setting.picture_samples
    body = []
    for s in SETS:
        seconds = {m: sum(r["cpu_seconds"] for r in measured[s.name]["pictures"][m]) for m in MODELS}
        foliar = measured[s.name]["pictures"]["abm"][0]["foliar_ratio"]
        body.append((s.order, s.title, f"{s.foliar_percent:.2f} %", f"{100 * foliar:.2f} %",
                     *(f"{seconds[m]:.0f} s" for m in MODELS)))
    return f"""
## Figures 5 to 7: the pictures

![Three sets of pictures, each with both models](images/paper/figures-5-7.jpg)

{samples} samples per pixel; left the ABM, right the simplified model. The plants, the light and the view are ours: the paper
does not describe its own. What is matched is what it states: a soybean leaf, which side is lit, ambient light alone in the
third set, and the foliar ratio, the share of pixels that see a leaf.

{table(("set", "light", "foliar ratio, paper", "ours", "CPU, `abm`", "CPU, `leaf_simplified`"), body)}
The paper gives one time, 95 minutes of CPU on an SGI R10000 for its Figure 7b; it does not say at how many pixels.
"""


# --- The table -------------------------------------------------------------------------------------------------------


def leaf_table(runs, tables):
    solved, sampled = tables["solve"], tables["montecarlo"]
    apart = [abs(a - b) for a, b in zip(solved["shares"], sampled["shares"])]
    rms = math.sqrt(sum(d * d for d in apart) / len(apart))
    return f"""
## The table of reflectances and transmittances

The paper samples it: {runs.setting.table_rays:.0e} rays at each degree from 0° to 180°, three wavelengths, 14.5 kB. So sampled
it takes {sampled['cpu_seconds']:.2g} s of CPU here; solved, as all the figures on this page have it, {solved['cpu_seconds']:.2g} s.
The two are {rms:.1e} apart (RMS of Rs, Rd and T; {max(apart):.1e} at most), which is the noise of sampling. A render holds
12.4 kB of it: 258 angles, even in the root of the cosine, of 48 bytes. What sampling, solving and coarser steps cost in
accuracy: [validation.md](validation.md#the-table-solved-against-sampled), [table_format.md](table_format.md).
"""


# --- Figures 8 to 10 ---------------------------------------------------------------------------------------------------


def solved_cutoff(comparison):
    return candidate(comparison, "leaf_simplified")["paper_manner"]["cutoff"]


def curves_of(runs, s, comparison):
    """[(title, how it is drawn, Ends)]"""
    solved = solved_cutoff(comparison)
    return [(title, how, runs.ends(s, model, solved if cutoff is None else cutoff)) for title, model, cutoff, how in CURVES]


def convergence_chart(path, measured):
    deepest = max(curve[2].depth() for m in measured.values() for curve in m["ends"]) + 1
    script = "set multiplot layout 2,3 margins 0.07,0.985,0.075,0.945 spacing 0.05,0.075\nunset mytics\nset tics font ',12'\n"
    script += f"set key font ',12'\nset xrange [0.7:{deepest + 0.3}]\nset xtics 1,{1 if deepest < 10 else 2}\n"
    for row, (label, value, scale) in enumerate((
            ("unshot rays / shot rays", Ends.unshot_ratio, "set logscale y\nset yrange [2e-7:2]\nset format y '10^{%T}'"),
            ("share of paths absorbed or cut off", Ends.ended, "unset logscale y\nset yrange [0:1]\nset format y '%.1f'"))):
        script += f"{scale}\nset xlabel '{'tree depth' if row else ''}'\n"
        for panel, s in enumerate(SETS):
            plots = [f"{PAPER_RATIO} with lines lc rgb '#888888' lw 1 notitle"] if row == 0 else []
            for i, (title, how, ends) in enumerate(measured[s.name]["ends"]):
                points = [(d, value(ends, d)) for d in range(1, deepest + 1)]
                script += block(f"d{row}{panel}{i}", [p for p in points if p[1] > 0])
                plots.append(f"$d{row}{panel}{i} using 1:2 with linespoints lw 2 ps 0.8 {how} title '{title}'")
            script += f"set title '{'' if row else f'Figure {s.graph}: {s.title}'}'\n"
            script += f"set ylabel '{'' if panel else label}'\n"
            # The back lit set leaves room: hardly a path ends there.
            script += ("set key top right\n" if (row, panel) == (1, 1) else "unset key\n") + "plot " + ", ".join(plots) + "\n"
    gnuplot(path, script + "unset multiplot\n", (1350, 820))


def depth_rows(measured):
    for s in SETS:
        paper_manner = {label: candidate(measured[s.name]["comparison"], label)["paper_manner"]
                        for label in ("abm", "leaf_simplified")}
        common = paper_manner["abm"]["tree_depth"]
        cutoffs = ("0.01", "none", "0.01", f"{paper_manner['leaf_simplified']['cutoff']:.2g}")
        for (_, model, _, _), cutoff, (_, _, ends) in zip(CURVES, cutoffs, measured[s.name]["ends"]):
            yield (s.title, f"`{model}`", cutoff, ends.depth(), common,
                   f"{ends.unshot_ratio(common):.1e} ± {ends.unshot_error(common):.0e}",
                   f"{thousands(ends.alive(common))} of {thousands(ends.shot(common))}", f"{100 * ends.ended(common):.1f} %")


def faster(measured):
    """Which of the two has the shallower tree, set by set, both with the paper's cutoff."""
    words = []
    for s in SETS:
        walk, _, table_, _ = (curve[2].depth() for curve in measured[s.name]["ends"])
        words.append(f"{s.title} {walk} and {table_}")
    return ", ".join(words)


def convergence(runs, images, measured):
    convergence_chart(images / "convergence.svg", measured)
    paths = measured["front"]["ends"][0][2].paths()
    return f"""
## Figures 8 to 10: convergence

![Unshot rays over shot rays, and paths absorbed or cut off, against tree depth](images/paper/convergence.svg)

Depth d is that after d scattering events. *Unshot over shot*, above: the rays that go on after d events, over all rays shot
until then, that is the camera rays and those that went on after 1, 2 ... d - 1 events. *Absorbed or cut off*, below: paths
that ended so at one of the first d events, over all paths. The rest left the scene. The luminance of the attenuation
(eq. 4) is compared with the cutoff after each event; light sampling has no part in either ratio. The paper ends its trees
where the first ratio is {PAPER_RATIO:g} (the grey line) and chooses the cutoff of the simplified model so that the ratio is the
ABM's. How it does so is not said. Here: the ABM's trees, with the paper's 0.01, end at the first depth below {PAPER_RATIO:g};
the cutoff of the simplified model is solved so that as many rays are unshot at that same depth
([compare.md](compare.md#speed-up)). {thousands(paths)} paths a curve; ± is the standard error of counting.

{table(("set", "model", "cutoff", f"first depth below {PAPER_RATIO:g}", "depth of (b)", "unshot / shot there", "rays",
        "absorbed or cut off by then"), depth_rows(measured))}
The paper finds that the simplified model converges faster in all three sets. Depths where the ratio falls below
{PAPER_RATIO:g}, `abm` and `leaf_simplified` with the same cutoff: {faster(measured)}. The shapes differ more than the depths.
`abm` kills a path at a leaf, with the probability that all three wavelengths are absorbed, so its curve falls from the first
event on. `leaf_simplified` kills none: it attenuates a path, goes on with it after the first event whatever the leaf, and
cuts it off later, once the product of two or three reflectances is below the cutoff. Which falls below {PAPER_RATIO:g} first
hangs on where rays go. Where most leave the scene after one or two leaves, as in the back lit set, the walk, which sends on
fewer, is ahead. An `abm` that is never cut off goes on longer where a leaf stands before a wall or over soil: a ray that
only a dull surface attenuates never ends but by a leaf or by leaving, and that is where the simplified model converges
faster. The paper's scenes have not been published, and whether its ABM was cut off at other surfaces is not said.
"""


# --- Table 2 -----------------------------------------------------------------------------------------------------------


def picture_rows(measured):
    for s in SETS:
        d = measured[s.name]["difference"]
        yield (s.title, "the paper", f"{s.foliar_percent:.2f} %", *triple(s.rms, 3), "", "")
        foliar = measured[s.name]["pictures"]["abm"][0]["foliar_ratio"]
        yield (s.title, "ours", f"{100 * foliar:.2f} %", *triple(d[f"rms_clipped_{c}"] for c in CHANNELS),
               " ".join(triple(d[f"noise_{c}"] for c in CHANNELS)), " ".join(triple(d[f"bias_{c}"] for c in CHANNELS)))


def bounded(error):
    return f"{error['value']:.4f} (≤ {error['high']:.4f})"


def bias_rows(measured):
    for s in SETS:
        yield (s.title, "RMS of the paper", *triple(s.rms, 3))
        for label in list(CANDIDATES)[1:5]:
            errors = last_errors(measured[s.name]["comparison"], label)
            yield (s.title, SHOWN[label], *(bounded(errors[c]["bias"]) for c in CHANNELS))


def ratio_text(ratio):
    if ratio is None:
        return "–"
    if "value" not in ratio:
        return ratio["kind"]
    return f"{ratio['value']:.1f}" + (" (extrapolated)" if ratio["kind"] == "extrapolated" else "")


def speed_rows(measured):
    for s in SETS:
        yield (s.title, "the paper", "", "", f"{s.speed_up:.2f}", "", "", "")
        for label in CANDIDATES:
            c = candidate(measured[s.name]["comparison"], label)
            speed, rung = c["speed_up"], c["rungs"][-1]
            yield (s.title, SHOWN[label], f"{1000 * rung['cpu_seconds'] / rung['samples']:.0f}",
                   f"{speed['a_equal_samples']:.2f}", f"{speed['b_paper']:.2f}", ratio_text(speed["c_equal_error"]),
                   ratio_text(speed["c_equal_error_at_1.5_bias"]), f"{speed['d_equal_noise']:.1f}")


def table_2(runs, measured):
    front = measured["front"]["comparison"]
    samples, reference = front["candidates"][0]["rungs"][-1]["samples"], front["reference"]
    return f"""
## Table 2: error

The paper's RMS error is that of two pictures which are both noisy. So is this: the pictures of Figures 5 to 7,
{2 * runs.setting.picture_samples} samples per pixel, linear SMPTE-C, clipped to [0, 1], over all pixels. Beside it what of it
is noise, of both pictures, and what is bias, which no number of samples takes away: red, green, blue.

{table(("set", "whose", "foliar ratio", "RMS, red", "green", "blue", "of it noise", "of it bias"), picture_rows(measured))}
Bias against what `abm` converges to, of all pixels, with the upper end of its 95 % interval (`frond compare`,
{front['width']} x {front['height']} pixels, {samples} samples per pixel; the reference is `{reference['candidate']}`, twice
{reference['samples']}, its noise taken out):

{table(("set", "model", "red", "green", "blue"), bias_rows(measured))}
## Table 2: speed-up

CPU time of `abm` over the model's, in four ways ([compare.md](compare.md#speed-up)): (a) at equal samples; (b) in the paper's
manner, light sampling blind to the surface lobe and paths cut off, with the cutoffs above; (c) at equal error, until all three
channels are down to the paper's RMS of that set, and until the RMS is 1.5 times the model's own bias; (d) at equal variance.
The first column is milliseconds of CPU for one sample of each pixel. The paper gives one number, and it stands beside (b).

{table(("set", "model", "ms", "(a)", "(b)", "(c) at the paper's RMS", "(c) at 1.5 × bias", "(d)"), speed_rows(measured))}"""


# --- Why -----------------------------------------------------------------------------------------------------------------


def cost(measured, s, model):
    """(rays a path, nanoseconds of CPU a ray) of a picture."""
    reports = measured[s.name]["pictures"][model]
    rays, paths = sum(r["rays"] for r in reports), sum(r["paths"] for r in reports)
    return rays / paths, 1e9 * sum(r["cpu_seconds"] for r in reports) / rays


def cost_rows(measured):
    for s in SETS:
        walk, simple = cost(measured, s, "abm"), cost(measured, s, "leaf_simplified")
        yield (s.title, *(f"{x:.2f}" for x in (walk[0], simple[0])), *(f"{x:.0f}" for x in (walk[1], simple[1])))


def at_shown_exposure(measured):
    """The largest bias of leaf_simplified as a share of the paper's RMS, were pictures compared as bright as they are shown."""
    share = 0
    for s in SETS:
        errors = last_errors(measured[s.name]["comparison"], "leaf_simplified")
        share = max(share, *(2**s.stops * errors[c]["bias"]["high"] / rms for c, rms in zip(CHANNELS, s.rms)))
    return share


def over_weighted(measured):
    """Speed-up (c) of leaf_simplified against the weighted walk, set by set."""
    words = []
    for s in SETS:
        simple, walk = (candidate(measured[s.name]["comparison"], label)["speed_up"]["c_equal_error"].get("value")
                        for label in ("leaf_simplified", "weighted"))
        words.append(f"{s.title} {simple / walk:.1f}" if simple and walk else f"{s.title} unknown")
    return ", ".join(words)


def differences(measured):
    noise_share = min(measured[s.name]["difference"][f"noise_{c}"] / measured[s.name]["difference"][f"rms_{c}"]
                      for s in SETS for c in CHANNELS)
    gains = [candidate(m["comparison"], "leaf_lambert")["speed_up"]["a_equal_samples"] for m in measured.values()]
    lowest, highest = min(gains), max(gains)
    return f"""
## Where ours and the paper's differ, and why

**At equal samples, (a) and (b), we gain next to nothing; the paper gained 4 to 10 times.** That is because the walk is cheap
here: even `leaf_lambert`, which looks up two numbers, gains only {lowest:.2f} to {highest:.2f} times, (a). What a path costs
is finding what its rays meet. And a killed path shoots no more rays, while an attenuated one goes on. Rays a path, shadow
rays included, and CPU time a ray, all of the render in it, in the pictures above:

{table(("set", "rays a path, `abm`", "`leaf_simplified`", "ns a ray, `abm`", "`leaf_simplified`"), cost_rows(measured))}
So a speed-up near 1 is no fault of the simplified model: the reference model has become as cheap as it.

**At equal error, (c), we gain more than the paper.** What the walk still costs is noise: an absorbed wavelength is black, one
that survives counts full, and light sampling sees the leaf through one walk. The table has the mean of all this. The paper
says that fewer rays are needed and does not count it. Part of this gain is to be had without a table: `abm` with `mode`
weighted has the same expectation as `abm` and less noise. Against that walk the gain (c) is {over_weighted(measured)}.

**Our RMS is smaller than the paper's, and most of it is noise** (at least {100 * noise_share:.0f} % of each figure). The paper
does not say how bright its pictures are. Ours have white in the light at 1, and leaves at less than a tenth; were they
compared as bright as they are shown above, the bias of `leaf_simplified` would be up to {100 * at_shown_exposure(measured):.0f} %
of the paper's RMS.

**The paper's shadow rays** (`surfacedirect` false) do not see the surface lobe. A ray that follows the lobe and meets the
light counts in full, so nothing is lost in the end; but a small light is seldom met, and there the price is noise, (d) in the
front and back lit sets. Under an even sky every such ray meets it, and both are alike.

**Colours.** All of this at 608, 551 and 455 nm, as published; the blue of SMPTE-C is at 464.7 nm ([wavelengths.md](wavelengths.md)).
"""


# --- What was asked ------------------------------------------------------------------------------------------------------


def verdict(holds):
    return "yes" if holds else "**no**"


def goal_rows(measured):
    for s in SETS:
        comparison = measured[s.name]["comparison"]
        errors = last_errors(comparison, "leaf_simplified")
        biases = [errors[c]["bias"] for c in CHANNELS]
        yield (s.title, "bias of `leaf_simplified`, upper 95 %", "at most " + " / ".join(triple(s.rms, 3)),
               " / ".join(triple(b["high"] for b in biases)), verdict(all(b["high"] <= r for b, r in zip(biases, s.rms))))
        speed = candidate(comparison, "leaf_simplified")["speed_up"]["c_equal_error"]
        yield (s.title, "speed-up (c) of `leaf_simplified`", f"at least {s.speed_up:.2f}", ratio_text(speed),
               verdict(speed.get("value", 0) >= s.speed_up))
        solved = max(last_errors(comparison, "leaf_solved")[c]["bias"]["high"] for c in CHANNELS)
        yield (s.title, "bias of `leaf_solved`, upper 95 %, worst channel", "at most 0.001", f"{solved:.4f}",
               verdict(solved <= 0.001))


def goals(measured):
    return f"""
## In short

The paper's error and speed-up, and what was measured here; RMS and bias are of red, green and blue.

{table(("set", "figure", "wanted", "measured", "holds"), goal_rows(measured))}"""


# --- The page ------------------------------------------------------------------------------------------------------------

ELSEWHERE = """
## Elsewhere

| in the paper | ours |
|---|---|
| Figures 1 and 4: BDF curves at 30° and 45° | [validation.md](validation.md#figures-1-and-4-of-the-paper-the-bdf-in-the-plane-of-incidence) |
| Figure 2: absorption of chlorophyll | from the authors' later publications, and what it makes of a leaf: [validation.md](validation.md#spectra-400-to-2500-nm) |
| Table 1: chromaticities and dominant wavelengths | [conventions.md](conventions.md), what 455 nm costs: [wavelengths.md](wavelengths.md) |
| future work: Meyer's choice of wavelengths | [wavelengths.md](wavelengths.md) |
"""


def page(runs, images, measured, tables, command):
    front = measured["front"]["comparison"]
    used = sum(m["comparison"]["cpu_seconds"] + sum(r["cpu_seconds"] for p in m["pictures"].values() for r in p)
               for m in measured.values())
    return f"""# The paper's experiments

G. V. G. Baranoski and J. G. Rokne, "A Simplified Model for Light Interaction with Plant Tissue": what it evaluates, its
figures beside ours. "The ABM" is `abm`, the random walk, analog as published; "the simplified model" is `leaf_simplified`,
with a solved table. 1 is a white diffuse surface in the light.

Made by `{command}` from what it measured, in {used / 60:.0f} minutes of CPU, on {machine()}.
{goals(measured)}
{pictures(runs, images, measured)}
{convergence(runs, images, measured)}
{table_2(runs, measured)}
{leaf_table(runs, tables)}
{differences(measured)}
{ELSEWHERE}
The comparisons were made by

```
{front['command'].replace(f'{ROOT}/', '')}
```

and the same for the other scenes, with their own `--target`.
"""


def measure(runs, s):
    comparison = runs.comparison(s)
    ends = curves_of(runs, s, comparison)
    shots = runs.pictures(s)
    return {"comparison": comparison, "ends": ends, "pictures": shots, "difference": runs.difference(s)}


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--quick", action="store_true", help="few samples, into build/paper")
    parser.add_argument("--smoke", metavar="FOLDER", help="hardly any samples, into a folder: a test that all of it runs")
    parser.add_argument("--continue", dest="keep", action="store_true", help="keep what an earlier run has measured")
    parser.add_argument("--threads", type=int, help="all by default")
    options = parser.parse_args()
    if options.smoke and not (shutil.which("gnuplot") and shutil.which("oiiotool")):
        raise SystemExit(77)  # skipped
    setting = SMOKE if options.smoke else QUICK if options.quick else FULL
    scratch = pathlib.Path(options.smoke) if options.smoke else BUILD.parent / "paper" / ("quick" if options.quick else "full")
    docs = ROOT / "docs" if setting is FULL else scratch
    runs = Runs(setting, scratch, options.threads, options.keep)
    measured = {s.name: measure(runs, s) for s in SETS}
    tables = {method: runs.table(method) for method in ("solve", "montecarlo")}
    text = page(runs, docs / "images" / "paper", measured, tables, "scripts/paper" + (" --quick" if setting is not FULL else ""))
    (docs / "paper.md").write_text(re.sub(r"\n{3,}", "\n\n", text))
    print(docs / "paper.md")


if __name__ == "__main__":
    main()
