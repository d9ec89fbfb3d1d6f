"""No invalid floating-point operation (0/0, inf - inf, 0 * inf, ...) in frond's own code while it renders: a library that is
preloaded (invalid_operations.cpp) catches them. NaN that is made and then discarded costs nothing today and is a wrong pixel
after the next change. INTENDED names the functions where it is right, and why.

FROND is the program, FROND_TRAPS the library, FROND_TEST_PLUGIN the plug-in hostile.
"""

import bisect
import os
import pathlib
import platform
import subprocess
import unittest

from frond_program import FROND, SCENE, SLOW, FrondTest

TRAPS = os.environ["FROND_TRAPS"]
ROOT = pathlib.Path(__file__).resolve().parents[2]

# Part of the demangled name of a function: why an invalid operation is right there.
INTENDED = {
    "Callbacks::intersect": "a ray in the plane of a box's face: 0 * inf, and the box counts as hit or as missed, both of which are right",
    "Callbacks::occluded": "the same",
}

# A scene in which 0 is divided by 0 unless the code takes care: surfaces without area, normals that cancel, a mirror without
# roughness seen along its surface, lights in the plane of what they light, values that underflow.
DEGENERATE = """
LookAt 0 0 2  0 0 0  0 1 0
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 32 "integer yresolution" 32
Sampler "lattice" "integer pixelsamples" 16
WorldBegin
LightSource "point" "point3 from" [0 0 0] "spectrum I" "stdillum-D65"
LightSource "infinite" "rgb L" [1e-38 1e-38 1e-38]
AttributeBegin
  AreaLightSource "diffuse" "rgb L" [1e-30 1 1e-38]
  Shape "trianglemesh" "point3 P" [-1 0 -1  1 0 -1  1 0 1] "integer indices" [0 1 2]
AttributeEnd
Material "conductor" "float roughness" 0
Shape "trianglemesh" "point3 P" [-1 0 -1  1 0 -1  1 0 1  0 0 0] "integer indices" [0 1 2  0 0 0  0 1 3]
  "normal3 N" [0 1 0  0 -1 0  0 0 0  1e-40 0 0] "point2 uv" [0 0  0 0  0 0  1e-40 0]
Material "dielectric" "float eta" 1
Shape "sphere" "float radius" 0.5
Shape "sphere" "float radius" 1e-30
Material "leaf_simplified"
Shape "disk" "float radius" 1
Shape "bilinearmesh" "point3 P" [0 0 0  0 0 0  0 1 0  0 1 0] "integer indices" [0 1 2 3]
ObjectBegin "empty"
ObjectEnd
ObjectBegin "leaf"
  Scale 1 1e-20 1
  Shape "disk" "float radius" 0.2
ObjectEnd
ObjectInstance "empty"
ObjectInstance "leaf"
"""


def functions(module):
    """Addresses and names of a module's functions, sorted."""
    lines = subprocess.run(["nm", "-C", "--defined-only", module], check=True, capture_output=True, text=True).stdout
    rows = (line.split(" ", 2) for line in lines.splitlines())
    return sorted((int(address, 16), name) for address, kind, name in rows if kind in "tTwW")


@unittest.skipUnless(platform.machine() == "x86_64", "traps of x86-64")
class TrapsTest(FrondTest):
    names = {}

    def function_at(self, module, offset):
        if module not in self.names:
            self.names[module] = functions(module)
        table = self.names[module]
        at = bisect.bisect_right(table, (offset, "\U0010ffff")) - 1
        return table[at][1] if at >= 0 else "?"

    def found(self, scene, *words):
        """Functions with an invalid operation that is not intended."""
        log = self.folder / "traps"
        log.unlink(missing_ok=True)
        command = [FROND, "render", str(scene), "--no-cache", "-q", "-o", str(self.folder / "image.exr"), *words]
        self.run_to_end(command, environment=dict(os.environ, LD_PRELOAD=TRAPS, FROND_TRAPS_LOG=str(log)))
        places = (line.rsplit(" ", 1) for line in log.read_text().splitlines())
        named = sorted({f"{self.function_at(module, int(offset, 16))} ({offset})" for module, offset in places})
        return [name for name in named if not any(part in name for part in INTENDED)]

    def check(self, scene, *words):
        with self.subTest(scene=scene.name, words=words):
            self.assertEqual(self.found(scene, *words), [])

    def test_an_invalid_operation_is_found(self):
        """A test that cannot fail would say nothing: NaN from a plug-in, which the integrator compares."""
        material = '"hostile_material" "string fault" "sample_f_nan"'
        scene = self.write("nan.pbrt", SCENE.replace('"diffuse" "rgb reflectance" [.5 .4 .3]', material))
        self.assertIn("Path", " ".join(self.found(scene, "--plugin", os.environ["FROND_TEST_PLUGIN"])))

    def test_degenerate_scene(self):
        self.check(self.write("degenerate.pbrt", DEGENERATE))

    def test_reference_scenes(self):
        folder = ROOT / "tests/pbrt_reference"
        # A trap costs two signals, and Embree makes many.
        for name in (folder / "agrees.txt").read_text().split()[:: 1 if SLOW else 4]:
            self.check(folder / f"{name}.pbrt", "--spp", "1")

    def test_leaf_scenes(self):
        materials = ("abm", "leaf_solved", "leaf_simplified", "leaf_lambert") if SLOW else ("leaf_solved", "leaf_simplified")
        crop = () if SLOW else ("--crop", "0.4,0.6,0.4,0.6")
        for name in ("soybean-front", "soybean-back", "hundred-leaves"):
            for material in materials:
                self.check(ROOT / "scenes" / name / "scene.pbrt", "--swap", f"*={material}", "--quick", "--spp", "1", *crop)


if __name__ == "__main__":
    unittest.main()
