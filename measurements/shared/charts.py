"""One style for the charts of all measurements: SVG whose text is text, the same bytes for the same figures."""

import matplotlib

matplotlib.use("svg")
from matplotlib import pyplot

# Colours that people of any colour vision tell apart (Okabe and Ito 2008).
COLORS = ["#000000", "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"]

pyplot.rcParams.update({
    "svg.fonttype": "none", "svg.hashsalt": "frond", "font.family": "DejaVu Sans", "font.size": 10.5, "axes.titlesize": 10.5,
    "legend.frameon": False, "axes.grid": True, "grid.color": "#dddddd", "axes.axisbelow": True, "axes.formatter.min_exponent": 4, "axes.linewidth": 1.1,
    "lines.linewidth": 1.8, "lines.markersize": 5, "figure.constrained_layout.use": True,
    "axes.prop_cycle": matplotlib.cycler(color=COLORS[1:])})


def figure(width, height, rows=1, columns=1, **more):
    """A figure of so many pixels, and its panels `[row][column]`."""
    return pyplot.subplots(rows, columns, figsize=(width / 96, height / 96), squeeze=False, **more)


def plain_ticks(axis, ticks):
    """These alone on a logarithmic axis, written as they are."""
    axis.set_ticks(ticks, [f"{t:g}" for t in ticks])
    axis.set_ticks([], minor=True)


def legend(of, panel, columns):
    """Of what a panel shows, below all panels: it hides nothing."""
    of.legend(*panel.get_legend_handles_labels(), loc="outside lower center", ncols=columns)


def save(of, path):
    path.parent.mkdir(parents=True, exist_ok=True)
    of.savefig(path, metadata={"Date": None})
    pyplot.close(of)
