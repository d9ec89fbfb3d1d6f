"""What the reports share: running frond, reading its tables, drawing by gnuplot."""

import csv
import io
import os
import pathlib
import resource
import subprocess

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(os.environ.get("FROND_BUILD", ROOT / "build" / "release"))
FROND = BUILD / "frond"

# Eight colours that people of any colour vision tell apart (Okabe and Ito 2008).
COLORS = ["#000000", "#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9"]


def run(*words, stdin=None):
    """Standard output of a command; its errors stop the report."""
    done = subprocess.run([str(w) for w in words], input=stdin, capture_output=True, text=True, check=False)
    if done.returncode != 0:
        raise SystemExit(f"{' '.join(map(str, words))}\n{done.stderr or done.stdout}")
    return done.stdout


def frond(*words):
    return run(FROND, *words)


def cpu_seconds(action):
    """What `action` returns, and the CPU time of the programs that it ran."""
    used = lambda: sum(resource.getrusage(resource.RUSAGE_CHILDREN)[:2])
    start = used()
    result = action()
    return result, used() - start


def rows(text):
    """The lines of a CSV with comments, as dictionaries of numbers where they are numbers."""
    lines = [line for line in text.splitlines() if line and not line.startswith("#")]
    return [{key: number(value) for key, value in row.items()} for row in csv.DictReader(io.StringIO("\n".join(lines)))]


def number(text):
    try:
        return float(text)
    except (TypeError, ValueError):
        return text


def gnuplot(path, script, size=(900, 560)):
    """Draws an SVG, to be read on a page and printed."""
    path.parent.mkdir(parents=True, exist_ok=True)
    head = f"""set terminal svg size {size[0]},{size[1]} font 'DejaVu Sans,14' background '#ffffff'
set output '{path}'
set border lw 1.2
set grid lc rgb '#dddddd' lw 1
set key opaque box lc rgb '#cccccc' samplen 2
"""
    run("gnuplot", stdin=head + script)


def block(name, points):
    """Inline data of a chart."""
    lines = "\n".join(" ".join(f"{x:.8g}" for x in point) for point in points)
    return f"${name} << EOD\n{lines}\nEOD\n"


def table(head, body):
    """A table in Markdown."""
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(str(cell) for cell in row) + " |" for row in body]) + "\n"


def thousands(count):
    return f"{count:,}"


def machine():
    """What the figures were measured on."""
    model = "unknown processor"
    for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            model = line.split(":", 1)[1].strip()
            break
    return f"{model}, {os.cpu_count()} cores; {frond('--version').strip()}"
