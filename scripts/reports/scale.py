"""docs/scale.md: canopies of ever more leaves."""

import json
import math
import os
import pathlib
import subprocess
import tempfile
import time

import pandas

import charts
from tools import FROND, arguments, machine, program, table, write

LAI, RADIUS, HEIGHT = 3, 0.05, 2
SIZES = [1e3, 1e4, 1e5, 1e6, 1e7, 1e8]
PLANT = 10_000  # leaves of an object, where objects hold leaves and tables hold objects
PIXELS, SAMPLES = 64, 256
ROW_BYTES = 48

SCENE = """Option "float period" [{side} {side}]
Camera "distant" "float zenith" [40] "float azimuth" [30] "float target" [0 {side} 0 {side} {top}]
Film "rgb" "integer xresolution" 1 "integer yresolution" {pixels}
PixelFilter "box"
Sampler "paddedsobol" "integer pixelsamples" {samples}
Integrator "path" "integer maxdepth" 64
WorldBegin
LightSource "distant" "point3 from" [-0.5 0 0.8660254] "point3 to" [0 0 0] "spectrum L" "stdillum-E"
Material "diffuse" "spectrum reflectance" [300 .2 2500 .2]
Shape "bilinearmesh" "point3 P" [0 0 0  {side} 0 0  0 {side} 0  {side} {side} 0]
Material "diffusetransmission" "spectrum reflectance" [300 .45 2500 .45] "spectrum transmittance" [300 .4 2500 .4]
ObjectBegin "leaf" Shape "disk" ObjectEnd
{world}
"""


def side_of(leaves):
    return math.sqrt(leaves * math.pi * RADIUS**2 / LAI)


def canopy(path, leaves, seed=0):
    side = side_of(leaves)
    program("canopy", "-q", "-o", path, "--count", int(leaves), "--scale", RADIUS, "--size", f"{side},{side}",
            "--heights", f"0.05,{HEIGHT}", "--seed", seed)


def one_level(folder, leaves):
    canopy(folder / "leaves.npy", leaves)
    return 'Shape "instances" "string object" "leaf" "string filename" "leaves.npy"'


def two_levels(folder, leaves):
    """Plots of PLANT leaves, each of four kinds and turned by quarters, side by side."""
    count = round(math.sqrt(leaves / PLANT))
    side = side_of(PLANT)
    world = ""
    for kind in range(4):
        canopy(folder / f"plot-{kind}.npy", PLANT, kind + 1)
        world += (f'ObjectBegin "plot-{kind}" Shape "instances" "string object" "leaf" "string filename" "plot-{kind}.npy" '
                  "ObjectEnd\n")
        places = [f"{i * side!r},{j * side!r},0\n" for i in range(count) for j in range(count) if (i + 2 * j) % 4 == kind]
        (folder / f"plots-{kind}.csv").write_text("x,y,z\n" + "".join(places), encoding="utf-8")
        program("instances", "-q", folder / f"plots-{kind}.csv", "-o", folder / f"plots-{kind}.npy")
        world += f'Shape "instances" "string object" "plot-{kind}" "string filename" "plots-{kind}.npy"\n'
    return world


def measure(make, leaves):
    """What a render of a canopy takes: to load, in memory, for a path."""
    with tempfile.TemporaryDirectory(prefix="frond_scale.", dir=os.environ.get("TMPDIR")) as name:
        folder = pathlib.Path(name)
        world = make(folder, leaves)
        scene = folder / "scene.pbrt"
        scene.write_text(SCENE.format(side=side_of(leaves), top=HEIGHT + RADIUS, pixels=PIXELS, samples=SAMPLES, world=world))
        words = [str(FROND), "render", str(scene), "-o", str(folder / "out.exr"), "--json", "-q", "--wavelengths",
                 "bands,wavelengths=800"]
        with subprocess.Popen(words, stdout=subprocess.PIPE, text=True) as render:
            peak = {"RssAnon": 0, "VmRSS": 0}
            while render.poll() is None:
                watch(render.pid, peak)
                time.sleep(0.02)
            text = render.stdout.read()
        if render.returncode != 0:
            raise SystemExit(f"{leaves:g} leaves: frond ended with {render.returncode}")
        result = json.loads(text)
    return {"leaves": leaves, "load": result["load_seconds"], "us": result["cpu_us_per_path"],
            "rays": result["rays_per_path"], "memory": peak["RssAnon"] * 1024, "mapped": peak["VmRSS"] * 1024}


def watch(pid, peak):
    """Largest memory so far: what belongs to the program alone, and with the files that it has mapped."""
    try:
        status = pathlib.Path(f"/proc/{pid}/status").read_text(encoding="utf-8")
    except (FileNotFoundError, ProcessLookupError):
        return
    for line in status.splitlines():
        field, _, value = line.partition(":")
        if field in peak:
            peak[field] = max(peak[field], int(value.split()[0]))


PAGE = """# A hundred million leaves

Written by `scripts/scale`. {machine}

Disks of {radius} m, each by itself, at a leaf area index of {lai}, in a layer of {height} m that is repeated periodically; the more
leaves, the larger the plot. **One level**: every leaf is a row of one table, {row} bytes in a file that is mapped into memory.
**Two levels**: four plots of {plant} leaves, and a table of plots. **Load**: reading, checking the rows and building, wall
time. **Memory**: the largest that the program had for itself, less what it has for a scene of one leaf, a leaf; with the
mapped file's rows beside it. **Path**: CPU time of a path from a distant sensor through the canopy in the near infrared, with
{rays:.1f} rays.

{table}
![What a leaf takes](images/scale.svg)

Embree 3's own instances take 351 bytes each, and twice as much while they are built. Here a table is one geometry, whose rows
are taken into the leaf's space when a ray comes by; a leaf of a single analytic surface is then met without another search.
Boxes are drawn around the points of each instance, not around the corners of the object's box, and a ray that passes an instance's box
in the world is tried against the object's own before it goes in.
"""


def draw(path, points):
    of, [row] = charts.figure(1200, 440, 1, 3)
    for panel, (title, key) in zip(row, (("load, s", "load"), ("bytes a leaf, for itself", "bytes"), ("µs of CPU a path", "us"))):
        for color, (name, of_kind) in zip(charts.COLORS[1:], points.groupby("kind", sort=False)):
            panel.plot(of_kind.leaves, of_kind[key], "o-", color=color, label=name)
        panel.set(xlabel="leaves", ylabel=title, xscale="log", yscale="log" if key == "load" else "linear", xlim=(7e2, 1.4e8))
        if key != "load":
            panel.set_ylim(bottom=0)
    charts.legend(of, row[0], 2)
    charts.save(of, path)


def main():
    options = arguments("scale", ("--most", dict(type=float, help="leaves of the largest canopy: 1e8")),
                        ("--no-docs", dict(action="store_true", help="print the figures, write no page")))
    most = options.most or (1e5 if options.quick else 1e8)
    base, points = measure(one_level, 1), []
    for name, make, least in (("one level", one_level, 1e3), ("two levels", two_levels, 4e4)):
        for leaves in SIZES:
            if least <= leaves <= most:
                points.append({"kind": name, **measure(make, leaves)})
                print(points[-1], flush=True)
    if options.no_docs:
        return
    points = pandas.DataFrame(points)
    # Of small canopies it is lost in what the program has anyway.
    large = points.leaves >= 1e5
    points["bytes"] = ((points.memory - base["memory"]) / points.leaves).where(large)
    points["with_file"] = ((points.mapped - base["mapped"]) / points.leaves).where(large)
    draw(options.docs / "images" / "scale.svg", points)
    shown = lambda value: "" if math.isnan(value) else f"{value:.0f}"
    body = [[p.kind, f"{int(p.leaves):,}", f"{p.load:.2f} s", f"{p.memory / 1e9:.2f} GB", shown(p.bytes), shown(p.with_file),
             f"{p.us:.1f} µs"] for p in points.itertuples()]
    head = ["", "leaves", "load", "memory", "bytes a leaf", "with the file", "path"]
    rays = points[points.kind == "one level"].rays.iloc[-1]
    write(options.docs / "scale.md", PAGE.format(machine=machine(), lai=LAI, radius=RADIUS, height=HEIGHT, row=ROW_BYTES,
                                                 plant=f"{PLANT:,}", rays=rays, table=table(head, body)))


if __name__ == "__main__":
    main()
