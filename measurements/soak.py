"""Soak: random scenes of all plug-ins in one process for hours (section "soak" of docs/reliability.md)

Checks memory, open files, numbers that are not finite, images that differ when they are rendered again, and drift of means. A
process renders scene after scene and writes log.jsonl; this one watches it. When it dies, another continues with the next scene.
The log and the scenes of all findings are in build/soak_report. Exit code 1 if there is a finding. Ctrl-C or SIGTERM end it with
the table of what has run.
  --hours H   default: 1
  --seed N    default: 1
  --scene N   renders scene N of the seed alone
  --quick     two minutes, and the section into build/soak_report
"""

import collections
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
import signal
import subprocess
import sys
import time

import numpy
import scipy.stats

from .shared.tools import ROOT, arguments, machine, table, write_section

FOLDER = ROOT / "build" / "soak_report"
INPUTS, LAST, LOG, FIRST = FOLDER / "inputs", FOLDER / "last.pbrt", FOLDER / "log.jsonl", FOLDER / "references.json"
RATE = 1e-4  # false alarms of a test of one run
REPEAT, JOB, MEASURE = 5, 20, 10  # every so many scenes: one is rendered again, another job is run, memory is measured
REFERENCES, CHECK = 40, 120  # renders of each fixed scene at the beginning, seconds between later ones
LONGEST, GRACE = 120, 60  # seconds after which a scene is stopped, and until it has to have stopped
DIES, WARM, BLOCKS, LEAST = 20, 500, 20, 5  # crashes after which the soak ends; scenes before memory counts; blocks of its measurements, and how many each has at least

# Ranges for small and fast scenes, narrower than those of `frond describe`: LIMITS always, BOUNDS nine times of ten.
LIMITS = {"maxdepth": (0, 20), "nsamples": (1, 3), "levels": (0, 3), "octaves": (0, 16), "tablerays": (1, 2000), "tablestep": (2, 90),
          "tolerance": (5e-3, 0.1), "xradius": (0.1, 4), "yradius": (0.1, 4), "sigma": (0.1, 3), "tau": (0.5, 6), "step": (40, 100),
          "pixelsamples": (1, 16), "xresolution": (2, 20), "yresolution": (2, 20), "epidermisaspect": (1, 15), "spongyaspect": (1, 15),
          "palisadeaspect": (1, 15), "radius": (0.01, 4), "width": (0, 0.5), "width0": (0, 0.5), "width1": (0, 0.5)}
BOUNDS = {"innerradius": (0, 0.2), "height": (-1, 1), "scale": (0.1, 3), "power": (1, 300), "illuminance": (1, 300), "fov": (20, 100),
          "coneangle": (10, 90), "conedeltaangle": (0, 9), "lensradius": (0, 0.1), "focaldistance": (1, 6), "thickness": (1e-4, 4e-4),
          "chlorophylla": (0, 10), "zmin": (-1, 0), "zmax": (0, 1), "interface.eta": (1.01, 2.5), "conductor.eta": (0.1, 4), "conductor.k": (0, 8),
          "eta": (1.01, 2.5), "k": (0, 8), "uscale": (-5, 5), "vscale": (-5, 5), "displacement": (0, 0.01), "lambdamin": (360, 500),
          "lambdamax": (600, 830), "iso": (50, 400), "exposuretime": (0.1, 2), "whitebalance": (3000, 9000), "maxcomponentvalue": (0.1, 100),
          "maxanisotropy": (1, 32), "cuticleaspect": (1, 20), "distance": (0, 10), "zenith": (-80, 80)}
ALWAYS = {*LIMITS} - {"octaves", "sigma", "tau", "step", "radius", "width", "width0", "width1", "epidermisaspect", "spongyaspect", "palisadeaspect"}
RARE = {"reflectance", "power", "illuminance", "cutoff", "zmin", "zmax", "tablefile", "light filename", "area light filename"}  # exclude others
NEVER = {"S", "faceIndices", "emissionfilename", "splitdepth", "scheme", "cropwindow", "pixelbounds", "screenwindow", "frameaspectratio",
         "shutteropen", "shutterclose", "film sensor", "film filename", "portal", "pigmentconcentrations", "diagonal", "savefp16", "target"}
CHEMISTRY = {"thickness", "chlorophylla", "chlorophyllb", "carotenoids", "protein", "cellulose", "lignin"}
FILES = {"measured": "metal.bsdf sheet.csv", "leaf_simplified": "leaf.csv", "leaf_solved": "modes.txt", "plymesh": "mesh.ply", "instances": "leaves.npy",
         "imagemap": "image.exr image.png wide.exr", "infinite": "image.exr", "goniometric": "image.exr", "projection": "wide.exr", "diffuse": "wide.exr"}
# Parameters whose values the ranges do not tell.
TEXTS = {"object": '"string object" "object"', "column": '"string column" "chlorophylla"', "normalmap": '"string normalmap" "image.png"',
         "responses": '"string responses" "response.spd"', "encoding": '"string encoding" "gamma 2.2"', "range": '"float range" [ 0.5 8 ]',
         "pigments": '"string pigments" "pigment.spd" "float pigmentconcentrations" 0.5', "wavelengths": '"float wavelengths" [ 450 550 650.5 ]',
         "materials": '"string materials" [ "first" "second" ]', "target": '"float target" [ -1 1 -1 1 0.5 ]'}
SQUARE = 'Shape "bilinearmesh" "point3 P" [ -3 -3 -1 3 -3 -1 -3 3 -1 3 3 -1 ]'
Param = collections.namedtuple("Param", "name types low high choices required")


def plugins(markdown):
    """{kind: {name: [Param]}} of what `frond describe --markdown` prints."""
    found, params = collections.defaultdict(dict), None
    for line in markdown.splitlines():
        if head := re.fullmatch(r"## (.+) `(\w+)`", line):
            params = found[head[1]][head[2]] = []
        elif params is not None and line.startswith("| `"):
            cells = [cell.strip().replace("\\|", "|") for cell in re.split(r"(?<!\\)\|", line)[1:-1]]
            types, reach, string = cells[1].split(" | "), cells[4], cells[1] == "string"
            ends = re.fullmatch(r"(?:from )?(\S+)(?: to (\S+))?", "" if string else reach)
            low, high = (float(end) if end else None for end in ends.groups()) if ends else (None, None)
            params.append(Param(cells[0].strip("`"), types, low, high, reach.split(" | ") if string and reach else [], cells[2] == "required"))
    return found


class Generator:
    """A random scene, or a job. `used` has its plug-ins."""

    def __init__(self, kinds, number, seed):
        self.kinds, self.random, self.used, self.names = kinds, random.Random(f"{seed}:{number}"), set(), {"float": [], "spectrum": []}
        self.share = lambda: self.random.choice((0, 1, *(round(self.random.random(), 4) for _ in range(8))))
        self.vector = lambda scale=1.0: " ".join(f"{self.random.gauss(0, scale):.4g}" for _ in range(3))

    def number(self, param):
        r, low, high = self.random, param.low, param.high
        if param.name in LIMITS:
            low, high = (1, 1) if param.name == "xresolution" and "camera distant" in self.used else LIMITS[param.name]
        elif param.name in BOUNDS and (r.random() < 0.9 or low is None):
            low, high = BOUNDS[param.name]
        value = (r.gauss(0, 1) if low is None else low + r.choice((0, 0.3 * r.random(), 10 ** r.uniform(-3, 1))) if high is None else
                 math.exp(r.uniform(math.log(low), math.log(high))) if low > 0 and high > 100 * low and r.random() < 0.8 else
                 r.choice((low, high, *(r.uniform(low, high) for _ in range(18)))))
        return str(round(value)) if param.types[0] == "integer" else f"{value:.6g}"

    def color(self, kind, param):
        r, last, type_ = self.random, param.name.split(".")[-1], self.random.choice([t for t in param.types if t in ("rgb", "spectrum", "blackbody")])
        metal, low = r.choice(("Ag", "Al", "Au", "Cu", "CuZn", "MgO", "TiO2")), 1.05 if last == "eta" else 0
        named = (f"stdillum-{r.choice(('A', 'D50', 'D65', 'E', 'F7'))}" if "light" in kind else "" if r.random() < 0.5 else
                 f"metal-{metal}-{last}" if param.name in ("k", "conductor.k", "conductor.eta") else "glass-BK7" if last == "eta" else "")
        if type_ != "spectrum":
            return f'"{type_} {param.name}" ' + (f"{r.uniform(2000, 9000):.0f}" if type_ == "blackbody" else f"[ {self.share()} {self.share()} {self.share()} ]")
        return f'"spectrum {param.name}" ' + (f'"{named}"' if named else f"[ 300 {low + self.share()} 550 {low + self.share()} 2500 {low + self.share()} ]")

    def special(self, kind, name, param):
        """Text of a parameter whose values the ranges do not tell, "" to leave it out; None for all others."""
        key = param.name
        if key in ("filename", "tablefile"):
            return f'"string {key}" "{self.random.choice(FILES[name].split())}"' if name in FILES else ""
        if key in TEXTS:
            return TEXTS[key]
        if key in ("from", "to", "dir", "v1", "v2"):
            return f'"{param.types[0]} {key}" [ {self.vector(2)} ]'
        if kind != "shape" or key not in ("P", "N", "uv", "indices", "degree", "basis"):
            return None
        count, loop = 4 if name in ("bilinearmesh", "curve") else 6, name == "loopsubdiv"
        points = ["1 0 0", "-1 0 0", "0 1 0", "0 -1 0", "0 0 1", "0 0 -1"] if loop else [self.vector(0.7) for _ in range(count)]
        points[1] = points[0] if self.random.random() < 0.1 and not loop else points[1]  # degenerate
        indices = "0 2 4 2 1 4 1 3 4 3 0 4 2 0 5 1 2 5 3 1 5 0 3 5" if loop else "0 1 2 3" if count == 4 else "0 1 2 3 4 5 1 2 3"
        return {"P": f'"point3 P" [ {" ".join(points)} ]', "indices": f'"integer indices" [ {indices} ]',
                "uv": f'"point2 uv" [ {" ".join(f"{self.random.random():.3f}" for _ in range(2 * count))} ]',
                "N": f'"normal N" [ {" ".join(self.vector() for _ in range(2 if name == "curve" else count))} ]'}.get(key, "")

    def parameter(self, kind, name, param):
        r, key = self.random, param.name
        given = param.required or key in ALWAYS or (key in ("P", "indices") and kind == "shape")
        likely = 0.05 if {key, f"{kind} {key}"} & RARE else 0.35
        if (not param.required and {key, f"{kind} {key}"} & NEVER) or not (given or r.random() < likely):
            return ""
        if (text := self.special(kind, name, param)) is not None:
            return text
        of = "spectrum" if {"rgb", "spectrum"} & set(param.types) else "float"
        if "texture" in param.types and self.names[of] and r.random() < 0.4:
            narrow = of == "float" and param.high is not None and kind == "material"
            if not narrow or name in ("abm", "mix") or (name in ("leaf_simplified", "leaf_solved") and key in CHEMISTRY):
                return f'"texture {key}" "{("thin" if param.high < 0.1 else "share") if narrow else r.choice(self.names[of])}"'
        if of == "spectrum" and ("float" not in param.types or r.random() < 0.5):
            return self.color(kind, param)
        if param.types[0] in ("bool", "string"):
            choices = ["true", "false"] if param.types[0] == "bool" else [f'"{choice}"' for choice in param.choices]
            return f'"{param.types[0]} {key}" {r.choice(choices)}' if choices else ""
        return f'"{"integer" if param.types[0] == "integer" else "float"} {key}" {self.number(param)}'

    def pick(self, kind, *names):
        """Name of a plug-in, of these or of all of a kind, and its parameters."""
        name = self.random.choice(names or sorted(self.kinds[kind]))
        self.used.add(f"{kind} {name}")
        return name, " ".join(filter(None, (self.parameter(kind, name, param) for param in self.kinds[kind][name])))

    def words(self, kind):
        """A plug-in as on the command line: name,parameter=value."""
        name, text = self.pick(kind)
        if name == "hero" and self.random.random() < 0.6:  # its leaf tables have many wavelengths, and take long
            return "smpte"
        values = re.findall(r'"\w+ ([\w.]+)" (?:"([^" ]*)"|([^\s"\[]+))', text)  # one value, no list
        return ",".join([name, *(f"{key}={string or number}" for key, string, number in values if key not in ("displacement", "normalmap"))])

    def scene(self):
        """Text of a scene, and keywords of frond.loads."""
        r, lines = self.random, []
        def add(directive, kind, *names):
            name, text = self.pick(kind, *names)
            lines.append(f'{directive} "{name}" {text}')
            return name
        def transformed():
            return f"AttributeBegin Translate {self.vector()} Rotate {r.uniform(0, 360):.1f} {self.vector()}"
        periodic = r.random() < 0.1
        lines += ['Option "float period" [ 2 2 ]'] * periodic + [f"LookAt 0 0 4  {self.vector(0.2)}  0 1 0"]
        camera = add("Camera", "camera")
        add("Film", "film"), add("Sampler", "sampler"), add("Integrator", "integrator")
        if camera != "distant":  # its pixels share no samples: the box filter, which is the default
            add("PixelFilter", "pixel filter")
        lines.append('WorldBegin' if camera != "distant" else 'PixelFilter "box"\nWorldBegin')
        for _ in range(r.randint(1, 3)):
            lines.append(transformed())
            add("LightSource", "light", *(("infinite", "distant") if periodic else ()))
            lines.append("AttributeEnd")
        lines += [f'Texture "{name}" "float" "checkerboard" "float tex1" {a} "float tex2" {b}' for name, a, b in (("thin", 1e-4, 3e-4), ("share", 0.1, 0.9))]
        for i in range(r.randint(0, 5)):
            of = r.choice(("float", "spectrum"))
            add(f'Texture "t{i}" "{of}"', f"{of} texture")
            self.names[of].append(f"t{i}")
        for name in ("first", "second"):
            add(f'MakeNamedMaterial "{name}" "string type"', "material", *sorted(set(self.kinds["material"]) - {"mix"}))
        lines.append(f'ObjectBegin "object" NamedMaterial "first" Shape "disk" "float radius" {r.uniform(0.1, 1):.3f} ObjectEnd')
        for _ in range(r.randint(1, 4)):
            lines += [transformed(), "ReverseOrientation" * (r.random() < 0.2)]
            add("Material", "material")
            shape = r.choice(sorted(self.kinds["shape"]))
            if r.random() < 0.3 and not periodic and shape not in ("curve", "instances"):
                add("AreaLightSource", "area light")
            add("Shape", "shape", shape)
            lines.append("AttributeEnd")
        instances = 'NamedMaterial "first" Shape "instances" "string object" "object" "string filename" "leaves.npy"'
        lines += [instances] * ("float texture instance" in self.used) + ['Material "diffuse"', SQUARE]
        more = {"wavelengths": self.words("wavelengths"), "seed": r.randrange(1 << 31)}
        if r.random() < 0.3:
            more["channels"] = ",".join(r.sample(["albedo", "normal", "depth", "position", "material", "instance", "samples"], 2))
        return "\n".join(lines) + "\n", more


BEGIN = 'LookAt 0 0 4 0 0 0 0 1 0\nCamera "perspective" "float fov" 30\nFilm "rgb" "integer xresolution" 12 "integer yresolution" 12\n'
EVEN = BEGIN + 'WorldBegin\nLightSource "infinite" "spectrum L" "stdillum-D65"\n'
FIXED = {"diffuse in even light": EVEN + 'Material "diffuse" "rgb reflectance" [ .8 .8 .8 ]\nShape "sphere"\n' + SQUARE + "\n",
    "leaf_solved in even light": EVEN + 'Material "leaf_solved" "string specimen" "soybean"\nShape "sphere"\n',
    "abm in even light": EVEN + 'Material "abm" "string specimen" "maize"\nShape "sphere"\n' + SQUARE + "\n",
    "rough metal, image, many lights": BEGIN + 'WorldBegin\nLightSource "infinite" "string filename" "image.exr"\n' + "".join(
        f'LightSource "point" "point3 from" [ {i} 2 3 ]\n' for i in range(-3, 4)) +
        'Material "conductor" "float roughness" 0.2\nShape "sphere"\nMaterial "coateddiffuse"\n' + SQUARE + "\n"}


def make_inputs(frond):
    INPUTS.mkdir(parents=True, exist_ok=True)
    light = 'LightSource "infinite" "rgb L" [ .7 .6 .5 ]\nMaterial "diffuse" "rgb reflectance" [ .4 .5 .3 ]\nShape "sphere"\n'
    for name, size in (("image.exr", (32, 32)), ("image.png", (32, 32)), ("wide.exr", (24, 10))):
        frond.loads(BEGIN.replace("12", "{}").format(*size) + "WorldBegin\n" + light).render(4).save(INPUTS / name)
    mesh = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n" \
           "property list uchar int vertex_indices\nend_header\n-1 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"
    for name, text in (("pigment.spd", "300 0\n500 20\n2500 0\n"), ("response.spd", "400 0\n550 1\n700 0\n"), ("mesh.ply", mesh),
                       ("job.pbrt", EVEN + 'Material "leaf_simplified"\nShape "disk"\n')):
        (INPUTS / name).write_text(text, encoding="utf-8")
    frond.canopy(INPUTS / "leaves.npy", count=30, size=[2, 2], column=["chlorophylla=2:5"])
    frond.run("table", specimen="soybean", wavelengths="360:830:10", output=INPUTS / "leaf.csv")
    frond.run("table", leaf=["leaf_solved"], wavelengths="450,550,650", output=INPUTS / "modes.txt")
    frond.run("goniophotometer", material=["leaf_simplified"], angles="0,40,80", wavelengths="360,600,830", patches="10x8", rays=20000, csv=INPUTS / "sheet.csv")
    shutil.copy(ROOT / "tests" / "pbrt_reference" / "metal.bsdf", INPUTS)


def check_finite(arrays):
    if wrong := [name for name, array in arrays.items() if not numpy.isfinite(array).all()]:
        raise ArithmeticError(f"not finite: {', '.join(wrong)}")


def general(message):
    """A message without the place in the scene, and with N for numbers."""
    return re.sub(r"(?<![\w\"])[-\d.e+]*\d", "N", re.sub(r"^\S*<string>[:\d]*: ", "", message.split("\n")[0]))


class Worker(logging.Handler):
    """The process that renders. It receives the warnings of frond."""

    def __init__(self, options):
        super().__init__(logging.WARNING)
        def late(*_):
            raise TimeoutError
        signal.signal(signal.SIGALRM, late)
        signal.signal(signal.SIGINT, signal.SIG_IGN if options.worker else signal.default_int_handler)
        signal.signal(signal.SIGTERM, signal.default_int_handler)
        import frond
        self.frond, self.seed, self.first, self.number = frond, options.seed, options.scene, options.scene
        self.log, self.warned, self.trim = LOG.open("a", encoding="utf-8", buffering=1), [], ctypes.CDLL(None).malloc_trim
        self.sessions = [frond.Session(threads=2, cache=False), frond.Session(threads=1, cache=FOLDER / "cache")]
        logging.getLogger("frond").addHandler(self)
        logging.getLogger("frond").propagate = False
        make_inputs(frond)
        os.chdir(INPUTS)
        self.kinds = plugins(frond.describe(markdown=True).text)
        self.write("plugins", names=[f"{kind} {name}" for kind, names in self.kinds.items() for name in names])

    def emit(self, record):
        self.warned += [record.getMessage()] if re.search("not a number|not finite", record.getMessage()) else []

    def write(self, what, **values):
        self.log.write(json.dumps({"what": what, "number": self.number, **values}) + "\n")

    def finding(self, kind, text, message):
        path = FOLDER / f"{kind.replace(' ', '-')}-{self.number}.pbrt"
        path.write_text(text, encoding="utf-8")
        self.write("finding", kind=kind, message=general(message), file=path.name)
        print(f"scene {self.number} of seed {self.seed}: {message}", flush=True)

    def attempt(self, what, text, function):
        """(end, result): done, refused, stopped after LONGEST seconds, or failed. Failures and numbers counted as black are findings."""
        text = f"# scene {self.number} of seed {self.seed}, {what}\n{text}"
        LAST.write_text(text, encoding="utf-8")
        self.warned, begin, result, why = [], time.monotonic(), None, ""
        signal.setitimer(signal.ITIMER_REAL, LONGEST)
        try:
            end, result = "done", function()
        except TimeoutError:
            end = "stopped"
            shutil.copy(LAST, FOLDER / f"stopped-{self.number}.pbrt")
        except self.frond.InputError as error:
            end, why = "refused", re.sub(r'"[^"]*"', '"..."', general(str(error)))
        except Exception as error:  # pylint: disable=broad-except
            end, kind = "failed", "not finite" if isinstance(error, ArithmeticError) else "error"
            self.finding(kind, text, f"{what.split(',')[0]}: {type(error).__name__}: {error}")
        finally:
            signal.setitimer(signal.ITIMER_REAL, 0)
        self.write(what.split(",")[0].split()[0], end=end, why=why, seconds=time.monotonic() - begin)
        for warning in self.warned if not what.startswith("again") else []:
            self.finding("not finite", text, warning)
        return end, result

    def render(self):
        made = Generator(self.kinds, self.number, self.seed)
        text, more = made.scene()
        sessions = self.sessions[:: made.random.choice((1, -1))]
        def image_in(session):
            image = self.frond.loads(text, INPUTS, session=session, **more).render()
            check_finite({channel: image[channel] for channel in image.channels})
            return image.array.tobytes()
        end, bits = self.attempt(f"render, {more}", text, lambda: image_in(sessions[0]))
        self.write("uses", names=sorted(made.used) if end == "done" else [])
        if self.number % REPEAT == 0 and end == "done":
            end, again = self.attempt(f"again, {more}", text, lambda: image_in(sessions[1]))
            if end == "refused" or (end == "done" and again != bits):
                self.finding("other bits", f"# {more}\n{text}", "other bits when it is rendered again")

    def job(self):
        """One of the other jobs, at cheap settings."""
        made = Generator(self.kinds, -self.number - 1, self.seed)
        frond, r, session, nm, scene = self.frond, made.random, self.sessions[0], [450, 550, 650], INPUTS / "job.pbrt"
        material, leaf = made.words("material"), f"leaf_solved,thickness={r.uniform(1e-4, 4e-4):.6g}"
        def conform():
            laws = frond.conform(material, samples=1000, angles="30", given_only=True, session=session, false_alarm_rate=1e-9)
            if not laws["all_hold"]:
                raise ValueError(f"broken: {[law for law, is_ in laws['laws'].items() if is_['verdict'] not in ('holds', 'not tested')]}")
            return 0
        jobs = {"spectrophotometer": lambda: frond.spectrophotometer(material, nm, rays=1000, session=session),
            "goniophotometer": lambda: frond.goniophotometer(material, nm, rays=1000, patches=(4, 8), session=session)["f"],
            "brf": lambda: frond.brf(scene, nm, zenith="-60:60:30", paths=500, session=session), "flux": lambda: frond.flux(scene, nm, paths=1000, session=session),
            "leaf_table": lambda: frond.leaf_table(leaf, nm, tolerance=0.01, session=session)["adaxial_reflected"],
            "fit": lambda: list(frond.fit([450, 550, 650, 800], [0.05, 0.12, 0.06, 0.45], [0.02, 0.1, 0.04, 0.45], like="soybean", session=session).leaf.values()), "conform": conform,
            "bsdf": lambda: frond.bsdf(material, nm, session=session).f([[0, 0.6, 0.8]], [[0.6, 0, 0.8], [0.6, 0, -0.8]]),
            "check": lambda: len(frond.check(str(scene), session=session).text)}
        name = r.choice(sorted(jobs))
        def numbers():
            found = jobs[name]()
            columns = dict(found.select_dtypes("number")) if hasattr(found, "select_dtypes") else {"result": numpy.asarray(found)}
            check_finite({key: column for key, column in columns.items() if key[:2] not in ("Rs", "Rd")})  # not all materials tell Rs from Rd
        self.attempt(f"job {name}, material {material}, leaf {leaf}", "", numbers)

    def fixed(self, name, seed):
        """Bits of a fixed scene, and the mean of its channel G."""
        image = self.frond.loads(FIXED[name], INPUTS, session=self.sessions[1], seed=seed, wavelengths="smpte").render(16)
        return image.array.tobytes().hex(), float(image["G"].mean(dtype=float))

    def check_fixed(self):
        """The fixed scenes with the seed of the first reference, whose bits they must have, and with one that is new."""
        for name, found in json.loads(FIRST.read_text(encoding="utf-8")).items():
            end, two = self.attempt(f"fixed {name}", FIXED[name], lambda: [self.fixed(name, seed) for seed in (0, REFERENCES + self.number)])
            if end == "done":
                self.write("mean", name=name, mean=two[1][1])
            if end == "refused" or (end == "done" and two[0][0] != found[0][0]):
                self.finding("other bits", FIXED[name], f"{name}: other bits than at the beginning")

    def measure(self):
        """Resident memory in MB, after free memory has been returned to the system; open files; threads."""
        gc.collect(), self.trim(0)
        status = pathlib.Path("/proc/self/status").read_text(encoding="utf-8")
        kilobytes, threads = (int(re.search(rf"^{key}:\s+(\d+)", status, re.MULTILINE)[1]) for key in ("VmRSS", "Threads"))
        self.write("memory", first=self.first, megabytes=kilobytes / 1024, files=len(os.listdir("/proc/self/fd")), threads=threads)

    def run(self, hours):
        if hours == 0:  # one scene
            return self.render() or (self.number % JOB == 0 and self.job()) or print(LOG.read_text(encoding="utf-8"))
        if not FIRST.exists():  # references of this process and those after it
            found = {name: [self.fixed(name, seed) for seed in range(REFERENCES)] for name in FIXED}
            FIRST.write_text(json.dumps(found), encoding="utf-8")
        begin = checked = time.monotonic()
        parent, every = os.getppid(), min(CHECK, 360 * hours)
        while time.monotonic() < begin + 3600 * hours and os.getppid() == parent:
            self.render()
            if self.number % JOB == 0:
                self.job()
            if self.number % MEASURE == 0:
                self.measure()
            if time.monotonic() - checked > every:
                self.check_fixed()
                checked = time.monotonic()
            self.number += 1


def growth(memory):
    """Growth in kB per scene of memory in MB, half width of its 95 % interval, probability of such a growth if there is none."""
    steps = numpy.diff([block.mean() for block in numpy.array_split(numpy.array(memory), BLOCKS)])
    mean, error, unit = steps.mean(), scipy.stats.sem(steps), 1024 * BLOCKS / (len(memory) * MEASURE)
    probability = scipy.stats.t.sf(mean / error, BLOCKS - 2) if error > 0 else float(mean <= 0)
    return mean * unit, scipy.stats.t.ppf(0.975, BLOCKS - 2) * error * unit, probability


SECTION = """## Soak

Measured on {machine}. `measurements/run soak --seed {seed}` rendered random scenes in one process for {hours:.3g} h: plug-ins and
parameters are drawn from the ranges that `frond describe` states, films have at most 20 × 20 pixels. Every {REPEAT} scenes the
scene is rendered again with another number of threads, every {JOB} scenes another job runs (BRF, flux, instruments, leaf tables,
fits, laws of BSDFs).

{summary}
A scene is refused, with an `InputError`, if its parameters exclude each other. Numbers that are not finite are those of images, of
results of jobs, and those that frond counts as black with a warning. `measurements/run soak --seed {seed} --scene N` repeats scene N.

**Memory** is resident memory after free memory has been returned to the system, measured every {MEASURE} scenes. The first fifth of
the measurements, and at least {WARM} scenes, are warm-up. The means of {BLOCKS} successive blocks of the others must not increase:
Student's t-test of their differences. A probability below {RATE:g} is a finding, at this false-alarm rate if memory varies like a random
walk, at a lower one if blocks vary independently. Open files, threads: a finding if the last block is above the first everywhere.

**Drift.** Four fixed scenes are rendered every {every:.0f} s with two seeds. With the first, the image must have the bits that it had at
the beginning. With the other, new each time, the means must be those of {REFERENCES} renders at the beginning: Student's t-test. A
probability below {RATE:g} / {count} is a finding: the false-alarm rate of the table is {RATE:g}.

{drift}
{findings}
"""


def report(options, seconds, crashes):
    """Writes the section from the log and the findings of crashes. Returns the number of all findings."""
    log, rows = collections.defaultdict(list), []
    for record in map(json.loads, LOG.read_text(encoding="utf-8").splitlines() if LOG.exists() else []):
        log[record["what"]].append(record)
    findings = [(one["kind"], one["message"], one["file"]) for one in log["finding"]] + crashes
    attempts = [one for what in ("render", "again", "job", "fixed") for one in log[what]]
    ends = {what: collections.Counter(one["end"] for one in log[what]) for what in ("render", "again", "job")}
    findings += [] if ends["render"]["done"] else [("error", "no scene was rendered", "")]
    late = max(([one for one in log["memory"] if one["first"] == first] for first in {one["first"] for one in log["memory"]}), key=len, default=[])
    eighths = [f"{late[len(late) * i // 8 - 1]['megabytes']:.0f}" for i in range(1, 9)] if len(late) >= 8 else []
    late = late[max(len(late) // 5, WARM // MEASURE):]
    memory = [[f"memory, tested with {BLOCKS * LEAST} measurements after warm-up", f"{len(late)} measurements"]]
    if len(late) >= BLOCKS * LEAST:
        grows, half, probability = growth([one["megabytes"] for one in late])
        says, size = f"{grows:.2f} ± {half:.2f} kB per scene, probability {probability:.2g}", len(late) // BLOCKS
        memory = [["memory after each eighth of the scenes, MB", ", ".join(eighths)],
                  ["growth of memory, with its 95 % interval", says], ["open files, threads", f"{late[-1]['files']}, {late[-1]['threads']}"]]
        findings += [("leak", f"growth of memory: {says}", "")] if probability < RATE else []
        findings += [("leak", f"{key} become more", "") for key in ("files", "threads") if min(x[key] for x in late[-size:]) > max(x[key] for x in late[:size])]
    for name, first in json.loads(FIRST.read_text(encoding="utf-8")).items() if FIRST.exists() else []:
        later, reference, texts = [one["mean"] for one in log["mean"] if one["name"] == name], [mean for _, mean in first], ["not tested", ""]
        if len(later) > 1:
            test = scipy.stats.ttest_ind(later, reference)
            low, high = (100 * end / numpy.mean(reference) for end in test.confidence_interval(0.95))
            texts = [f"{(low + high) / 2:+.3f} ± {(high - low) / 2:.3f}", f"{test.pvalue:.2g}"]
            findings += [] if test.pvalue >= RATE / len(FIXED) else [("drift", f"drift of {name}: probability {test.pvalue:.2g}", "")]
        rows.append([name, len(later), *texts])
    uses = collections.Counter({name: 0 for one in log["plugins"] for name in one["names"]})
    uses.update(name for one in log["uses"] for name in one["names"])
    least, count = min(uses.items(), key=lambda use: use[1], default=("none", 0))
    kinds = collections.Counter(kind for kind, _, _ in findings)
    summary = table(["", ""], [["scenes rendered; refused", f"{ends['render']['done']}; {ends['render']['refused']}"],
        ["other jobs; refused", f"{ends['job']['done']}; {ends['job']['refused']}"],
        [f"stopped after {LONGEST} s", sum(one["end"] == "stopped" for one in attempts)],
        ["longest scene or job", f"{max((one['seconds'] for one in attempts), default=0):.1f} s"],
        ["plug-ins used; least", f"{sum(map(bool, uses.values()))} of {len(uses)}; {least}, {count} times"],
        ["rendered again", ends["again"]["done"]], *memory, *([f"findings: {kind}", kinds[text]] for kind, text in (
            ("numbers that are not finite", "not finite"), ("other bits", "other bits"), ("errors", "error"), ("leaks", "leak"), ("drift", "drift"), ("crashes", "crash")))])
    listed, files = collections.Counter(message for _, message, _ in findings), {message: file for _, message, file in findings[::-1]}
    lines = [f"- {number} × {message}{f' ({files[message]})' if files[message] else ''}" for message, number in listed.most_common()]
    refused = collections.Counter(one["why"] for one in attempts if one["end"] == "refused")
    print(summary, *(f"{number} times refused: {message}" for message, number in refused.most_common(20)), *lines, sep="\n")
    write_section(options.docs / "reliability.md", "soak", SECTION.format(
        machine=machine(), seed=options.seed, hours=seconds / 3600, summary=summary, JOB=JOB, REPEAT=REPEAT, MEASURE=MEASURE, WARM=WARM,
        BLOCKS=BLOCKS, RATE=RATE, REFERENCES=REFERENCES, count=len(FIXED), every=min(CHECK, 360 * options.hours),
        drift=table(["scene", "renders", "difference of the mean, %, 95 %", "probability"], rows), findings="\n".join(lines) or "No finding."))
    return len(findings)


def watch(words, stops):
    """Exit code of the process that renders, which is ended by a signal in `stops`, or by a scene that does not stop."""
    LAST.write_text("# start\n", encoding="utf-8")
    with subprocess.Popen([sys.executable, "-B", "-m", "measurements.soak", *map(str, words)]) as process:
        told = False
        while process.poll() is None:
            time.sleep(0.5)
            if stops and not told:
                told = not process.terminate()
            if time.time() - LAST.stat().st_mtime > LONGEST + GRACE:
                process.kill()
                return f"none after {LONGEST + GRACE} s"
    return 0 if told and process.returncode == -signal.SIGTERM else process.returncode


def supervise(options):
    """Runs the process that renders, and again with the next scene when it has died. Returns the number of findings."""
    shutil.rmtree(FOLDER, ignore_errors=True)
    FOLDER.mkdir(parents=True)
    stops, first, crashes, begin = [], 0, [], time.monotonic()
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda caught, _: stops.append(caught))
    while (left := options.hours - (time.monotonic() - begin) / 3600) > 0 and not stops and len(crashes) < DIES and first is not None:
        if not (code := watch(["--worker", "--hours", left, "--seed", options.seed, "--scene", first], stops)):
            break
        copy = shutil.copy(LAST, FOLDER / f"crash-{len(crashes)}.pbrt")
        crashes.append(("crash", f"the process ended; exit code: {code}", copy.name))
        at = re.match(r"# scene (\d+)", copy.read_text(encoding="utf-8"))
        first = int(at[1]) + 1 if at else None  # None: it cannot start
    return report(options, time.monotonic() - begin, crashes)


def main():
    options = arguments("soak", ("--hours", {"type": float}), ("--seed", {"type": int, "default": 1}), ("--scene", {"type": int}), ("--worker", {"action": "store_true"}))
    options.hours = options.hours or (1 / 30 if options.quick else 1) * (options.scene is None)
    if options.scene is None:
        sys.exit(1 if supervise(options) else 0)
    try:
        FOLDER.mkdir(parents=True, exist_ok=True)
        Worker(options).run(options.hours)
    except KeyboardInterrupt:  # SIGTERM
        pass


if __name__ == "__main__":
    main()
