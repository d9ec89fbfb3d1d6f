"""A comparison of two runs as one self-contained HTML page."""

import html as html_library
import pathlib
import re

import numpy
import pandas

from ..shared.tools import ROOT
from . import plot
from .comparison import FALSE_ALARMS, warnings
from .text import change, interval, seconds, verdict

HERE = pathlib.Path(__file__).parent
STYLES = (ROOT / "src/study/compare/page/page.css", HERE / "page.css")  # the style of frond compare's report, and additions
SIGNS = {"slower": "▲ slower", "faster": "▼ faster", "": ""}
CHANNELS = ("red", "green", "blue")


def escape(value):
    return html_library.escape(str(value))


def span(content, kind):
    return f'<span class="{kind}">{content}</span>' if kind else content


def table(head, rows, **more):
    frame = pandas.DataFrame([list(map(str, row)) for row in rows], columns=head)
    with pandas.option_context("display.max_colwidth", None):
        return f'<div class="scroll">{frame.to_html(escape=False, index=False, border=0, **more)}</div>'


def warning_list(comparison):
    found = warnings(comparison)
    return f"<ul class=\"warnings\">{''.join(f'<li>{escape(w)}</li>' for w in found)}</ul>" if found else ""


def runs(comparison):
    keys = {"commit": "Commit", "date": "Date", "machine": "Machine", "compiler": "Compiler", "compiler_flags": "Flags",
            "frond_version": "frond"}
    both = (comparison.a, comparison.b)
    rows = [[what, *(escape(r.context.get(key, "unknown")) for r in both)] for key, what in keys.items()]
    return table(["", "A", "B"], [*rows, ["Rounds", *(r.rounds for r in both)]], classes="runs")


def family_table(comparison):
    rows = []
    for name, (changes, mean) in comparison.families().items():
        marks = [c.mark for c in changes]
        rows.append([escape(name), len(changes), marks.count("slower") or "-", marks.count("faster") or "-", change(mean.ratio),
                     interval(mean.low, mean.high), change(changes[-1].ratio), change(changes[0].ratio)])
    return table(["family", "benchmarks", "▲ slower", "▼ faster", "mean change", "95 % interval", "from", "to"], rows)


def time_table(comparison):
    axis = plot.Axis([c.ratio for c in comparison.times])
    rows = [[span(SIGNS[c.mark], c.mark), f"<code>{escape(c.name)}</code>", seconds(c.a), seconds(c.b),
             span(change(c.ratio), c.mark), interval(c.low, c.high), axis.bar(c.low, c.ratio, c.high, c.mark)]
            for c in comparison.times]
    return table(["", "benchmark", "A", "B", "change", "95 % interval", axis.labels()], rows, table_id="times")


def figure(change_of_figure, unit):
    """The cell of a counter of the images' errors."""
    a, b = (f"{x / unit:.3g}".replace("-", "−") for x in (change_of_figure.a, change_of_figure.b))
    if change_of_figure.mark == "same":
        return span(a, "same")
    return span(f"{a} → {b}", "changed" if change_of_figure.mark == "changed" else "")


def derived(comparison, name, counter, unit):
    """The cell of a counter that depends on time; its significance is that of the times."""
    found = [run.counters[name].get(counter) for run in (comparison.a, comparison.b)]
    return "-" if any(x is None for x in found) else " → ".join(f"{numpy.exp(numpy.log(x).mean()) / unit:.3g}" for x in found)


# For each counter the heading of its column and the unit.
TIMED = {"us_per_path": ("µs per path", 1), "speedup": ("speed-up", 1),
         "speedup_equal_noise": ("speed-up at equal noise", 1), "efficiency": ("efficiency, 10⁹/s", 1e9)}
ERRORS = {f"{kind}_{c}": (f"{word} {c}, {power}", unit) for kind, word, power, unit in (
    ("offset", "offset", "10⁻³", 1e-3), ("rms", "RMS", "10⁻³", 1e-3), ("bias2", "bias²", "10⁻⁶", 1e-6))
    for c in CHANNELS} | {"variance": ("variance, 10⁻⁶", 1e-6)}


def scene_table(names, columns, content):
    rows = []
    for name in names:
        _, scene, leaf = name.split("/")
        rows.append([escape(scene), f"<code>{escape(leaf)}</code>",
                     *(content(name, counter, unit) for counter, (_, unit) in columns.items())])
    return table(["scene", "leaf", *(words for words, _ in columns.values())], rows, classes="names")


def scene_sections(comparison):
    figures = {(f.name, f.counter): f for f in comparison.figures}
    timed = [name for name in comparison.names if name.startswith("scene/")]
    judged = [name for name in timed if (name, "variance") in figures]
    if not judged:
        return ""
    return f"""<section><h2>Scenes: cost</h2>
{scene_table(timed, TIMED, lambda *column: derived(comparison, *column))}
</section>
<section><h2>Scenes: error</h2>
<p class="note">One value if A and B are equal to the last digit, otherwise A → B; <span class="changed">bold</span>
if they differ by more than their standard errors explain.</p>
{scene_table(judged, ERRORS, lambda name, counter, unit: figure(figures[name, counter], unit))}
</section>"""


def method(comparison):
    how = ("A and B ran in turn in each round, and the ratio of each round is one value" if comparison.paired else
           "A and B are two separate runs (Welch's test)")
    return f"""<p>Each round is a separate process; a benchmark's time in a round is that of its fastest repetition, which
other work disturbed least. {how}. The test is Student's t on logarithms, corrected for the number of benchmarks (Holm 1979): in two runs
of one program any benchmark is marked with a probability of {FALSE_ALARMS:.0%}. A different memory layout of the same code can
change a benchmark of nanoseconds by a few per cent; this is a real change of the time, but means nothing.</p>
<p>Offset, RMS, bias² and variance come from renders with fixed seeds: the same code gives the same digits. Differing values
are tested against their standard errors, with a probability of {FALSE_ALARMS:.0%} for a false alarm among all of them.
docs/performance.md defines the counters.</p>"""


def html(comparison):
    values = {
        "title": escape(f"Benchmarks: {comparison.b.label} against {comparison.a.label}"),
        "css": "\n".join(path.read_text(encoding="utf-8") for path in STYLES),
        "verdict": escape(verdict(comparison)), "warnings": warning_list(comparison), "runs": runs(comparison),
        "families": family_table(comparison), "times": time_table(comparison), "scenes": scene_sections(comparison),
        "method": method(comparison), "alarms": f"with a false-alarm rate of {FALSE_ALARMS:.0%}",
    }
    page = (HERE / "page.html").read_text(encoding="utf-8")
    return re.sub(r"\{\{(\w+)\}\}", lambda m: values[m[1]], page)
