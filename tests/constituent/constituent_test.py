"""A leaf's constituent is one row: tests/plugins/further_constituent.cpp has one more, betalains, and is loaded before
libfrond, so that its table is the program's and the module's. What follows from the table has it."""

import csv
import json
import os
import subprocess
import sys
import unittest

from frond_program import FROND, FrondTest

ROWS = os.environ["FROND_ROWS"]
LEAF = 'WorldBegin\nLightSource "infinite"\nMaterial "leaf_solved" %s\nShape "disk"\n'
SPECTRUM = "nm,R,T\n" + "".join(f"{nm},{r},{t}\n" for nm, r, t in (
    (450, .045, .016), (500, .05, .03), (550, .08, .15), (600, .06, .1), (650, .05, .05), (680, .045, .02), (720, .25, .28),
    (800, .44, .45), (1200, .41, .44), (1450, .12, .15), (1650, .29, .33), (1940, .04, .03), (2200, .12, .16)))


class ConstituentTest(FrondTest):
    def frond(self, *words, code=0, rows=ROWS):
        return self.run_to_end([FROND, *map(str, words)], code, environment=dict(os.environ, LD_PRELOAD=rows))

    def in_python(self, text):
        out, _ = self.run_to_end([sys.executable, "-c", text], environment=dict(os.environ, LD_PRELOAD=ROWS))
        return out

    def test_without_the_row_nothing_has_it(self):
        self.assertNotIn("betalains", self.frond("describe", "leaf_solved", rows="")[0])
        _, err = self.frond("spectrophotometer", "leaf_solved,betalains=1", "--wavelengths", 535, code=1, rows="")
        self.assertIn('no parameter "betalains"', err)

    def test_materials_have_the_parameter(self):
        for material in ("abm", "leaf", "leaf_lambert", "leaf_simplified", "leaf_solved"):
            described, _ = self.frond("describe", material)
            self.assertRegex(described, r'"float \| texture betalains"\n +Betalains in the mesophyll.*\n +0 to 100; in kg/m\^3\n')
        scene = self.write("leaf.pbrt", LEAF % '"float betalains" 101')
        _, err = self.frond("render", scene, "-o", self.folder / "a.exr", "-q", code=1)
        self.assertIn("leaf.pbrt:3:42", err)
        self.assertIn("outside its range 0 to 100 kg/m^3", err)

    def test_it_absorbs_where_its_spectrum_says(self):
        reflected = []
        for amount in (0, 2):
            table = self.folder / "r.csv"
            self.frond("spectrophotometer", f"leaf_lambert,betalains={amount}", "--wavelengths", "535,800", "--rays", 1 << 16,
                       "--csv", table, "-q")
            rows = csv.DictReader(line for line in table.read_text().splitlines() if not line.startswith("#"))
            reflected.append([float(row["R"]) for row in rows])
        self.assertLess(reflected[1][0], 0.8 * reflected[0][0])
        # 5 standard errors of the difference of two shares of 65,536 rays: false alarms 6e-7.
        self.assertAlmostEqual(reflected[1][1], reflected[0][1], delta=0.014)

    def test_a_texture_gives_it(self):
        checks = 'Texture "t" "float" "checkerboard" "float tex1" 0 "float tex2" 5\n'
        scene = self.write("leaf.pbrt", (LEAF % '"texture betalains" "t"').replace("Material", checks + "Material"))
        self.frond("render", scene, "-o", self.folder / "a.exr", "--quick", "-q", "--no-cache", "--wavelengths", "smpte")

    def test_a_table_beside_it_replaces_it(self):
        self.write("t.csv", "nm,R,T\n400,.1,.1\n700,.1,.1\n")
        leaf = LEAF.replace("leaf_solved", "leaf_lambert") % '"float betalains" 1 "string tablefile" "t.csv"'
        _, err = self.frond("render", self.write("leaf.pbrt", leaf), "-o", self.folder / "a.exr", "--quick",
                            "--wavelengths", "smpte")
        self.assertIn('"betalains" has no effect with "tablefile"', err)

    def test_caches_tell_leaves_apart(self):
        cache = self.folder / "cache"
        tables = set()
        for number, amount in enumerate(("", '"float betalains" 1', '"float betalains" 2'), 1):
            scene = self.write("leaf.pbrt", LEAF % amount)
            for rows in (ROWS, "") if not amount else (ROWS,):  # a leaf without any has the key that it had before
                self.frond("render", scene, "-o", self.folder / "a.exr", "--quick", "-q", "--cache", cache, "--wavelengths",
                           "smpte", rows=rows)
                tables |= {path.name for path in cache.glob("**/*.modes")}
                self.assertEqual(len(tables), number)
        head, _ = self.frond("table", "leaf_simplified,betalains=1.5", "--wavelengths", 535, "-o", "-", "-q")
        self.assertRegex(head, r"# betalains 1\.5 kg/m\^3, absorption [0-9a-f]{16}\n")

    def test_a_fit_finds_it_and_reports_it(self):
        self.write("leaf.csv", SPECTRUM)
        leaf = self.folder / "leaf.pbrt"
        text, _ = self.frond("fit", self.folder / "leaf.csv", "-o", leaf, "--json", self.folder / "fit.json", "--like", "red")
        self.assertRegex(text, r"\n  betalains +[0-9.e-]+ kg/m\^3")
        self.assertRegex(text, r"\n  betalains +[0-9.e-]+ ug/cm2")
        self.assertRegex(leaf.read_text(), r'"float betalains" [0-9.e-]+\n')
        fit = json.loads((self.folder / "fit.json").read_text())
        for table in ("numbers", "contents", "leaf"):
            self.assertIn("betalains", [row["name"] for row in fit[table]], table)
        self.frond("fit", self.folder / "leaf.csv", "--all-leaves", "--csv", self.folder / "fits.csv", "--like", "red", "--fix",
                   "betalains=3ug/cm2")
        lines = [line for line in (self.folder / "fits.csv").read_text().splitlines() if not line.startswith("#")]
        (row,) = csv.DictReader(lines)
        self.assertAlmostEqual(float(row["betalains_ug_cm2"]), 3, places=6)
        self.assertGreater(float(row["betalains"]), 0)

    def test_a_fit_finds_how_much_a_leaf_has(self):
        """Of the spectra of a leaf with betalains, within the four standard errors that the fit states."""
        table = self.folder / "leaf.csv"
        self.frond("spectrophotometer", "leaf_solved,specimen=walnut,betalains=0.8", "--wavelengths", "400:2400:20", "--rays",
                   1 << 16, "--csv", table, "-q")
        self.frond("fit", table, "--json", self.folder / "fit.json", "--structure", "bifacial", "--sieve", "on")
        numbers = {row["name"]: row for row in json.loads((self.folder / "fit.json").read_text())["numbers"]}
        found = numbers["betalains"]
        self.assertTrue(found["identified"], found)
        self.assertLess(abs(found["value"] / 0.8 - 1), 4 * found["relative_standard_error"], found)

    def test_mitsubas_export_writes_it(self):
        scene = self.write("leaf.pbrt", LEAF % '"float betalains" 1.5 "float chlorophylla" 2')
        self.frond("export", scene, "--format", "mitsuba", "-o", self.folder / "out", "-q")
        self.assertIn('name="betalains" value="1.5"', (self.folder / "out" / "scene.xml").read_text())

    def test_the_module_has_it(self):
        try:
            import frond  # noqa: F401
        except ImportError:
            self.skipTest("it needs FROND_PYTHON")
        out = self.in_python(
            "import frond\nfrom frond import _frond\n"
            "s = frond.default_session()._session\n"
            "d = _frond.leaf_chemistry(s, 'leaf_solved,betalains=2', [535.0, 800.0])\n"
            "print(dict(_frond.leaf_numbers())['betalains'], d['amount']['betalains'], *d['specific_absorption']['betalains'])")
        self.assertEqual(out, "absorption 2.0 9000.0 0.0\n")
        fit = f"import frond\nprint('betalains' in frond.fit(data={SPECTRUM!r}, like='red').parameters)"
        self.assertEqual(self.in_python(fit), "True\n")

    def test_mitsubas_plugin_takes_it(self):
        if subprocess.run([sys.executable, "-c", "import mitsuba, frond"], capture_output=True).returncode:
            self.skipTest("it needs Mitsuba and FROND_PYTHON")
        out = self.in_python(
            "import mitsuba as mi\nmi.set_variant('scalar_rgb')\nimport frond.mitsuba\n"
            "print('betalains' in frond.mitsuba.CHEMISTRY)\n"
            "print(mi.load_dict({'type': 'frond_leaf', 'betalains': 1.5}))")
        self.assertTrue(out.startswith("True\n"), out)
        self.assertIn("betalains=1.5", out)


if __name__ == "__main__":
    unittest.main()
