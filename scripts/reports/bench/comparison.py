"""Two runs side by side: which benchmarks take longer or shorter, and whether any picture is another one."""

import dataclasses
import statistics

import numpy
from scipy import special

from .results import family

# Chance that one or more of the benchmarks of two runs of the same program are marked; another such for the pictures.
FALSE_ALARMS = 0.05


@dataclasses.dataclass
class TimeChange:
    """Of one benchmark: CPU time of B over that of A, with a 95 % interval of its own."""
    name: str
    a: float
    b: float
    ratio: float
    low: float
    high: float
    p: float  # adjusted for all benchmarks

    @property
    def mark(self):
        if self.p >= FALSE_ALARMS:
            return ""
        return "slower" if self.ratio > 1 else "faster"


@dataclasses.dataclass
class FigureChange:
    """Of a counter that does not hang on time, with its standard error in either run."""
    name: str
    counter: str
    a: float
    b: float
    a_se: float
    b_se: float
    p: float  # adjusted for all figures

    @property
    def mark(self):
        if self.a == self.b:
            return "same"
        return "changed" if self.p < FALSE_ALARMS else "within errors"


class Comparison:
    """`times` sorted from the slowest on; `figures` in the benchmarks' order."""

    def __init__(self, a, b):
        self.a, self.b = a, b
        session = a.context.get("session")
        self.paired = session is not None and session == b.context.get("session")
        self.names = [name for name in a.times if name in b.times]
        self.only_a = [name for name in a.times if name not in b.times]
        self.only_b = [name for name in b.times if name not in a.times]
        if not self.names:
            raise SystemExit("the two runs have no benchmark in common")
        self.times = sorted(self.compare_times(), key=lambda change: -change.ratio)
        self.figures = self.compare_figures()

    def compare_times(self):
        tests = [self.test(self.a.times[name], self.b.times[name]) for name in self.names]
        adjusted = holm([p for *_, p in tests])
        return [TimeChange(name, geometric_mean(self.a.times[name]), geometric_mean(self.b.times[name]), *ratios, p)
                for name, (*ratios, _), p in zip(self.names, tests, adjusted)]

    def families(self):
        """The changes of each family, and that of its geometric mean: ratio, low, high."""
        members = {}
        for change in self.times:
            members.setdefault(family(change.name), []).append(change)
        order = dict.fromkeys(map(family, self.names))
        return {f: (members[f], self.test(*(run.mean_of([c.name for c in members[f]]) for run in (self.a, self.b)))[:3])
                for f in order}

    def test(self, a, b):
        """B over A with the ends of its interval, and p: Student's t on logarithms, of pairs or as Welch has it. Of a single
        round nothing can be told."""
        common = sorted(a.keys() & b.keys())
        if len(common) < 2 if self.paired else min(len(a), len(b)) < 2:
            return geometric_mean(b) / geometric_mean(a), 0.0, numpy.inf, 1.0
        first, second = (numpy.log([run[i] for i in common] if self.paired else list(run.values())) for run in (a, b))
        gap, dof = second.mean() - first.mean(), len(common) - 1
        if self.paired:
            square = (second - first).var(ddof=1) / len(common)
        else:
            of_a, of_b = first.var(ddof=1) / len(a), second.var(ddof=1) / len(b)
            square = of_a + of_b
            dof = square**2 / max(of_a**2 / (len(a) - 1) + of_b**2 / (len(b) - 1), 1e-300)
        if square == 0:
            return *numpy.exp([gap] * 3), 1.0 if gap == 0 else 0.0
        error = square**0.5
        reach = special.stdtrit(dof, 0.975) * error
        return *numpy.exp([gap, gap - reach, gap + reach]), 2 * special.stdtr(dof, -abs(gap) / error)

    def compare_figures(self):
        found = []
        for name in self.names:
            a, b = self.a.counters.get(name, {}), self.b.counters.get(name, {})
            for counter in a:
                if counter in b and counter + "_se" in a and counter + "_se" in b:
                    found.append(FigureChange(name, counter, *(settled(run[c]) for c in (counter, counter + "_se")
                                                               for run in (a, b)), 1.0))
        for change, p in zip(found, holm([difference_p(f) for f in found])):
            change.p = p
        return found

    def slower(self, least=0.0):
        """Those that are, by this share at least."""
        return [c for c in self.times if c.mark == "slower" and c.ratio >= 1 + least]

    def faster(self):
        return [c for c in reversed(self.times) if c.mark == "faster"]

    def changed_figures(self):
        return [f for f in self.figures if f.mark == "changed"]


def geometric_mean(rounds):
    return statistics.geometric_mean(rounds.values())


def holm(ps):
    """p-values adjusted so that a level holds for all of them together (Holm 1979)."""
    order = numpy.argsort(ps)
    adjusted = numpy.empty(len(ps))
    adjusted[order] = numpy.minimum(1, numpy.maximum.accumulate(numpy.take(ps, order) * numpy.arange(len(ps), 0, -1)))
    return adjusted.tolist()


def settled(rounds):
    """Pictures are the same in every round: their figures are, too."""
    return next(iter(rounds.values()))


def difference_p(figure):
    """By a z-test. Renders from the same seeds hang together, and the errors are upper bounds: alarms are rarer yet."""
    if figure.a == figure.b:
        return 1.0
    error = numpy.hypot(figure.a_se, figure.b_se)
    return 2 * special.ndtr(-abs(figure.b - figure.a) / error) if error > 0 else 0.0


# What the figures depend on, by its name in the context.
SURROUNDINGS = {"machine": "machine", "num_cpus": "number of processors", "mhz_per_cpu": "clock rate in MHz",
                "cpu_scaling_enabled": "CPU frequency scaling", "compiler": "compiler",
                "compiler_flags": "compiler's flags", "min_time": "shortest time of a benchmark"}


def warnings(comparison):
    """Why the times may differ by more than what was changed."""
    a, b = comparison.a.context, comparison.b.context
    found = [f"Another {what}: {a.get(key, 'unknown')} in A, {b.get(key, 'unknown')} in B."
             for key, what in SURROUNDINGS.items() if a.get(key) != b.get(key)]
    if not comparison.paired:
        found.append("The runs were made one after the other: a machine that has become faster or slower between them "
                     "shows as a change of everything. scripts/bench --commits runs both in turn.")
    for label, names in (("A", comparison.only_a), ("B", comparison.only_b)):
        if names:
            found.append(f"In {label} alone, and left out: {', '.join(names[:5])}{', ...' if names[5:] else ''} "
                         f"({len(names)}).")
    rounds = min(comparison.a.rounds, comparison.b.rounds)
    if rounds < 6:
        found.append(f"{rounds} rounds are few: small changes cannot be told from chance.")
    for label, run in (("A", comparison.a), ("B", comparison.b)):
        found += busy(label, run.context) + unsettled(label, run)
    return found


def busy(label, context):
    load = max(context.get("load_avg") or [0])
    if load <= context.get("num_cpus", 1):
        return []
    return [f"The machine had other work to do during {label}: a load of {load:.1f} on {context['num_cpus']} "
            "processors."]


def unsettled(label, run):
    names = sorted({name for name, counters in run.counters.items() for counter in counters
                    if counter + "_se" in counters and len(set(counters[counter].values())) > 1})
    if not names:
        return []
    return [f"Renders of {label} differ from round to round, which those of one seed must not: {', '.join(names)}."]
