"""Sampler "lattice": variance for random half-spaces (section "lattice" of docs/internals.md)

The variance is relative to Owen-scrambled points of Sobol's sequence. Takes a minute.
  --search   searches factors for the light and for the direction, and then for the wavelengths, by the same measure, and
             prints the best ones
  --quick    few half-spaces, into build/lattice_report
"""

import re

import numpy
from scipy.stats import qmc

from .shared.tools import ROOT, arguments, table, write_section

SOURCE = (ROOT / "src/cameras/samplers.cpp").read_text(encoding="utf-8")
SECOND = int(re.search(r"kSecond = (0x[0-9a-f]+)", SOURCE)[1], 16)
REORDER = int(re.search(r"kReorder = (0x[0-9a-f]+)", SOURCE)[1], 16)
FACTORS = {name: int(re.search(rf"{constant} = (\d+)", SOURCE)[1]) for name, constant in
           [("film", "kFilm"), ("lens", "kLens"), ("on_light", "kOnLight"), ("direction", "kDirection"), ("wavelengths", "kWavelengths")]}
COUNTS = [16, 64, 256, 1024]
# Pairs of dimensions; "twice" has two points of its second pair for each one of the first. With "wavelengths" the points inside
# count by a colour that depends on the number of the wavelengths.
CASES = {"film": ["film"], "film, light": ["film", "on_light"], "film, direction": ["film", "direction"],
         "film, lens": ["film", "lens"], "film, light twice": ["film", "on_light", "twice"],
         "film, direction twice": ["film", "direction", "twice"], "film, light, direction": ["film", "on_light", "direction"],
         "film, blue": ["film", "wavelengths"], "film, light, blue": ["film", "on_light", "wavelengths"],
         "film, direction, blue": ["film", "direction", "wavelengths"]}
WEIGHTS = {16: 1, 64: 2, 256: 2, 1024: 1}  # of numbers of points in the search
BLUE = 0.58  # standard deviation of the blue of four wavelengths at equal steps over their place in the steps, nearly a cosine
random = numpy.random.default_rng(1)


class HalfSpaces:
    """Random half-spaces through the unit cube. Pairs of dimensions contribute to a normal by different shares, since most
    edges depend on some of the pairs alone."""

    def __init__(self, dimensions, count):
        normal = random.normal(size=(count, dimensions))
        shares = numpy.exp(1.3 * random.normal(size=(count, dimensions // 2)))
        self.normal = (normal * numpy.repeat(shares, 2, axis=1)).astype("float32").T
        self.threshold = (self.normal * random.random((dimensions, count), dtype="float32")).sum(axis=0)
        self.phase = random.random(count, dtype="float32")
        self.volume = self.inside(qmc.Sobol(dimensions, seed=1).random(1 << 15))

    def inside(self, points):
        """Share of the points that lie inside. A column after the pairs is the number of the wavelengths."""
        pairs = len(self.normal)
        inside = points[:, :pairs].astype("float32") @ self.normal < self.threshold
        if points.shape[1] > pairs:
            inside = inside * (1 + BLUE * 2**0.5 * numpy.cos(2 * numpy.pi * (points[:, pairs:].astype("float32") + self.phase)))
        return inside.mean(axis=0)

    def variance(self, make, rounds):
        """Mean squared error of the volumes by point sets that `make` returns."""
        return numpy.mean([(self.inside(make()) - self.volume) ** 2 for _ in range(rounds)])


def lattice(count, factors, twice=False, stride=1, on_spectrum=0):
    """Point sets of one pixel each, without reflections. The radical inverses of 2^n samples are all multiples of 2^-n; those of
    every `stride`-th sample are the first of them. `on_spectrum`: the factor of the wavelengths, if there are any."""
    total = 2 * count if twice else count * stride
    factors = factors if stride == 1 else [k * REORDER % total for k in factors]
    assert not on_spectrum or (stride == 1 and not twice)
    by = (numpy.array([[k, k * SECOND] for k in factors]) * ([[2], [1]] if twice else 1)).ravel()
    if on_spectrum:
        by = numpy.append(by, on_spectrum)
    points = numpy.outer(numpy.arange(total // stride), by % total) % total / total
    return lambda: (points + random.random(points.shape[1])) % 1


def sobol(count, pairs, twice=False, on_spectrum=0):
    """The same by Sobol's sequence, shuffled for each pair and for the wavelengths."""
    def make():
        sets = [random.permutation(qmc.Sobol(2, seed=random).random(count)) for _ in range(pairs)]
        if twice:
            sets = [numpy.repeat(sets[0], 2, axis=0), qmc.Sobol(2, seed=random).random(2 * count)]
            sets[1] = random.permutation(sets[1].reshape(count, 2, 2)).reshape(-1, 2)
        if on_spectrum:
            sets.append(random.permutation(qmc.Sobol(1, seed=random).random(count)))
        return numpy.concatenate(sets, axis=1)
    return make


class Measure:
    """Variance of lattices relative to Sobol's sequence."""

    def __init__(self, half_spaces, rounds):
        self.spaces = {pairs: HalfSpaces(2 * pairs, half_spaces) for pairs in (1, 2, 3)}
        self.rounds, self.known = rounds, {}

    def rounds_of(self, count):
        return max(3, self.rounds * 64 // (64 + count))

    def ratio(self, count, factors, twice=False, stride=1, on_spectrum=0):
        case, rounds = (count, len(factors), twice, on_spectrum != 0), self.rounds_of(count)
        spaces = self.spaces[len(factors)]
        if case not in self.known:
            self.known[case] = spaces.variance(sobol(*case), 2 * rounds)
        return spaces.variance(lattice(count, factors, twice, stride, on_spectrum), rounds) / self.known[case]


def bits(counts, step, points):
    """What the steps of a search add to an odd factor: the bits that matter for `points` points and not yet in the last step."""
    return range(1, points, 2) if step == 0 else range(0, points, points // counts[step] * counts[step - 1])


def search(measure):
    """Factors of the light and the direction: their bits that matter for 16 points, then two more for each four times as many."""
    found = [(0, 0, 0)]
    for step, count in enumerate(COUNTS):
        odd = bits(COUNTS, step, 2 * count)
        scores = []
        for score, light, direction in found:
            for b in odd:
                twice = measure.ratio(count, [1, light + b], True)
                for c in odd:
                    k, m = light + b, direction + c
                    joint = measure.ratio(count, [1, k]) + 0.6 * measure.ratio(count, [1, m]) + measure.ratio(count, [1, k, m])
                    both = twice + measure.ratio(count, [1, m], True)
                    scores.append((score + WEIGHTS[count] * (joint + 0.4 * both), k, m))
        found = sorted(scores)[:40]
        print(count, "points: light", found[0][1], "direction", found[0][2], flush=True)


def search_wavelengths(measure):
    """The same for the wavelengths, from 4 points on, with the other factors as they are."""
    found, counts = [(0, 0)], [4, *COUNTS]
    for step, count in enumerate(counts):
        scores = []
        for score, factor in found:
            for b in bits(counts, step, count):
                of = [measure.ratio(count, [FACTORS[d] for d in pairs], on_spectrum=factor + b)
                      for pairs in (["film"], ["film", "on_light"], ["film", "direction"], ["film", "on_light", "direction"])]
                scores.append((score + WEIGHTS.get(count, 1) * numpy.dot(of, [1, 1, 0.7, 0.7]), factor + b))
        found = sorted(scores)[:40]
        print(count, "points: wavelengths", [factor for _, factor in found[:8]], flush=True)


def by_orientation(count, rounds):
    """Variance of edges by their angle, relative to Sobol's sequence: of one lattice, and with random reflections."""
    angles, places = numpy.radians(numpy.arange(1.5, 180, 3)), random.random((40, 2))
    variances = {}
    for name, make in {"lattice": lattice(count, [1]), "sobol": sobol(count, 1)}.items():
        inside = [[numpy.mean((points - place) @ [numpy.cos(angle), numpy.sin(angle)] < 0) for _ in range(rounds)
                   for points in [make()]] for angle in angles for place in places]
        variances[name] = numpy.var(inside, axis=1).reshape(len(angles), len(places)).mean(axis=1)
    one, n, k = variances["lattice"], len(angles), numpy.arange(len(angles))
    # x reflected: 180 degrees less the angle; x and y exchanged: 90 degrees less the angle.
    reflected = (one + one[::-1] + one[(n // 2 - 1 - k) % n] + one[(k - n // 2) % n]) / 4
    return one / variances["sobol"], reflected / variances["sobol"]


def main():
    options = arguments("lattice", ("--search", dict(action="store_true", help="search factors")))
    if options.search:
        measure = Measure(500, 6)
        search(measure)
        return search_wavelengths(measure)
    measure = Measure(300 if options.quick else 2000, 4 if options.quick else 60)
    rows = []
    for name, dimensions in CASES.items():
        factors = [FACTORS[d] for d in dimensions if d not in ("twice", "wavelengths")]
        on_spectrum = FACTORS["wavelengths"] if "wavelengths" in dimensions else 0
        rows.append([name] + [f"{measure.ratio(count, factors, 'twice' in dimensions, on_spectrum=on_spectrum):.2f}"
                              for count in COUNTS])
    for stride, name in ((2, "second"), (4, "fourth"), (8, "eighth")):
        rows.append([f"film, every {name} sample"] + [f"{measure.ratio(count, [1], stride=stride):.2f}" for count in COUNTS])
    spaces = measure.spaces[3]
    joint = [spaces.variance(lambda n=count: qmc.Sobol(6, seed=random).random(n), 2 * measure.rounds_of(count))
             for count in COUNTS]
    rows.append(["the same by Sobol's sequence in six dimensions"] +
                [f"{variance / measure.known[count, 3, False, False]:.2f}" for count, variance in zip(COUNTS, joint)])
    one, reflected = by_orientation(64, 8 if options.quick else 100)
    text = table(["pairs of dimensions"] + [f"{count} samples" for count in COUNTS], rows)
    text += (f"\nBy the orientation of an edge in the pixel, with 64 samples: {one.min():.1f} to {one.max():.1f} without the "
             f"reflections, {reflected.min():.1f} to {reflected.max():.1f} with them.\n")
    write_section(options.docs / "internals.md", "lattice", text)
    print(text)


if __name__ == "__main__":
    main()
