"""How paths end at each depth of the ray-tracing tree: the two ratios of the paper's convergence graphs."""

import dataclasses
import math

PAPER_RATIO = 1e-4  # of unshot to shot rays, at which the paper's trees end


@dataclasses.dataclass
class Ends:
    """Paths by the number of scattering events that they had come through when they ended."""

    escaped: list
    absorbed: list

    @staticmethod
    def of(report):
        """From what `frond render --json` prints."""
        return Ends(report["paths_escaped_by_depth"], report["paths_absorbed_by_depth"])

    def depths(self):
        return max(len(self.escaped), len(self.absorbed))

    def paths(self):
        return self.alive(0)

    def alive(self, events):
        """Rays that go on after so many events."""
        return sum(self.escaped[events:]) + sum(self.absorbed[events:])

    def shot(self, events):
        """Rays shot before the last of so many events: one of each path that was alive after 0, 1 ... events - 1."""
        return sum(self.alive(i) for i in range(events))

    def unshot_ratio(self, events):
        return self.alive(events) / self.shot(events)

    def ended(self, events):
        """Share of all paths that were absorbed, or cut off, at one of the first `events` events."""
        return sum(self.absorbed[:events]) / self.paths()

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
        last = next(d for d in range(1, self.depths() + 1)
                    if self.alive(d) == 0 or (self.alive(d) + 0.5) / self.shot(d) < PAPER_RATIO)
        if last == 1:
            return 1
        before, after = (math.log((self.alive(d) + 0.5) / self.shot(d)) for d in (last - 1, last))
        return last - 1 + min(1, (before - math.log(PAPER_RATIO)) / (before - after))


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
