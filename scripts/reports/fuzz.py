"""scripts/fuzz --report: the section of docs/reliability.md about fuzzing, from the results of the last runs and of the last
coverage."""

import json

import tools

FUZZ = tools.ROOT / "build" / "fuzz"


def results(name, command):
    path = FUZZ / name
    if not path.exists():
        raise SystemExit(f"{path} is missing: {command} makes it")
    return json.loads(path.read_text(encoding="utf-8"))


def text(runs, coverage):
    total = sum(run["executions"] for run in runs)
    findings = sum(run["findings"] for run in runs)
    rows = [[run["target"].replace("_", " "), f"{run['seconds'] / 60:g} min", f"{run['executions']:,}", f"{run['corpus']:,}",
             str(run["findings"])] for run in runs]
    lines, covered = (sum(file[key] for file in coverage) for key in ("lines", "covered"))
    files = [[f"`{file['file']}`", str(file["lines"]), f"{100 * file['covered'] / file['lines']:.1f} %"] for file in coverage]
    return f"""### Fuzzing

{tools.machine()}. clang 14, AddressSanitizer, UndefinedBehaviorSanitizer, conversions from float to integer.
{total:,} inputs, {findings} failures.

{tools.table(["target", "time", "inputs", "corpus after it", "failures"], rows)}

Lines of the readers that the corpus and the tests reach: {100 * covered / lines:.1f} %.

{tools.table(["file", "lines", "reached"], files)}
"""


if __name__ == "__main__":
    tools.write_section(
        tools.ROOT / "docs" / "reliability.md",
        "fuzz",
        text(results("fuzz.json", "scripts/fuzz"), results("coverage.json", "scripts/fuzz --coverage")),
    )
