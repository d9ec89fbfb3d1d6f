"""The table of reflectances and transmittances: solved against sampled."""

import re
import subprocess

from tools import COLORS, FROND, block, rows, table
from validation_report import LEAVES, rms

TABLE_ANGLES = "0:90:15,105:180:15"


def timed_table(leaf, *options):
    """Rows of a table by (angle, wavelength), and the CPU time that it took without starting the program."""
    words = [FROND, "table", "--specimen", leaf, "--wavelengths", "608,551,455", "--angles", TABLE_ANGLES, "--threads",
             "1", "-o", "-", *options]
    done = subprocess.run([str(w) for w in words], capture_output=True, text=True, check=True)
    seconds = float(re.search(r"([0-9.e+-]+) s of CPU", done.stderr).group(1))
    return {(r["theta_deg"], r["wavelength_nm"]): r for r in rows(done.stdout)}, seconds


def difference(a, b):
    """RMS over the table's figures, and the largest."""
    d = [a[k][name] - b[k][name] for k in b for name in ("Rd", "T")]
    return rms(d), max(map(abs, d))


def tables(report):
    report.add("""
## The table: solved against sampled

Rd and T by both methods, at 13 angles of incidence on both sides and 608, 551 and 455 nm. The reference is the
solution with 40 nodes a segment. Monte Carlo is the paper's: analog walks, here by the batched kernel.
""")
    body, data, plots = [], "", []
    for number_of_leaf, leaf in enumerate(LEAVES):
        exact, _ = timed_table(leaf, "--method", "solve", "--nodes", 40)
        sampled, solved = [], []
        for rays in (1e3, 1e4, 1e5) if report.quick else (1e3, 1e4, 1e5, 1e6, 1e7):
            values, seconds = timed_table(leaf, "--method", "montecarlo", "--rays", f"{rays:.0e}")
            error, worst = difference(values, exact)
            sampled.append((seconds, error))
            body.append([leaf, f"Monte Carlo, {rays:.0e} rays", f"{seconds:.3g}", f"{error:.1e}", f"{worst:.1e}"])
        for nodes in (3, 4, 6, 8, 12, 16, 24):
            values, seconds = timed_table(leaf, "--method", "solve", "--nodes", nodes)
            error, worst = difference(values, exact)
            solved.append((seconds, error))
            body.append([leaf, f"solve, {nodes} nodes", f"{seconds:.3g}", f"{error:.1e}", f"{worst:.1e}"])
        color, mark = COLORS[1 + number_of_leaf], 7 + 2 * number_of_leaf
        data += block(f"mc{number_of_leaf}", sampled) + block(f"so{number_of_leaf}", solved)
        plots += [f"$mc{number_of_leaf} with linespoints pt {mark} lw 2 lc rgb '{color}' title '{leaf}, Monte Carlo'",
                  f"$so{number_of_leaf} with linespoints pt {mark - 1} lw 2 dt (6,3) lc rgb '{color}' title '{leaf}, solved'"]
    report.chart("table-error", "Error of the table against CPU time", data + f"""
set title 'Table of 13 angles, three wavelengths'
set logscale xy
set format xy '10^{{%L}}'
set yrange [1e-11:0.1]
set xlabel 'CPU time (s)'
set ylabel 'RMS error of Rd and T'
set key bottom left
plot {', '.join(plots)}
""")
    report.add(table(["leaf", "method", "CPU s", "RMS error", "largest"], body))
