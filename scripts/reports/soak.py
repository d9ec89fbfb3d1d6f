"""Soak in docs/reliability.md: random scenes and jobs in one process for hours. Memory, open files, finite numbers, equal bits,
means against references.

A process with the module frond renders scene after scene; this one watches it. When it dies, the scene is kept as a finding, and
another process goes on with the next scene."""

import argparse
import collections
import csv
import ctypes
import gc
import json
import logging
import math
import os
import pathlib
import random
import re
import shutil
import subprocess
import sys
import time

import numpy
import scipy.stats

from tools import ROOT, arguments, machine, table, write_section

FOLDER = ROOT / "build" / "soak_report"
INPUTS = FOLDER / "inputs"
NEGLIGIBLE = 20  # MB per hour
FALSE_ALARM = 1e-6
BLOCKS = 20
REPEAT = 5  # every so many scenes one is rendered again
JOB = 20  # every so many scenes another job is run
REFERENCES, SECONDS_OF_CHECKS = 40, 120
LONGEST = 300  # seconds of one scene
DIES = 20  # crashes after which the soak ends

# Values of parameters by name, where the range of frond describe is too wide for small and fast scenes: nine times of ten.
BOUNDS = {"innerradius": (0, 0.2), "height": (-1, 1), "scale": (0.1, 3), "power": (1, 300), "illuminance": (1, 300), "coneangle": (10, 90), "fov": (20, 100),
          "lensradius": (0, 0.1), "focaldistance": (1, 6), "thickness": (1e-4, 4e-4), "chlorophylla": (0, 10), "zmin": (-1, 0),
          "zmax": (0, 1), "interface.eta": (1.01, 2.5), "conductor.eta": (0.1, 4), "conductor.k": (0, 8), "eta": (1.01, 2.5), "k": (0, 8),
          "uscale": (-5, 5), "vscale": (-5, 5), "displacement": (0, 0.01), "lambdamin": (360, 500), "lambdamax": (600, 830),
          "iso": (50, 400), "exposuretime": (0.1, 2), "whitebalance": (3000, 9000), "maxcomponentvalue": (0.1, 100),
          "maxanisotropy": (1, 32), "cuticleaspect": (1, 20), "distance": (0, 10), "zenith": (-80, 80), "conedeltaangle": (0, 9)}
# Always, for the time that a scene takes.
LIMITS = {"maxdepth": (0, 20), "nsamples": (1, 3), "levels": (0, 3), "octaves": (0, 16), "tablerays": (1, 2000), "tablestep": (2, 90),
          "tolerance": (5e-3, 0.1), "xradius": (0.1, 4), "yradius": (0.1, 4), "sigma": (0.1, 3), "tau": (0.5, 6), "step": (40, 100),
          "pixelsamples": (1, 16), "xresolution": (2, 20), "yresolution": (2, 20), "maxrms": (0.005, 1),
          "epidermisaspect": (1, 15), "spongyaspect": (1, 15), "palisadeaspect": (1, 15),
          "radius": (0.01, 4), "width": (0, 0.5), "width0": (0, 0.5), "width1": (0, 0.5)}
LEFT_OUT = {"S", "faceIndices", "emissionfilename", "splitdepth", "scheme", "cropwindow", "pixelbounds", "screenwindow", "frameaspectratio",
            "shutteropen", "shutterclose", "film sensor", "portal", "pigmentconcentrations", "diagonal", "savefp16"}
RARE = {"reflectance", "power", "illuminance", "cutoff", "zmin", "zmax", "tablefile", "light filename", "area light filename"}  # exclude others, or have no effect
CHEMISTRY = {"thickness", "chlorophylla", "chlorophyllb", "carotenoids", "protein", "cellulose", "lignin"}
ALWAYS = {"xresolution", "yresolution", "pixelsamples", "maxdepth", "xradius", "yradius", "nsamples", "tolerance", "levels", "tablerays", "tablestep"}
SQUARE = 'Shape "bilinearmesh" "point3 P" [ -3 -3 -1 3 -3 -1 -3 3 -1 3 3 -1 ]'

Param = collections.namedtuple("Param", "name types default low high choices required")


def plugins(markdown):
    """{kind: {name: [Param]}} of what `frond describe --markdown` prints."""
    found, params = collections.defaultdict(dict), None
    for line in markdown.splitlines():
        if head := re.fullmatch(r"## (.+) `(\w+)`", line):
            params = found[head[1]][head[2]] = []
        elif params is not None and line.startswith("| `"):
            cells = [cell.strip().replace("\\|", "|") for cell in re.split(r"(?<!\\)\|", line)[1:-1]]
            types, reach = cells[1].split(" | "), cells[4]
            ends = re.fullmatch(r"(?:from )?(\S+)(?: to (\S+))?", reach) if types != ["string"] else None
            low, high = (float(end) if end else None for end in ends.groups()) if ends and reach else (None, None)
            choices = reach.split(" | ") if types == ["string"] and reach else []
            params.append(Param(cells[0].strip("`"), types, cells[2], low, high, choices, cells[2] == "required"))
    return found


class Scenes:
    """Random scenes. `used` counts the plug-ins of the last one."""

    def __init__(self, kinds):
        self.kinds = kinds

    def begin(self, number, seed):
        self.random, self.used, self.names = random.Random(f"{seed}:{number}"), set(), {"float": [], "spectrum": []}

    def pick(self, kind, *names):
        name = self.random.choice(names or sorted(self.kinds[kind]))
        return name, self.plugin(kind, name)

    def number(self, param):
        r, integer = self.random, param.types[0] == "integer"
        low, high = param.low, param.high
        if param.name == "xresolution" and "camera distant" in self.used:
            return "1"
        if param.name in LIMITS:
            low, high = LIMITS[param.name]
        elif param.name in BOUNDS and (r.random() < 0.9 or low is None):
            low, high = BOUNDS[param.name]
        if low is None:
            value = r.gauss(0, 1)
        elif high is None:
            value = low + r.choice((0, 0.3 * r.random(), 10 ** r.uniform(-3, 1)))
        elif low > 0 and high > 100 * low and r.random() < 0.8:
            value = math.exp(r.uniform(math.log(low), math.log(high)))
        else:
            value = r.choice((low, high, *(r.uniform(low, high) for _ in range(18))))
        return str(round(value)) if integer else f"{value:.6g}"

    def vector(self, scale=1.0):
        return " ".join(f"{self.random.gauss(0, scale):.4g}" for _ in range(3))

    def share(self):
        return self.random.choice((0, 1, *(round(self.random.random(), 4) for _ in range(8))))

    def color(self, kind, param):
        """A parameter of rgb, spectrum or blackbody."""
        r, type_ = self.random, self.random.choice([t for t in param.types if t in ("rgb", "spectrum", "blackbody")])
        if type_ == "blackbody":
            return f'"blackbody {param.name}" {r.uniform(2000, 9000):.0f}'
        if type_ == "rgb":
            return f'"rgb {param.name}" [ {self.share()} {self.share()} {self.share()} ]'
        if "light" in kind:
            return f'"spectrum {param.name}" "stdillum-{r.choice(("A", "D50", "D65", "E", "F7"))}"'
        if param.name.split(".")[-1] in ("eta", "k") and r.random() < 0.5:
            metal = r.choice(("Ag", "Al", "Au", "Cu", "CuZn", "MgO", "TiO2"))
            last = param.name.split(".")[-1]
            is_metal = last == "k" or "conductor" in param.name
            return f'"spectrum {param.name}" "{f"metal-{metal}-{last}" if is_metal else r.choice(("glass-BK7", "glass-F11"))}"'
        low = 1.05 if param.name.endswith("eta") else 0
        return f'"spectrum {param.name}" [ 300 {low + self.share()} 550 {low + self.share()} 2500 {low + self.share()} ]'

    def special(self, kind, name, param):
        """Text of a parameter whose values the ranges do not tell; None for all others, "" to leave it out."""
        r, key = self.random, param.name
        image = {"plymesh": "mesh.ply", "instances": "leaves.npy", "imagemap": r.choice(("image.exr", "image.png", "wide.exr")),
                 "infinite": "image.exr", "goniometric": "image.exr", "projection": "wide.exr", "diffuse": "wide.exr"}
        strings = {"object": "object", "column": "chlorophylla", "normalmap": "image.png",
                   "encoding": r.choice(("sRGB", "linear", "gamma 2.2")), "responses": "response.spd",
                   "tablefile": "leaf.csv" if name == "leaf_simplified" else "modes.txt"}
        if key == "filename":
            return f'"string filename" "{image[name]}"' if name in image else ""
        if key in strings:
            return f'"string {key}" "{strings[key]}"' if param.required or r.random() < 0.3 else ""
        if key == "pigments":
            return f'"string pigments" "pigment.spd" "float pigmentconcentrations" {self.share()}'
        if key == "materials":
            return '"string materials" [ "first" "second" ]'
        if key in ("from", "to", "dir", "v1", "v2"):
            return f'"{param.types[0]} {key}" [ {self.vector(2)} ]'
        lists = {"range": "0.5 8", "target": "-1 1 -1 1 0.5", "wavelengths": "450 550 650.5"}
        if key in lists:
            return f'"float {key}" [ {lists[key]} ]' if param.required else ""
        return self.geometry(name, key) if kind == "shape" else None

    def geometry(self, name, key):
        """Vertices and what belongs to them."""
        r, four, loop = self.random, name in ("bilinearmesh", "curve"), name == "loopsubdiv"
        if key not in ("P", "N", "uv", "indices", "degree", "basis"):
            return None
        count = 4 if four else 6
        points = [self.vector(0.7) for _ in range(count)]
        if r.random() < 0.1:
            points[1] = points[0]  # degenerate
        octahedron = "0 2 4 2 1 4 1 3 4 3 0 4 2 0 5 1 2 5 3 1 5 0 3 5"
        texts = {"P": f'"point3 P" [ {"1 0 0 -1 0 0 0 1 0 0 -1 0 0 0 1 0 0 -1" if loop else " ".join(points)} ]',
                 "indices": f'"integer indices" [ {octahedron if loop else "0 1 2 3" if four else "0 1 2 3 4 5 1 2 3"} ]',
                 "uv": f'"point2 uv" [ {" ".join(f"{r.random():.3f}" for _ in range(2 * count))} ]',
                 "N": f'"normal N" [ {" ".join(self.vector() for _ in range(2 if name == "curve" else count))} ]'}
        return texts.get(key, "") if key in ("P", "indices") or r.random() < 0.5 else ""

    def plugin(self, kind, name):
        self.used.add(f"{kind} {name}")
        words = [self.parameter(kind, name, param) for param in self.kinds[kind][name]]
        return " ".join(word for word in words if word)

    def parameter(self, kind, name, param):
        r, key = self.random, param.name
        given = param.required or key in ALWAYS or (key in ("P", "indices") and kind == "shape")
        if key in LEFT_OUT or f"{kind} {key}" in LEFT_OUT or not (given or r.random() < (0.05 if {key, f"{kind} {key}"} & RARE else 0.35)):
            return ""
        text = self.special(kind, name, param)
        if text is not None:
            return text
        of = "spectrum" if {"rgb", "spectrum"} & set(param.types) else "float"
        if "texture" in param.types and self.names[of] and r.random() < 0.4:
            narrow = of == "float" and param.high is not None and kind == "material"
            if not narrow or name in ("abm", "mix") or (name in ("leaf_simplified", "leaf_solved") and key in CHEMISTRY):
                return f'"texture {key}" "{("thin" if param.high < 0.1 else "share") if narrow else r.choice(self.names[of])}"'
        if of == "spectrum" and ("float" not in param.types or r.random() < 0.5):
            return self.color(kind, param)
        if param.types[0] == "bool":
            return f'"bool {key}" {r.choice(("true", "false"))}'
        if param.types[0] == "string":
            return f'"string {key}" "{r.choice(param.choices)}"' if param.choices else ""
        return f'"{"integer" if param.types[0] == "integer" else "float"} {key}" {self.number(param)}'

    def words(self, kind):
        """A plug-in as on the command line: name,parameter=value."""
        name, text = self.pick(kind)
        if name == "hero" and self.random.random() < 0.6:  # its leaf tables have many wavelengths, and take long
            return "smpte"
        values = re.findall(r'"\w+ ([\w.]+)" (?:\[ ([^\]]*) \]|"([^"]*)"|(\S+))', text)
        return ",".join([name, *(f"{key}={(a or b or c).split(' ')[0]}" for key, a, b, c in values if key not in ("displacement", "normalmap") and " " not in
                                (a or b or c))])

    def scene(self):
        """Text of a scene, and keywords of frond.loads."""
        r, lines = self.random, []
        def add(directive, kind, *names):
            name, text = self.pick(kind, *names)
            lines.append(f'{directive} "{name}" {text}')
            return name
        periodic = r.random() < 0.1
        if periodic:
            lines.append('Option "float period" [ 2 2 ]')
        lines.append(f"LookAt 0 0 4  {self.vector(0.2)}  0 1 0")
        camera = add("Camera", "camera")
        add("Film", "film"), add("Sampler", "sampler"), add("Integrator", "integrator")
        if camera == "distant":
            lines.append('PixelFilter "box"')
        else:
            add("PixelFilter", "pixel filter")
        lines.append("WorldBegin")
        for _ in range(r.randint(1, 3)):
            lines.append(f"AttributeBegin Translate {self.vector()} Rotate {r.uniform(0, 360):.1f} {self.vector()}")
            add("LightSource", "light", *(("infinite", "distant") if periodic else ()))
            lines.append("AttributeEnd")
        lines += [f'Texture "{name}" "float" "checkerboard" "float tex1" {a} "float tex2" {b}' for name, a, b in
                  (("thin", 1e-4, 3e-4), ("share", 0.1, 0.9))]
        for i in range(r.randint(0, 5)):
            of = r.choice(("float", "spectrum"))
            name, text = self.pick(f"{of} texture")
            lines.append(f'Texture "t{i}" "{of}" "{name}" {text}')
            self.names[of].append(f"t{i}")
        for name in ("first", "second"):
            kind = r.choice(sorted(set(self.kinds["material"]) - {"mix"}))
            lines.append(f'MakeNamedMaterial "{name}" "string type" "{kind}" {self.plugin("material", kind)}')
        lines.append(f'ObjectBegin "object" NamedMaterial "first" Shape "disk" "float radius" {r.uniform(0.1, 1):.3f} ObjectEnd')
        for _ in range(r.randint(1, 4)):
            lines.append(f"AttributeBegin Translate {self.vector(0.5)} Rotate {r.uniform(0, 360):.1f} {self.vector()}")
            if r.random() < 0.2:
                lines.append("ReverseOrientation")
            add("Material", "material")
            shape = r.choice(sorted(self.kinds["shape"]))
            if r.random() < 0.3 and not periodic and shape not in ("curve", "instances"):
                add("AreaLightSource", "area light")
            add("Shape", "shape", shape)
            lines.append("AttributeEnd")
        if "float texture instance" in self.used:
            lines.append('NamedMaterial "first" Shape "instances" "string object" "object" "string filename" "leaves.npy"')
        lines += ['Material "diffuse"', SQUARE]
        more = {"wavelengths": self.words("wavelengths"), "seed": r.randrange(1 << 31)}
        if r.random() < 0.3:
            more["channels"] = ",".join(r.sample(["albedo", "normal", "depth", "position", "material", "instance", "samples"], 2))
        return "\n".join(lines) + "\n", more


def make_inputs(frond):
    """Files that scenes name."""
    INPUTS.mkdir(parents=True, exist_ok=True)
    light = 'LightSource "infinite" "rgb L" [ .7 .6 .5 ]\nMaterial "diffuse" "rgb reflectance" [ .4 .5 .3 ]\nShape "sphere"\n'
    for name, size in (("image.exr", (32, 32)), ("image.png", (32, 32)), ("wide.exr", (24, 10))):
        film = 'LookAt 0 0 3 0 0 0 0 1 0\nCamera "perspective"\nFilm "rgb" "integer xresolution" {} "integer yresolution" {}\nWorldBegin\n'
        frond.loads(film.format(*size) + light).render(4).save(INPUTS / name)
    for name, text in (("pigment.spd", "300 0\n500 20\n2500 0\n"), ("response.spd", "400 0\n550 1\n700 0\n")):
        (INPUTS / name).write_text(text, encoding="utf-8")
    triangle = ["ply", "format ascii 1.0", "element vertex 3", *(f"property float {axis}" for axis in "xyz"), "element face 1",
                "property list uchar int vertex_indices", "end_header", "-1 0 0", "1 0 0", "0 1 0", "3 0 1 2", ""]
    (INPUTS / "mesh.ply").write_text("\n".join(triangle), encoding="utf-8")
    frond.canopy(INPUTS / "leaves.npy", count=30, size=[2, 2], column=["chlorophylla=2:5"])
    frond.run("table", specimen="soybean", wavelengths="360:830:10", output=INPUTS / "leaf.csv")
    frond.run("table", leaf=["leaf_solved"], wavelengths="450,550,650", output=INPUTS / "modes.txt")


BEGIN = 'LookAt 0 0 4 0 0 0 0 1 0\nCamera "perspective" "float fov" 30\nFilm "rgb" "integer xresolution" 12 "integer yresolution" 12\n'
EVEN = BEGIN + 'WorldBegin\nLightSource "infinite" "spectrum L" "stdillum-D65"\n'
FIXED = {
    "white furnace": EVEN + 'Material "diffuse" "rgb reflectance" [ 1 1 1 ]\nShape "sphere"\n',
    "leaf_solved in even light": EVEN + 'Material "leaf_solved" "string specimen" "soybean"\nShape "sphere"\n',
    "abm and a small light": BEGIN + 'WorldBegin\nLightSource "point" "point3 from" [ 2 2 3 ]\n'
                                     'Material "abm" "string specimen" "maize"\nShape "sphere"\n' + SQUARE + "\n",
    "rough metal, image, many lights": BEGIN + 'WorldBegin\nLightSource "infinite" "string filename" "image.exr"\n' + "".join(
        f'LightSource "point" "point3 from" [ {i} 2 3 ]\n' for i in range(-3, 4)) +
        'Material "conductor" "float roughness" 0.2\nShape "sphere"\nMaterial "coateddiffuse"\n' + SQUARE + "\n",
}


class Drift:
    """Means of fixed scenes, each with another seed, against those of the beginning."""

    def __init__(self, frond, session):
        self.frond, self.session, self.seed = frond, session, 0
        self.reference = {name: [self.mean(name) for _ in range(REFERENCES)] for name in FIXED}
        self.found = {name: [] for name in FIXED}

    def mean(self, name):
        self.seed += 1
        image = self.frond.loads(FIXED[name], INPUTS, session=self.session, seed=self.seed, wavelengths="smpte").render(16)
        return float(image["G"].mean(dtype=float))

    def check(self):
        for name, values in self.reference.items():
            spread = max(numpy.std(values, ddof=1), 1e-7 * abs(numpy.mean(values)))
            self.found[name].append((self.mean(name) - numpy.mean(values)) / spread)


class Worker:
    """The process that renders."""

    def __init__(self, options):
        import frond
        self.frond, self.options, self.begin, self.number = frond, options, time.monotonic(), options.first
        self.result = {"scenes": 0, "jobs": 0, "refused": {}, "findings": [], "uses": {}, "repeated": 0, "slowest": 0.0, "all_used": None}
        self.sessions = [frond.Session(threads=2, cache=False), frond.Session(threads=1, cache=FOLDER / "cache")]
        make_inputs(frond)
        os.chdir(INPUTS)
        self.scenes = Scenes(plugins(frond.describe(markdown=True).text))
        self.wanted = {f"{kind} {name}" for kind, names in self.scenes.kinds.items() for name in names}
        self.log = (FOLDER / f"log-{options.first}.csv").open("w", encoding="utf-8", buffering=1)
        self.log.write("seconds,scenes,rss_kb,descriptors,threads\n")
        logging.getLogger("frond").setLevel(logging.ERROR)
        self.trim = ctypes.CDLL(None).malloc_trim

    def finding(self, what, text=""):
        path = FOLDER / f"finding-{self.number}.pbrt"
        path.write_text(f"# {what}\n{text}", encoding="utf-8")
        self.result["findings"].append(f"{what}: {path.relative_to(ROOT)}")
        print(f"scene {self.number}: {what}", flush=True)
        self.save()

    def save(self):
        (FOLDER / f"result-{self.options.first}.json").write_text(json.dumps(self.result, indent=1), encoding="utf-8")

    def measure(self):
        gc.collect()
        self.trim(0)
        status = pathlib.Path("/proc/self/status").read_text(encoding="utf-8")
        rss, threads = (re.search(rf"^{key}:\s+(\d+)", status, re.M)[1] for key in ("VmRSS", "Threads"))
        descriptors = len(os.listdir("/proc/self/fd"))
        self.log.write(f"{time.monotonic() - self.begin:.2f},{self.number - self.options.first},{rss},{descriptors},{threads}\n")

    def attempt(self, what, text, function):
        """What the function returns; None if it is refused. Any other error is a finding."""
        (FOLDER / "last.pbrt").write_text(text, encoding="utf-8")
        start = time.monotonic()
        try:
            return function()
        except self.frond.InputError as error:
            message = re.sub(r"[-\d.e+]*\d", "N", re.sub(r'"[^"]*"', '"..."', str(error).split("\n")[0].split(": ", 1)[-1]))
            self.result["refused"][message] = self.result["refused"].get(message, 0) + 1
        except Exception as error:  # pylint: disable=broad-except
            self.finding(f"{what}: {type(error).__name__}: {error}", text)
        finally:
            self.result["slowest"] = max(self.result["slowest"], time.monotonic() - start)
            if time.monotonic() - start > 10:
                (FOLDER / f"slow-{self.number}.pbrt").write_text(text, encoding="utf-8")
        return None

    def render(self):
        self.scenes.begin(self.number, self.options.seed)
        text, more = self.scenes.scene()
        head = f"# scene {self.number} of seed {self.options.seed}: frond.loads(text, folder, **{more})\n"
        session, other = self.sessions[:: self.scenes.random.choice((1, -1))]
        def image_in(session):
            return self.frond.loads(text, INPUTS, session=session, **more).render()
        image = self.attempt("render", head + text, lambda: image_in(session))
        if image is None:
            return
        self.result["scenes"] += 1
        for name in self.scenes.used:
            self.result["uses"][name] = self.result["uses"].get(name, 0) + 1
        if self.result["all_used"] is None and self.wanted <= set(self.result["uses"]):
            self.result["all_used"] = time.monotonic() - self.begin
        for channel in image.channels:
            if not numpy.isfinite(image[channel]).all():
                self.finding(f"not finite in {channel}", head + text)
                break
        if self.number % REPEAT == 0:
            again = self.attempt("render again", head + text, lambda: image_in(other))
            self.result["repeated"] += 1
            if again is None or again.array.tobytes() != image.array.tobytes():
                self.finding("other bits when it is rendered again", head + text)

    def job(self):
        """One of the other jobs, at cheap settings; its numbers have to be finite."""
        self.scenes.begin(-self.number - 1, self.options.seed)
        frond, r, session = self.frond, self.scenes.random, self.sessions[0]
        material, leaf = self.scenes.words("material"), f"leaf_solved,thickness={r.uniform(1e-4, 4e-4):.6g}"
        scene = FOLDER / "job.pbrt"
        scene.write_text(EVEN + 'Material "leaf_simplified"\nShape "disk"\n', encoding="utf-8")
        nm = [450, 550, 650]
        jobs = {
            "spectrophotometer": lambda: frond.spectrophotometer(material, nm, rays=1000, session=session),
            "goniophotometer": lambda: frond.goniophotometer(material, nm, rays=1000, patches=(4, 8), session=session)["f"],
            "brf": lambda: frond.brf(scene, nm, zenith="-60:60:30", paths=500, session=session),
            "flux": lambda: frond.flux(scene, nm, paths=1000, session=session),
            "leaf_table": lambda: frond.leaf_table(leaf, nm, tolerance=0.01, session=session)["adaxial_reflected"],
            "fit": lambda: list(frond.fit([450, 550, 650, 800], [0.05, 0.12, 0.06, 0.45], [0.02, 0.1, 0.04, 0.45], like="soybean", session=session).leaf.values()),
            "conform": lambda: self.conform(material),
            "bsdf": lambda: frond.bsdf(material, nm, session=session).f([[0, 0.6, 0.8]], [[0.6, 0, 0.8], [0.6, 0, -0.8]]),
            "check": lambda: frond.check(str(scene), session=session).text and [0],
        }
        name = r.choice(sorted(jobs))
        text = f"# job {name}: material {material}, leaf {leaf}\n"
        found = self.attempt(name, text, jobs[name])
        self.result["jobs"] += 1
        if found is None:
            return
        self.result["uses"][f"job {name}"] = self.result["uses"].get(f"job {name}", 0) + 1
        values = found.select_dtypes("number").to_numpy() if hasattr(found, "select_dtypes") else numpy.asarray(found)
        if numpy.isinf(values).any() or (numpy.isnan(values).any() and not hasattr(found, "select_dtypes")):
            self.finding(f"{name}: not finite", text)

    def conform(self, material):
        laws = self.frond.conform(material, samples=1000, angles="30", session=self.sessions[0], false_alarm_rate=1e-9)
        if not laws["all_hold"]:
            broken = [name for name, law in laws["laws"].items() if law["verdict"] not in ("holds", "not tested")]
            self.finding(f"conform: broken: {broken}", f"# {material}\n")
        return [0]

    def run(self):
        drift = Drift(self.frond, self.sessions[1])
        checked, end = time.monotonic(), self.begin + 3600 * self.options.hours
        every = min(SECONDS_OF_CHECKS, 3600 * self.options.hours / 10)
        while time.monotonic() < end:
            self.render()
            if self.number % JOB == 0:
                self.job()
            self.number += 1
            if self.number % 10 == 0:
                self.measure()
            if time.monotonic() - checked > every:
                drift.check()
                self.result["drift"], checked = drift.found, time.monotonic()
                self.save()
        self.result["seconds"] = time.monotonic() - self.begin
        self.save()


def slope(seconds, megabytes):
    """Slope in MB per hour with the half width of its 95 % interval: a line through averages of blocks of time, whose residuals'
    correlation from block to block widens the interval."""
    edges = numpy.linspace(seconds[0], seconds[-1], BLOCKS + 1)
    block = numpy.clip(numpy.searchsorted(edges, seconds, "right") - 1, 0, BLOCKS - 1)
    means = [(seconds[block == i].mean() / 3600, megabytes[block == i].mean()) for i in range(BLOCKS) if (block == i).any()]
    if len(means) < 5:
        return math.nan, math.inf
    hours, level = numpy.array(means).T
    line = scipy.stats.linregress(hours, level)
    rest = level - line.intercept - line.slope * hours
    power = (rest**2).sum()
    correlation = min(max((rest[1:] * rest[:-1]).sum() / power if power > 0 else 0, 0), 0.9)
    wide = scipy.stats.t.ppf(0.975, len(means) - 2) * math.sqrt((1 + correlation) / (1 - correlation))
    return line.slope, wide * line.stderr


def drift_rows(found):
    """A row for each scene, and alarms: of single means by Student's t, and of the mean over all."""
    rows, alarms = [], []
    count = sum(map(len, found.values())) + len(found)
    for name, z in found.items():
        if not z:
            continue
        scale = math.sqrt(1 + 1 / REFERENCES)
        mean = float(numpy.mean(z)) / math.sqrt(1 / len(z) + 1 / REFERENCES)
        least = min(2 * scipy.stats.t.sf(v, REFERENCES - 1) for v in (*(abs(v) / scale for v in z), abs(mean)))
        rows.append([name, len(z), f"{max(map(abs, z)) / scale:.2f}", f"{mean:+.2f}", f"{least:.2g}"])
        if least < FALSE_ALARM / count:
            alarms.append(f"drift of {name}: probability {least:.2g}")
    return rows, alarms


SECTION = """## Soak

Measured on {machine}. `scripts/soak --hours {hours:g} --seed {seed}` rendered random scenes in one process: plug-ins and parameters
are drawn from the ranges that `frond describe` states, films have up to 20 × 20 pixels. Every {JOB} scenes another job runs (BRF,
flux, instruments, leaf tables, fits, tests of laws). Every {REPEAT} scenes the scene is rendered again with another number of threads.

{summary}
Scenes that were refused: their parameters exclude each other, and the error is an `InputError`.

**Memory** is the resident memory of the process after free memory has been returned to the system. The slope is that of a line
through the averages of {BLOCKS} blocks of time, after the warm-up: the first fifth of the time, and until each plug-in has been
used. The residuals' correlation from block to block widens the interval. A slope counts as a leak if its 95 % interval is above
{NEGLIGIBLE} MB per hour.

**Drift.** Four fixed scenes are rendered every {every:.0f} s, each time with another seed. Their mean is compared with that of
{REFERENCES} renders at the beginning, in units of its standard deviation. Last column: the smallest probability of such a
difference, of a single mean or of the mean of all, if nothing drifts. An alarm is given below {FALSE_ALARM:g} divided by the
number of comparisons: this is the false-alarm rate of one run of the script, for normally distributed means.

{drift}
{findings}
"""


def report(options, parts, crashes):
    """Writes the section; returns the findings."""
    results = [json.loads(path.read_text(encoding="utf-8")) for path in parts if path.exists()]
    findings = crashes + [finding for result in results for finding in result["findings"]]
    logs = [list(csv.DictReader(path.with_name(path.name.replace("result", "log")).with_suffix(".csv").open(encoding="utf-8")))
            for path in parts if path.exists()]
    log, result = max(zip(logs, results), key=lambda pair: len(pair[0]))
    seconds, rss, descriptors, threads = (numpy.array([float(row[key] or 0) for row in log if None not in row.values()]) for key in
                                          ("seconds", "rss_kb", "descriptors", "threads"))
    warm = max(0.2 * seconds[-1], min(result["all_used"] or 0, 0.5 * seconds[-1]))
    late = seconds >= warm
    grows, half = slope(seconds[late], rss[late] / 1024)
    if grows - half > NEGLIGIBLE:
        findings.append(f"memory grows by {grows:.1f} ± {half:.1f} MB per hour")
    for name, values in (("open files", descriptors[late]), ("threads", threads[late])):
        fifth = max(1, len(values) // 5)
        if values[-fifth:].min() > values[:fifth].max():
            findings.append(f"{name}: from {values[:fifth].max():.0f} to {values[-fifth:].min():.0f}")
    drift, alarms = drift_rows(result.get("drift", {}))
    findings += alarms
    uses, refused = collections.Counter(), collections.Counter()
    for one in results:
        uses.update(one["uses"])
        refused.update(one["refused"])
    total = {key: sum(one[key] for one in results) for key in ("scenes", "jobs", "repeated")}
    least, count = min((use for use in uses.items() if not use[0].startswith("job")), key=lambda use: use[1], default=("none", 0))
    is_of = [sum(text in finding for finding in findings) for text in ("not finite", "other bits")]
    summary = table(["", ""], [
        ["scenes rendered", total["scenes"]], ["refused", sum(refused.values())], ["other jobs", total["jobs"]],
        ["uses of plug-ins", sum(uses.values())], ["least used", f"{least}, {count} times"],
        ["images with numbers that are not finite", is_of[0]], ["scenes rendered again, with other bits", f"{total['repeated']}, {is_of[1]}"],
        ["crashes", len(crashes)], ["longest scene or job", f"{max(one['slowest'] for one in results):.1f} s"],
        ["memory after warm-up, median", f"{numpy.median(rss[late]) / 1024:.0f} MB"],
        ["slope of memory, MB per hour", f"{grows:.1f} ± {half:.1f}"],
        ["open files, threads", f"{numpy.median(descriptors[late]):.0f}, {numpy.median(threads[late]):.0f}"]])
    print(summary, *(f"{number} times refused: {message}" for message, number in refused.most_common(40)), sep="\n")
    listed = "\n".join(f"- {finding}" for finding in findings) if findings else "No finding."
    every = min(SECONDS_OF_CHECKS, 360 * options.hours)
    heads = ["scene", "renders", "largest difference", "difference of the mean", "probability"]
    text = SECTION.format(machine=machine(), JOB=JOB, REPEAT=REPEAT, BLOCKS=BLOCKS, NEGLIGIBLE=NEGLIGIBLE, REFERENCES=REFERENCES,
                          FALSE_ALARM=FALSE_ALARM, hours=options.hours, seed=options.seed, summary=summary, every=every,
                          drift=table(heads, drift), findings=listed)
    write_section(options.docs / "reliability.md", "soak", text)
    return findings


def watch(words):
    """Exit code of the process that renders; -9 for one scene that takes longer than LONGEST."""
    last = FOLDER / "last.pbrt"
    last.write_text("", encoding="utf-8")
    with subprocess.Popen(words) as process:
        while process.poll() is None:
            time.sleep(1)
            if time.time() - last.stat().st_mtime > LONGEST:
                process.kill()
    return process.returncode


def supervise(options):
    """Starts the process that renders, and again after a crash."""
    shutil.rmtree(FOLDER, ignore_errors=True)
    FOLDER.mkdir(parents=True)
    first, crashes, parts, end = 0, [], [], time.monotonic() + 3600 * options.hours
    while time.monotonic() < end and len(crashes) < DIES:
        hours = (end - time.monotonic()) / 3600
        words = [sys.executable, "-B", "-m", "soak", "--worker", "--hours", str(hours), "--seed", str(options.seed), "--first", str(first)]
        code = watch(words)
        parts.append(FOLDER / f"result-{first}.json")
        if code == 0:
            break
        if code > 0:
            sys.exit("the process that renders has failed")
        scene = (FOLDER / "last.pbrt").read_text(encoding="utf-8")
        at = re.match(r"# scene (\d+)", scene)
        path = FOLDER / f"crash-{len(crashes)}.pbrt"
        path.write_text(scene, encoding="utf-8")
        crashes.append(f"the process ended with {code}{f' after {LONGEST} s' if code == -9 else ''}: {path.relative_to(ROOT)}")
        print(crashes[-1], flush=True)
        first = (int(at[1]) if at else first) + 1
    findings = report(options, parts, crashes)
    print(*findings, sep="\n")
    sys.exit(1 if findings else 0)


def main():
    options = arguments("soak", ("--hours", {"type": float}), ("--seed", {"type": int, "default": 1}),
                        ("--worker", {"action": "store_true", "help": argparse.SUPPRESS}),
                        ("--first", {"type": int, "default": 0, "help": argparse.SUPPRESS}))
    options.hours = options.hours or (1 / 30 if options.quick else 1)
    if options.worker:
        Worker(options).run()
    else:
        supervise(options)


if __name__ == "__main__":
    main()
