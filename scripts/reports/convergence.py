"""How paths end at each depth of the ray-tracing tree: the two ratios of the paper's convergence graphs."""

import dataclasses
import math

PAPER_RATIO = 1e-4  # of unshot to shot rays, below which the paper's trees end


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

    def unshot_error(self, events):
        """Standard error of the ratio, of counting."""
        return math.sqrt(self.alive(events)) / self.shot(events)

    def ended(self, events):
        """Share of all paths that were absorbed, or cut off, at one of the first `events` events."""
        return sum(self.absorbed[:events]) / self.paths()

    def depth(self):
        """The first depth where fewer than PAPER_RATIO of the rays shot are left."""
        return next(d for d in range(1, self.depths() + 1) if self.unshot_ratio(d) < PAPER_RATIO)


def check():
    """100 paths: 60 go on after one event, 30 after two, none after three."""
    ends = Ends([25, 30], [15, 0, 30])
    assert [ends.alive(d) for d in range(5)] == [100, 60, 30, 0, 0]
    assert (ends.unshot_ratio(1), ends.unshot_ratio(2)) == (0.6, 30 / 160)
    assert math.isclose(ends.unshot_error(2), math.sqrt(30) / 160)
    assert [ends.ended(d) for d in range(4)] == [0, 0.15, 0.15, 0.45]
    assert ends.depth() == 3
    assert Ends([10**6], [0, 0, 0, 0, 101, 99]).depth() == 5
    assert Ends([5], []).depth() == 1


if __name__ == "__main__":
    check()
