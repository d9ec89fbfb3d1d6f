"""Pages, the scripts that write them, help (docs/commands.md and docs/plugins.md are made of it) and public headers use the words
of docs/glossary.md."""

import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]

# What is not to be written, and what is in its place.
REFUSED = {
    r"\bfor ever\b": "periodically, without end",
    r"\bthe house\b|\bby room of\b": "architecture, module",
    r"[Mm]ay be given again": "Repeatable",
    r"\banswered by\b(?! theirs)": "replaced by",
    r"\bgives back\b": "reflects, transmits, scatters",
    r"\bthe way in for\b": "entry point",
    r"\b(is|are) told\b": "is reported, is estimated",
    r"\bin whatever company\b": "does not depend on other samples",
    r"\bnowhere clearly off\b": "within ... % in every view",
    r"\bwhat stands in the scene\b": "the scene",
    r"\berror of pi f\b.*\blog\b|\bleaf modes:": "mode table",
}


def files():
    pages = [*ROOT.glob("*.md"), *(ROOT / "docs").glob("*.md"), *(ROOT / "scenes").rglob("*.md"), *(ROOT / "examples").rglob("*.md")]
    return [p for p in pages if p.name != "glossary.md"] + list((ROOT / "src").rglob("*.h")) + \
        list((ROOT / "scripts" / "reports").rglob("*.py"))


class Words(unittest.TestCase):
    def test_no_page_and_no_header_has_a_word_that_is_refused(self):
        self.assertGreater(len(files()), 300)
        found = []
        for path in files():
            for number, line in enumerate(path.read_text(encoding="utf-8").splitlines(), 1):
                found += [f"{path.relative_to(ROOT)}:{number}: {match[0]!r}: {instead}" for refused, instead in REFUSED.items()
                          if (match := re.search(refused, line))]
        self.assertEqual(found, [])

    def test_a_word_that_is_refused_is_found(self):
        for line in ("a plot that goes on for ever", "a table by room of", "May be given again.", "errors are told"):
            self.assertTrue(any(re.search(refused, line) for refused in REFUSED), line)
        for line in ("one for every path", "questions answered by theirs", "there is room for it"):
            self.assertFalse(any(re.search(refused, line) for refused in REFUSED), line)


if __name__ == "__main__":
    unittest.main()
