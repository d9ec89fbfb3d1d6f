"""No run of 12 or more equal lines is in two places of the sources: what two files need is a function of one of them."""

import collections
import pathlib
import re
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[2]
FOLDERS = ("src", "python", "tests", "measurements", "scripts", "bench", "exports", "cmake")
LINES = 12
# Lists of includes and imports may agree. Left out: inputs of the fuzz targets, files of earlier versions, the generated stub.
IGNORED_LINE = re.compile(r"#include|#pragma once|import |from \S+ import")
IGNORED_FILES = ("tests/fuzz/corpus/", "tests/data/", "python/frond/__init__.pyi")


def sources():
    for folder in FOLDERS:
        for path in sorted((ROOT / folder).rglob("*")):
            name = str(path.relative_to(ROOT))
            code = path.suffix in (".h", ".cpp", ".py", ".cmake", ".sh", ".awk", ".txt", "") and path.is_file()
            if code and not name.startswith(IGNORED_FILES) and (path.suffix != ".txt" or path.name == "CMakeLists.txt"):
                yield name, path.read_text(encoding="utf-8", errors="replace")


def kept(text):
    """Numbers and contents of the lines that count, without indentation."""
    lines = ((number, line.strip()) for number, line in enumerate(text.splitlines(), 1))
    return [(number, line) for number, line in lines if line and not IGNORED_LINE.match(line)]


def equal_runs(files):
    """Runs of LINES or more equal lines: [(file:line, file:line, number of lines)], each once."""
    kept_lines = {name: kept(text) for name, text in files}
    places = collections.defaultdict(list)
    for name, lines in kept_lines.items():
        for i in range(len(lines) - LINES + 1):
            places[tuple(line for _, line in lines[i:i + LINES])].append((name, i))
    found = []
    for group in places.values():
        for (a, i), (b, j) in zip(group, group[1:]):
            before = i and j and kept_lines[a][i - 1][1] == kept_lines[b][j - 1][1]
            if not before and (a != b or j - i >= LINES):
                length = 0
                while i + length < len(kept_lines[a]) and j + length < len(kept_lines[b]) and \
                        kept_lines[a][i + length][1] == kept_lines[b][j + length][1]:
                    length += 1
                found.append((f"{a}:{kept_lines[a][i][0]}", f"{b}:{kept_lines[b][j][0]}", length))
    return found


class Duplicates(unittest.TestCase):
    def test_no_run_of_equal_lines_is_in_two_places(self):
        files = list(sources())
        self.assertGreater(len(files), 1000)
        found = [f"{a} and {b}: {length} equal lines" for a, b, length in equal_runs(files)]
        self.assertEqual(found, [], "\n".join(["", *found]))

    def test_a_run_is_found_whole_and_once(self):
        run = [f"line {i};" for i in range(15)]
        one, other = "\n".join(["a", *run, "b"]), "\n".join(["c", "", *(f"    {line}\n" for line in run), "d"])
        self.assertEqual(equal_runs([("one", one), ("other", other)]), [("one:2", "other:3", 15)])
        self.assertEqual(equal_runs([("one", "\n".join(run + run))]), [("one:1", "one:16", 15)])
        self.assertEqual(equal_runs([("one", "\n".join(run[:11])), ("other", "\n".join(run[:11]))]), [])


if __name__ == "__main__":
    unittest.main()
