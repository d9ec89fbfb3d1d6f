"""Calls with wrong arguments, plug-ins and BSDFs that fail, and interruption. Each call runs in a process of its
own, so that a crash or an endless loop fails one test only. A case is a line of a table."""

import json
import os
import re
import signal
import subprocess
import sys
import time

import pytest

from conftest import SCENE

#: A call ends within a second after SIGINT; the rest is for busy machines.
ALLOWANCE_S = 3
#: A call that has not ended by then is taken as endless. No call of the tables lasts a second.
ENDLESS_S = 10

PLUGIN = os.environ.get("FROND_HOSTILE_PLUGIN")
ENVIRONMENT = dict(os.environ, PYTHONPATH=os.pathsep.join(sys.path))

#: What the calls of the tables use. The small scene is a diffuse plane.
SETTING = f'''
import frond, numpy, logging, os, sys
nan, inf = float("nan"), float("inf")
SCENE = {SCENE!r}.replace("leaf_solved", "leaf_lambert")
open("scene.pbrt", "w").write(SCENE)
DEEP = "\\"integer maxdepth\\" 1048576\\n"
ROOM = (f"Integrator \\"path\\" {{DEEP}} WorldBegin AreaLightSource \\"diffuse\\" Material \\"diffuse\\""
        " \\"spectrum reflectance\\" [300 1 900 1] Shape \\"sphere\\" \\"float radius\\" 9")
FOG = (f"Integrator \\"volpath\\" {{DEEP}} MakeNamedMedium \\"m\\" \\"string type\\" \\"homogeneous\\""
       " \\"float sigma_a\\" 0 \\"float sigma_s\\" 1e9 MediumInterface \\"m\\" Camera \\"perspective\\" WorldBegin "
       "LightSource \\"infinite\\" \\"spectrum L\\" \\"stdillum-D65\\"")
SPECTRA = dict(wavelengths=list(range(400, 700, 20)), R=[0.1] * 15, T=[0.1] * 15)
LIGHT = ("LightSource \\"distant\\" \\"point3 from\\" [0 0 0] \\"point3 to\\" [0.3 0 1]\\n"
         "LightSource \\"infinite\\" \\"spectrum L\\" \\"stdillum-D65\\"")
session = frond.Session(threads=1, cache=False, plugins=[p for p in [os.environ.get("FROND_HOSTILE_PLUGIN")] if p])

class Raises:
    def __float__(self):
        raise KeyError("mine")

def python_bsdf(**members):
    return type("Paper", (frond.Bsdf,), {{"f": lambda self, wo, wi, nm: 0.1, **members}})()

def conform(*args, **more):
    return frond.conform(*args, **{{"samples": 1000, "excess": 0, "angles": 0, "wavelengths": 551, "session": session, **more}})

class Warnings(logging.Handler):
    texts = []
    def emit(self, record):
        self.texts.append(record.getMessage())

def image(text, **more):
    """Renders a scene. Raises an error unless the values are finite, and none is negative without a warning."""
    handler = Warnings(logging.WARNING)
    logging.getLogger("frond").addHandler(handler)
    values = session.loads(text, **more).render(4).array
    assert numpy.isfinite(values).all(), "not finite"
    assert (values >= 0).all() or handler.texts, "negative, and no warning"
    return [float(values.mean()), handler.texts]

def with_material(fault):
    return image(SCENE.replace("LightSource \\"infinite\\" \\"spectrum L\\" \\"stdillum-D65\\"", LIGHT),
                 swap={{"leaf": f"hostile_material,fault={{fault}}"}})

def with_texture(kind, parameter, fault):
    texture = f'Texture "t" "{{kind}}" "hostile_{{kind}}" "string fault" "{{fault}}"\\nMakeNamedMaterial "leaf"'
    text = SCENE.replace('MakeNamedMaterial "leaf"', texture)
    if parameter == "alpha":
        return image(text.replace("2 2 1 ]", '2 2 1 ] "texture alpha" "t"'))
    return image(text.replace('"string type" "leaf_lambert"', '"string type" "diffuse" "texture reflectance" "t"'))

def with_light(fault):
    return image(SCENE.replace("WorldBegin", f'WorldBegin\\nLightSource "hostile_light" "string fault" "{{fault}}"'))

def with_shape(fault):
    return image(SCENE.split("Shape")[0] + f'Shape "hostile_shape" "string fault" "{{fault}}"')

def with_wavelengths(fault):
    return image(SCENE, wavelengths=f"hostile_wavelengths,fault={{fault}}")
'''

#: Forks a process for each call of standard input, and writes a line of JSON: [how it ended, class, text].
RUNNER = SETTING + f'''
import json, select, signal, time

def outcome(call):
    try:
        return ["returned", "", repr(eval(call, globals()))[:2000]]
    except BaseException as error:
        return ["raised", type(error).__name__, str(error)[:2000]]

for line in sys.stdin:
    call = json.loads(line)
    read, write = os.pipe()
    child = os.fork()
    if child == 0:
        os.write(write, json.dumps(outcome(call)).encode()[:60000])
        os._exit(0)
    os.close(write)
    found = None if select.select([read], [], [], {ENDLESS_S})[0] else ["endless", "", ""]
    if found:
        os.kill(child, signal.SIGKILL)
    text = os.read(read, 65536) if not found else b""
    _, status = os.waitpid(child, 0)
    os.close(read)
    if not found:
        found = ["signal " + str(os.WTERMSIG(status)), "", ""] if os.WIFSIGNALED(status) else json.loads(text)
    os.write(1, (json.dumps(found) + "\\n").encode())
'''

BAD_INPUT = "InputError ValueError TypeError"
#: Call, classes of the exception ("" if it returns), pattern of its message or of the returned value.
CALLS = [
    # Texts that are empty.
    ('frond.bsdf("", [550.])', BAD_INPUT, "material"),
    ('conform("")', BAD_INPUT, "material"),
    ('frond.spectrophotometer("", 551)', BAD_INPUT, "material"),
    ('frond.goniophotometer("", 551)', BAD_INPUT, "material"),
    ('frond.export("", format="csv", output="e.csv", wavelengths=551, angles=0)', BAD_INPUT, "material"),
    ('frond.bench("")', BAD_INPUT, "material"),
    ('frond.leaf_table("", [551])', BAD_INPUT, "material"),
    ('frond.leaf_table("diffuse", [551])', "InputError", "is no leaf: leaf_solved is needed"),
    ('frond.load("scene.pbrt", swap="leaf=")', BAD_INPUT, "swap"),
    ('frond.load("")', BAD_INPUT, "scene|file"),
    ('frond.load("scene.pbrt", wavelengths="")', BAD_INPUT, "wavelengths"),
    ('frond.flux("scene.pbrt", wavelengths="", paths=64, period=(2, 2))', BAD_INPUT, "wavelengths"),
    ('frond.brf("scene.pbrt", wavelengths="", paths=64, period=(2, 2))', BAD_INPUT, "wavelengths"),
    ('frond.run(None)', "ValueError", "None"),
    ('frond.load("scene.pbrt", session=5)', "TypeError", "frond.Session is needed, not 5"),
    ('frond.Session(threads="2")', "TypeError", "threads: a whole number is needed, not '2' .str"),
    ('frond.Session(cache="tables\\0more")', "ValueError", "zero byte"),
    ('frond.Session(plugins=["a\\0b"])', "ValueError", "zero byte"),
    ('frond.Session(plugins="nowhere.so")', BAD_INPUT, "nowhere.so"),
    ('frond.load("scene.pbrt", session=session).render(1).save("a\\0.exr")', "ValueError", "zero byte"),
    ('frond.read_image("a\\0.exr")', "ValueError", "zero byte"),
    ('frond.run("render", scene=bytearray(b"nope.pbrt"), session=session)', BAD_INPUT, "nope.pbrt"),
    ('frond.run("nowhere")', "KeyError InputError ValueError", "nowhere"),
    # Lists that are empty.
    ('frond.compare("scene.pbrt", [], size=4, spp=4)', BAD_INPUT, "materials|candidate"),
    ('frond.convert([], output="a.png")', BAD_INPUT, "images"),
    ('frond.merge([], output="a.exr")', BAD_INPUT, "parts"),
    ('frond.merge(numpy.zeros(0), output="a.exr")', BAD_INPUT, "parts"),
    ('frond.difference([])', BAD_INPUT, "images"),
    ('frond.render([], output="a.exr")', BAD_INPUT, "scene"),
    ('frond.check([])', BAD_INPUT, "scene"),
    ('conform([])', BAD_INPUT, "material"),
    ('frond.flux("scene.pbrt", wavelengths=[], paths=64, period=(2, 2))', BAD_INPUT, "wavelengths"),
    ('frond.brf("scene.pbrt", wavelengths=[], paths=64, period=(2, 2))', BAD_INPUT, "wavelengths"),
    ('frond.spectrophotometer("diffuse", [])', BAD_INPUT, "wavelengths"),
    ('frond.bsdf("diffuse", [])', BAD_INPUT, "wavelengths"),
    ('frond.bsdf("diffuse", [500, 510, 520, 530, 540]).sample([0, 0, 1])', "ValueError", "wavelengths"),
    ('frond.leaf_table("leaf_solved", [])', BAD_INPUT, "wavelengths"),
    ('frond.fit([], [], [])', BAD_INPUT, ""),
    # Arrays as lists.
    ('len(frond.spectrophotometer("diffuse", numpy.array([500., 551.]), rays=100)["R"])', "", "2"),
    ('len(frond.spectrophotometer("diffuse", 551, numpy.arange(3) * 8, rays=100)["R"])', "", "3"),
    ('len(frond.spectrophotometer("diffuse", numpy.arange(500., 560)[::30], rays=100)["R"])', "", "2"),
    ('frond.load("scene.pbrt", pixels=numpy.array([0, 2, 0, 3])).render(1).array.shape[:2]', "", r"\(3, 2\)"),
    ('frond.load("scene.pbrt", wavelengths=numpy.array([500., 551.])).render(1).channels', "", "551"),
    ('frond.spectrophotometer("diffuse", numpy.zeros((2, 2, 2)))', BAD_INPUT, "wavelengths"),
    # Numbers.
    ('frond.spectrophotometer("diffuse", nan)', BAD_INPUT, "wavelengths"),
    ('frond.spectrophotometer("diffuse", 551, inf)', BAD_INPUT, "angles"),
    ('frond.spectrophotometer("diffuse", 551, rays=2**64)', BAD_INPUT, "rays"),
    ('frond.spectrophotometer("diffuse", 551, rays=10**400)', BAD_INPUT, "rays"),
    ('frond.spectrophotometer("diffuse", 551, rays=-1)', BAD_INPUT, "rays"),
    ('frond.spectrophotometer("diffuse", 551, seed=2**64)', BAD_INPUT, "seed"),
    ('frond.goniophotometer("diffuse", 551, patches=(10**5, 10**5))', BAD_INPUT, "patches"),
    ('frond.goniophotometer("diffuse", 551, patches=(0, 4))', BAD_INPUT, "patches"),
    ('frond.goniophotometer("diffuse", 551, patches=(-1, 4))', BAD_INPUT, "patches"),
    ('frond.bsdf("diffuse", nan)', BAD_INPUT, "nan"),
    ('frond.bsdf("diffuse", 1e308)', BAD_INPUT, ""),
    ('frond.leaf_table("leaf_solved", [551], tolerance=-1)', BAD_INPUT, "tolerance"),
    ('frond.leaf_table("leaf_solved", [551], tolerance=nan)', BAD_INPUT, "tolerance"),
    ('frond.leaf_table("leaf_solved", [551], tolerance=inf)', BAD_INPUT, "tolerance"),
    ('frond.leaf_table("leaf_solved", [551], tolerance=0)', BAD_INPUT, "tolerance"),
    ('frond.leaf_table("leaf_solved", [551], depths=(0, inf))', BAD_INPUT, "depths"),
    ('frond.leaf_table("leaf_solved", [551], depths=(2, 1))', BAD_INPUT, "depths"),
    ('frond.leaf_table("leaf_solved", [nan])', BAD_INPUT, "nan"),
    ('frond.fit(**{**SPECTRA, "R": [inf] + [0.1] * 14})', BAD_INPUT, "inf"),
    ('frond.fit(**{**SPECTRA, "R": [0.1]})', BAD_INPUT, "R"),
    ('frond.fit(**SPECTRA, fix={"chlorophylla": -1})', BAD_INPUT, "chlorophylla"),
    ('frond.fit(**SPECTRA, fix={"chlorophylla": nan})', BAD_INPUT, "chlorophylla"),
    ('frond.fit(**SPECTRA, fix={"thickness": 0})', BAD_INPUT, "thickness"),
    ('frond.load("scene.pbrt").render(2, time_limit=2**60).samples', "", r"\(2, 2\)"),
    ('frond.render("scene.pbrt", output="a.exr", spp=2, time_limit=1e300).code', "", "0"),
    ('frond.load("scene.pbrt").render(2, time_limit=-1)', BAD_INPUT, "time_limit"),
    ('frond.load("scene.pbrt").render(2, time_limit=nan)', BAD_INPUT, "time_limit"),
    ('frond.load("scene.pbrt", adaptive=True).render(2, max_rms=nan)', BAD_INPUT, "max_rms"),
    ('frond.load("scene.pbrt").render(-1)', BAD_INPUT, ""),
    ('frond.Session(threads=-1)', BAD_INPUT, "threads"),
    ('frond.Session(threads=2**31)', BAD_INPUT + " OverflowError", ""),
    # Values of a wrong class.
    ('frond.spectrophotometer("diffuse", None)', BAD_INPUT, "wavelengths"),
    ('frond.spectrophotometer("diffuse", Raises())', "KeyError", "mine"),
    ('frond.bsdf("diffuse", [Raises()])', "KeyError", "mine"),
    ('frond.check(b"scene.pbrt").text', "", "no errors"),
    ('frond.bsdf("diffuse", [551], session="x")', BAD_INPUT, "session"),
    ('conform(numpy.zeros(3))', BAD_INPUT, ""),
    ('frond.check("a\\0b")', BAD_INPUT, ""),
    ('frond.render("scene.pbrt", output="a.exr\\0b", spp=1)', BAD_INPUT, "output"),
    ('frond.check("\\ud800")', BAD_INPUT + " UnicodeEncodeError", "scene|surrogate"),
    ('frond.submit("scene.pbrt", output="o.exr", spp=2, tasks=2, slurm=True, folder="x" * 5000)',
     "InputError OSError", "x"),
    ('frond.load("scene.pbrt").render(20000, progress=3)', "TypeError", ""),
    ('session.loads(SCENE).render(2**63)', "InputError", "samples per pixel are requested: 1073741824 are the most"),
    ('session.loads(SCENE).render(2**70)', "ValueError", "samples: .* 64 bits"),
    ('session.loads(SCENE).render(-5)', "ValueError", "samples"),
    ('session.loads(SCENE).render(2.5)', "TypeError", "samples: a whole number"),
    ('session.loads(SCENE).render(1).render_more("4")', "TypeError", "samples: a whole number"),
    # Text.
    ('session.load(b"caf\\xe9.pbrt")', "ValueError", "path: .* is not UTF-8"),
    ('session.loads("\\udcff")', "ValueError", "text: .* is not UTF-8"),
    ('session.loads(b"x")', "TypeError", "text: text is needed"),
    ('session.loads(SCENE).render(1).save(b"caf\\xe9.exr")', "ValueError", "path: .* is not UTF-8"),
    ('frond.bsdf("dif\\udc80", [551])', "ValueError", "material: .* is not UTF-8"),
    ('frond.bsdf("dif\\0fuse", [551])', "ValueError", "material: .* zero bytes"),
    ('frond.bsdf("diffuse", numpy.array(551.)).f([0, 0, 1], [0, 0, 1]).shape', "", r"\(1, 1\)"),
    ('frond.merge(["a.part", None], output="x.exr")', "TypeError", "part.*None"),
    ('frond.fit([500, 600], numpy.ones((2, 2)) * 0.1)', "TypeError", "R: one dimension is needed, not .* of shape"),
    ('frond.spectrophotometer(python_bsdf(), 551, session=session)', "TypeError", r"material: a text is needed.*register_material"),
    ('frond.bench(python_bsdf(f=lambda self, wo, wi, nm: "x"), angles=0, lanes=1, repetitions=1, min_time=1e-3, samples=1000, session=session)',
     "TypeError", r"Paper\.(f|sample) returns"),
    ('frond.conform(type(python_bsdf()), session=session)', "TypeError", r"Paper is a class; give an object of it, as in Paper\(\)"),
    ('frond.register_material("x\\0y", python_bsdf(), session=session)', "ValueError", "name: .* zero bytes"),
    ('frond.register_material("", python_bsdf(), session=session)', "ValueError", "name"),
    ('frond.register_material("a b", python_bsdf(), session=session)', "ValueError", "name"),
    ('frond.register_material("k", type(python_bsdf()), session=session)', "TypeError", "bsdf: an object"),
    # An old file stays where there is no room for a new one.
    ('[__import__("signal").signal(25, 1), frond.leaf_table("leaf_solved", [551]).save("keep.leaf"),'
     ' __import__("resource").setrlimit(1, (5000, 5000)),'
     ' outcome(\'frond.leaf_table("leaf_solved", [551, 455]).save("keep.leaf")\'),'
     ' os.path.getsize("keep.leaf") > 5000]', "", r"keep\.leaf.*True"),
    # Directions.
    ('frond.bsdf("abm", [551]).sample([[nan, nan, nan]])', BAD_INPUT, "wo|direction"),
    ('frond.bsdf("abm", [551]).f([0, 0, inf], [0, 0, 1])', BAD_INPUT, "wo|direction"),
    ('frond.bsdf("diffuse", [551]).pdf([0, 0, 0], [0, 0, 1])', BAD_INPUT, "wo|direction"),
    ('frond.bsdf("diffuse", [551]).f([0, 0, 1], [0, 0, 7])', BAD_INPUT, "wi|direction"),
    ('frond.bsdf("diffuse", [551]).f([0, 1], [0, 0, 1])', BAD_INPUT, ""),
    ('frond.bsdf("diffuse", [551]).f(numpy.zeros((0, 3)), numpy.zeros((0, 3))).shape', "", r"\(0, 1\)"),
    ('frond.bsdf("diffuse", [551]).f(numpy.eye(3)[:, ::-1], [0, 0, 1]).shape', "", r"\(3, 1\)"),
    ('frond.bsdf("diffuse", [551]).f([0, 0, 1], [0, 0, 1], seed=-1)', BAD_INPUT, ""),
    # BSDFs in Python.
    ('conform(python_bsdf(pdf=lambda self, wo, wi, nm: -1.0))["all_hold"]', "", "False"),
    ('conform(python_bsdf(pdf=lambda self, wo, wi, nm: nan))["all_hold"]', "", "False"),
    ('conform(python_bsdf(f=lambda self, wo, wi, nm: nan))["laws"]["values"]["verdict"]', "", "broken"),
    ('conform(python_bsdf(f=lambda self, wo, wi, nm: -inf))["laws"]["values"]["verdict"]', "", "broken"),
    ('conform(python_bsdf(f=lambda self, wo, wi, nm: "x"))', BAD_INPUT, r"\bf\b"),
    ('conform(python_bsdf(f=lambda self, wo, wi, nm: [1, 2]))', BAD_INPUT, "wavelengths"),
    ('conform(python_bsdf(pdf=lambda self, wo, wi, nm: 10**400))', BAD_INPUT + " OverflowError", "pdf"),
    ('conform(python_bsdf(sample=lambda self, wo, uc, u, nm: 3))', BAD_INPUT, "sample"),
    ('conform(python_bsdf(sample=lambda self, wo, uc, u, nm: ((nan, nan, nan), 0.1, 1)))["all_hold"]', "", "False"),
    ('conform(python_bsdf(flags=3))', BAD_INPUT, "flags"),
    ('conform(python_bsdf(flags=()))', BAD_INPUT, "flags"),
    ('conform(python_bsdf(f=lambda self, wo, wi, nm: {}["mine"]))', "KeyError", "mine"),
    # A name that was refused keeps its first object.
    ('[frond.register_material("twice", python_bsdf(f=lambda self, wo, wi, nm: 0.25), session=session),'
     ' outcome("frond.register_material(\'twice\', python_bsdf(f=lambda self, wo, wi, nm: 0.5), session=session)"),'
     ' float(frond.bsdf("twice", [551], session=session).f([0, 0, 1], [0, 0, 1])[0, 0])]', "", r"already exists.*0\.25"),
    # Two sessions have a material of the same name.
    ('[frond.register_material("both", python_bsdf(f=lambda self, wo, wi, nm, v=v: v), session=s) or s for v, s in'
     ' ((0.25, session), (0.5, frond.Session(cache=False)))] and'
     ' float(frond.bsdf("both", [551], session=session).f([0, 0, 1], [0, 0, 1])[0, 0])', "", r"0\.25"),
]

#: Faults of tests/plugins/hostile.cpp after which a render goes on, and what is said; the others end it with an error
#: that names the plug-in.
GOES_ON = {
    "with_material": ("none", "null", "f_nan", "f_infinite", "f_negative", "pdf_nan", "pdf_infinite", "pdf_negative",
                      "pdf_zero", "sample_f_nan", "sample_f_infinite", "sample_pdf_nan", "sample_pdf_negative",
                      "sample_pdf_zero", "zero_direction", "nan_direction", "long_direction"),
    "with_light": ("none", "nan", "infinite", "negative", "distance_nan", "distance_zero", "pdf_negative", "nan_direction",
                   "long_direction"),
    "with_shape": ("none", "nan", "nan_normal"),
    "with_wavelengths": ("none", "nan", "infinite", "negative"),
    "with_texture float": ("none", "nan", "infinite", "negative"),
    "with_texture spectrum": ("none", "nan", "infinite", "negative"),
}
EXCEPTIONS = ("make_runtime_error", "make_bad_alloc", "make_object", "runtime_error", "bad_alloc", "object")
ENDS = {kind: EXCEPTIONS for kind in GOES_ON} | {
    "with_material": (*EXCEPTIONS, "prepare_runtime_error", "f_throws", "sample_throws", "pdf_throws"),
    "with_shape": (*EXCEPTIONS, "nan_bounds"),
}
#: Values that are not finite, which the renderer counts as black and reports.
REPORTED = ("f_nan", "f_infinite", "sample_f_nan", "sample_f_infinite", "sample_pdf_nan", "sample_pdf_zero")
#: Measurements end with an error instead: a share without them would be wrong.
MEASURED = [f'{function.format(f"hostile_material,fault={fault}")}'
            for fault in ("sample_f_nan", "sample_f_infinite", "sample_pdf_nan", "sample_pdf_negative", "nan_direction")
            for function in ('frond.spectrophotometer("{}", 551, rays=1000, session=session)',
                             'frond.goniophotometer("{}", 551, rays=1000, session=session)',
                             'frond.flux("scene.pbrt", wavelengths=551, paths=1000, swap="*={}", session=session)')]
MEASURED += [f'frond.goniophotometer("hostile_material,fault={fault}", 551, integrate=True, session=session)'
             for fault in ("f_nan", "f_negative")]


def call_of(kind, fault):
    """Returns the call of a fault. "with_texture float" is the alpha of a shape, the other a reflectance."""
    function, *texture = kind.split()
    words = [*texture, "alpha" if texture == ["float"] else "reflectance", fault] if texture else [fault]
    return f"{function}({', '.join(map(repr, words))})"


PLUGIN_CALLS = [(kind, fault, call_of(kind, fault)) for table in (GOES_ON, ENDS) for kind, faults in table.items()
                for fault in faults]
THROWN = ("f_throws", "sample_throws", "pdf_throws", "runtime_error", "object")
CONFORM_FAULTS = (*GOES_ON["with_material"][1:], *THROWN)
#: Exceptions of a BSDF outside of a render.
INSTRUMENT_CALLS = [f'{function.format(f"hostile_material,fault={fault}")}'
                    for fault in ("sample_throws", "runtime_error", "object")
                    for function in ('frond.spectrophotometer("{}", 551, rays=10, session=session)',
                                     'frond.goniophotometer("{}", 551, rays=10, session=session)')]


@pytest.fixture(scope="module")
def outcomes(tmp_path_factory):
    """Returns {call: [how it ended, class, text]} of all calls."""
    calls = [call for call, _, _ in CALLS]
    if PLUGIN:
        calls += [call for _, _, call in PLUGIN_CALLS] + [conform_call(fault) for fault in CONFORM_FAULTS]
        calls += INSTRUMENT_CALLS + MEASURED
    script = tmp_path_factory.mktemp("hostile") / "runner.py"
    script.write_text(RUNNER)
    lines = "".join(json.dumps(call) + "\n" for call in calls)
    done = subprocess.run([sys.executable, str(script)], input=lines, text=True, stdout=subprocess.PIPE,
                          stderr=subprocess.DEVNULL, cwd=script.parent, env=ENVIRONMENT, check=True)
    found = [json.loads(line) for line in done.stdout.splitlines()]
    return dict(zip(calls, found, strict=True))


def conform_call(fault):
    return f'conform("hostile_material,fault={fault}")["all_hold"]'


def check(found, classes, pattern):
    how, error, text = found
    assert how in ("returned", "raised"), how
    assert (error in classes.split()) if classes else how == "returned", f"{how} {error}: {text}"
    assert re.search(pattern, text), text


@pytest.mark.parametrize("call, classes, pattern", CALLS, ids=[call for call, _, _ in CALLS])
def test_a_wrong_call_is_an_exception(call, classes, pattern, outcomes):
    check(outcomes[call], classes, pattern)


needs_plugin = pytest.mark.skipif(not PLUGIN, reason="FROND_HOSTILE_PLUGIN names no plug-in")


@needs_plugin
@pytest.mark.parametrize("kind, fault, call", PLUGIN_CALLS, ids=[f"{kind}-{fault}" for kind, fault, _ in PLUGIN_CALLS])
def test_a_plugin_that_fails(kind, fault, call, outcomes):
    """The values of an image are finite in any case (`image`)."""
    found = outcomes[call]
    if fault == "nan_bounds":
        check(found, BAD_INPUT, "shape")
    elif fault not in GOES_ON[kind]:
        check(found, "InputError", r"hostile_|loaded from hostile\.so")
    else:
        warned = fault in REPORTED if kind == "with_material" else kind == "with_light" and fault != "none"
        check(found, "", (r"this light returned.*finite" if kind == "with_light" else r"\['.*finite") if warned else "")


@needs_plugin
@pytest.mark.parametrize("fault", CONFORM_FAULTS)
def test_conform_finds_a_plugin_that_fails(fault, outcomes):
    """A material without a surface, "null", obeys all laws."""
    check(outcomes[conform_call(fault)], "", "True" if fault == "null" else "False")


@needs_plugin
@pytest.mark.parametrize("call", INSTRUMENT_CALLS)
def test_an_instrument_names_a_plugin_that_throws(call, outcomes):
    check(outcomes[call], "InputError", r"loaded from hostile\.so")


@needs_plugin
@pytest.mark.parametrize("call", MEASURED)
def test_a_measurement_of_wrong_weights_is_an_error(call, outcomes):
    check(outcomes[call], "InputError", "has a defect")


#: Calls that last long. `session` has no cache.
LONG = {
    "render": 'frond.load("scene.pbrt", session=session).render(10**9)',
    "load": 'frond.loads(SCENE.replace("leaf_lambert", "leaf").replace(" 16 ", " 512 ", 2), swap="leaf,maxrms=0.0001",'
            ' samples=100000, session=session)',
    "render_python": '[frond.register_material("slow", python_bsdf(f=lambda *_: __import__("time").sleep(0.02) or 0.1),'
                     ' session=session), session.loads(SCENE.replace("leaf_lambert", "slow").replace(" 16 ", " 512 ", 2))'
                     '.render(10**6)]',
    "load_reflections": 'session.loads(ROOM)',
    "load_scatterings": 'session.loads(FOG)',
    "leaf_table": 'frond.leaf_table("leaf_solved", range(400, 2400), session=session)',
    "table": 'frond.table(specimen="maize", method="montecarlo", wavelengths=551, rays=10**9, output="t.csv",'
             ' session=session)',
    "spectrophotometer": 'frond.spectrophotometer("leaf_solved", range(400, 2400), rays=1000, session=session)',
    "goniophotometer": 'frond.goniophotometer("abm", 551, rays=10**12, session=session)',
    "integrate": 'frond.goniophotometer("leaf_solved", 551, patches=(2000, 4000), integrate=True, session=session)',
    "conform": 'conform("abm", samples=10**7)',
    "conform_python": 'conform(python_bsdf(), samples=10**6)',
    "conform_sweep": 'conform("leaf_solved", samples=20000, sweep=True)',
    "bench": 'frond.bench("abm", samples=10**12, session=session)',
    "bench_time": 'frond.bench("abm", min_time=0.3, repetitions=10000, session=session)',
    "export": 'frond.export("leaf_solved", format="osl", output="e.osl", rays=10**12, wavelengths=[600, 550, 450],'
              ' session=session)',
    "brf": 'frond.brf("scene.pbrt", paths=2**32, period=(2, 2), session=session)',
    "flux": 'frond.flux("scene.pbrt", paths=10**12, period=(2, 2), session=session)',
    "structure": 'frond.structure("scene.pbrt", rays=10**12, period=(2, 2), session=session)',
    "compare": 'frond.compare("scene.pbrt", spp=10**6, reference_spp=10**6, session=session)',
    "canopy": 'frond.canopy(output="c.npy", count=10**8, size=(1e5, 1e5), session=session)',
    "bsdf": 'frond.bsdf("abm", [551], session=session).sample(numpy.tile(numpy.float32([0, 0, 1]), (40_000_000, 1)))',
}
INTERRUPTED = SETTING + '''
import signal
signal.signal(signal.SIGINT, signal.default_int_handler)
print("ready", flush=True)
try:
    eval(sys.argv[1])
    print("ended", flush=True)
except KeyboardInterrupt:
    print("stopped", flush=True)
'''


def seconds_until_end(process):
    """Sends SIGINT. A process that does not end in time is killed."""
    process.send_signal(signal.SIGINT)
    start = time.monotonic()
    try:
        process.wait(ALLOWANCE_S)
    except subprocess.TimeoutExpired:
        process.kill()
        process.wait()
        pytest.fail(f"not ended {ALLOWANCE_S} s after SIGINT")
    return time.monotonic() - start


@pytest.mark.parametrize("name", LONG)
def test_ctrl_c_ends_a_long_call(name, tmp_path):
    with subprocess.Popen([sys.executable, "-c", INTERRUPTED, LONG[name]], stdout=subprocess.PIPE,
                          stderr=subprocess.DEVNULL, text=True, cwd=tmp_path, env=ENVIRONMENT) as process:
        assert process.stdout.readline() == "ready\n"
        time.sleep(1 if name == "bsdf" else 0.5)
        assert process.poll() is None, "the call is too short for this test: " + process.stdout.read()
        seconds_until_end(process)
        assert process.stdout.read() == "stopped\n"


@pytest.mark.parametrize("words", ["conform abm --samples 10000000",
                                   "render scene.pbrt --spp 1000000000 -o o.exr --checkpoint 100",
                                   "spectrophotometer abm --wavelengths 551 --rays 1e12"], ids=lambda w: w.split()[0])
def test_ctrl_c_ends_a_command(words, scene_text, tmp_path):
    (tmp_path / "scene.pbrt").write_text(scene_text)
    default = lambda: signal.signal(signal.SIGINT, signal.SIG_DFL)  # a background job inherits that SIGINT is ignored
    with subprocess.Popen([os.environ["FROND"], *words.split()], stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL,
                          cwd=tmp_path, preexec_fn=default) as process:
        time.sleep(0.5)
        assert process.poll() is None, "the command is too short for this test"
        seconds_until_end(process)
        assert process.returncode in (-signal.SIGINT, 130)
