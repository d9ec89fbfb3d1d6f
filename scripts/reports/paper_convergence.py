"""Figures 8 to 10 of the paper: how the trees of both models thin out with depth. By itself it checks the two ratios."""

import math

import numpy

import charts
from paper_runs import SETS, candidate
from tools import table

PAPER_RATIO = 1e-4  # of unshot to shot rays, at which the paper's trees end


class Ends:
    """Paths by the number of scattering events that they had come through when they ended."""

    def __init__(self, escaped, absorbed):
        ends = numpy.zeros((2, max(len(escaped), len(absorbed))))
        ends[0, :len(escaped)], ends[1, :len(absorbed)] = escaped, absorbed
        self.absorbed = ends[1]
        self.going = [*ends.sum(axis=0)[::-1].cumsum()[::-1], 0]  # after so many events

    @staticmethod
    def of(report):
        """From what `frond render --json` prints."""
        return Ends(report["paths_escaped_by_depth"], report["paths_absorbed_by_depth"])

    def paths(self):
        return int(self.alive(0))

    def alive(self, events):
        """Rays that go on after so many events."""
        return self.going[min(events, len(self.going) - 1)]

    def shot(self, events):
        """Rays shot before the last of so many events: one of each path that was alive after 0, 1 ... events - 1."""
        return sum(self.alive(i) for i in range(events))

    def unshot_ratio(self, events):
        return self.alive(events) / self.shot(events)

    def ended(self, events):
        """Share of all paths that were absorbed, or cut off, at one of the first `events` events."""
        return self.absorbed[:events].sum() / self.paths()

    def ratio_between(self, depth):
        """The first ratio at a depth between two whole ones, its logarithm taken as linear, and its standard error of
        counting. Where no ray is left half a one is taken. As src/study/compare/cutoff.cpp does."""
        whole = math.floor(depth)
        t = depth - whole
        a, b = (self.alive(d) + 0.5 for d in (whole, whole + 1))
        ratio = math.exp((1 - t) * math.log(a / self.shot(whole)) + t * math.log(b / self.shot(whole + 1)))
        return ratio, ratio * math.sqrt(((1 - t) ** 2 + 2 * t * (1 - t)) / a + t**2 / b)

    def depth(self):
        """Where the first ratio has fallen to PAPER_RATIO, between two whole depths as above."""
        last = next(d for d in range(1, len(self.going))
                    if self.alive(d) == 0 or (self.alive(d) + 0.5) / self.shot(d) < PAPER_RATIO)
        if last == 1:
            return 1
        before, after = (math.log((self.alive(d) + 0.5) / self.shot(d)) for d in (last - 1, last))
        return last - 1 + min(1, (before - math.log(PAPER_RATIO)) / (before - after))


# Title, model, cutoff (None: solved for the set), and its colour, mark and line.
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
it. {paths:,} paths a curve; ± is the standard error of counting.

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


def check():
    """100 paths: 60 go on after one event, 30 after two, none after three."""
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
