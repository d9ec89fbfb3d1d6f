"""Random scenes of all plug-ins, from what `frond describe` prints, and fixed scenes whose means are compared."""

import collections
import math
import random
import re
import shutil

from ..shared.tools import ROOT

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


def make_inputs(frond, folder):
    """Writes the files that the scenes read."""
    folder.mkdir(parents=True, exist_ok=True)
    light = 'LightSource "infinite" "rgb L" [ .7 .6 .5 ]\nMaterial "diffuse" "rgb reflectance" [ .4 .5 .3 ]\nShape "sphere"\n'
    for name, size in (("image.exr", (32, 32)), ("image.png", (32, 32)), ("wide.exr", (24, 10))):
        frond.loads(BEGIN.replace("12", "{}").format(*size) + "WorldBegin\n" + light).render(4).save(folder / name)
    mesh = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n" \
           "property list uchar int vertex_indices\nend_header\n-1 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"
    for name, text in (("pigment.spd", "300 0\n500 20\n2500 0\n"), ("response.spd", "400 0\n550 1\n700 0\n"), ("mesh.ply", mesh),
                       ("job.pbrt", EVEN + 'Material "leaf_simplified"\nShape "disk"\n')):
        (folder / name).write_text(text, encoding="utf-8")
    frond.canopy(folder / "leaves.npy", count=30, size=[2, 2], column=["chlorophylla=2:5"])
    frond.run("table", specimen="soybean", wavelengths="360:830:10", output=folder / "leaf.csv")
    frond.run("table", leaf=["leaf_solved"], wavelengths="450,550,650", output=folder / "modes.txt")
    frond.run("goniophotometer", material=["leaf_simplified"], angles="0,40,80", wavelengths="360,600,830", patches="10x8", rays=20000, csv=folder / "sheet.csv")
    shutil.copy(ROOT / "tests" / "pbrt_reference" / "metal.bsdf", folder)
