"""Files of frond export, read by the programs that they are for. A test is skipped, by name, if its program is missing."""

import csv
import importlib.util
import json
import math
import os
import pathlib
import re
import shutil
import subprocess
import sys
import unittest

from frond_program import FROND, FrondTest

HERE = pathlib.Path(__file__).resolve().parent
VENV, BENCHMARK = (pathlib.Path(os.environ[f"FROND_{name}_VENV"]) for name in ("EXPORT", "BENCHMARK"))
TABLE = ("--wavelengths", "455,551", "--angles", "8,45", "--view-angles", "0,30,60", "--view-azimuths", "0,90,180,270")

MATERIALX = """
import json, sys
import MaterialX as mx
from MaterialX import PyMaterialXGenShader as gen, PyMaterialXGenOsl as osl
library, document, path = mx.createDocument(), mx.createDocument(), mx.getDefaultDataSearchPath()
mx.loadLibraries(mx.getDefaultDataLibraryFolders(), path, library)
mx.readFromXmlFile(document, sys.argv[1])
document.importLibrary(library)
valid, message = document.validate()
generator = osl.OslShaderGenerator.create()
context = gen.GenContext(generator)
context.registerSourceCodeSearchPath(path)
shaders = [m.getName() for m in document.getMaterialNodes()
           if generator.generate(m.getName(), m, context).getSourceCode("pixel")]
number = lambda v: list(v.asTuple()) if hasattr(v, "asTuple") else v
nodes = {n.getName(): {i.getName(): number(i.getValue()) for i in n.getInputs() if i.getValue() is not None}
         for n in document.getNodes()}
print(json.dumps({"valid": valid, "message": message, "shaders": shaders, "nodes": nodes}))
"""

CYCLES = """
import json, sys, types
from leaf_benchmark.programs import cycles
task = types.SimpleNamespace(theta=[7.5 + 15 * i for i in range(12)], phi=[7.5 + 15 * i for i in range(24)], light_theta=[])
print(json.dumps(list(cycles.table(lambda _: cycles.script(sys.argv[1]))(task, 1024, 1)[0])))
"""


def module(name, requirement=None):
    """The Python that has a module: this one, or the one in a folder of its own, into which it is put if it can be."""
    if importlib.util.find_spec(name):
        return sys.executable
    python = VENV / "bin" / "python"
    if name == "bpy":  # 370 MB: leaf_benchmark/run installs it
        python = BENCHMARK / "bin" / "python"
    has = lambda: python.exists() and subprocess.run([python, "-c", f"import {name}"], capture_output=True,
                                                     check=False).returncode == 0
    if not has() and name != "bpy":
        subprocess.run([sys.executable, "-m", "venv", VENV], capture_output=True, check=False)
        subprocess.run([python, "-m", "pip", "install", "-q", requirement or name], capture_output=True, check=False)
    if not has():
        raise unittest.SkipTest(f"there is no Python module {name}")
    return str(python)


class ReadersTest(FrondTest):
    def export(self, name, *words):
        path = self.folder / name
        subprocess.run([FROND, "export", *map(str, words), "-o", path, "--no-cache", "-q"], check=True)
        return path

    def python(self, python, code, *words):
        """Returns the program's output, parsed as JSON."""
        return json.loads(subprocess.run([python, "-c", code, *map(str, words)], check=True, capture_output=True,
                                         text=True).stdout)

    def table(self):
        with open(self.export("t.csv", "leaf_solved", "--format", "csv", *TABLE), encoding="utf-8") as file:
            return list(csv.DictReader(line for line in file if not line.startswith("#")))

    def check_against_csv(self, shares, f):
        """Both as nested lists: quantity, wavelength, side, theta_i; wavelength to kind."""
        rows = self.table()
        self.assertEqual(len(rows), 2 * 2 * 2 * (2 + 3 * 4 * 2))
        axes = {key: list(dict.fromkeys(r[key] for r in rows if r[key]))
                for key in ("wavelength_nm", "side", "theta_i_deg", "theta_o_deg", "phi_o_deg")}
        for r in rows:
            w, s, i = (axes[key].index(r[key]) for key in ("wavelength_nm", "side", "theta_i_deg"))
            if r["quantity"] in "RT":
                found = shares["RT".index(r["quantity"])][w][s][i]
            else:
                o, p = (axes[key].index(r[key]) for key in ("theta_o_deg", "phi_o_deg"))
                found = f[w][s][i][o][p][("f_r", "f_t").index(r["quantity"])]
            self.assertAlmostEqual(found, float(r["value"]), delta=1e-5 * float(r["value"]))

    def test_numpy_reads_npz(self):
        python = module("numpy")
        path = self.export("t.npz", "leaf_solved", "--format", "npz", *TABLE)
        found = self.python(python, "import json, sys, numpy\nz = numpy.load(sys.argv[1])\n"
                            "print(json.dumps({k: v.tolist() for k, v in z.items()}))", path)
        self.assertEqual(found["axes"], ["wavelength_nm", "side", "theta_i_deg", "theta_o_deg", "phi_o_deg", "kind"])
        self.assertEqual(found["wavelength_nm"], [455, 551])
        self.assertEqual(found["phi_o_deg"], [0, 90, 180, 270])
        self.assertEqual((found["side"], found["kind"]), (["front", "back"], ["reflected", "transmitted"]))
        self.assertEqual(found["material"], "leaf_solved")
        self.check_against_csv((found["R"], found["T"]), found["f_per_sr"])

    def netcdf(self):
        path = self.folder / "t.nc"
        words = [FROND, "export", "leaf_solved", "--format", "netcdf", *TABLE, "-o", path, "--no-cache", "-q"]
        done = subprocess.run(words, capture_output=True, text=True, check=False)
        if done.returncode != 0 and re.search("was built without|no such file", done.stderr):
            self.skipTest("this frond has no NetCDF library")
        self.assertEqual(done.returncode, 0, done.stderr)
        return path

    def test_scipy_reads_netcdf(self):
        path = self.netcdf()
        found = self.python(module("scipy"), "import json, sys\nfrom scipy.io import netcdf_file\n"
                            "v = netcdf_file(sys.argv[1], mmap=False).variables\n"
                            "print(json.dumps({k: a[:].tolist() for k, a in v.items()}))", path)
        self.assertEqual(found["theta_o"], [0, 30, 60])
        self.check_against_csv((found["R"], found["T"]), found["f"])

    def test_ncdump_reads_netcdf(self):
        path = self.netcdf()
        if not shutil.which("ncdump"):
            self.skipTest("there is no ncdump")
        text = subprocess.run(["ncdump", "-h", path], check=True, capture_output=True, text=True).stdout
        for line in ("float f(wavelength, side, theta_i, theta_o, phi_o, kind) ;", 'f:units = "sr-1" ;',
                     'wavelength:units = "nm" ;', 'side:flag_meanings = "front back" ;', ':Conventions = "CF-1.8" ;'):
            self.assertIn(line, text)

    def radiance(self):
        python = module("pyradiance")
        folder = pathlib.Path(subprocess.run([python, "-c", "import pyradiance; print(pyradiance.__path__[0])"],
                                             check=True, capture_output=True, text=True).stdout.strip())
        environment = dict(os.environ, RAYPATH=f".:{folder / 'lib'}", PATH=f"{folder / 'bin'}:{os.environ['PATH']}")
        return lambda *words, text=True, **more: subprocess.run(list(map(str, words)), cwd=self.folder, env=environment,
                                                                capture_output=True, text=text, check=True, **more).stdout

    def test_radiance_reads_klems(self):
        program = self.radiance()
        self.export("grey.xml", "leaf_solved", "--format", "radiance", "--wavelengths", 551)
        self.export("leaf.xml", "leaf_solved", "--format", "radiance", "--wavelengths", "450:650:50")
        self.export("traced.xml", "leaf_solved,incident=traced", "--format", "radiance", "--wavelengths", 551)
        worst = lambda text: max(float(line.split()[-1]) for line in text.split("Reciprocity Error")[1].splitlines()[1:])
        for file, color, most in (("grey.xml", 0, 0.1), ("leaf.xml", 1, 1)):  # per cent; colours are rounded when read
            report = program("checkBSDF", file)
            self.assertIn("Type: Klems_Full", report)
            self.assertIn(f"Color: {color}", report)
            self.assertLess(worst(report), most)
        self.assertGreater(worst(program("checkBSDF", "traced.xml")), 1)
        (self.folder / "wrapped.xml").write_text(program("wrapBSDF", "-a", "kf", "-f", "m=wrapped", "leaf.xml"))
        self.assertIn("Manufacturer: 'wrapped'", program("checkBSDF", "wrapped.xml"))

    def test_radiance_finds_the_same_shares(self):
        """Under a sky of radiance 1 a sheet shows R or T."""
        program = self.radiance()
        self.export("leaf.xml", "leaf_solved", "--format", "radiance", "--wavelengths", 551)
        with open(self.export("s.csv", "leaf_solved", "--format", "csv", "--wavelengths", 551, "--angles", "10,40",
                              "--view-angles", 0, "--view-azimuths", 0), encoding="utf-8") as file:
            rows = [r for r in csv.DictReader(line for line in file if line[0] != "#") if r["quantity"] in "RT"]
        self.assertEqual(len(rows), 8)
        for r in rows:
            front = r["side"] == "front"
            up = (r["quantity"] == "R") == front  # where the sky is
            # The light is near the sheet's edge of the sky and fills it: a source of 180 degrees.
            (self.folder / "scene.rad").write_text(
                "void glow sky\n0\n0\n4 1 1 1 0\n" + f"sky source s\n0\n0\n4 0 0 {1 if up else -1} 180\n"
                "void BSDF leaf\n6 0 leaf.xml 0 1 0 .\n0\n0\n"
                "leaf polygon p\n0\n0\n12 -9 -9 0  9 -9 0  9 9 0  -9 9 0\n")
            (self.folder / "scene.oct").write_bytes(program("oconv", "scene.rad", text=False))
            theta = math.radians(float(r["theta_i_deg"]))
            x, z = math.sin(theta), math.cos(theta) * (1 if front else -1)
            ray = f"{3 * x} 0 {3 * z} {-x} 0 {-z}\n" * 200
            text = program("rtrace", "-h", "-ab", "1", "-ad", "4096", "-lw", "1e-6", "-ss", "16", "-u+", "scene.oct",
                           input=ray)
            values = [float(line.split()[1]) for line in text.splitlines() if len(line.split()) == 3]
            mean = sum(values) / len(values)
            error = math.sqrt(sum((v - mean)**2 for v in values) / len(values) / (len(values) - 1))
            # Patches are 10 degrees wide; 5 standard errors
            self.assertAlmostEqual(mean, float(r["value"]), delta=0.02 * float(r["value"]) + 5 * error, msg=r)

    def near_normal(self):
        """R and T of the soybean leaf's front and back, light at 8 degrees, red, green and blue in this order."""
        with open(self.export("s.csv", "leaf_solved", "--format", "csv", "--wavelengths", "455,551,608", "--angles", 8,
                              "--view-angles", 0, "--view-azimuths", 0), encoding="utf-8") as file:
            rows = [r for r in csv.DictReader(line for line in file if line[0] != "#") if r["quantity"] in "RT"]
        return {side: {q: [float(r["value"]) for r in reversed(rows) if (r["side"], r["quantity"]) == (side, q)]
                       for q in "RT"} for side in ("front", "back")}

    def assert_near(self, found, right, delta):
        for a, b in zip(found, right, strict=True):
            self.assertAlmostEqual(a, b, delta=delta)

    def test_frond_imports_gltf(self):
        path = self.export("leaf.gltf", "leaf_solved", "--format", "gltf", "--wavelengths", "608,551,455")
        subprocess.run([FROND, "import", path, "-o", self.folder / "leaf.pbrt", "--strict", "-q"], check=True)
        text = (self.folder / "leaf-plant.pbrt").read_text()
        self.assertIn('"string type" "diffusetransmission"', text)
        front = self.near_normal()["front"]
        for name, right in (("reflectance", front["R"]), ("transmittance", front["T"])):
            found = re.search(rf'"rgb {name}" \[ (.*) \]', text)[1].split()
            self.assert_near(map(float, found), right, 0.0005)

    def test_materialx_validates(self):
        python = module("MaterialX", "materialx==1.39.5")
        path = self.export("leaf.mtlx", "leaf_solved", "--format", "materialx", "--wavelengths", "608,551,455")
        found = self.python(python, MATERIALX, path)
        self.assertTrue(found["valid"], found["message"])
        self.assertEqual(found["shaders"], ["leaf_openpbr", "leaf_lambertian"])
        for side, right in self.near_normal().items():
            openpbr, plain = found["nodes"][f"openpbr_{side}"], found["nodes"]
            w, anisotropy = openpbr["subsurface_weight"], openpbr["subsurface_scatter_anisotropy"]
            # OpenPBR 1.1, thin-walled: of the subsurface's colour, (1 + g) / 2 is transmitted
            self.assert_near([w * c * (1 + anisotropy) / 2 for c in openpbr["subsurface_color"]], right["T"], 0.0005)
            self.assert_near([(1 - w) * b + w * c * (1 - anisotropy) / 2
                              for b, c in zip(openpbr["base_color"], openpbr["subsurface_color"])], right["R"], 0.0005)
            self.assert_near(plain[f"reflected_{side}"]["color"], right["R"], 0.0005)
            self.assert_near(plain[f"transmitted_{side}"]["color"], right["T"], 0.0005)

    def test_radiance_reads_trans(self):
        """R and T of the line in the comment, under a sky of radiance 1."""
        program = self.radiance()
        text = self.export("leaf.xml", "leaf_lambert", "--format", "radiance", "--wavelengths", 551).read_text()
        trans = re.search("void trans leaf 0 0 7 (.*) -->", text)[1]
        total, share = float(trans.split()[0]), float(trans.split()[5])
        for up, right in ((1, total * (1 - share)), (-1, total * share)):
            (self.folder / "scene.rad").write_text(
                f"void glow sky\n0\n0\n4 1 1 1 0\nsky source s\n0\n0\n4 0 0 {up} 180\nvoid trans leaf 0 0 7 {trans}\n"
                "leaf polygon p\n0\n0\n12 -9 -9 0  9 -9 0  9 9 0  -9 9 0\n")
            (self.folder / "scene.oct").write_bytes(program("oconv", "scene.rad", text=False))
            found = program("rtrace", "-h", "-ab", "1", "-ad", "4096", "-lw", "1e-6", "scene.oct",
                            input="0 0 3 0 0 -1\n").split()
            self.assertAlmostEqual(float(found[0]), right, delta=0.002)

    def test_osl_compiles(self):
        compiler = shutil.which("oslc")
        if not compiler:
            self.skipTest("there is no oslc")
        path = self.export("leaf.osl", "leaf_solved", "--format", "osl", "--rays", "1e3")
        subprocess.run([compiler, path.name], cwd=self.folder, check=True, capture_output=True)

    def test_cycles_shows_the_same_shares(self):
        python = module("bpy")
        path = self.export("leaf.osl", "leaf_solved", "--format", "osl", "--rays", "1e5")
        modules = f"{HERE.parents[1]}:{pathlib.Path(FROND).parent / 'python'}"
        found = subprocess.run([python, "-B", "-c", CYCLES, path], check=True, capture_output=True, text=True,
                               env=os.environ | {"PYTHONPATH": modules})
        shares = {(name, theta): colors for name, _, theta, _, *colors in json.loads(found.stdout.splitlines()[-1])}
        with open(self.export("s.csv", "leaf_solved", "--format", "csv", "--wavelengths", "455,551,608", "--angles",
                              "7.5,37.5,67.5", "--view-angles", 0, "--view-azimuths", 0), encoding="utf-8") as file:
            rows = [r for r in csv.DictReader(line for line in file if line[0] != "#") if r["quantity"] in "RT"]
        self.assertEqual(len(rows), 36)
        for r in rows:
            theta = float(r["theta_i_deg"])
            shown = shares[r["quantity"], theta if r["side"] == "front" else 180 - theta]
            channel = (608, 551, 455).index(float(r["wavelength_nm"]))
            self.assertAlmostEqual(shown[channel], float(r["value"]), delta=0.004, msg=r)
        for (_, theta), furnace in ((of, colors) for of, colors in shares.items() if of[0] == "S"):
            for c in range(3):
                self.assertAlmostEqual(furnace[c], shares["R", theta][c] + shares["T", theta][c], delta=0.006)


if __name__ == "__main__":
    unittest.main()
