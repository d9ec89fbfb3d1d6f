"""Fuzzing: counts of the last run of each target, and the last coverage (section "fuzz" of docs/reliability.md)

Reads the results of scripts/fuzz and of scripts/fuzz --coverage in build/fuzz
"""

import json

from .shared import tools

FUZZ = tools.ROOT / "build" / "fuzz"
TARGETS = sorted(path.stem for path in (tools.ROOT / "tests" / "fuzz").glob("*.cpp") if path.stem != "replay")


def load(paths, command):
    """Returns the contents of JSON files."""
    if not paths or not all(path.exists() for path in paths):
        raise SystemExit(f"results are missing in {FUZZ}: {command} makes them")
    return [json.loads(path.read_text(encoding="utf-8")) for path in paths]


def text(runs, coverage):
    total = sum(run["executions"] for run in runs)
    findings = sum(run["findings"] for run in runs)
    rows = [[run["target"].replace("_", " "), f"{run['seconds'] / 60:g} min", f"{run['executions']:,}", f"{run['corpus']:,}",
             str(run["findings"])] for run in runs]
    lines, covered = (sum(file[key] for file in coverage) for key in ("lines", "covered"))
    files = [[f"`{file['file']}`", str(file["lines"]), f"{100 * file['covered'] / file['lines']:.1f} %"] for file in coverage]
    return f"""### Fuzzing

{tools.machine()}. clang 14, AddressSanitizer, UndefinedBehaviorSanitizer, conversions from float to integer.
{total:,} inputs, {findings} failures, in the last run of each target. Several targets ran at a time.

{tools.table(["target", "time", "inputs", "corpus after it", "failures"], rows)}

Lines of the readers that the corpus and the tests reach: {100 * covered / lines:.1f} %.

{tools.table(["file", "lines", "reached"], files)}
"""


if __name__ == "__main__":
    tools.write_section(
        tools.ROOT / "docs" / "reliability.md",
        "fuzz",
        text(
            load([FUZZ / "results" / f"{target}.json" for target in TARGETS], "scripts/fuzz"),
            *load([FUZZ / "coverage.json"], "scripts/fuzz --coverage"),
        ),
    )
