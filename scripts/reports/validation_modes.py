"""The table of modes: error against nodes, cells, modes and time."""

import math
import re
import subprocess

from tools import FROND, frond, rows, table
from validation_report import LEAVES, rms


class Modes:
    """What `frond table leaf_solved` writes: cells and, by wavelength, index and modes [side][way][m][sin i][sin o]."""

    def __init__(self, leaf, nm, *options):
        words = [FROND, "table", f"leaf_solved,specimen={leaf}", "--wavelengths", nm, "--threads", 1, "-o", "-", *options]
        done = subprocess.run([str(w) for w in words], capture_output=True, text=True, check=True)
        self.seconds = float(re.search(r"([0-9.e+-]+) s of CPU", done.stderr).group(1))
        self.kilobytes = int(re.search(r"([0-9]+) kB in a render", done.stderr).group(1))
        lines = [line.split() for line in done.stdout.splitlines() if not line.startswith("#")]
        self.cells, at, self.columns = int(lines[0][1]), 2, []
        while at < len(lines):
            index, series = float(lines[at][3]), []
            at += 1
            for _ in range(4):
                count, at = int(lines[at][3]), at + 1
                grids = [lines[at + m * (self.cells + 2):at + (m + 1) * (self.cells + 2)] for m in range(count)]
                series.append([[[float(x) for x in row] for row in grid] for grid in grids])
                at += count * (self.cells + 2)
            self.columns.append((index, series))

    def counts(self):
        """Most modes that light takes that comes back, and that crosses."""
        return [max(len(series[k]) for _, series in self.columns for k in ways) for ways in ((0, 2), (1, 3))]


def passage(sine, index):
    """1 - F and the cosine inside, of a direction outside."""
    mu, inside = math.sqrt(1 - sine * sine), math.sqrt(1 - (sine / index) ** 2)
    s, p = (mu - index * inside) / (mu + index * inside), (index * mu - inside) / (index * mu + inside)
    return 1 - (s * s + p * p) / 2, inside


def largest_between(a, b):
    """Largest difference of pi f at the grid's nodes, over azimuths."""
    largest = 0
    for (index, first), (_, second) in zip(a.columns, b.columns):
        through = [passage(i / a.cells, index) for i in range(a.cells + 1)]
        for x, y in zip(first, second):
            none = [[0] * (a.cells + 2)] * (a.cells + 2)
            differences = [(x[m] if m < len(x) else none, y[m] if m < len(y) else none) for m in range(max(len(x), len(y)))]
            for i in range(a.cells + 1):
                for o in range(a.cells + 1):
                    d = [p[i][o] - q[i][o] for p, q in differences]
                    scale = math.pi * through[i][0] * through[o][0] / through[o][1]
                    for k in range(9):
                        f = sum(x * math.cos(m * k * math.pi / 8) for m, x in enumerate(d))
                        largest = max(largest, abs(f) * scale)
    return largest


def small_patches(leaf, tolerance, step):
    """f over patches of 2 by 10 degrees, light at every `step` degrees on both sides."""
    text = frond("goniophotometer", f"leaf_solved,specimen={leaf},tolerance={tolerance}", "--integrate", "--angles",
                 f"0:88:{step},92:180:{step}", "--wavelengths", "608,551,455", "--patches", "90x36", "--csv", "-", "-q")
    return [p["f_per_sr"] for p in rows(text)]


def modes(report):
    nodes_body, tolerance_body = [], []
    step = 44 if report.quick else 8
    for leaf in LEAVES:
        for nm in (455, 551, 800):
            finest = Modes(leaf, nm, "tolerance=1e-5", "--nodes", 24)
            cells = []
            for nodes in (3, 4, 5, 6, 8, 12):
                some = Modes(leaf, nm, "tolerance=1e-5", "--nodes", nodes)
                cells.append(f"{largest_between(some, finest):.0e}, {1000 * some.seconds:.0f} ms")
            nodes_body.append([f"{leaf}, {nm}"] + cells)
        exact = small_patches(leaf, 1e-5, step)
        for tolerance in (1e-1, 1e-2, 2e-3, 5e-4, 1e-4):
            table_of = Modes(leaf, "608,551,455", f"tolerance={tolerance}")
            off = [math.pi * (x - y) for x, y in zip(small_patches(leaf, tolerance, step), exact)]
            back, across = table_of.counts()
            tolerance_body.append([leaf, f"{tolerance:g}", table_of.cells, f"{back}, {across}", f"{table_of.seconds:.2g}",
                                   table_of.kilobytes, f"{max(map(abs, off)):.1e}", f"{rms(off):.1e}"])
    report.add("""
## The table of modes: error against nodes, cells, modes and time

Of `leaf_solved` (docs/solved_leaf.md); errors are of pi f, which is 1 for white paper; times are CPU times of one core. By
the solver's nodes a segment (`frond table leaf_solved --nodes`), the largest difference from 24 nodes over all angles and
azimuths, and the time for one wavelength at a tolerance of 1e-5; five nodes are the default here:
""")
    report.add(table(["leaf, nm", "3 nodes", "4", "5", "6", "8", "12"], nodes_body))
    report.add(f"""
By `"float tolerance"`, at 608, 551 and 455 nm, the difference from a tolerance of 1e-5 over patches of 2° by 10° all around,
light at every {step}° on both sides; modes are those of light that comes back and of light that crosses:
""")
    report.add(table(["leaf", "tolerance", "cells", "modes", "CPU s", "kB in a render", "largest error", "RMS error"],
                     tolerance_body))
