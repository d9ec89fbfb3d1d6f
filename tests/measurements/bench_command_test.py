"""The measurement bench as users call it: files in, page and exit code out; and the order in which programs take turns."""

import contextlib
import io
import pathlib
import shutil
import subprocess
import sys
import tempfile
import unittest
from unittest import mock

import bench_runs as runs
from measurements.shared import tools
from measurements.bench import __main__ as command
from measurements.bench import results, session, tables

NAMES = [f"bsdf/<{i}>" for i in range(20)]


class FolderTest(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def file(self, name, content):
        return str(runs.save(self.folder / name, content))

    def run_bench(self, *words):
        """Exit code and output."""
        out = io.StringIO()
        with mock.patch.object(sys, "argv", ["measurements/run bench", *words]), contextlib.redirect_stdout(out):
            return command.main(), out.getvalue()


class Compare(FolderTest):
    def setUp(self):
        super().setUp()
        rng = runs.seeded()
        self.a = self.file("a.json", runs.noisy(rng, NAMES, noise=0.01))
        self.b = self.file("b.json", runs.noisy(rng, NAMES, noise=0.01, slower=NAMES[4:5], machine="big iron"))
        self.page = self.folder / "page.html"

    def compare(self, *words):
        return self.run_bench("--compare", self.a, self.b, "-o", str(self.page), *words)

    def test_writes_a_page_that_needs_nothing_beside_it(self):
        code, out = self.compare()
        self.assertEqual(code, 0)
        page = self.page.read_text(encoding="utf-8")
        for text in ("▲ slower", "bsdf/&lt;4&gt;", "Another machine: a machine in A, big iron in B."):
            self.assertIn(text, page)
        for needs in ("http:", "https:", " src=", "<link", "@import", "{{", "<4>"):
            self.assertNotIn(needs, page)
        self.assertEqual(page.count("<td><code>bsdf/"), len(NAMES))
        self.assertIn("1 benchmark slower, by up to", out)

    def test_a_regression_ends_with_2_where_that_is_asked_for(self):
        self.assertEqual(self.compare("--fail-on-regression", "5")[0], 2)
        self.assertEqual(self.compare("--fail-on-regression", "30")[0], 0)

    def test_another_image_ends_with_2_as_well(self):
        self.a = self.file("a.json", runs.images(0.01))
        self.b = self.file("b.json", runs.images(0.02))
        code, out = self.compare("--fail-on-regression", "30")
        self.assertEqual(code, 2)
        self.assertIn("scene/soybean-front/abm rms_red: 0.01 ± 0.0001, now 0.02 ± 0.0001", out)
        self.assertIn('class="changed"', self.page.read_text(encoding="utf-8"))

    def test_files_that_are_no_runs_are_refused(self):
        for content in ("{}", "nothing"):
            pathlib.Path(self.a).write_text(content, encoding="utf-8")
            with self.assertRaisesRegex(SystemExit, "a.json is not what measurements/run bench or frond_bench writes"):
                self.compare()
        self.assertFalse(self.page.exists())

    def test_the_page_runs_in_a_browser(self):
        browser = shutil.which("chromium")
        if not browser:
            self.skipTest("chromium is not installed")
        self.compare()
        done = subprocess.run([browser, "--headless=new", "--no-sandbox", "--disable-gpu", "--virtual-time-budget=5000",
                               f"--user-data-dir={self.folder}/profile", "--dump-dom", f"file://{self.page}"],
                              capture_output=True, text=True, check=True)
        self.assertIn('id="shown">1 of 20<', done.stdout)  # changed ones alone, where there are any
        self.assertEqual(done.stdout.count('hidden=""'), len(NAMES) - 1)


class FakeProgram:
    """Notes its turns."""

    def __init__(self, commit, turns):
        self.commit, self.turns, self.rounds = commit, turns, []

    def build(self):
        self.turns.append("build " + self.commit)

    def run_round(self, setting, _):
        self.turns.append(self.commit)
        entries = [runs.entry("x", 0, 1e-6 * (setting.repetitions - i)) | {"repetition_index": i}
                   for i in range(setting.repetitions)]
        aggregate = runs.entry("x_mean", 0, 1) | {"run_type": "aggregate"}
        self.rounds.append(runs.document([*entries, aggregate], load_avg=[len(self.rounds)]))


class Session(unittest.TestCase):
    def setUp(self):
        self.turns = []
        with contextlib.redirect_stdout(io.StringIO()):
            self.documents = session.measure([FakeProgram(c, self.turns) for c in "AB"], session.Setting(rounds=3))

    def test_programs_take_turns_and_each_is_as_often_the_first(self):
        self.assertEqual(self.turns, ["build A", "build B", "A", "B", "B", "A", "A", "B"])

    def test_a_run_holds_every_repetition_of_every_round(self):
        a, b = self.documents
        self.assertEqual([(e["round"], e["repetition_index"]) for e in a["benchmarks"]],
                         [(i, j) for i in range(3) for j in range(3)])
        self.assertEqual(a["context"]["session"], b["context"]["session"])
        self.assertEqual((a["context"]["commit"], b["context"]["commit"]), ("A", "B"))
        self.assertEqual(a["context"]["load_avg"], [2])
        for seconds in results.Run(a).times["x"]:
            self.assertAlmostEqual(seconds, 1e-6)  # the fastest of a round


class Tables(FolderTest):
    def test_figures_have_the_digits_that_their_intervals_leave_sense_to(self):
        self.assertEqual(tables.plus_minus(1.23456, 0.0321), "1.235 ± 0.032")
        self.assertEqual(tables.plus_minus(123.4, 17), "123 ± 17")

    def test_a_document_takes_the_figures_between_its_marks(self):
        page = self.folder / "benchmarks.md"
        begin, end = tools.section_marks("bench")
        page.write_text(f"before\n{begin}old\n{end}after\n", encoding="utf-8")
        run = self.file("run.json", runs.images(0.01))
        with mock.patch.object(command, "DOCUMENT", page):
            self.assertEqual(self.run_bench("--write-docs", run)[0], 0)
        text = page.read_text(encoding="utf-8")
        self.assertTrue(text.startswith("before\n") and text.endswith("after\n"))
        self.assertNotIn("old", text)
        self.assertIn("| soybean-front | `abm` | 0.5 |", text)


if __name__ == "__main__":
    unittest.main()
