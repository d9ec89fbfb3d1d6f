"""docs/scale.md: canopies of ever more leaves."""

import argparse
import json
import math
import os
import pathlib
import re
import subprocess
import tempfile
import time

from tools import COLORS, FROND, ROOT, block, frond, gnuplot, machine, table, thousands

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
    frond("canopy", "-q", "-o", path, "--count", int(leaves), "--scale", RADIUS, "--size", f"{side},{side}",
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
        with open(folder / f"plots-{kind}.csv", "w", encoding="utf-8") as out:
            out.write("x,y,z\n")
            for i in range(count):
                out.writelines(f"{i * side!r},{j * side!r},0\n" for j in range(count) if (i + 2 * j) % 4 == kind)
        frond("instances", "-q", folder / f"plots-{kind}.csv", "-o", folder / f"plots-{kind}.npy")
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
        with subprocess.Popen(words, stdout=subprocess.PIPE, text=True) as program:
            peak = {"anonymous": 0, "all": 0}
            while program.poll() is None:
                watch(program.pid, peak)
                time.sleep(0.02)
            text = program.stdout.read()
        if program.returncode != 0:
            raise SystemExit(f"{leaves:g} leaves: frond ended with {program.returncode}")
        result = json.loads(text)
    return {"leaves": leaves, "load": result["load_seconds"], "us": result["cpu_us_per_path"],
            "rays": result["rays_per_path"], "memory": peak["anonymous"] * 1024, "mapped": peak["all"] * 1024}


def watch(pid, peak):
    """Largest memory so far: what belongs to the program alone, and with the files that it has mapped."""
    try:
        status = pathlib.Path(f"/proc/{pid}/status").read_text(encoding="utf-8")
    except (FileNotFoundError, ProcessLookupError):
        return
    for key, field in (("anonymous", "RssAnon"), ("all", "VmRSS")):
        found = re.search(rf"{field}:\s+(\d+) kB", status)
        if found:
            peak[key] = max(peak[key], int(found[1]))


PAGE = """# A hundred million leaves

Written by `scripts/scale`. {machine}

Disks of {radius} m, each by itself, at a leaf area index of {lai}, in a layer of {height} m that goes on for ever; the more
leaves, the larger the plot. **One level**: every leaf is a row of one table, {row} bytes in a file that is mapped into memory.
**Two levels**: four plots of {plant} leaves, and a table of plots. **Load**: reading, checking the rows and building, wall
time. **Memory**: the largest that the program had for itself, less what it has for a scene of one leaf, a leaf; with the
mapped file's rows beside it. **Path**: CPU time of a path from a distant sensor through the canopy in the near infrared, with
{rays:.1f} rays.

{table}
![What a leaf takes](images/scale.svg)

Embree 3's own instances take 351 bytes each, and twice as much while they are built. Here a table is one geometry, whose rows
are taken into the leaf's space when a ray comes by; a leaf of a single analytic surface is then met without another search.
Boxes are drawn around the points of each copy, not around the corners of the object's box, and a ray that passes a copy's box
in the world is tried against the object's own before it goes in.
"""


def draw(results):
    script = "set multiplot layout 1,3\nset logscale x\nset format x '10^{%L}'\nset xlabel 'leaves'\nset xrange [1e3:1e8]\n"
    panels = [("load, s", "load", "top left"), ("bytes a leaf, for itself", "bytes", "center right"), ("µs of CPU a path", "us", "top left")]
    for title, key, place in panels:
        script += f"set key {place}\n"
        script += "set logscale y\n" if key == "load" else "unset logscale y\nset yrange [0:*]\n"
        script += f"set ylabel '{title}'\n"
        plots = []
        for i, (name, points) in enumerate(results.items()):
            shown = [(p["leaves"], p[key]) for p in points if p[key] is not None]
            script += block(f"d{i}", shown)
            plots.append(f"$d{i} with linespoints pt {5 + 2 * i} lw 2 lc rgb '{COLORS[i + 1]}' title '{name}'")
        script += "plot " + ", ".join(plots) + "\n"
    gnuplot(ROOT / "docs/images/scale.svg", script + "unset multiplot\n", (1200, 420))


def main():
    parser = argparse.ArgumentParser(prog="scripts/scale", description=__doc__)
    parser.add_argument("--most", type=float, default=1e8, help="leaves of the largest canopy")
    parser.add_argument("--no-docs", action="store_true", help="print the figures, write no page")
    options = parser.parse_args()
    base = measure(one_level, 1)
    results = {}
    for name, make, least in (("one level", one_level, 1e3), ("two levels", two_levels, 4e4)):
        results[name] = []
        for leaves in SIZES:
            if not least <= leaves <= options.most:
                continue
            point = measure(make, leaves)
            # Of small canopies it is lost in what the program has anyway.
            point["bytes"] = (point["memory"] - base["memory"]) / leaves if leaves >= 1e5 else None
            point["with_file"] = (point["mapped"] - base["mapped"]) / leaves if leaves >= 1e5 else None
            results[name].append(point)
            print(name, point, flush=True)
    if options.no_docs:
        return
    draw(results)
    shown = lambda value: "" if value is None else f"{value:.0f}"
    body = [[name, thousands(int(p["leaves"])), f"{p['load']:.2f} s", f"{p['memory'] / 1e9:.2f} GB", shown(p["bytes"]),
             shown(p["with_file"]), f"{p['us']:.1f} µs"] for name, points in results.items() for p in points]
    head = ["", "leaves", "load", "memory", "bytes a leaf", "with the file", "path"]
    rays = results["one level"][-1]["rays"]
    page = PAGE.format(machine=machine(), lai=LAI, radius=RADIUS, height=HEIGHT, row=ROW_BYTES, plant=thousands(PLANT),
                       rays=rays, table=table(head, body))
    (ROOT / "docs/scale.md").write_text(page, encoding="utf-8")


if __name__ == "__main__":
    main()
