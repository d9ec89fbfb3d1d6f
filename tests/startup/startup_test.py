"""Which shared libraries the program loads for what it does: OpenImageIO's, some 250, for pictures of 8 bits and for reading."""

import os
import re
import unittest

from frond_program import FROND, FrondTest


class StartupTest(FrondTest):
    def libraries(self, *words):
        """File names, as the loader initialises them, at the start and later. It writes them to a file for each process."""
        log = self.folder / "loader"
        environment = dict(os.environ, LD_DEBUG="files", LD_DEBUG_OUTPUT=str(log))
        process = self.start([FROND, *map(str, words)], environment)
        _, errors = process.communicate()
        self.assertEqual(process.returncode, 0, errors)
        (trace,) = self.folder.glob("loader.*")
        text = trace.read_text(encoding="utf-8", errors="replace")
        trace.unlink()
        return {os.path.basename(path) for path in re.findall(r"calling init: (\S+)", text)}

    def check_is_light(self, libraries):
        self.assertEqual([name for name in libraries if re.search("OpenImageIO|frond_image|Qt|opencv|boost|avcodec", name)], [])
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

    def test_pictures_of_8_bits_and_reading_load_the_rest(self):
        png = self.libraries("render", self.scene, "-o", self.folder / "a.png", "--spp", 1, "-q", "--no-cache")
        self.assertTrue(any(name.startswith("libOpenImageIO") for name in png), png)
        self.write("textured.pbrt", 'WorldBegin\nTexture "t" "spectrum" "imagemap" "string filename" "a.png"\n'
                   'Material "diffuse" "texture reflectance" "t"\nShape "sphere"\n')
        words = ("render", self.folder / "textured.pbrt", "-o", self.folder / "a.exr", "--quick", "-q", "--no-cache")
        self.assertTrue(any(name.startswith("libOpenImageIO") for name in self.libraries(*words)))


if __name__ == "__main__":
    unittest.main()
