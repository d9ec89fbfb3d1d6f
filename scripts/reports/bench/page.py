"""A comparison of two runs as one HTML page that needs nothing beside it."""

import html as html_library
import pathlib
import re

from tools import ROOT

from . import plot
from .comparison import FALSE_ALARMS, geometric_mean, warnings
from .text import change, interval, seconds, verdict

HERE = pathlib.Path(__file__).parent
STYLES = (ROOT / "src/study/compare/page/page.css", HERE / "page.css")  # that of frond compare's report, and more
SIGNS = {"slower": "▲ slower", "faster": "▼ faster", "": ""}
CHANNELS = ("red", "green", "blue")


def escape(value):
    return html_library.escape(str(value))


def cell(content, kind="", tag="td"):
    return f'<{tag} class="{kind}">{content}</{tag}>' if kind else f"<{tag}>{content}</{tag}>"


def heading(content, kind=""):
    return cell(content, kind, "th")


def table(head, rows, attributes=""):
    """Headings are texts, or what `heading` makes; each row comes with its own attributes."""
    headings = [h if h.startswith("<th") else heading(h) for h in head]
    lines = [f"<tr{of_row}>{''.join(cells)}</tr>" for of_row, cells in rows]
    return f"<table{attributes}><thead><tr>{''.join(headings)}</tr></thead><tbody>{''.join(lines)}</tbody></table>"


def warning_list(comparison):
    found = warnings(comparison)
    return f"<ul class=\"warnings\">{''.join(f'<li>{escape(w)}</li>' for w in found)}</ul>" if found else ""


def runs(comparison):
    keys = {"commit": "Commit", "date": "Date", "machine": "Machine", "compiler": "Compiler", "compiler_flags": "Flags",
            "frond_version": "frond"}
    both = (comparison.a, comparison.b)
    rows = [("", [cell(what), *(cell(escape(r.context.get(key, "unknown"))) for r in both)])
            for key, what in keys.items()]
    rows.append(("", [cell("Rounds"), *(cell(r.rounds) for r in both)]))
    classes = ' class="runs"'
    return f'<div class="scroll">{table(["", "A", "B"], rows, classes)}</div>'


def family_table(comparison):
    rows = []
    for name, (changes, (ratio, low, high)) in comparison.families().items():
        marks = [c.mark for c in changes]
        rows.append(("", [cell(escape(name)), cell(len(changes)), cell(marks.count("slower") or "-"),
                          cell(marks.count("faster") or "-"), cell(change(ratio)), cell(interval(low, high)),
                          cell(change(changes[-1].ratio)), cell(change(changes[0].ratio))]))
    return table(["family", "benchmarks", "▲ slower", "▼ faster", "mean change", "95 % interval", "from", "to"], rows)


def time_table(comparison):
    axis = plot.Axis([c.ratio for c in comparison.times])
    rows = [(f' data-name="{escape(c.name)}" data-mark="{c.mark}"',
             [cell(SIGNS[c.mark], c.mark), cell(f"<code>{escape(c.name)}</code>"), cell(seconds(c.a)), cell(seconds(c.b)),
              cell(change(c.ratio), c.mark), cell(interval(c.low, c.high)),
              cell(axis.bar(c.low, c.ratio, c.high, c.mark), "plot")]) for c in comparison.times]
    head = ["", "benchmark", "A", "B", "change", "95 % interval", heading(axis.labels(), "plot")]
    return table(head, rows, ' id="times"')


def figure(change_of_figure, unit):
    """A counter of the pictures' errors in one cell."""
    a, b = (f"{x / unit:.3g}".replace("-", "−") for x in (change_of_figure.a, change_of_figure.b))
    if change_of_figure.mark == "same":
        return cell(a, "same")
    return cell(f"{a} → {b}", "changed" if change_of_figure.mark == "changed" else "")


def derived(comparison, name, counter, unit):
    """A counter that hangs on time: its change is the times'."""
    a, b = (run.counters[name].get(counter) for run in (comparison.a, comparison.b))
    return cell(" → ".join(f"{geometric_mean(x) / unit:.3g}" for x in (a, b)) if a and b else "-")


# Of the counters, what stands over their columns and the unit there.
TIMED = {"us_per_path": ("µs a path", 1), "speedup": ("speed-up", 1),
         "speedup_equal_noise": ("speed-up at equal noise", 1), "efficiency": ("efficiency, 10⁹/s", 1e9)}
ERRORS = {f"{kind}_{c}": (f"{word} {c}, {power}", unit) for kind, word, power, unit in (
    ("offset", "offset", "10⁻³", 1e-3), ("rms", "RMS", "10⁻³", 1e-3), ("bias2", "bias²", "10⁻⁶", 1e-6))
    for c in CHANNELS} | {"variance": ("variance, 10⁻⁶", 1e-6)}


def scene_table(names, columns, content):
    rows = []
    for name in names:
        _, scene, leaf = name.split("/")
        rows.append(("", [cell(escape(scene)), cell(f"<code>{escape(leaf)}</code>"),
                          *(content(name, counter, unit) for counter, (_, unit) in columns.items())]))
    head = ["scene", "leaf", *(words for words, _ in columns.values())]
    classes = ' class="names"'
    return f'<div class="scroll">{table(head, rows, classes)}</div>'


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
<p class="note">One figure where A and B have the same to the last digit, else A → B; <span class="changed">bold</span>
where they differ by more than their standard errors explain.</p>
{scene_table(judged, ERRORS, lambda name, counter, unit: figure(figures[name, counter], unit))}
</section>"""


def method(comparison):
    how = ("A and B ran in turn in each round, and the ratio of each round is one figure" if comparison.paired else
           "A and B are two runs of their own (Welch's test)")
    return f"""<p>A round is a process of its own; a benchmark's time in it is that of its fastest repetition, which
other work disturbed least. {how}. The test is Student's t on logarithms, corrected for the number of benchmarks (Holm
1979): two runs of one program are marked anywhere with a probability of {FALSE_ALARMS:.0%}. Another layout of the same
code can move a benchmark of nanoseconds by some per cent; that is a true change of the time, and means nothing.</p>
<p>Offset, RMS, bias² and variance come from renders of fixed seeds: the same code gives the same digits. Where they differ,
they are held against their standard errors, with a chance of {FALSE_ALARMS:.0%} for a false alarm among all of them.
docs/benchmarks.md says what each counter means.</p>"""


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
