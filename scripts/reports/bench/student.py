"""Tests on a few figures: Student's t, and what many tests at once ask for. Python's library has none of it."""

import functools
import math
import statistics


def two_sided_p(t, dof):
    """P(|T| >= |t|) for whole degrees of freedom (Abramowitz and Stegun 1964, 26.7.3 and 26.7.4)."""
    theta = math.atan(abs(t) / math.sqrt(dof))
    sine, cosine = math.sin(theta), math.cos(theta)
    if dof % 2 == 0:
        within = sine * powers(cosine * cosine, 1, dof // 2)
    else:
        tail = sine * cosine * powers(cosine * cosine, 2, dof // 2)
        within = 2 / math.pi * (theta + tail)
    return max(0.0, 1 - within)


def powers(x, first, count):
    """1 + first/(first+1) x + first (first+2) / ((first+1) (first+3)) x^2 + ..., so many terms."""
    total, term = 0.0, 1.0
    for i in range(count):
        total += term
        term *= x * (first + 2 * i) / (first + 2 * i + 1)
    return total


@functools.cache
def two_sided_quantile(p, dof):
    """The t with P(|T| >= t) = p."""
    low, high = 0.0, 1.0
    while two_sided_p(high, dof) > p:
        high *= 2
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if two_sided_p(middle, dof) > p else (low, middle)
    return high


def paired(a, b):
    """Mean of b - a, its standard error, degrees of freedom; the figures belong together one by one."""
    gaps = [y - x for x, y in zip(a, b)]
    return statistics.mean(gaps), statistics.stdev(gaps) / math.sqrt(len(gaps)), len(gaps) - 1


def unpaired(a, b):
    """The same of figures that have nothing to do with each other (Welch 1947; degrees of freedom rounded down)."""
    va, vb = statistics.variance(a) / len(a), statistics.variance(b) / len(b)
    if va + vb == 0:
        return statistics.mean(b) - statistics.mean(a), 0.0, len(a) + len(b) - 2
    dof = (va + vb) ** 2 / (va**2 / (len(a) - 1) + vb**2 / (len(b) - 1))
    return statistics.mean(b) - statistics.mean(a), math.sqrt(va + vb), math.floor(dof)


def holm(ps):
    """p-values adjusted so that a level holds for all of them together (Holm 1979)."""
    adjusted, worst = [1.0] * len(ps), 0.0
    for rank, i in enumerate(sorted(range(len(ps)), key=ps.__getitem__)):
        worst = max(worst, min(1.0, (len(ps) - rank) * ps[i]))
        adjusted[i] = worst
    return adjusted
