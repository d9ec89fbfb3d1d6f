"""less3d: CPU time for an error of the BRF there and in frond brf (section "less3d" of docs/radiometry.md)

The same canopy of squares, seen from the nadir and from 11 directions, with independent replicates of both, each on one thread; the
first argument of taskset decides on which core. Installs less3d 3.0.1, whose metadata says MIT, into build/less3d-venv by pip.
  --replicates N   of less3d for each set of views (default 40); frond has four times as many
  --views NAME     nadir or plane only, and print its row
  --quick          few replicates, into build/less3d_report
"""

import contextlib
import io
import math
import time

import less
import numpy

from .shared.tools import FROND, ROOT, Use, arguments, machine, program, rms, table, write_section

FOLDER = ROOT / "build" / "less3d"
SIDE, HALF = 10.0, 0.05 * math.sqrt(math.pi) / 2  # of the tile, and half the side of a square of the area of a disk of 5 cm, metres
VIEWS = {"nadir": [0], "plane": list(range(-75, 76, 15))}
RMS = 0.01
PIXELS = {"nadir": 128, "plane": 128}  # along each side of less3d's images: about as many paths as 1 % needs

SECTION = """### less3d

Measured by `measurements/run less3d` on {machine}; less3d 3.0.1 with Embree.

A periodic tile of 10 m x 10 m with {leaves:,} square leaves (leaf area index 3, spherical leaf angles, reflectance and transmittance 0.45)
over black soil, the sun at 30° from the zenith; the BRF at the nadir, and at 11 directions from −75° to 75° in the sun's plane.
{replicates} replicates of less3d, four times as many of frond. `frond brf --rms 0.01` runs as it is; an image of less3d for each view has {pixels} x {pixels} pixels of
one path, and its replicates shift the images over the tile, since it has no seed. No leaf sticks out of the tile: less3d would lose that part. The error is the standard deviation of the
replicates relative to the mean, RMS over the views. CPU time is that for an error of 1 %: time x (error / 1 %)², without and with the time
to start and to load the scene once.

{rows}
The ratios have the 95 % intervals of the errors' variances. Means of the views from frond, and differences of less3d's in
standard errors: {means}.
Chi-square over the {views} views is {chi:.1f} (above 19.7 in one of 20 such comparisons without a difference).

less3d takes the x axis of an OBJ file as westward, y as upward, z as northward. A mesh written with x eastward has the sun on its other
side: it is another canopy of the same statistics.
"""


def squares():
    """The leaves' corners, by leaf: those of frond's canopy of disks."""
    path = FOLDER / "leaves.npy"
    program("canopy", "-q", "-o", path, "--lai", 3, "--angles", "spherical", "--scale", 0.05, "--size", f"{SIDE},{SIDE}", "--heights",
            "0.05,1.95", "--seed", 1)
    rows = numpy.load(path)
    maps = rows["transform"]
    corner = numpy.array([[-1, -1, 0], [1, -1, 0], [-1, 1, 0], [1, 1, 0]]) * HALF / 0.05
    reach = abs(maps[:, :2, :3] @ corner.T).max(axis=2)  # less3d loses what sticks out of the tile
    maps[:, :2, 3] = numpy.clip(maps[:, :2, 3], reach, SIDE - reach)
    numpy.save(path, rows)
    (FOLDER / "scene.pbrt").write_text(f"""Option "float period" [{SIDE} {SIDE}]
WorldBegin
LightSource "distant" "point3 from" [-0.5 0 {math.sqrt(0.75)}] "point3 to" [0 0 0] "spectrum L" "stdillum-E"
Material "diffuse" "spectrum reflectance" [300 0 2500 0]
Shape "bilinearmesh" "point3 P" [0 0 0  {SIDE} 0 0  0 {SIDE} 0  {SIDE} {SIDE} 0]
Material "diffusetransmission" "spectrum reflectance" [300 0.45 2500 0.45] "spectrum transmittance" [300 0.45 2500 0.45]
ObjectBegin "leaf" Shape "bilinearmesh" "point3 P" [{" ".join(map(str, corner.ravel()))}] ObjectEnd
Shape "instances" "string object" "leaf" "string filename" "leaves.npy"
""", encoding="utf-8")
    return numpy.einsum("nij,kj->nki", maps[:, :, :3], corner) + maps[:, None, :, 3]


class Frond:
    """Replicates of a set of views: BRFs, CPU seconds of the measurement and of its set-up, paths of a view."""

    def __init__(self, zenith):
        self.views = ("--wavelengths", 800, "--zenith=" + ",".join(map(str, zenith)), "--threads", 1)

    def run(self, seed, *effort):
        path = FOLDER / "frond.csv"
        use = Use(FROND, "brf", FOLDER / "scene.pbrt", *self.views, "--seed", seed, *effort, "-q", "--csv", path)
        return use.cpu, numpy.loadtxt(path, delimiter=",", skiprows=1, ndmin=2)[:, 3]

    def replicate(self, seed):
        setup, _ = self.run(seed, "--paths", 1)
        cpu, brf = self.run(seed, "--rms", RMS)
        return brf, cpu - setup, setup


class Less:
    """The same of less3d."""

    def __init__(self, zenith, corners, pixels):
        self.zenith, self.pixels = zenith, pixels
        self.shifts = numpy.random.default_rng(1)
        with contextlib.redirect_stdout(io.StringIO()):
            self.scene, self.setup = self.load(corners, f"leaves{len(zenith)}.obj")

    def load(self, corners, name):
        corners, first = corners.reshape(-1, 3) - [SIDE / 2, SIDE / 2, 0], 4 * numpy.arange(len(corners))[:, None] + 1
        faces = numpy.concatenate([first + [0, 1, 3], first + [0, 3, 2]], axis=1).reshape(-1, 3)
        path = FOLDER / name  # less3d keeps its own copy by name, takes x as westward, y as upward, z as northward
        with open(path, "w", encoding="utf-8") as file:
            numpy.savetxt(file, corners[:, [0, 2, 1]] * [-1, 1, 1], "v %.7g %.7g %.7g", header="g leaf", comments="")
            numpy.savetxt(file, faces, "f %d %d %d")
        start = time.process_time()
        scene = less.Scene(backend="embree")
        scene.size, scene.repetitive = SIDE, True
        scene.terrain = less.Terrain(property=less.Lambertian(reflectance=0.0))
        leaf = less.Object("leaf", mesh=str(path))
        leaf.set_property(less.Lambertian(reflectance=0.45, transmittance=0.45))
        scene.add(leaf, positions=numpy.array([[SIDE / 2, SIDE / 2, corners[:, 2].min()]]))  # of its lowest point
        scene.illumination = less.Illumination(source=less.Sun(zenith=30, azimuth=270), atmosphere=less.NoAtmosphere())
        scene.build()
        for old in FOLDER.glob(f"{name}*"):
            old.unlink()
        return scene, time.process_time() - start

    def replicate(self, _):
        with contextlib.redirect_stdout(io.StringIO()):
            start = time.process_time()
            brf = [numpy.mean(self.scene.simulate(less.OpticalImager(
                less.Orthographic(image_size=self.pixels, extent=SIDE, center=tuple(self.shifts.uniform(0, SIDE, 2)), view_zenith=abs(z),
                                  view_azimuth=270 if z < 0 else 90), bands=[800.0], quality=1)).to_brf().data) for z in self.zenith]
            return numpy.array(brf, dtype=float), time.process_time() - start, self.setup


def measured(program_of, replicates):
    """Means and their errors by view, relative error, CPU seconds to 1 % and those of the set-up, degrees of freedom."""
    found = [program_of.replicate(seed) for seed in range(1, replicates + 1)]
    brf = numpy.array([one[0] for one in found])
    mean, spread = brf.mean(axis=0), brf.std(axis=0, ddof=1)
    error = rms(spread / mean)
    cpu, setup = (float(numpy.mean([one[i] for one in found])) for i in (1, 2))
    return mean, spread / math.sqrt(replicates), error, cpu * (error / RMS) ** 2, setup, brf.shape[1] * (replicates - 1)


def main():
    options = arguments("less3d", ("--replicates", {"type": int, "default": 40}), ("--views", {"choices": list(VIEWS)}))
    replicates = 3 if options.quick else options.replicates
    FOLDER.mkdir(parents=True, exist_ok=True)
    corners, body, means, chi = squares(), [], [], 0.0
    for name in [options.views] if options.views else VIEWS:
        ours = measured(Frond(VIEWS[name]), 4 * replicates)
        theirs = measured(Less(VIEWS[name], corners, PIXELS[name]), replicates)
        means = [f"{zenith}° {a:.4f} ({100 * (b / a - 1):+.1f} %, {(b - a) / math.hypot(da, db):+.1f})"
                 for zenith, a, da, b, db in zip(VIEWS[name], ours[0], ours[1], theirs[0], theirs[1])]
        chi = sum((ours[0] - theirs[0]) ** 2 / (ours[1] ** 2 + theirs[1] ** 2))
        ratio, width = ours[3] / theirs[3], 1.96 * math.sqrt(2 / ours[5] + 2 / theirs[5])
        for label, m, relative in (("frond", ours, f"{ratio:.2f} ({ratio * math.exp(-width):.2f} to {ratio * math.exp(width):.2f})"),
                                   ("less3d", theirs, "1")):
            whole = (ours[3] + ours[4]) / (theirs[3] + theirs[4]) if m is ours else 1
            body.append([name, label, f"{100 * m[2]:.2f} %", f"{m[3]:.3f} s", relative, f"{m[3] + m[4]:.2f} s", f"{whole:.2f}"])
    rows = table(["views", "program", "error of a run", "CPU to 1 %", "relative", "with set-up", "relative"], body)
    print(rows, *means, f"chi-square {chi:.1f}", sep="\n")
    if options.views:
        return
    write_section(options.docs / "radiometry.md", "less3d",
                  SECTION.format(machine=machine(), leaves=len(corners), replicates=replicates, pixels=PIXELS["nadir"], rows=rows,
                                 means=", ".join(means), views=len(means), chi=chi))


if __name__ == "__main__":
    main()
