"""Examples of the pages: runs them and writes their output into docs

A block marked `output` is the output of the block of commands (sh) or of Python before it, or their log if there is no output. A
line "..." in it matches any lines, a column "..." any columns. Examples that fail are named and keep their text. Takes some
minutes.
  --only PAGE   only this page, as radiometry.md; repeatable
"""

import argparse
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

from .shared.tools import BUILD, FROND, ROOT, write

EXAMPLE = re.compile(r"^```(?P<language>sh|python)\n(?P<commands>(?:(?!```).*\n)*)```\n\n?```output\n(?P<output>(?:(?!```).*\n)*)```$", re.M)
LIMIT_S = 600


def form(line):
    """A line without its numbers and the width of its columns."""
    return re.sub(r"[\s\d.±+-]+|e-\d+", "#", line)


def without_columns(lines, header):
    """The lines of a table of right-aligned columns, with `...` in place of the columns that the documented header omits."""
    fields = re.split(r" {2,}", header.strip())
    before, after = fields.index("..."), len(fields) - fields.index("...") - 1
    found = [m.end() for m in re.finditer(r"\S+(?: \S+)*", lines[0])]
    first, last = found[before - 1], found[len(found) - after - 1]
    return [f"{line[:first]}  {'...' if line.strip() else ''}{line[last:]}".rstrip() for line in lines]


def shortened(old, new):
    """`new` with the lines and columns left out that `old` leaves out; None if the line after those is not in it."""
    old, new, result = old.splitlines(), new.splitlines(), []
    while old:
        if old[0].strip() == "...":
            result.append(old.pop(0))
            if not old:
                break
            while new and form(new[0]) != form(old[0]):
                new.pop(0)
            if not new:
                return None
        elif re.search(r" {2}\.\.\.( {2}|$)", old[0]):
            length = next((i for i, line in enumerate(new) if not line), len(new))
            result += without_columns(new[:length], old[0])
            old, new = old[length:], new[length:]
        elif new:
            old.pop(0)
            result.append(new.pop(0))
        else:
            break
    return "\n".join(result if "..." in result[-1:] else result + new) + "\n"


class Runner:
    """Runs examples in a folder that has the folders of the repository, and frond on its path."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        shutil.copytree(ROOT / "scenes", self.folder / "scenes")  # examples write beside the scenes
        for name in ("tests", "docs"):
            (self.folder / name).symlink_to(ROOT / name)
        (self.folder / "build").mkdir()
        (self.folder / "build" / "release").symlink_to(BUILD)
        self.environment = {**os.environ, "PATH": f"{FROND.parent}:{os.environ['PATH']}"}

    def output(self, language, commands):
        words = ["bash", "-ec", commands] if language == "sh" else [sys.executable, "-c", commands]
        done = subprocess.run(words, cwd=self.folder, env=self.environment, capture_output=True, text=True, timeout=LIMIT_S,
                              check=False)
        said = re.sub(r" +$", "", done.stdout or done.stderr, flags=re.M)  # the log is shown where there is nothing else
        # A broken law or a difference is an answer, with the code 2; 1 is an error.
        return said if done.returncode in (0, 2) else None, done.stderr


def main():
    parser = argparse.ArgumentParser(prog="measurements/run examples")
    parser.add_argument("--only", action="append", help="a page in docs")
    only = parser.parse_args().only
    failed = []
    for page in sorted((ROOT / "docs").glob("*.md")):
        if only and page.name not in only:
            continue
        text = page.read_text(encoding="utf-8")
        with tempfile.TemporaryDirectory() as folder:
            runner = Runner(folder)

            def renewed(example, page=page, runner=runner):
                output, said = runner.output(example["language"], example["commands"])
                shown = shortened(example["output"], output) if output else None
                if not shown:
                    failed.append(f"{page.name}: {example['commands'].strip()}\n{output or said}")
                    return example[0]
                start, end = (at - example.start() for at in example.span("output"))
                return example[0][:start] + shown + example[0][end:]

            new = EXAMPLE.sub(renewed, text)
        if new != text:
            write(page, new)
    if failed:
        raise SystemExit("These examples failed:\n" + "\n".join(failed))


if __name__ == "__main__":
    main()
