"""Refinement of `brf` and `flux` to an error: coverage and number of paths, simulated (section "refinement" of docs/internals.md)

Takes five minutes. The rules are those of src/jobs/support/refine.h.
  --quick    few simulations, into build/refinement_report
"""

import re

import numpy

from .shared.tools import ROOT, arguments, table, write_section

SOURCE = (ROOT / "src/jobs/support/refine.h").read_text(encoding="utf-8")


def constant(name):
    return float(re.search(rf"\b{name} = ([0-9.]+)", SOURCE)[1])


STEPS, LEAST_STEP, SHARE, MOST_GROWTH = map(constant, ("kSteps", "kLeastStep", "kShare", "kMostGrowth"))
DEGREES = (31, 64, 128)  # of freedom of the error: pairs of rows; `brf` has 64
NEEDED = (100, 3000)  # samples of a row at which the true error is the target
FIRST = 8


def next_amount(amount):
    return amount + int(max(LEAST_STEP, (1 << (amount.bit_length() - 1)) // STEPS))


def next_check(amount, ratio):
    most = amount * min(MOST_GROWTH, 1 + SHARE * (ratio**2 - 1))
    following = next_amount(amount)
    while next_amount(following) <= most:
        following = next_amount(following)
    return following


def refine(random, pairs, needed, following):
    """One measurement of a quantity that is 0: whether 1.96 errors cover it, its samples relative to `needed`, and its checks."""
    target = 1 / numpy.sqrt(2 * pairs * needed)
    sums, done, amount, checks = numpy.zeros((2, pairs)), 0, FIRST, 0
    while True:
        sums += random.normal(0, numpy.sqrt(amount - done), sums.shape)
        done, means, checks = amount, sums / amount, checks + 1
        error = numpy.sqrt(((means[0] - means[1]) ** 2).sum()) / (2 * pairs)
        if error <= target:
            return abs(means.mean()) < 1.96 * error, amount / needed, checks
        amount = following(amount, error / target)


def main():
    options = arguments("refinement")
    random = numpy.random.default_rng(1)
    rows = []
    for name, following in (("eight amounts of each doubling", lambda amount, ratio: next_amount(amount)),
                            ("those that `brf` checks", next_check)):
        results = {(pairs, needed): numpy.array([refine(random, pairs, needed, following) for _ in range(40 if options.quick else 4000)])
                   for pairs in DEGREES for needed in NEEDED}
        coverage = [", ".join(f"{results[pairs, needed][:, 0].mean():.3f}" for needed in NEEDED) for pairs in DEGREES]
        paths = ", ".join(f"{x.mean():.2f} ± {x.std():.2f}" for needed in NEEDED for x in [results[64, needed][:, 1]])
        checks = ", ".join(f"{results[64, needed][:, 2].mean():.0f}" for needed in NEEDED)
        rows.append([name, *coverage, paths, checks])
    head = ["checked", *(f"coverage, {pairs} degrees" for pairs in DEGREES), "paths, 64 degrees", "checks, 64 degrees"]
    text = table(head, rows)
    write_section(options.docs / "internals.md", "refinement", text)
    print(text)


if __name__ == "__main__":
    main()
