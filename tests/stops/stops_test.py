"""Jobs whose scenes keep them busy for hours inside one path, one pilot or one step of loading, and end soon after a
signal or at their time limit. LATEST separates "stops" from "runs for hours", also on a busy machine."""

import json
import signal
import subprocess
import time
import unittest

from frond_program import FROND, THREADS, FrondTest

LATEST = 10  # seconds after a signal or a time limit

HEAD = """
LookAt 0 0 4  0 0 0  0 1 0
Camera "perspective" "float fov" 4
Film "rgb" "integer xresolution" 16 "integer yresolution" 16
Sampler "lattice" "integer pixelsamples" 64
Integrator "{integrator}" "integer maxdepth" {depth}
WorldBegin
"""
SKY = 'LightSource "infinite" "rgb L" [1 1 1]\n'
BALL = """{light}AttributeBegin
Material "interface"
MediumInterface "m" ""
Shape "sphere" "float radius" 1.9
AttributeEnd
"""


def grid_with_a_spike(kind="uniformgrid", values='"float density" [{}]', none="0", spike="1e30"):
    """A medium of 32 cells along each axis, all but one of them empty: few of the rays that are traced when it is loaded
    meet the cell, all of the camera's do."""
    n = 32
    cells = [none] * n**3
    cells[16 + n * (16 + n * 12)] = spike
    return (
        f'MakeNamedMedium "m" "string type" "{kind}" "point3 p0" [-2 -2 -2] "point3 p1" [2 2 2] '
        f'"integer nx" {n} "integer ny" {n} "integer nz" {n} {values.format(" ".join(cells))}\n'
    )


def scene(world, integrator="volpath", depth=8):
    return HEAD.format(integrator=integrator, depth=depth) + world


LAYERS = "".join(
    f'Shape "trianglemesh" "point3 P" [-1 -1 {z}  1 -1 {z}  1 1 {z}  -1 1 {z}] "integer indices" [0 1 2  0 2 3]\n'
    for z in range(200)
)
FIELD = (
    'Option "float period" [2 2]\nFilm "rgb" "integer xresolution" 16 "integer yresolution" 16\nCamera "perspective"\n'
    'WorldBegin\nLightSource "distant" "point3 from" [0 0 1] "point3 to" [0 0 0]\n'
)
CAGE = (
    'Shape "loopsubdiv" "integer levels" 10 "point3 P" [1 0 0  -1 0 0  0 1 0  0 -1 0  0 0 1  0 0 -1] "integer indices" '
    "[4 0 2  4 2 1  4 1 3  4 3 0  5 2 0  5 1 2  5 3 1  5 0 3]\n"
)

WHITE = '"spectrum reflectance" [300 1 900 1]'
DENSE = 'MakeNamedMedium "m" "string type" "homogeneous" "float sigma_a" 0 "float sigma_s" 1e9\n'
SHELLS = "".join(
    f'AttributeBegin\nMaterial "interface"\nMediumInterface "m"\nShape "sphere" "float radius" {1 + i / 999}\n'
    "AttributeEnd\n"
    for i in range(900)
)

RENDERS = {
    "null collisions": scene(grid_with_a_spike() + BALL.format(light=SKY)),
    "null collisions among colours": scene(
        grid_with_a_spike("rgbgrid", '"rgb sigma_s" [{}]', "0 0 0", "1e20 1e20 1e20") + BALL.format(light=SKY)
    ),
    "null collisions of shadow rays": scene(
        grid_with_a_spike()
        + BALL.format(light='LightSource "point" "point3 from" [0 0 -3]\n')
        + 'Material "diffusetransmission"\nShape "disk" "float radius" 1 "float height" 2\n'
    ),
    "scatterings": scene(DENSE + BALL.format(light=SKY), depth=1 << 20),
    "leaves of vanishing size": scene(
        'MakeNamedMedium "m" "string type" "turbid" "float density" 1e9 "spectrum reflectance" [300 .5 900 .5] '
        '"spectrum transmittance" [300 .5 900 .5]\n' + BALL.format(light=SKY),
        depth=1 << 20,
    ),
    "invisible surfaces": scene(DENSE + SHELLS + BALL.format(light=SKY), depth=1 << 20),
    "reflections": scene(
        f'AttributeBegin\nAreaLightSource "diffuse"\nMaterial "diffuse" {WHITE}\nShape "sphere" "float radius" 9\n'
        "AttributeEnd\n",
        integrator="path",
        depth=1 << 20,
    ),
    "subdivision": scene(SKY + 'Material "diffuse"\n' + CAGE, integrator="path"),
    "tables": scene(
        SKY + 'Material "leaf_solved" "string specimen" "soybean" "float tolerance" 1e-5\nShape "sphere"\n',
        integrator="path",
    ),
}
MEASUREMENTS = {
    "brf": ("brf", FIELD + f'Material "diffuse" {WHITE}\n' + LAYERS, "--zenith=0", "--integrator", "path,maxdepth=99999"),
    "flux": ("flux", FIELD + 'Material "abm" "string specimen" "soybean"\n' + LAYERS),
    "flux by instance": (
        "flux",
        FIELD + 'ObjectBegin "layers"\nMaterial "abm" "string specimen" "soybean"\n' + LAYERS
        + 'ObjectEnd\nObjectInstance "layers"\n',
        "--by",
        "instance",
    ),
}


class Stops(FrondTest):
    def commands(self):
        """Commands that would run for hours, by name."""
        for name, text in RENDERS.items():
            path = self.write(name.replace(" ", "_") + ".pbrt", text)
            yield name, ["render", str(path), "-o", str(self.folder / "image.exr")]
        for name, (command, text, *words) in MEASUREMENTS.items():
            path = self.write(name.replace(" ", "_") + ".pbrt", text)
            more = ["--paths", "4e9", "--wavelengths", "450,650", "--csv", str(self.folder / "shares.csv")]
            yield name, [command, str(path), *words, *more]

    def start_frond(self, command, *words):
        return self.start([FROND, *command, "--no-cache", "--threads", str(THREADS), *words])

    def test_a_signal_ends_what_would_last_for_hours(self):
        signals = [signal.SIGTERM, signal.SIGINT, signal.SIGHUP]
        for i, (name, command) in enumerate(self.commands()):
            number = signals[i % len(signals)]
            with self.subTest(name=name, signal=number.name):
                process = self.start_frond(command, "--checkpoint", "60")
                time.sleep(1)
                self.assertIsNone(process.poll(), "it has ended before the signal")
                process.send_signal(number)
                _, err = process.communicate(timeout=LATEST)
                self.assertEqual(process.returncode, 128 + number, err)
                self.assertIn("stopped; ", err)
                for part in self.folder.glob("*.part"):
                    part.unlink()

    def test_a_signal_without_a_checkpoint_ends_it_too(self):
        for number in (signal.SIGTERM, signal.SIGINT, signal.SIGHUP):
            with self.subTest(signal=number.name):
                path = self.write("scene.pbrt", RENDERS["null collisions"])
                process = self.start_frond(["render", str(path), "-o", str(self.folder / "image.exr")])
                time.sleep(0.5)
                process.send_signal(number)
                process.communicate(timeout=LATEST)
                self.assertEqual(process.returncode, -number)

    def test_a_time_limit_ends_what_would_last_for_hours(self):
        for name, command in self.commands():
            with self.subTest(name=name):
                process = self.start_frond(command, "--time-limit", "1")
                _, err = process.communicate(timeout=1 + LATEST)
                self.assertIn("the time limit ended", err)
                if process.returncode == 0:  # a partial result
                    self.assertTrue([*self.folder.glob("image.exr"), *self.folder.glob("shares.csv")])
                else:
                    self.assertEqual(process.returncode, 1, err)
                    self.assertRegex(err, r"\.pbrt:")
                for result in ("image.exr", "shares.csv"):
                    (self.folder / result).unlink(missing_ok=True)

    def test_a_path_without_end_leaves_out_its_tile_alone(self):
        """A spike that few pixels see: what has been rendered is kept, and the tile of those pixels has no samples."""
        side = 240  # the middle is that of a tile
        far = RENDERS["null collisions"].replace("LookAt 0 0 4 ", "LookAt 0 0 40 ").replace('"float fov" 4', '"float fov" 90')
        far = far.replace('resolution" 16', f'resolution" {side}').replace('pixelsamples" 64', 'pixelsamples" 1')
        command = ["render", str(self.write("far.pbrt", far)), "-o", str(self.folder / "image.exr"), "--json", "-"]
        process = self.start_frond(command, "--time-limit", "5")
        out, err = process.communicate()
        self.assertEqual(process.returncode, 0, err)
        self.assertIn("the time limit ended: pixels have 0 to 1 samples, not 1", err)
        self.assertGreater(json.loads(out)["paths"], 0.98 * side**2)

    def test_a_stopped_flux_goes_on_to_the_same_result(self):
        """Stopped inside a round of 262,144 paths, of which the first blocks count."""
        for name in ("flux", "flux by instance"):
            with self.subTest(name=name):
                command, text, *words = MEASUREMENTS[name]
                layers = "".join(LAYERS.splitlines(keepends=True)[:3])
                path = self.write("few.pbrt", text.replace(LAYERS, layers))
                common = [command, str(path), *words, "--wavelengths", "450,650", "--paths", "60000"]
                expected, _ = self.run_to_end(
                    [FROND, *common, "--no-cache", "--threads", str(THREADS), "--csv", "-", "-q"]
                )
                csv, stops = self.folder / "kept.csv", 0
                while not csv.exists():
                    process = self.start_frond([*common, "--csv", str(csv), "--checkpoint", "60", "--resume"])
                    try:
                        process.communicate(timeout=0.5 + 0.3 * stops)
                    except subprocess.TimeoutExpired:
                        process.send_signal(signal.SIGTERM)
                        process.communicate(timeout=LATEST)
                        stops += 1
                self.assertEqual(csv.read_text(encoding="utf-8"), expected)
                for kept in self.folder.glob("kept.csv*"):
                    kept.unlink()


if __name__ == "__main__":
    unittest.main()
