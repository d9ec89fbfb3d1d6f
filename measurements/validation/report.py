"""Collects the sections of docs/results/validation.md; shared by all parts."""

import json
import re

from ..shared import charts
from ..shared.tools import BUILD, ROOT, run, write

LEAVES = ["soybean", "maize"]
RGB = [608, 551, 455]


class Report:
    def __init__(self, quick):
        self.quick = quick
        self.folder = ROOT / "build" / "validation_report" if quick else ROOT / "docs" / "results"
        self.images = self.folder / "images" / "validation"
        self.folder.mkdir(parents=True, exist_ok=True)
        self.parts = []

    def rays(self, full):
        return f"{full / 100 if self.quick else full:.0e}"

    def add(self, text):
        self.parts.append(text.strip() + "\n")

    def chart(self, name, title, figure):
        charts.save(figure, self.images / f"{name}.svg")
        self.add(f"![{title}](images/validation/{name}.svg)")

    def cases_of(self, test, pattern, **environment):
        """The test cases, with the properties that they record."""
        path = self.folder / f"{test}.json"
        run("env", *(f"{key}={value}" for key, value in environment.items()), BUILD / "tests" / test, f"--gtest_filter={pattern}",
            f"--gtest_output=json:{path}")
        suites = json.loads(path.read_text())["testsuites"]
        path.unlink()
        return [case for suite in suites for case in suite["testsuite"]]

    def write(self, renewed):
        """Writes the page. `renewed`: replaces only the sections of the existing page with the same titles."""
        path = self.folder / "validation.md"
        text = "\n".join(self.parts)
        if renewed:
            sections = dict((s.split("\n", 1)[0], s) for s in re.split(r"^(?=## )", path.read_text(encoding="utf-8"), flags=re.M))
            for section in filter(None, re.split(r"^(?=## )", text, flags=re.M)):
                title = section.split("\n", 1)[0]
                if title not in sections:
                    raise SystemExit(f"{path} has no section {title!r}: run without --only")
                sections[title] = section.rstrip("\n") + "\n\n"
            text = "".join(sections.values()).rstrip("\n") + "\n"
        write(path, text)
