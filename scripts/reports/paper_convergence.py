"""Figures 8 to 10 of the paper: how the trees of both models thin out with depth."""

import math

from convergence import PAPER_RATIO, Ends
from paper_runs import SETS, candidate
from tools import COLORS, block, gnuplot, table, thousands

# Title, model, cutoff (None: solved for the set), and how gnuplot draws it.
CURVES = (
    ("abm, cutoff 0.01", "abm", 0.01, f"lc rgb '{COLORS[0]}' pt 7"),
    ("abm, no cutoff", "abm", 0, f"lc rgb '{COLORS[0]}' pt 6 dt 3"),
    ("leaf\\_simplified, cutoff 0.01", "leaf_simplified", 0.01, f"lc rgb '{COLORS[1]}' pt 5"),
    ("leaf\\_simplified, cutoff solved", "leaf_simplified", None, f"lc rgb '{COLORS[2]}' pt 9 dt 2"),
)


def curves_of(runs, s, manner):
    """[(title, how it is drawn, Ends)]; `manner`: the comparison that solved the cutoff."""
    solved = candidate(manner, "leaf_simplified")["paper_manner"]["cutoff"]
    return [(title, how, runs.ends(s, model, solved if cutoff is None else cutoff)) for title, model, cutoff, how in CURVES]


def convergence_chart(path, measured):
    deepest = math.ceil(max(curve[2].depth() for m in measured.values() for curve in m["ends"]))
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
        manner = {label: candidate(measured[s.name]["manner"], label)["paper_manner"]
                  for label in ("abm", "leaf_simplified")}
        end = manner["abm"]["tree_depth"]
        solved = f"{manner['leaf_simplified']['cutoff']:.2g}, solved"
        for (_, model, cutoff, _), (_, _, ends) in zip(CURVES, measured[s.name]["ends"]):
            ratio, error = ends.ratio_between(end)
            yield (s.title, f"`{model}`", solved if cutoff is None else cutoff or "none", f"{ends.depth():.1f}",
                   f"({ratio / PAPER_RATIO:.2f} ± {error / PAPER_RATIO:.2f}) · 10⁻⁴ at {end:.1f}",
                   f"{100 * ends.ended(math.ceil(end)):.1f} %")


def depths(measured):
    """Of both models with the paper's cutoff, set by set."""
    words = []
    for s in SETS:
        walk, _, simple, _ = (curve[2].depth() for curve in measured[s.name]["ends"])
        words.append(f"{s.title} {walk:.1f} and {simple:.1f}")
    return ", ".join(words)


def at_first_event(measured):
    """Paths of leaf_simplified, front lit, that end at their first event with the paper's cutoff and with the solved one."""
    return [f"{100 * measured['front']['ends'][i][2].ended(1):.0f} %" for i in (2, 3)]


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
where the first ratio is 10⁻⁴ (the grey line) and chooses the cutoff of the simplified model so that the ratio is the ABM's;
how is not said. Here the ABM's trees, with the paper's 0.01, end where 10⁻⁴ is left, at a depth interpolated between two
whole ones, and the cutoff of the simplified model is solved so that the same is left at that depth
([compare.md](compare.md#speed-up)): a pilot's answer, whose ratio the table checks with more samples. The paper has 0.01 for
it. {thousands(paths)} paths a curve; ± is the standard error of counting.

{table(("set", "model", "cutoff", "depth where 10⁻⁴ is left", "unshot / shot at the depth of (b)", "absorbed or cut off by then"),
       depth_rows(measured))}
The paper finds that the simplified model converges faster in all three sets. Here 10⁻⁴ is left, with `abm` and with
`leaf_simplified`, both cut off at 0.01, at these depths: {depths(measured)}.
The shapes differ more than the depths.
`abm` kills a path at a leaf, with the probability that all three wavelengths are absorbed, so its curve falls from the first
event on. `leaf_simplified` kills none: it attenuates a path, goes on with it after the first event whatever the leaf, and
cuts it off later, once the product of two or three reflectances is below the cutoff. Which is down to 10⁻⁴ first
hangs on where rays go. Where most leave the scene after one or two leaves, as in the back lit set, the walk, which sends on
fewer, is ahead. An `abm` that is never cut off goes on longer where a leaf stands before a wall or over soil: a ray that
only a dull surface attenuates never ends but by a leaf or by leaving, and that is where the simplified model converges
faster.

The ratio does not fall evenly with the cutoff: it jumps where many paths have the same attenuation, so that two cutoffs may
leave the same. Our wall behind the front lit leaves reflects 0.015. A cutoff above that ends every path that meets the wall
first, and (b) would then gain by the wall, not by the leaf: of all paths {' with 0.01, '.join(at_first_event(measured))} with the
solved cutoff end at their first event. The paper's scenes have not been published, and whether its ABM was cut off at other
surfaces is not said.
"""
