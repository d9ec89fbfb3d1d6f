"""Benchmarks: runs them, and compares two runs or two commits (docs/performance.md)

  --commits A B              builds two commits, runs both in turn and compares; . is the working tree
  --compare A.json B.json    writes a page that compares two runs
  --write-docs RUN.json      writes the run's figures into docs/performance.md
  -o, --output PATH          JSON of a run, page of --compare or folder of --commits; by default in build/bench
  --quick                    fewer benchmarks and rounds: under two minutes
  --filter RE                only benchmarks whose names match
  --repetitions N            number of rounds, each a process; default: 12, with --quick 5
  --fail-on-regression PCT   exits with 2 if a benchmark is slower by PCT per cent or more, or an image has changed
"""

import argparse
import dataclasses
import json
import pathlib
import sys

from ..shared.tools import ROOT, write, write_section
from . import page, results, session, tables, text
from .comparison import Comparison

DOCUMENT = ROOT / "docs" / "performance.md"


def arguments():
    """The options; measurements/run bench describes them."""
    parser = argparse.ArgumentParser(prog="measurements/run bench")
    what = parser.add_mutually_exclusive_group()
    what.add_argument("--compare", nargs=2, metavar=("A.json", "B.json"))
    what.add_argument("--commits", nargs=2, metavar=("A", "B"))
    what.add_argument("--write-docs", metavar="RUN.json")
    parser.add_argument("-o", "--output", type=pathlib.Path)
    parser.add_argument("--quick", action="store_true")
    parser.add_argument("--filter", metavar="RE")
    parser.add_argument("--repetitions", type=int, metavar="N")
    parser.add_argument("--fail-on-regression", type=float, metavar="PCT")
    return parser.parse_args()


def setting_of(options):
    chosen = {"filter": options.filter, "rounds": options.repetitions}
    if options.repetitions is not None and options.repetitions < 1:
        raise SystemExit("--repetitions is at least 1")
    base = session.QUICK if options.quick else session.Setting()
    return dataclasses.replace(base, **{k: v for k, v in chosen.items() if v is not None})


def run_one(options):
    [document] = session.measure([session.Program()], setting_of(options))
    write(options.output or session.WORKTREES / "run.json", json.dumps(document, indent=1))
    print(tables.figures(results.Run(document)))


def run_commits(options):
    folder = options.output or session.WORKTREES
    documents = session.measure([session.Program(c) for c in options.commits], setting_of(options))
    for name, document in zip("ab", documents):
        write(folder / f"{name}.json", json.dumps(document, indent=1))
    return compare(*map(results.Run, documents), folder / "page.html", options.fail_on_regression)


def compare(a, b, path, fail_on_regression):
    comparison = Comparison(a, b)
    write(path, page.html(comparison))
    print(text.summary(comparison))
    if fail_on_regression is None:
        return 0
    return 2 if comparison.slower(fail_on_regression / 100) or comparison.changed_figures() else 0


def main():
    options = arguments()
    if options.commits:
        return run_commits(options)
    if options.compare:
        return compare(*map(results.read, options.compare), options.output or session.WORKTREES / "page.html",
                       options.fail_on_regression)
    if options.write_docs:
        write_section(DOCUMENT, "bench", tables.section(results.read(options.write_docs)))
        return 0
    return run_one(options)


if __name__ == "__main__":
    sys.exit(main())
