"""What measurements share: they start frond and read what it writes, resize scenes, format tables, and write pages."""

import argparse
import io
import json
import os
import pathlib
import re
import subprocess
import tempfile
import time

import numpy
import pandas

ROOT = pathlib.Path(__file__).resolve().parents[2]
BUILD = pathlib.Path(os.environ.get("FROND_BUILD", ROOT / "build" / "release"))
FROND = BUILD / "frond"


def arguments(name, *more):
    """The options of measurements/run NAME: --quick and `more`, pairs of flag and settings of argparse. `docs` is the folder of its
    page."""
    parser = argparse.ArgumentParser(prog=f"measurements/run {name}")
    folder = ROOT / "build" / f"{name}_report"
    parser.add_argument("--quick", action="store_true", help=f"few samples, to see that it runs: into {folder.relative_to(ROOT)}")
    for flag, settings in more:
        parser.add_argument(flag, **settings)
    options = parser.parse_args()
    options.docs = folder if options.quick else ROOT / "docs"
    return options


def write(path, text):
    path.parent.mkdir(parents=True, exist_ok=True)
    part = path.with_name(f"{path.name}.part")
    part.write_text(text, encoding="utf-8")
    part.replace(path)
    print(f"Written: {path}")


def section_marks(name, script=None):
    script = script if script and "/" in script else f"measurements/run {script or name}"
    return f"<!-- {name}: written by {script} -->\n", f"<!-- end of {name} -->\n"


def with_section(page, name, text, script=None):
    """The page's text with another section of this name: what lies between its two marks."""
    begin, end = section_marks(name, script)
    if page.count(begin) != 1 or page.count(end) != 1:
        raise SystemExit(f"the page has no section {begin.strip()} ... {end.strip()}")
    before, rest = page.split(begin)
    return f"{before}{begin}\n{text.strip()}\n\n{end}{rest.split(end)[1]}"


def write_section(path, name, text, script=None):
    """Writes the section `name` of a page, which keeps its other text. A page that does not exist has this section alone.
    `script`: the measurement that writes it, by default the one of this name."""
    empty = "\n".join(section_marks(name, script))
    write(path, with_section(path.read_text(encoding="utf-8") if path.exists() else empty, name, text, script))


def run(*words, **more):
    """Standard output of a command; its errors stop the measurement."""
    done = subprocess.run([str(w) for w in words], capture_output=True, **{"text": True, **more}, check=False)
    if done.returncode != 0:
        raise SystemExit(f"{' '.join(map(str, words))}\n{done.stderr or done.stdout}")
    return done.stdout


def program(*words):
    """Standard output of frond, for what its Python module does not have."""
    return run(FROND, *words)


def program_json(*words):
    return json.loads(program(*words))


def program_csv(*words):
    return pandas.read_csv(io.StringIO(program(*words)), comment="#")


def frond_table(*words):
    """What `frond table` writes, the CPU seconds that it says to have taken, and all that it says."""
    done = subprocess.run([str(w) for w in (FROND, "table", *words, "-o", "-")], capture_output=True, text=True, check=True)
    return done.stdout, float(re.search(r"([0-9.e+-]+) s of CPU", done.stderr)[1]), done.stderr


class Use:
    """A program run by itself, so that the kernel tells its own use: output, CPU and wall seconds, memory."""

    def __init__(self, *words):
        words, start = list(map(str, words)), time.perf_counter()
        with tempfile.TemporaryFile() as output:
            process = subprocess.Popen(words, stdout=output)
            _, status, usage = os.wait4(process.pid, 0)
            process.returncode = os.waitstatus_to_exitcode(status)
            if process.returncode != 0:
                raise SystemExit(f"{' '.join(words)} ended with {process.returncode}")
            output.seek(0)
            self.output = output.read().decode()
        self.cpu, self.wall = usage.ru_utime + usage.ru_stime, time.perf_counter() - start
        self.megabytes = usage.ru_maxrss / 1024


def sized(path, folder, width, height=None):
    """A copy of a scene file at another resolution, which finds its parts where they are."""
    path = pathlib.Path(path)
    text, count = re.subn(r'("integer ([xy])resolution") \d+', lambda m: f"{m[1]} {width if m[2] == 'x' else height or width}",
                          path.read_text(encoding="utf-8"))
    if count != 2:
        raise SystemExit(f"{path} does not say one width and one height of its film")
    text = re.sub(r'(Include|"string filename") "(?=[^/"][^"]*")', rf'\1 "{path.parent}/', text)
    copy = folder / f"{path.parent.name}-{path.stem}-{width}.pbrt"
    copy.write_text(text, encoding="utf-8")
    return copy


def plane_of_incidence(found, below):
    """Of a goniophotometer's patches on a side of the leaf: angles from the normal, those on the light's side negative, and
    where they are in its arrays."""
    theta, phi = found["theta_o_deg"], numpy.round(found["phi_o_deg"], 6)
    angle = numpy.where(phi == 0, -1, 1) * numpy.minimum(theta, 180 - theta)
    place = numpy.nonzero(numpy.isin(phi, (0, 180)) & ((theta > 90) == below))
    order = numpy.argsort(angle[place])
    place = tuple(index[order] for index in place)
    return angle[place], place


def rms(values):
    return float(numpy.sqrt(numpy.mean(numpy.square(values))))


def table(head, body):
    """A table in Markdown."""
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(str(cell) for cell in row) + " |" for row in body]) + "\n"


def machine():
    """What the figures were measured on. Programs whose code fills a processor's vectors depend on their width."""
    cpu = pathlib.Path("/proc/cpuinfo").read_text(encoding="utf-8")
    model = re.search(r"^model name\s*: (.*)$", cpu, re.MULTILINE)
    vectors = " with AVX-512" if " avx512f " in cpu else " with AVX2" if " avx2 " in cpu else ""
    return f"{model[1] if model else 'unknown processor'}{vectors}, {os.cpu_count()} cores; {program('--version').strip()}"
