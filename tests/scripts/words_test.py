"""Pages, the measurements and the benchmark that write them, help, Python docstrings and public headers use the words of docs/glossary.md.

docs/commands.md and docs/plugins*.md are made of the texts of help, so that a refused word in an option is found there."""

import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]

# A refused word, and what to write instead.
REFUSED = {
    # One word for one thing: the glossary's word for it, and not
    r"(?<![-.\"])\b[Pp]ictures?\b(?! =)": "image",
    r"\b[Cc]op(y|ies) of (an |the |each )?(object|scene|leaf|leaves|plant)": "instance; a periodic scene is repeated",
    r"\b[Rr]eadings\b|\b(a|the|each|one|every|per) reading\b": "measurement; for files: reader, read",
    r"\b[Ss]ubjects\b|\bthe subject\b": "candidate; material under test; material",
    r"\b[Rr]ungs?\b": "candidate, model, number of samples",
    r"\b(the|a|each|open|every) questions?\b": "open leaf, open choice",
    r"\bportable leaf\b|\bleaf modes\b|\bBody(Table|Spectrum|Modes)\b": "mode table",
    r"\b(a|each|one) piece of (an |the )?(image|render|job)|\brenders in pieces\b": "part",
    r"\b[Pp]laces? (in|of) (a|the) bundle\b": "lane",
    r"\b[Ww]hom\b": "log, observer, user",
    # Images, riddles and personified programs.
    r"\bfor ever\b": "periodically, without end",
    r"\bthe house\b|\bby room of\b|\ba crumb\b": "architecture, module",
    r"[Mm]ay be given again": "Repeatable",
    r"\banswered by\b(?! theirs)": "replaced by",
    r"\b(gives?|gave|given|giving) back\b": "reflects, transmits, scatters, returns",
    r"\bthe way in for\b": "entry point",
    r"\b(is|are|was|were) told\b": "is reported, is estimated",
    r"\bin whatever company\b": "does not depend on other samples",
    r"\bnowhere clearly off\b": "within ... % in every view",
    r"\bwhat stands in the scene\b|\bstands? for (itself|themselves)\b": "the scene; is no part of an instance",
    r"\berror of pi f\b.*\blog\b|\bleaf modes:": "mode table",
    r"\bhangs? (up)?on\b": "depends on",
    r"\bknows? (nothing|no)\b|\buntil it knows\b": "does not depend on, does not store",
    r"\bwritten down for\b": "to write",
}


def files():
    pages = [*ROOT.glob("*.md"), *(ROOT / "docs").rglob("*.md"), *(ROOT / "scenes").rglob("*.md"), *(ROOT / "examples").rglob("*.md")]
    return [p for p in pages if p.name != "glossary.md"] + list((ROOT / "src").rglob("*.h")) + \
        list((ROOT / "measurements").rglob("*.py")) + list((ROOT / "leaf_benchmark").rglob("*.py")) + list((ROOT / "python" / "frond").glob("*.py*"))


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
        for line in ("a plot that goes on for ever", "a table by room of", "May be given again.", "errors are told", "the picture",
                     "two copies of an object", "the readings", "the subject", "on each rung", "the question", "a piece of the image",
                     "whom it is shown", "it gives back what it takes", "it hangs on the seed", "a walk knows nothing of the way back"):
            self.assertTrue(any(re.search(refused, line) for refused in REFUSED), line)
        for line in ("one for every path", "there is room for it", "--picture, the older name", "frond.Picture", "reading a file",
                     "a copy of the buffer", "subject to rounding", "piecewise constant"):
            self.assertFalse(any(re.search(refused, line) for refused in REFUSED), line)


if __name__ == "__main__":
    unittest.main()
