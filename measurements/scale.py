"""Large canopies: load time, memory and CPU time of 1,000 to 100,000,000 leaves (section "scale" of docs/performance.md)

Takes about 10 minutes on two cores, 10 GB of disk and 24 GB of memory for the largest canopy.
  --most N    leaves of the largest canopy; 1e7 leaves out the largest
  --no-docs   prints the figures only
  --quick     up to 100,000 leaves, into build/scale_report
"""

import json
import math
import os
import pathlib
import subprocess
import tempfile
import time

import pandas

from .shared import charts
from .shared.tools import FROND, arguments, machine, program, table, write_section

LAI, RADIUS, HEIGHT = 3, 0.05, 2
SIZES = [1e3, 1e4, 1e5, 1e6, 1e7, 1e8]
PLANT = 10_000  # leaves of a plot, for two levels
PIXELS, SAMPLES = 64, 256

SCENE = """Option "float period" [{side} {side}]
Camera "distant" "float zenith" [40] "float azimuth" [30] "float target" [0 {side} 0 {side} {top}]
Film "rgb" "integer xresolution" 1 "integer yresolution" {pixels}
PixelFilter "box"
Sampler "lattice" "integer pixelsamples" {samples}
Integrator "path" "integer maxdepth" 64 "integer scatteredrays" 1
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
    """Adjacent plots of PLANT leaves, of four kinds."""
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
    """Load time, peak memory and CPU time per path of a render of a canopy."""
    with tempfile.TemporaryDirectory(prefix="frond_scale.", dir=os.environ.get("TMPDIR")) as name:
        folder = pathlib.Path(name)
        world = make(folder, leaves)
        scene = folder / "scene.pbrt"
        scene.write_text(SCENE.format(side=side_of(leaves), top=HEIGHT + RADIUS, pixels=PIXELS, samples=SAMPLES, world=world))
        words = [str(FROND), "render", str(scene), "-o", str(folder / "out.exr"), "--json", "-", "-q", "--wavelengths",
                 "bands,wavelengths=800"]
        with subprocess.Popen(words, stdout=subprocess.PIPE, text=True) as render:
            peak = 0
            while render.poll() is None:
                peak = max(peak, private_memory(render.pid))
                time.sleep(0.02)
            text = render.stdout.read()
        if render.returncode != 0:
            raise SystemExit(f"{leaves:g} leaves: frond ended with {render.returncode}")
        result = json.loads(text)
    return {"leaves": leaves, "load": result["load_seconds"], "us": result["cpu_us_per_path"],
            "rays": result["rays_per_path"], "memory": peak}


def private_memory(pid):
    """Memory of a process in bytes, without mapped files; 0 if it has ended."""
    try:
        status = pathlib.Path(f"/proc/{pid}/status").read_text(encoding="utf-8")
    except (FileNotFoundError, ProcessLookupError):
        return 0
    for line in status.splitlines():
        field, _, value = line.partition(":")
        if field == "RssAnon":
            return int(value.split()[0]) * 1024
    return 0


SECTION = """### Canopies of up to {most} leaves

{machine}. The paths of the largest canopy take {rays:.1f} rays each.

{table}
![Load time, memory per leaf and CPU time per path against the number of leaves](images/scale.svg)
"""


def draw(path, points):
    of, [row] = charts.figure(1200, 440, 1, 3)
    shown = (("load time, s", "load"), ("private bytes per leaf", "bytes"), ("CPU time per path, µs", "us"))
    for panel, (title, key) in zip(row, shown):
        for color, (name, of_kind) in zip(charts.COLORS[1:], points.groupby("kind", sort=False)):
            panel.plot(of_kind.leaves, of_kind[key], "o-", color=color, label=name)
        panel.set(xlabel="leaves", ylabel=title, xscale="log", yscale="log" if key == "load" else "linear", xlim=(7e2, 1.4e8))
        if key != "load":
            panel.set_ylim(bottom=0)
    charts.legend(of, row[0], 2)
    charts.save(of, path)


def main():
    options = arguments("scale", ("--most", dict(type=float, help="number of leaves of the largest canopy; default: 1e8")),
                        ("--no-docs", dict(action="store_true", help="print the figures and write no page")))
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
    # In small canopies the memory of leaves is negligible beside that of the program.
    large = points.leaves >= 1e5
    points["bytes"] = ((points.memory - base["memory"]) / points.leaves).where(large)
    draw(options.docs / "images" / "scale.svg", points)
    shown = lambda value: "" if math.isnan(value) else f"{value:.0f}"
    body = [[p.kind, f"{int(p.leaves):,}", f"{p.load:.2f} s", f"{p.memory / 1e9:.2f} GB", shown(p.bytes),
             f"{p.us:.1f} µs"] for p in points.itertuples()]
    head = ["", "leaves", "load", "memory", "bytes per leaf", "path"]
    rays = points[points.kind == "one level"].rays.iloc[-1]
    text = SECTION.format(most=f"{int(points.leaves.max()):,}", machine=machine(), rays=rays, table=table(head, body))
    write_section(options.docs / "performance.md", "scale", text)


if __name__ == "__main__":
    main()
