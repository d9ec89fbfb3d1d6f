"""Runs of the frond program for tests that disturb it. Its path is in FROND."""

import json
import os
import pathlib
import struct
import subprocess
import tempfile
import time
import unittest

FROND = os.environ["FROND"]
SLOW = os.environ.get("FROND_SLOW_TESTS") == "1"

SCENE = """
LookAt 0 .5 2  0 0 0  0 1 0
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 48 "integer yresolution" 32
Sampler "lattice" "integer pixelsamples" 16
Integrator "path" "integer maxdepth" 6
WorldBegin
LightSource "infinite" "spectrum L" "stdillum-D65"
Material "diffuse" "rgb reflectance" [.5 .4 .3]
Shape "trianglemesh" "point3 P" [-2 -.5 -2  2 -.5 -2  2 -.5 2  -2 -.5 2] "integer indices" [0 1 2  0 2 3]
Material "diffusetransmission" "rgb reflectance" [.2 .5 .1]
Shape "sphere" "float radius" .5
"""
# Pixels that have samples, including pixels around the image whose filter reaches into it.
PIXELS = 50 * 34
THREADS = 2


def part_header(path):
    """Header of a part, before its sums (docs/many_machines.md)."""
    data = pathlib.Path(path).read_bytes()
    magic = b"frond part 4\n"
    assert data.startswith(magic), f"{path} is no part"
    (size,) = struct.unpack_from("<Q", data, len(magic))
    return json.loads(data[len(magic) + 8 : len(magic) + 8 + size])


class FrondTest(unittest.TestCase):
    """A folder with a scene in it."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="frond_test_")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)
        self.scene = self.write("scene.pbrt", SCENE)

    def write(self, name, text):
        path = self.folder / name
        path.write_text(text, encoding="utf-8")
        return path

    def command(self, output, *words):
        words = ("--threads", THREADS, "-o", output, *words)
        return [FROND, "render", str(self.scene), "--no-cache", *map(str, words)]

    def start(self, command, environment=None, **more):
        environment = dict(environment or os.environ, SOURCE_DATE_EPOCH="0")
        process = subprocess.Popen(
            command, env=environment, text=True, stdout=subprocess.PIPE, stderr=subprocess.PIPE, **more
        )
        self.addCleanup(self.end, process)
        return process

    @staticmethod
    def end(process):
        if process.poll() is None:
            process.kill()
            process.wait()
        for pipe in (process.stdout, process.stderr):
            pipe.close()

    def run_to_end(self, command, code=0, **more):
        process = self.start(command, **more)
        out, err = process.communicate()
        self.assertEqual(process.returncode, code, err)
        return out, err

    def run_for(self, seconds, *words):
        """Output of `self.command(*words)` with a time limit of so many seconds, or 4 and 16 times as many where nothing
        is measured by then: under a sanitizer on a busy machine."""
        for limit in (seconds, 4 * seconds, 16 * seconds):
            process = self.start(self.command(*words, "--time-limit", limit))
            out, err = process.communicate()
            if process.returncode == 0 or "the time limit ended before" not in err:
                break
        self.assertEqual(process.returncode, 0, err)
        return out, err

    def samples_in(self, seconds):
        """How many samples per pixel a run of so many seconds gets to here and now, load and all."""
        image = self.folder / "calibration.exr"
        out, _ = self.run_for(seconds, image, "--spp", 1 << 24, "--json", "-", "-q")
        image.unlink()
        return max(64, json.loads(out)["samples_per_pixel"])

    def wait_for(self, condition, what, seconds=20):
        end = time.monotonic() + seconds
        while not condition():
            self.assertLess(time.monotonic(), end, f"{what} did not come")
            time.sleep(0.0005)

    def files(self):
        return sorted(path.name for path in self.folder.iterdir())
