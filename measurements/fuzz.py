"""Fuzzing: counts of the last run of each target, and the last coverage (section "fuzz" of docs/reliability.md)

Reads the results of scripts/fuzz and of scripts/fuzz --coverage in build/fuzz. Targets without a result, and a coverage that was not
measured again, keep what the page has.
"""

import json
import re

from .shared import tools

FUZZ = tools.ROOT / "build" / "fuzz"
PAGE = tools.ROOT / "docs" / "reliability.md"
TARGETS = sorted(path.stem for path in (tools.ROOT / "tests" / "fuzz").glob("*.cpp") if path.stem != "replay")


def load(path):
    """Returns the content of a JSON file; None if it does not exist."""
    return json.loads(path.read_text(encoding="utf-8")) if path.exists() else None


def earlier_runs(page):
    """Returns the runs that the page's table has, by target."""
    number = lambda digits: int(digits.replace(",", ""))
    rows = re.findall(r"^\| ([a-z0-9 ]+) \| ([0-9.]+) min \| ([0-9,]+) \| ([0-9,]+) \| ([0-9,]+) \|$", page, re.M)
    return {target.replace(" ", "_"): {"target": target, "seconds": 60 * float(minutes), "executions": number(inputs),
                                       "corpus": number(corpus), "findings": number(findings)}
            for target, minutes, inputs, corpus, findings in rows}


def earlier_coverage(page):
    """Returns the coverage that the page's table has, of files that still exist."""
    rows = re.findall(r"^\| `(src/[^`]+)` \| ([0-9]+) \| ([0-9.]+) % \|$", page, re.M)
    return [{"file": file, "lines": int(lines), "covered": round(float(share) * int(lines) / 100)}
            for file, lines, share in rows if (tools.ROOT / file).exists()]


def machines(page):
    """Returns the machines that the page names, and this one."""
    name, version = tools.machine().split("; ")
    earlier = re.search(r"^### Fuzzing\n\n(.*?); frond", page, re.M)
    names = earlier[1].split(" and ") if earlier else []
    return " and ".join(names + [name] * (name not in names)) + "; " + version


def text(machine, runs, coverage):
    total = sum(run["executions"] for run in runs)
    findings = sum(run["findings"] for run in runs)
    rows = [[run["target"].replace("_", " "), f"{run['seconds'] / 60:g} min", f"{run['executions']:,}", f"{run['corpus']:,}",
             str(run["findings"])] for run in runs]
    lines, covered = (sum(file[key] for file in coverage) for key in ("lines", "covered"))
    files = [[f"`{file['file']}`", str(file["lines"]), f"{100 * file['covered'] / file['lines']:.1f} %"] for file in coverage]
    return f"""### Fuzzing

{machine}. clang 14, AddressSanitizer, UndefinedBehaviorSanitizer, conversions from float to integer.
{total:,} inputs, {findings} failures, in the last run of each target. Several targets ran at a time.

{tools.table(["target", "time", "inputs", "corpus after it", "failures"], rows)}

Lines of the readers that the corpus and the tests reach: {100 * covered / lines:.1f} %.

{tools.table(["file", "lines", "reached"], files)}
"""


if __name__ == "__main__":
    page = PAGE.read_text(encoding="utf-8")
    before = earlier_runs(page)
    runs = [load(FUZZ / "results" / f"{target}.json") or before.get(target) for target in TARGETS]
    if not any((FUZZ / "results" / f"{target}.json").exists() for target in TARGETS):
        raise SystemExit(f"results are missing in {FUZZ}: scripts/fuzz makes them")
    for target, run in zip(TARGETS, runs):
        if not run:
            print(f"{target} has no result")
    tools.write_section(PAGE, "fuzz", text(machines(page), [run for run in runs if run],
                                           load(FUZZ / "coverage.json") or earlier_coverage(page)))
