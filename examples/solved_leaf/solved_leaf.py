"""A second solver of leaf_solved in plain Python, written from docs/leaf_models.md alone: some modes of both kinds of leaf.

    solved_leaf.py FROND    builds them for soybean and maize at 551 nm and compares them with those of `frond table
                            leaf_solved`
"""

import math
import subprocess
import sys

NODES = 4  # a segment
N_MESOPHYLL, N_WALL = 1.416, 1.411  # at 551 nm; the cuticle's index and the depth come with the table


class Leaf:
    """Indices of media 0 to 6, the mesophyll's depth, and exponents of lobes [interface][going up][refracted]."""

    def __init__(self, specimen, n_cuticle, depth):
        self.moves, self.depth = specimen == "maize", depth
        cut, epi, pal, spo = (10, 5, None, 5) if self.moves else (5, 5, 1, 5)
        inner = N_MESOPHYLL if self.moves else N_WALL
        self.n = [1, n_cuticle, N_MESOPHYLL, 1, inner, n_cuticle, 1]
        above, below = [[cut, epi], [epi, None]], [[epi, None], [cut, epi]]
        if self.moves:
            self.lobe = [above, [[epi, spo], [spo, epi]], [[spo, spo], [spo, spo]], [[spo, spo], [spo, spo]],
                         [[spo, epi], [epi, spo]], below]
        else:
            self.lobe = [above, [[epi, pal], [pal, epi]], [[pal, spo], [spo, pal]], [[None, None], [None, None]],
                         [[None, epi], [epi, None]], below]

    def depths(self):
        """(weight, optical depth of each medium): one, or the places of the air space."""
        if not self.moves:
            return [(1, [0, 0, self.depth, 0, 0, 0, 0])]
        places = []
        for s, w in gauss(2 * NODES):
            p = s * s * (3 - 2 * s)
            places.append((w * 6 * s * (1 - s), [0, 0, self.depth * p, 0, self.depth * (1 - p), 0, 0]))
        return places


def gauss(count):
    """Gauss-Legendre on [0, 1]."""
    rule = []
    for i in range(count):
        x = math.cos(math.pi * (i + 0.75) / (count + 0.5))
        for _ in range(100):
            p0, p1 = 1.0, x
            for k in range(2, count + 1):
                p0, p1 = p1, ((2 * k - 1) * x * p1 - (k - 1) * p0) / k
            slope = count * (x * p1 - p0) / (x * x - 1)
            x -= p1 / slope
        rule.append(((1 - x) / 2, 1 / ((1 - x * x) * slope * slope)))
    return rule


def directions(n, indices):
    """(mu, weight) of the nodes in a medium of index n, ascending in k."""
    nodes, below = [], 0.0
    for ns in sorted(set(indices)):
        if ns > n:
            break
        widest = math.sqrt(1 - (below / ns) ** 2)
        for high, low in ((1, 0.3), (0.3, 0.05), (0.05, 0)):
            for x, w in RULE:
                mu_s = widest * (high - x * (high - low))
                mu = math.sqrt((n - ns) * (n + ns) + (ns * mu_s) ** 2) / n
                nodes.append((mu, w * widest * (high - low) * ns * ns * mu_s / (n * n * mu)))
        below = ns
    return nodes


RULE, AZIMUTHS = gauss(NODES), gauss(32)


def lobe_mode(e, mu_axis, mu, m):
    """A_m by quadrature over the azimuths that the cut leaves, in place of the recurrence."""
    a, b = mu_axis * mu, math.sqrt((1 - mu_axis**2) * (1 - mu**2))
    most = math.pi if a >= b else math.acos(-a / b)
    return most / math.pi * sum(w * max(0.0, a + b * math.cos(most * x)) ** e * math.cos(m * most * x)
                                for x, w in AZIMUTHS)


def fresnel(mu, eta):
    """Reflectance, and the cosine beyond; eta = n here / n there."""
    cos2 = 1 - eta * eta * (1 - mu * mu)
    if cos2 <= 0:
        return 1.0, 0.0
    beyond = math.sqrt(cos2)
    s, p = (eta * mu - beyond) / (eta * mu + beyond), (mu - eta * beyond) / (mu + eta * beyond)
    return (s * s + p * p) / 2, beyond


def product(a, b):
    columns = list(zip(*b))
    return [[sum(x * y for x, y in zip(row, column)) for column in columns] for row in a]


def total(a, b):
    return [[x + y for x, y in zip(p, q)] for p, q in zip(a, b)]


def solve(a, b):
    """a^-1 b, by elimination with pivots."""
    rows = [p + q for p, q in zip(a, b)]
    size = len(rows)
    for i in range(size):
        pivot = max(range(i, size), key=lambda r: abs(rows[r][i]))
        rows[i], rows[pivot] = rows[pivot], rows[i]
        rows[i] = [x / rows[i][i] for x in rows[i]]
        for r in range(size):
            if r != i and rows[r][i] != 0:
                factor = rows[r][i]
                rows[r] = [x - factor * y for x, y in zip(rows[r], rows[i])]
    return [row[size:] for row in rows]


class Mode:
    def __init__(self, leaf, m, sines):
        self.leaf, self.m, self.sines = leaf, m, sines
        self.nodes = [directions(n, leaf.n) for n in leaf.n]
        self.kept, self.matrices = {}, {}

    def whole(self, e, j):
        """N for the axes that are nodes of medium j: the sum of A_0 w."""
        if (e, j) not in self.kept:
            self.kept[e, j] = [sum(lobe_mode(e, axis, mu, 0) * w for mu, w in self.nodes[j])
                               for axis, _ in self.nodes[j]]
        return self.kept[e, j]

    def kernel(self, e, j):
        """K_m in medium j."""
        if (e, j) not in self.matrices:
            self.matrices[e, j] = [[lobe_mode(e, axis, mu, self.m) * w / n for mu, w in self.nodes[j]]
                                   for (axis, _), n in zip(self.nodes[j], self.whole(e, j))]
        return self.matrices[e, j]

    def branch(self, j, up, refracts):
        """R or T of rays in medium j."""
        to = (j - 1 if up else j + 1) if refracts else j
        e = self.leaf.lobe[j - 1 if up else j][up][refracts]
        size = len(self.nodes[to])
        result = []
        for i, chance in enumerate(self.chances(j, up, refracts)):
            if i >= size:  # beyond the critical angle
                result.append([0.0] * size)
            elif e is None:
                result.append([chance if k == i else 0.0 for k in range(size)])
            else:
                result.append([chance * x for x in self.kernel(e, to)[i]])
        return result

    def chances(self, j, up, refracts):
        eta = self.leaf.n[j] / self.leaf.n[j - 1 if up else j + 1]
        reflectances = [fresnel(mu, eta)[0] for mu, _ in self.nodes[j]]
        return [1 - f if refracts else f for f in reflectances]

    def source(self, j, up):
        """s of medium j: columns are the ways out, by the adaxial side and by the abaxial one."""
        ways = len(self.sines)
        exits = {(1, False): (False, 0), (2, True): (True, 0), (5, True): (False, 1), (4, False): (True, 1)}
        if (j, up) not in exits:
            return [[0.0] * (2 * ways) for _ in self.nodes[j]]
        refracts, side = exits[j, up]
        to = (j - 1 if up else j + 1) if refracts else j
        e = self.leaf.lobe[j - 1 if up else j][up][refracts]
        result = []
        for i, chance in enumerate(self.chances(j, up, refracts)):
            row = [0.0] * (2 * ways)
            if i < len(self.nodes[to]):
                axis, whole = self.nodes[to][i][0], self.whole(e, to)[i]
                row[side * ways:(side + 1) * ways] = [chance * lobe_mode(e, axis, mu, self.m) / whole
                                                      for mu in self.inner()]
            result.append(row)
        return result

    def inner(self):
        """Cosines inside of the directions outside."""
        return [math.sqrt(1 - (s / self.leaf.n[1]) ** 2) for s in self.sines]

    def prospects(self):
        """D_1 and U_5: means over the places of the air space."""
        sums = None
        for weight, depths in self.leaf.depths():
            part = [[[weight * x for x in row] for row in side] for side in self.prospects_at(depths)]
            sums = part if sums is None else [total(a, b) for a, b in zip(sums, part)]
        return sums

    def prospects_at(self, depths):
        def survive(j, matrix):
            return [[x * math.exp(-depths[j] / mu) for x in row] for (mu, _), row in zip(self.nodes[j], matrix)]

        p, q = survive(1, self.branch(1, True, False)), survive(1, self.source(1, True))
        xs, ys = {}, {}
        for j in range(1, 6):
            down = survive(j, self.branch(j, False, False))
            loop = [[(i == k) - x for k, x in enumerate(row)] for i, row in enumerate(product(down, p))]
            ys[j] = solve(loop, total(product(down, q), survive(j, self.source(j, False))))
            if j == 5:
                break
            xs[j] = solve(loop, survive(j, self.branch(j, False, True)))
            up = survive(j + 1, self.branch(j + 1, True, True))
            q = total(product(up, total(product(p, ys[j]), q)), survive(j + 1, self.source(j + 1, True)))
            p = total(survive(j + 1, self.branch(j + 1, True, False)), product(up, product(p, xs[j])))
        upward = total(product(p, ys[5]), q)
        downward = ys[5]
        for j in range(4, 0, -1):
            downward = total(product(xs[j], downward), ys[j])
        return downward, upward

    def h(self):
        """As files have it: [lit side][way out](incident sine, leaving sine)."""
        e, ways = self.leaf.lobe[0][False][True], len(self.sines)
        entrance = []
        for axis in self.inner():
            whole = sum(lobe_mode(e, axis, mu, 0) * w for mu, w in self.nodes[1])
            entrance.append([lobe_mode(e, axis, mu, self.m) * w / whole for mu, w in self.nodes[1]])
        scale = (1 if self.m == 0 else 2) / (2 * math.pi * self.leaf.n[1] ** 2)
        above, below = ([[scale * x for x in row] for row in product(entrance, side)] for side in self.prospects())
        part = lambda rows, side: [row[side * ways:(side + 1) * ways] for row in rows]
        return [[part(above, 0), part(above, 1)], [part(below, 1), part(below, 0)]]


def file_modes(frond, specimen):
    """Cells, index, depth and the modes of the table that the program writes."""
    words = [frond, "table", f"leaf_solved,specimen={specimen},tolerance=1e-2", "--nodes", str(NODES),
             "--wavelengths", "551", "-q", "-o", "-"]
    text = subprocess.run(words, capture_output=True, text=True, check=True).stdout
    lines = [line.split() for line in text.splitlines() if not line.startswith("#")]
    cells, (_, _, _, index, _, depth) = int(lines[0][1]), lines[2]
    modes, at = {}, 3
    while at < len(lines):
        side, way, _, count = lines[at]
        at += 1
        for m in range(int(count)):
            grid = lines[at:at + cells + 2]
            modes[side == "abaxial", way == "transmitted", m] = [[float(x) for x in row] for row in grid]
            at += cells + 2
    return cells, float(index), float(depth), modes


def difference(frond, specimen):
    cells, n_cuticle, depth, expected = file_modes(frond, specimen)
    leaf = Leaf(specimen, n_cuticle, depth)
    sines = [k / cells for k in range(cells + 2)]
    largest = 0.0
    for m in (0, 1):
        mode = Mode(leaf, m, sines).h()
        for (below, crosses, which), grid in expected.items():
            if which == m:
                pairs = zip((x for row in mode[below][crosses] for x in row), (x for row in grid for x in row))
                largest = max(largest, max(abs(x - y) for x, y in pairs))
    return largest


def main():
    failed = False
    for specimen in ("soybean", "maize"):
        largest = difference(sys.argv[1], specimen)
        print(f"{specimen}: largest difference {largest:.1e}")
        failed = failed or not largest < 1e-10
    sys.exit(failed)


if __name__ == "__main__":
    main()
