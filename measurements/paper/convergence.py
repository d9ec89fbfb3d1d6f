"""Figures 8 to 10 of the paper: the share of paths that continue, by depth. Run as a program, it checks the two ratios."""

import math

import numpy

from ..shared import charts
from ..shared.tools import table
from .runs import SETS, candidate

PAPER_RATIO = 1e-4  # of unshot to shot rays, at which the paper's trees end


class Ends:
    """Numbers of paths by the number of their scattering events when they ended."""

    def __init__(self, escaped, absorbed):
        ends = numpy.zeros((2, max(len(escaped), len(absorbed))))
        ends[0, :len(escaped)], ends[1, :len(absorbed)] = escaped, absorbed
        self.absorbed = ends[1]
        self.going = [*ends.sum(axis=0)[::-1].cumsum()[::-1], 0]  # after so many events

    @staticmethod
    def of(report):
        """From the output of `frond render --json`."""
        return Ends(report["paths_escaped_by_depth"], report["paths_absorbed_by_depth"])

    def paths(self):
        return int(self.alive(0))

    def alive(self, events):
        """Number of rays that continue after `events` events."""
        return self.going[min(events, len(self.going) - 1)]

    def shot(self, events):
        """Number of rays shot before event `events`: one for each path that continued after 0, 1 ... events - 1 events."""
        return sum(self.alive(i) for i in range(events))

    def unshot_ratio(self, events):
        return self.alive(events) / self.shot(events)

    def ended(self, events):
        """Share of all paths that were absorbed, or cut off, at one of the first `events` events."""
        return self.absorbed[:events].sum() / self.paths()

    def ratio_between(self, depth):
        """The first ratio at a depth between two whole ones, by linear interpolation of its logarithm, and its standard error of
        counting. Half a ray is added to each count, as in src/study/compare/cutoff.cpp."""
        whole = math.floor(depth)
        t = depth - whole
        a, b = (self.alive(d) + 0.5 for d in (whole, whole + 1))
        ratio = math.exp((1 - t) * math.log(a / self.shot(whole)) + t * math.log(b / self.shot(whole + 1)))
        return ratio, ratio * math.sqrt(((1 - t) ** 2 + 2 * t * (1 - t)) / a + t**2 / b)

    def depth(self):
        """Depth at which the first ratio is PAPER_RATIO, interpolated as above."""
        last = next(d for d in range(1, len(self.going))
                    if self.alive(d) == 0 or (self.alive(d) + 0.5) / self.shot(d) < PAPER_RATIO)
        if last == 1:
            return 1
        before, after = (math.log((self.alive(d) + 0.5) / self.shot(d)) for d in (last - 1, last))
        return last - 1 + min(1, (before - math.log(PAPER_RATIO)) / (before - after))


# Title, model, cutoff (None: solved for the set), and colour, marker and line style.
CURVES = (
    ("abm, cutoff 0.01", "abm", 0.01, (0, "o", "-")),
    ("abm, no cutoff", "abm", 0, (0, "D", ":")),
    ("leaf_simplified, cutoff 0.01", "leaf_simplified", 0.01, (1, "s", "-")),
    ("leaf_simplified, cutoff solved", "leaf_simplified", None, (2, "^", "--")),
)


def curves_of(runs, s, manner):
    """[(title, how it is drawn, Ends)]; `manner`: the comparison that solved the cutoff."""
    solved = candidate(manner, "leaf_simplified")["paper_cutoff"]
    return [(title, how, Ends.of(runs.ends(s, model, solved if cutoff is None else cutoff))) for title, model, cutoff, how in CURVES]


def convergence_chart(path, measured):
    deepest = math.ceil(max(curve[2].depth() for m in measured.values() for curve in m["ends"]))
    of, panels = charts.figure(1350, 860, 2, 3, sharex=True, sharey="row")
    for column, s in enumerate(SETS):
        above, below = panels[:, column]
        for title, (color, mark, line), ends in measured[s.name]["ends"]:
            style = {"color": charts.COLORS[color], "marker": mark, "linestyle": line, "label": title}
            ratios = [(d, ends.unshot_ratio(d)) for d in range(1, deepest + 1) if ends.alive(d)]
            above.semilogy(*(zip(*ratios) if ratios else ([], [])), **style)
            below.plot(range(1, deepest + 1), [ends.ended(d) for d in range(1, deepest + 1)], **style)
        above.axhline(PAPER_RATIO, color="#888888", linewidth=1)
        above.set(title=f"Figure {s.graph}: {s.title}", ylim=(2e-7, 2))
        below.set(xlabel="tree depth", ylim=(0, 1), xlim=(0.7, deepest + 0.3), xticks=range(1, deepest + 1, 1 + deepest // 10))
    panels[0, 0].set_ylabel("unshot rays / shot rays")
    panels[1, 0].set_ylabel("share of paths absorbed or cut off")
    charts.legend(of, panels[0, 0], 4)
    charts.save(of, path)


def depth_rows(measured):
    for s in SETS:
        manner = {label: candidate(measured[s.name]["manner"], label)
                  for label in ("abm", "leaf_simplified")}
        end = manner["abm"]["paper_tree_depth"]
        solved = f"{manner['leaf_simplified']['paper_cutoff']:.2g}, solved"
        for (_, model, cutoff, _), (_, _, ends) in zip(CURVES, measured[s.name]["ends"]):
            ratio, error = ends.ratio_between(end)
            yield (s.title, f"`{model}`", solved if cutoff is None else cutoff or "none", f"{ends.depth():.1f}",
                   f"({ratio / PAPER_RATIO:.2f} ± {error / PAPER_RATIO:.2f}) · 10⁻⁴ at {end:.1f}",
                   f"{100 * ends.ended(math.ceil(end)):.1f} %")


def depths(measured):
    """Text with the depths of both models with the paper's cutoff, for each set."""
    words = []
    for s in SETS:
        walk, _, simple, _ = (curve[2].depth() for curve in measured[s.name]["ends"])
        words.append(f"{s.title} {walk:.1f} and {simple:.1f}")
    return ", ".join(words)


def at_first_event(measured):
    """Shares of front lit leaf_simplified paths that end at their first event, with the paper's and the solved cutoff."""
    return [f"{100 * measured['front']['ends'][i][2].ended(1):.0f} %" for i in (2, 3)]


def convergence(runs, images, measured):
    convergence_chart(images / "convergence.svg", measured)
    paths = measured["front"]["ends"][0][2].paths()
    return f"""
## Figures 8 to 10: convergence

![Unshot rays over shot rays, and paths absorbed or cut off, against tree depth](images/paper/convergence.svg)

Depth d means after d scattering events. *Unshot over shot* (top): rays that continue after d events divided by all rays shot
before, which are the camera rays and those that continued after 1, 2 ... d - 1 events. *Absorbed or cut off* (bottom): paths that
ended so at one of the first d events divided by all paths. All other ended paths left the scene. The luminance of the attenuation
(eq. 4) is compared with the cutoff after each event; light sampling affects neither ratio.

The paper ends its trees where the first ratio is 10⁻⁴ (the grey line). It chooses the cutoff of the simplified model so that the
ratio equals that of the ABM, and does not state how. Here the ABM has the paper's cutoff of 0.01, and its trees end at the depth
where the ratio is 10⁻⁴, interpolated between two whole depths. The cutoff of the simplified model is solved so that its ratio at
this depth is the same ([compare](../compare.md)). The solution comes from a short render; the table checks its ratio with more
samples. The paper has 0.01 for this cutoff too. Each curve has {paths:,} paths; ± is the standard error of counting.

{table(("set", "model", "cutoff", "depth where the ratio is 10⁻⁴", "unshot / shot at the depth of (b)",
        "absorbed or cut off at this depth"), depth_rows(measured))}
The paper finds that the simplified model converges faster in all three sets. Here the ratio is 10⁻⁴ at these depths with `abm` and
with `leaf_simplified`, both with a cutoff of 0.01: {depths(measured)}. The shapes of the curves differ more than the depths. `abm`
ends a path at a leaf with the probability that all three wavelengths are absorbed, so that its curve falls from the first event
on. `leaf_simplified` ends no path at a leaf. It attenuates the path and continues it after the first event on any leaf; the path
is cut off later, when the product of two or three reflectances is below the cutoff. Without a cutoff, about one
path in 10,000 never ends: interpolated normals let it into a closed stem, whose reflectance attenuates it but ends no path.

The scene decides which model reaches 10⁻⁴ at the smaller depth. Where most paths leave the scene after one or two leaves, as in
the back lit set, the walk reaches it first, because it continues fewer paths. `abm` without a cutoff continues paths longer where
a leaf is in front of a wall or over soil: a diffuse surface only attenuates a ray, which ends only at a leaf or outside the scene.
There the simplified model converges faster.

The ratio is not a smooth function of the cutoff. It jumps where many paths have the same attenuation, so that two cutoffs may give
the same ratio. The wall behind the front lit leaves reflects 0.015. A cutoff above this value ends every path that meets the
wall first, and (b) then measures the wall instead of the leaf. Of all paths, {' with 0.01, '.join(at_first_event(measured))}
with the solved cutoff end at their first event. The paper's scenes are not published, and it does not state whether its ABM was
cut off at other surfaces.
"""


def check():
    """Checks `Ends` with 100 paths: 60 continue after one event, 30 after two, none after three."""
    ends = Ends([25, 30], [15, 0, 30])
    assert [ends.alive(d) for d in range(5)] == [100, 60, 30, 0, 0]
    assert (ends.unshot_ratio(1), ends.unshot_ratio(2)) == (0.6, 30 / 160)
    assert [ends.ended(d) for d in range(4)] == [0, 0.15, 0.15, 0.45]
    assert all(map(math.isclose, ends.ratio_between(2), (30.5 / 160, math.sqrt(30.5) / 160)))
    assert math.isclose(ends.ratio_between(1.5)[0], math.sqrt(60.5 / 100 * 30.5 / 160))
    assert ends.depth() == 3
    assert Ends([5], []).depth() == 1
    many = Ends([10**6], [0, 0, 0, 0, 300, 40])
    assert 4 < many.depth() < 5 and math.isclose(many.ratio_between(many.depth())[0], PAPER_RATIO)


if __name__ == "__main__":
    check()
