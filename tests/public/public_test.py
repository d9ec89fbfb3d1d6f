"""Runs the cases of tests/public: what others reported, asked or published, with the right values (tests/public/README.md).

public_test.py                    all cases
public_test.py CASE...            these
public_test.py --write-page       writes the table of docs/results/public_cases.md

FROND names the program.
"""

import csv
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import tomllib

HERE = pathlib.Path(__file__).resolve().parent
FROND = pathlib.Path(os.environ.get("FROND", HERE.parents[1] / "build" / "release" / "frond")).resolve()
PAGE = HERE.parents[1] / "docs" / "results" / "public_cases.md"
HEAD_OF_TABLE = "| case | what is right | report | state |"
CASE_KEYS = {"about", "reports", "not_met", "today", "steps"}
STEP_KEYS = {"command", "exit", "says", "never_says", "values", "absent"}
VALUE_KEYS = {"file", "at", "row", "column", "is", "within", "error_column", "errors", "why"}


class Failed(Exception):
    pass


def unknown_keys(where, table, known):
    if extra := set(table) - known:
        raise Failed(f"{where}: unknown keys {', '.join(sorted(extra))}; known: {', '.join(sorted(known))}")


def found(folder, value):
    """The number that `value` names, and its standard error (0 if none is named)."""
    path = folder / value["file"]
    if "at" in value:
        node = json.loads(path.read_text())
        for key in value["at"]:
            node = node[key]
        return float(node), 0.0
    with open(path, newline="", encoding="utf-8") as stream:
        rows = list(csv.DictReader(line for line in stream if not line.startswith("#")))
    wanted = value.get("row", {})
    matching = [row for row in rows if all(row[key] == str(text) for key, text in wanted.items())]
    if len(matching) != 1:
        raise Failed(f"{value['file']}: {len(matching)} rows have {wanted}")
    row = matching[0]
    return float(row[value["column"]]), float(row[value["error_column"]]) if "error_column" in value else 0.0


def check_value(folder, value):
    unknown_keys("values", value, VALUE_KEYS)
    number, error = found(folder, value)
    limit = value.get("within", 0) + value.get("errors", 5) * error
    if not abs(number - value["is"]) <= limit:
        raise Failed(f"{value['file']}: {value.get('column', value.get('at'))} is {number}, not {value['is']} within {limit:.3g}")


def run_step(folder, step, environment):
    unknown_keys("steps", step, STEP_KEYS)
    run = subprocess.run(["bash", "-c", step["command"]], cwd=folder, env=environment, stdin=subprocess.DEVNULL,
                         stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, errors="replace", timeout=600)
    shown = f"$ {step['command']}\n{run.stdout[-3000:]}(exit code {run.returncode})"
    if run.returncode != step.get("exit", 0):
        raise Failed(f"exit code {run.returncode}, not {step.get('exit', 0)}\n{shown}")
    for pattern in step.get("says", []):
        if not re.search(pattern, run.stdout):
            raise Failed(f"nothing matches {pattern!r}\n{shown}")
    for pattern in step.get("never_says", []):
        if re.search(pattern, run.stdout):
            raise Failed(f"something matches {pattern!r}\n{shown}")
    for name in step.get("absent", []):
        if (folder / name).exists():
            raise Failed(f"{name} was left\n{shown}")
    for value in step.get("values", []):
        try:
            check_value(folder, value)
        except (Failed, OSError, KeyError, IndexError, TypeError, ValueError) as error:
            raise Failed(f"{type(error).__name__}: {error}\n{shown}") from error


def run_case(case, steps):
    with tempfile.TemporaryDirectory(prefix="frond_public_") as temporary:
        folder = pathlib.Path(temporary) / case.name
        shutil.copytree(case.folder, folder)
        environment = dict(os.environ, PATH=f"{FROND.parent}:{os.environ['PATH']}", XDG_CACHE_HOME=f"{temporary}/cache")
        for step in steps:
            run_step(folder, step, environment)


def is_met(case):
    try:
        run_case(case, case.record["steps"])
        return True
    except Failed:
        return False


class Case:
    def __init__(self, folder):
        self.folder, self.name = folder, folder.name
        self.record = tomllib.loads((folder / "case.toml").read_text())
        unknown_keys(f"{self.name}/case.toml", self.record, CASE_KEYS)
        for key in ("about", "reports", "steps"):
            if not self.record.get(key):
                raise Failed(f"{self.name}/case.toml: \"{key}\" is missing or empty")
        if ("not_met" in self.record) != bool(self.record.get("today")):
            raise Failed(f"{self.name}/case.toml: \"not_met\" needs [[today]], what frond does until then, and only it")
        for step in [*self.record.get("today", []), *self.record["steps"]]:
            if not {"exit", "says", "never_says", "values", "absent"} & set(step):
                raise Failed(f"{self.name}/case.toml: a step without an expectation: {step['command']}")


def page_of(cases):
    """docs/results/public_cases.md with its table, which ends the page, made anew."""
    lines = [HEAD_OF_TABLE, "|---|---|---|---|"]
    for case in cases:
        links = ", ".join(f"[{number}]({link})" if link.startswith("http") else link
                          for number, link in enumerate(case.record["reports"], 1))
        state = f"not met: {case.record['not_met']}" if "not_met" in case.record else "met"
        lines.append(f"| [{case.name}](../../tests/public/{case.name}/case.toml) | {case.record['about'].strip()} | {links} | {state} |")
    return PAGE.read_text().partition(HEAD_OF_TABLE)[0] + "\n".join(lines) + "\n"


def main(words):
    cases = [Case(folder) for folder in sorted(HERE.iterdir()) if (folder / "case.toml").is_file()]
    if words == ["--write-page"]:
        PAGE.write_text(page_of(cases))
        return 0
    if unknown := set(words) - {case.name for case in cases}:
        print(f"no case {', '.join(sorted(unknown))}", file=sys.stderr)
        return 2
    failed, passed = [], 0
    for case in cases:
        if words and case.name not in words:
            continue
        not_met = case.record.get("not_met")
        try:
            run_case(case, case.record["today" if not_met else "steps"])
            passed += 1
        except Failed as error:
            failed.append(case.name)
            print(f"{case.name}: {error}")
            continue
        if not_met and is_met(case):
            failed.append(case.name)
            print(f"{case.name}: is met: remove \"not_met\" and \"today\" from its case.toml")
    if not words and page_of(cases) != PAGE.read_text():
        failed.append(PAGE.name)
        print("docs/results/public_cases.md does not have the table of these cases: run scripts/generate")
    print(f"{passed} passed, {len(failed)} failed")
    return 1 if failed or passed == 0 else 0


if __name__ == "__main__":
    try:
        sys.exit(main(sys.argv[1:]))
    except Failed as error:
        print(error, file=sys.stderr)
        sys.exit(1)
