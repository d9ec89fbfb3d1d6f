"""Shared libraries that the program loads, by operation: OpenImageIO's, some 250, for images of 8 bits and for reading."""

import os
import pathlib
import re
import subprocess
import unittest

from frond_program import FROND, FrondTest

LOADER = pathlib.Path("/lib64/ld-linux-x86-64.so.2")
SCENES = pathlib.Path(__file__).resolve().parents[2] / "scenes"


class StartupTest(FrondTest):
    def traced(self, *words):
        """The loader's report of all libraries that it loads, at the start and later. It writes that to a file for each process."""
        log = self.folder / "loader"
        environment = dict(os.environ, LD_DEBUG="files", LD_DEBUG_OUTPUT=str(log))
        process = self.start([FROND, *map(str, words)], environment)
        _, errors = process.communicate()
        self.assertEqual(process.returncode, 0, errors)
        (trace,) = self.folder.glob("loader.*")
        text = trace.read_text(encoding="utf-8", errors="replace")
        trace.unlink()
        return text

    def libraries(self, *words):
        """File names, as they are initialised."""
        return {os.path.basename(path) for path in re.findall(r"calling init: (\S+)", self.traced(*words))}

    def check_is_light(self, libraries):
        self.assertEqual([name for name in libraries if re.search("OpenImageIO|frond_image|Qt|opencv|boost|avcodec|rsvg", name)], [])
        # 20 to 22 in Debian 12 and 13; what one of them brings with it would be seen here.
        self.assertLess(len(libraries), 40, sorted(libraries))

    def test_to_look_something_up_takes_few_libraries(self):
        for words in (["--help"], ["list"], ["describe", "abm"], ["render", "--help"]):
            with self.subTest(words):
                libraries = self.libraries(*words)
                self.assertTrue(any(name.startswith("libfrond.so") for name in libraries), libraries)
                self.check_is_light(libraries)

    def test_so_does_a_render_to_an_exr_and_a_part(self):
        part = self.folder / "a.part"
        for words in (["-o", self.folder / "a.exr"], ["--part", part]):
            self.check_is_light(self.libraries("render", self.scene, *words, "--spp", 1, "-q", "--no-cache"))
        self.check_is_light(self.libraries("merge", part, "-o", self.folder / "b.exr"))

    def test_images_of_8_bits_and_reading_load_the_rest(self):
        png = self.libraries("render", self.scene, "-o", self.folder / "a.png", "--spp", 1, "-q", "--no-cache")
        self.assertTrue(any(name.startswith("libOpenImageIO") for name in png), png)
        self.write("textured.pbrt", 'WorldBegin\nTexture "t" "spectrum" "imagemap" "string filename" "a.png"\n'
                   'Material "diffuse" "texture reflectance" "t"\nShape "sphere"\n')
        words = ("render", self.folder / "textured.pbrt", "-o", self.folder / "a.exr", "--quick", "-q", "--no-cache")
        self.assertTrue(any(name.startswith("libOpenImageIO") for name in self.libraries(*words)))

    def test_charts_load_librsvg_for_png_alone(self):
        words = ("spectrophotometer", "leaf_solved", "--wavelengths", "455,551", "--rays", 100, "-q", "--plot")
        self.check_is_light(self.libraries(*words, self.folder / "a.svg"))
        process = self.start([FROND, *map(str, words), str(self.folder / "a.png")])
        _, errors = process.communicate()
        if process.returncode != 0:
            self.assertIn("librsvg", errors)
            self.skipTest(errors)
        libraries = self.libraries(*words, self.folder / "a.png")
        self.assertTrue(any(name.startswith("librsvg") for name in libraries), libraries)

    def test_the_library_for_avx2_makes_the_same_bits(self):
        if not list(pathlib.Path(FROND).parent.glob("glibc-hwcaps/x86-64-v3/libfrond.so*")):
            self.skipTest("there is one library")
        hardware = subprocess.run([LOADER, "--help"], capture_output=True, text=True, check=True).stdout
        if not re.search(r"x86-64-v3 \(supported", hardware):
            self.skipTest("this machine has no AVX2")
        self.assertRegex(self.traced("list"), r"/glibc-hwcaps/\S*/libfrond")
        for words in (("hundred-leaves/scene.pbrt", "--swap", "*=leaf_solved"), ("soybean-front/scene.pbrt", "--swap", "*=abm"),
                      ("hundred-leaves/closed.pbrt", "--wavelengths", "smpte", "--max-rms", 0.2)):
            with self.subTest(words):
                images = []
                for program in ([FROND], [LOADER, "--glibc-hwcaps-mask", "none", FROND]):
                    out = self.folder / "image.exr"
                    render = [*program, "render", SCENES / words[0], *words[1:], "--quick", "-q", "--no-cache", "-o", out]
                    process = self.start(list(map(str, render)))
                    _, errors = process.communicate()
                    self.assertEqual(process.returncode, 0, errors)
                    images.append(re.sub(rb"capDate\0string\0.{23}", b"", out.read_bytes(), count=1, flags=re.DOTALL))
                self.assertEqual(*images)


if __name__ == "__main__":
    unittest.main()
