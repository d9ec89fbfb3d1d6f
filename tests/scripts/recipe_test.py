"""The recipe of conda-forge: its dependencies are those of the build, and rattler-build renders it."""

import pathlib
import re
import subprocess
import unittest

import yaml

ROOT = pathlib.Path(__file__).resolve().parents[2]
RECIPE = ROOT / "packaging" / "conda" / "recipe.yaml"
# Of scripts/setup.sh, by conda-forge's name; None: what only tests, or Debian's compiler, need.
NAMES = {
    "g++": None, "ccache": None, "libgmock-dev": None, "libbenchmark-dev": None, "ninja-build": "ninja", "libembree-dev": "embree",
    "libopenimageio-dev": "openimageio", "libwebp-dev": "libwebp-base", "libopenexr-dev": "openexr",
    "libopencolorio-dev": "opencolorio", "libfmt-dev": "fmt", "libcli11-dev": "cli11", "nlohmann-json3-dev": "nlohmann_json",
    "libeigen3-dev": "eigen", "libzstd-dev": "zstd", "zlib1g-dev": "zlib", "libboost-dev": "libboost-headers",
    "libnetcdf-dev": "libnetcdf", "libmeshoptimizer-dev": "meshoptimizer", "librsvg2-dev": "librsvg", "libnanovdb-dev": "nanovdb",
}
RENDER = """
import sys
import rattler_build
linux = rattler_build.PlatformConfig(target_platform="linux-64", build_platform="linux-64", host_platform="linux-64")
variants = rattler_build.VariantConfig({"python": ["3.12.*"], "cxx_compiler": ["gxx"], "c_stdlib": ["sysroot"]})
found = rattler_build.Stage0Recipe.from_file(sys.argv[1]).render(variants, rattler_build.RenderConfig(platform=linux))
print(*(variant.recipe.package.name for variant in found))
"""


class Recipe(unittest.TestCase):
    recipe = yaml.safe_load(RECIPE.read_text(encoding="utf-8"))

    def test_dependencies_are_those_of_the_build(self):
        listed = re.search(r"^build_packages=\((.*?)\)", (ROOT / "scripts" / "setup.sh").read_text(encoding="utf-8"), re.M | re.S)[1]
        needed = {name for package in listed.split() if (name := NAMES.get(package, package))}
        of_python = re.search(r"^requires = \[(.*)\]$", (ROOT / "pyproject.toml").read_text(encoding="utf-8"), re.M)[1]
        needed |= {name for name in re.findall(r'"([\w-]+)', of_python)} | {"python", "pip"}
        requirements = self.recipe["requirements"]
        names = {entry.split()[0] for entry in requirements["build"] + requirements["host"]} - {"${{"}
        self.assertEqual(names, needed)

    def test_the_package_needs_what_the_wheel_does(self):
        wheel = re.search(r"^dependencies = \[(.*)\]$", (ROOT / "pyproject.toml").read_text(encoding="utf-8"), re.M)[1]
        run = [entry.replace(" ", "") for entry in self.recipe["requirements"]["run"]]
        self.assertLessEqual(set(re.findall(r'"([^"]+)"', wheel)), set(run))

    def test_licences_are_files(self):
        for name in self.recipe["about"]["license_file"]:
            self.assertTrue((ROOT / name).is_file(), name)
        self.assertIn(f'license = "{self.recipe["about"]["license"]}"', (ROOT / "pyproject.toml").read_text(encoding="utf-8"))

    def test_rattler_build_renders_it(self):
        python = ROOT / "build" / "engines" / "bin" / "python"
        if subprocess.run([python, "-c", "import rattler_build"], capture_output=True, check=False).returncode if python.exists() else 1:
            self.skipTest("scripts/test installs py-rattler-build")
        found = subprocess.run([python, "-c", RENDER, RECIPE], capture_output=True, text=True, check=False)
        self.assertEqual(found.returncode, 0, found.stderr)
        self.assertEqual(found.stdout.split(), ["frond-render"])


if __name__ == "__main__":
    unittest.main()
