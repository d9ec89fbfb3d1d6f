"""Two runs side by side: which benchmarks take longer or shorter, and whether any image is another one."""

import numpy
import pandas
from scipy import special

from .results import family

# Chance that one or more of the benchmarks of two runs of the same program are marked; another such for the images.
FALSE_ALARMS = 0.05


class Comparison:
    """`times`: of each benchmark name, a, b (CPU time), ratio of B over A with a 95 % interval of its own from low to high, p,
    adjusted for all benchmarks, and mark; sorted from the slowest on. `figures`: of counters that do not depend on time name,
    counter, a, b, a_se, b_se (standard errors), p, adjusted for all figures, and mark, in the benchmarks' order."""

    def __init__(self, a, b):
        self.a, self.b = a, b
        session = a.context.get("session")
        self.paired = session is not None and session == b.context.get("session")
        self.names = [name for name in a.times if name in b.times]
        self.only_a = [name for name in a.times if name not in b.times]
        self.only_b = [name for name in b.times if name not in a.times]
        if not self.names:
            raise SystemExit("the two runs have no benchmark in common")
        times = self.changes(a.times[self.names], b.times[self.names])
        times["p"] = holm(times.p)
        times["mark"] = numpy.where(times.p >= FALSE_ALARMS, "", numpy.where(times.ratio > 1, "slower", "faster"))
        times = times.rename_axis("name").reset_index().sort_values("ratio", ascending=False, kind="stable")
        self.times = list(times.itertuples(index=False))
        self.figures = list(self.compare_figures().itertuples(index=False))

    def changes(self, a, b):
        """Of each column: geometric means, B over A with the ends of its interval, and p, by Student's t on logarithms, of pairs
        or as Welch has it. Of a single round nothing can be told."""
        a, b = numpy.log(a), numpy.log(b)
        gap, gaps = b.mean() - a.mean(), b - a
        if self.paired:
            gap, square, dof = gaps.mean().fillna(gap), gaps.var() / gaps.count(), gaps.count() - 1
        else:
            of_a, of_b = a.var() / a.count(), b.var() / b.count()
            square = of_a + of_b
            dof = square**2 / (of_a**2 / (a.count() - 1) + of_b**2 / (b.count() - 1))
        error = square**0.5
        reach = (special.stdtrit(dof, 0.975) * error).mask(error == 0, 0).fillna(numpy.inf)
        p = pandas.Series(2 * special.stdtr(dof, -abs(gap) / error), gap.index).mask(error == 0, 1.0 * (gap == 0)).fillna(1)
        return pandas.DataFrame({"a": numpy.exp(a.mean()), "b": numpy.exp(b.mean()), "ratio": numpy.exp(gap),
                                 "low": numpy.exp(gap - reach), "high": numpy.exp(gap + reach), "p": p})

    def families(self):
        """The changes of each family, and that of its geometric mean in each round that has them all."""
        members = {}
        for change in self.times:
            members.setdefault(family(change.name), []).append(change)
        means = [pandas.DataFrame({f: numpy.exp(numpy.log(run.times[[c.name for c in of_family]]).mean(axis=1, skipna=False))
                                   for f, of_family in members.items()}) for run in (self.a, self.b)]
        found = self.changes(*means)
        return {f: (members[f], found.loc[f]) for f in dict.fromkeys(map(family, self.names))}

    def compare_figures(self):
        rows = []
        for name in self.names:
            a, b = (run.counters[name] for run in (self.a, self.b))
            rows += [(name, c, *(settled(run[of]) for of in (c, f"{c}_se") for run in (a, b)))
                     for c in a if {c, f"{c}_se"} <= {*b} and f"{c}_se" in a]
        found = pandas.DataFrame(rows, columns=["name", "counter", "a", "b", "a_se", "b_se"]).astype(dict.fromkeys(
            ("a", "b", "a_se", "b_se"), float))
        # By a z-test. Renders from the same seeds hang together, and the errors are upper bounds: alarms are rarer yet.
        gap, error = abs(found.b - found.a), numpy.hypot(found.a_se, found.b_se)
        found["p"] = holm((2 * special.ndtr(-gap / error)).mask(gap == 0, 1))
        found["mark"] = numpy.where(gap == 0, "same", numpy.where(found.p < FALSE_ALARMS, "changed", "within errors"))
        return found

    def slower(self, least=0.0):
        """Those that are, by this share at least."""
        return [c for c in self.times if c.mark == "slower" and c.ratio >= 1 + least]

    def faster(self):
        return [c for c in reversed(self.times) if c.mark == "faster"]

    def changed_figures(self):
        return [f for f in self.figures if f.mark == "changed"]


def settled(rounds):
    """Images are the same in every round: their figures are, too."""
    return rounds.iloc[0]


def holm(ps):
    """p-values adjusted so that a level holds for all of them together (Holm 1979)."""
    ps = numpy.asarray(ps, float)
    order, adjusted = numpy.argsort(ps), numpy.empty(len(ps))
    adjusted[order] = numpy.minimum(1, numpy.maximum.accumulate(ps[order] * numpy.arange(len(ps), 0, -1)))
    return adjusted


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
                     "shows as a change of everything. measurements/run bench --commits runs both in turn.")
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
                    if counter + "_se" in counters and counters[counter].nunique() > 1})
    if not names:
        return []
    return [f"Renders of {label} differ from round to round, which those of one seed must not: {', '.join(names)}."]
