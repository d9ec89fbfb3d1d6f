"""Mitsuba 3: ten exported scenes there and in frond (section "mitsuba_scenes" of docs/other_renderers.md)

Exports the scenes by frond export --format mitsuba, and installs what the measurement mitsuba installs.
  --gpu     with Mitsuba's variant for NVIDIA's GPUs, and the section "mitsuba_gpu"
  --quick   few samples, into build/mitsuba_scenes_report
"""

import re
import statistics
import time

import numpy

import mitsuba as mi

OPTIONS = arguments("mitsuba_scenes", ("--gpu", {"action": "store_true"}))
VARIANT = "cuda_ad_rgb" if OPTIONS.gpu else "llvm_ad_rgb"
try:
    mi.set_variant(VARIANT)
except ImportError as error:
    raise SystemExit(f"--gpu needs an NVIDIA GPU and its driver: {error}" if OPTIONS.gpu else error)

import frond
import frond.mitsuba

from .shared.tools import ROOT, arguments, machine, program, run, table, write_section

FOLDER = ROOT / "build" / "mitsuba_scenes"
SIZE, BLOCKS = 128, 4
# Samples of a pixel that Mitsuba renders at a time, because a wavefront holds all of them.
AT_ONCE = 2048 if OPTIONS.gpu else 256
RENDERS = 3  # of each program and kind; the median of their times counts

# Scenes of the repository, with a smaller film and a box filter, and the samples per pixel of each of two renders.
OF_REPOSITORY = {"soybean-front/scene": 512, "soybean-back/scene": 1024, "soybean-ambient/scene": 512,
                 "hundred-leaves/closed": 256, "furnace/transmission": 256}

HEAD = """{space}
LookAt {look}
Camera {camera}
Film "rgb" "integer xresolution" {width} "integer yresolution" {height} {film}
Sampler "lattice" "integer pixelsamples" 16
Integrator "path" "integer maxdepth" 12
PixelFilter "box"
WorldBegin
"""
FLOOR = """
MakeNamedMaterial "grey" "string type" "diffuse" "rgb reflectance" [ 0.5 0.45 0.3 ]
NamedMaterial "grey"
Shape "trianglemesh" "integer indices" [ 0 1 2 0 2 3 ] "point3 P" [ -6 -6 0  6 -6 0  6 6 0  -6 6 0 ]
"""
SUN = 'LightSource "distant" "point3 from" [ 1 -1 2 ] "point3 to" [ 0 0 0 ] "blackbody L" 5000 "float scale" 3\n'


def head(look="0 -5 3  0 0 0.6  0 0 1", camera='"perspective" "float fov" 38', width=SIZE, height=SIZE, film="", mirrored=True):
    return HEAD.format(space="Scale -1 1 1" if mirrored else "", look=look, camera=camera, width=width, height=height, film=film)


# Scenes made for features that those of the repository do not have.
MADE = {
    "images": (256, head() + SUN + """
LightSource "infinite" "rgb L" [ 0.4 0.5 0.7 ]
Texture "colours" "spectrum" "imagemap" "string filename" "colours.png" "float uscale" 1.5 "float vdelta" 0.2
Texture "holes" "float" "imagemap" "string filename" "holes.png" "string filter" "point"
""" + FLOOR + """
Material "diffuse" "texture reflectance" "colours"
Shape "bilinearmesh" "point3 P" [ -1.6 0.3 0.1  -0.1 0 0.1  -1.6 0.3 1.9  -0.1 0 1.9 ]
Material "diffuse" "rgb reflectance" [ 0.7 0.2 0.2 ]
Shape "bilinearmesh" "point3 P" [ 0.1 0 0.1  1.6 0.3 0.1  0.1 0 1.9  1.6 0.3 1.9 ] "texture alpha" "holes"
"""),
    "camera": (256, head(camera='"perspective" "float fov" 50 "float screenwindow" [ -0.9 1.5 -0.4 0.8 ]', width=160, height=80,
                          film='"integer pixelbounds" [ 16 144 8 72 ] "float iso" 150', mirrored=False) + """
LightSource "spot" "point3 from" [ -1 -2 4 ] "point3 to" [ 0 0 0 ] "rgb I" [ 30 25 20 ] "float coneangle" 25 "float conedeltaangle" 0
LightSource "point" "point3 from" [ 2 -1 3 ] "rgb I" [ 4 6 9 ]
""" + FLOOR + """
AttributeBegin
Translate -1 0.5 0.8
AreaLightSource "diffuse" "rgb L" [ 2 3 4 ]
Shape "sphere" "float radius" 0.3
AttributeEnd
AttributeBegin
Translate 0.8 0 0
Rotate 20 0 1 0
ReverseOrientation
Shape "cylinder" "float radius" 0.4 "float zmin" 0 "float zmax" 1.2
AttributeEnd
"""),
    "orthographic": (256, head(camera='"orthographic" "float screenwindow" [ -2.2 1.8 -1.5 2.5 ]') + """
LightSource "infinite" "rgb L" [ 0.8 0.9 1 ]
AttributeBegin
Translate 0 0 4
ReverseOrientation
AreaLightSource "diffuse" "rgb L" [ 9 8 7 ]
Shape "disk" "float radius" 1
AttributeEnd
""" + FLOOR + """
MakeNamedMaterial "gold" "string type" "conductor" "spectrum eta" "metal-Au-eta" "spectrum k" "metal-Au-k"
MakeNamedMaterial "red" "string type" "diffuse" "rgb reflectance" [ 0.6 0.1 0.1 ]
MakeNamedMaterial "mixed" "string type" "mix" "string materials" [ "grey" "red" ] "float amount" 0.3
MakeNamedMaterial "pane" "string type" "thindielectric" "float eta" 1.5
AttributeBegin
Translate -0.9 0 0.6
NamedMaterial "gold"
Shape "sphere" "float radius" 0.5
Translate -0.3 1 0
NamedMaterial "mixed"
Shape "sphere" "float radius" 0.4
AttributeEnd
AttributeBegin
Translate 0.9 0 0.6
Material "dielectric" "float eta" 1.4
Shape "sphere" "float radius" 0.5
AttributeEnd
NamedMaterial "pane"
Shape "bilinearmesh" "point3 P" [ -0.6 -0.8 0.1  0.6 -0.8 0.1  -0.6 -0.8 1.4  0.6 -0.8 1.4 ]
"""),
    "instances": (256, head() + SUN + 'LightSource "infinite" "rgb L" [ 0.4 0.5 0.7 ]\n' + FLOOR + """
MakeNamedMaterial "leaf" "string type" "leaf_lambert" "string specimen" "maize"
ObjectBegin "blade"
NamedMaterial "leaf"
Shape "trianglemesh" "integer indices" [ 0 1 2 1 3 2 ] "point3 P" [ 0 0 0  0.3 0 0  0 0.1 0.8  0.3 0.1 0.8 ]
ObjectEnd
ObjectBegin "plant"
ObjectInstance "blade"
AttributeBegin
Rotate 120 0 0 1
ObjectInstance "blade"
AttributeEnd
AttributeBegin
Rotate 240 0 0 1
Scale -1 1 1.3
ObjectInstance "blade"
AttributeEnd
ObjectEnd
AttributeBegin
Translate 0.2 -1 0
ObjectInstance "plant"
AttributeEnd
Shape "instances" "string object" "plant" "string filename" "plants.npy"
"""),
    "sky": (256, head() + 'LightSource "infinite" "string filename" "sky.exr" "float scale" 1.5\n' + FLOOR + """
Translate 0 0 0.8
Shape "sphere" "float radius" 0.8
"""),
}

SECTION = """### Agreement of exported scenes

Measured by `measurements/run mitsuba_scenes` on {machine}; Mitsuba {version}, `llvm_ad_rgb`. Each scene is exported, rendered with a box
filter at {size} x {size} pixels by both programs with two seeds, and compared in linear colour; frond renders with
`--wavelengths smpte` and `--swap "*=leaf_solved"` on all cores. `mean` is the relative difference of the image's mean, averaged over
the colours. `standard error` is its standard error, from the two renders by each program. `blocks` is the largest difference of
{blocks} block means and colours in their standard errors: {expected} is exceeded once in twenty scenes by chance. Times are wall-clock
times of a render, without loading: the median of {renders} after a first one, which compiles. `efficiency` is that of Mitsuba relative
to frond: efficiency is 1 / (variance x time).

{table}
{notes}
"""

ON_GPU = """### The same scenes on a GPU

Measured by `measurements/run mitsuba_scenes --gpu` in the same way: Mitsuba {version}, `cuda_ad_rgb` on {gpu}; frond on {machine}.

{table}
"""

NOTES = """The last five scenes were made for this comparison: `images` (reflectance, alpha), `camera` (screen window, crop, exposure, left-handed
space, spot and point light, sphere as a light), `orthographic` (metal, glass, pane, mixture of diffuse materials), `instances`
(nested, mirrored, from a table), `sky` (image light). Three scenes differ by more than noise:

- `images`: Mitsuba interpolates between reflectances, frond between colours before it converts them. With `"string filter" "point"` the
  difference is within noise.
- `sky`: Mitsuba's map by latitude and longitude has sampled the image again, whose texels have random colours here.
- `soybean-back`: with 4096 samples the difference is +0.21 % ± 0.03 %. Mitsuba begins a ray 9e-5 of the coordinates away from the
  surface, frond 8e-6. In the valleys of a curved leaflet the longer offset carries rays at grazing angles past the neighbouring
  triangles. A build of frond with an offset 12 times as long differs from frond by +0.21 % as well (+0.12, +0.08, +0.42 % in red,
  green, blue); one with a quarter of the offset by -0.01 % ± 0.01 %. With `diffusetransmission` for the leaves, whose light at
  grazing angles is weak, the difference is +0.02 % ± 0.01 %.

`soybean-front` differs by two to three standard errors in different runs: 0.02 % is the limit of what these renders resolve."""


def make_files(folder):
    """Writes the images and the table that the scenes name."""
    random = numpy.random.default_rng(1)
    image = lambda name, values: mi.Bitmap((255 * values).astype(numpy.uint8)).write(str(folder / name))
    image("colours.png", random.random((8, 8, 3)))
    image("holes.png", (random.random((8, 8, 1)) > 0.4).astype(float))
    sky = random.random((32, 32, 3)).astype(numpy.float32)
    mi.Bitmap(sky + 5 * (random.random((32, 32, 1)) > 0.97).astype(numpy.float32)).write(str(folder / "sky.exr"))
    maps = numpy.zeros((12, 3, 4), numpy.float32)
    maps[:, [0, 1, 2], [0, 1, 2]] = random.uniform(0.6, 1.4, (12, 1))
    maps[:, :2, 3] = random.uniform(-2, 2, (12, 2))
    numpy.save(folder / "plants.npy", maps)


def scene_files(folder):
    """Yields name, file and samples of each scene."""
    for name, samples in OF_REPOSITORY.items():
        text = (ROOT / f"scenes/{name}.pbrt").read_text(encoding="utf-8")
        text = re.sub(r'"integer (x|y)resolution" \d+', rf'"integer \1resolution" {SIZE}', text)
        text = re.sub(r"^WorldBegin", 'PixelFilter "box"\nWorldBegin', text, flags=re.MULTILINE)
        text = re.sub(r'Include "', f'Include "{(ROOT / "scenes" / name).parent}/', text)
        file = folder / f"{name.replace('/', '-')}.pbrt"
        file.write_text(text, encoding="utf-8")
        yield name.removesuffix("/scene"), file, samples
    make_files(folder)
    for name, (samples, text) in MADE.items():
        file = folder / f"{name}.pbrt"
        file.write_text(text, encoding="utf-8")
        yield name, file, samples


def sums(pixels, blocks):
    """Sums over blocks x blocks rectangles of pixels, for each colour."""
    rows, columns = (numpy.array_split(numpy.arange(n), blocks) for n in pixels.shape[:2])
    return numpy.array([[pixels[numpy.ix_(r, c)].sum((0, 1)) for c in columns] for r in rows])


def timed(render):
    """Images of two seeds, and the median time of a render with loaded scene, after a first one, which compiles."""
    render(0)
    images, times = [], []
    for seed in range(1, RENDERS + 1):
        start = time.perf_counter()
        images.append(render(seed))
        times.append(time.perf_counter() - start)
    return images[:2], statistics.median(times)


def compare(file, samples):
    """Renders by both programs. Returns the relative difference of the means, its standard error, the largest difference of a
    block in its standard errors, and of each program the time of a render and its variance, a mean over pixels and colours."""
    folder = FOLDER / file.stem
    program("export", file, "--format", "mitsuba", "-o", folder)
    exported = folder / "scene.xml"
    swap = {"*": "leaf_solved"} if "frond_leaf" in exported.read_text(encoding="utf-8") else None
    scene = mi.load_file(str(exported))
    parts = max(1, samples // AT_ONCE)

    sessions = [frond.load(file, wavelengths="smpte", swap=swap, seed=seed) for seed in range(RENDERS + 1)]

    def frond_image(seed):
        return sessions[seed].render(samples).rgb.astype(numpy.float64)

    def mitsuba_image(seed):
        images = (mi.render(scene, spp=samples // parts, seed=1000 * seed + part) for part in range(parts))
        return sum(numpy.array(image)[:, :, :3].astype(numpy.float64) for image in images) / parts

    (ours, our_time), (theirs, their_time) = timed(frond_image), timed(mitsuba_image)
    difference = (sum(theirs) - sum(ours)) / 2
    # Pixels are independent; the difference of two renders estimates each pixel's variance.
    our_variance, their_variance = ((a - b) ** 2 / 4 for a, b in (ours, theirs))
    variance = our_variance + their_variance
    of_blocks = sums(difference, BLOCKS) / numpy.sqrt(numpy.maximum(sums(variance, BLOCKS), 1e-30))
    noisy = sums(variance, BLOCKS) > 0  # blocks that see the sky alone have neither noise nor a difference
    mean = sum(ours).mean((0, 1)) / 2
    relative = difference.mean((0, 1)) / mean
    error = numpy.sqrt(variance.sum((0, 1))) / variance[:, :, 0].size / mean
    # Colours of a path are correlated: the mean of their errors is an upper bound of the error of their mean.
    return (relative.mean(), error.mean(), abs(of_blocks[noisy]).max(), (our_time, our_variance.mean()),
            (their_time, their_variance.mean()))


def main():
    FOLDER.mkdir(parents=True, exist_ok=True)
    mi.set_log_level(mi.LogLevel.Error)
    rows = []
    for name, file, samples in scene_files(FOLDER):
        difference, error, blocks, ours, theirs = compare(file, 64 if OPTIONS.quick else samples)
        # In the furnace frond has no noise.
        efficiency = f"{ours[0] * ours[1] / (theirs[0] * theirs[1]):.2g}" if ours[1] > 1e-6 * theirs[1] else ""
        rows.append([f"`{name}`", f"{100 * difference:+.3f} %", f"{100 * error:.3f} %", f"{difference / error:+.1f}", f"{blocks:.1f}",
                     f"{ours[0]:.2f} s", f"{theirs[0]:.3f} s", efficiency])
        print(rows[-1], flush=True)
    head = ["scene", "mean", "standard error", "mean in standard errors", "blocks", "frond", "Mitsuba", "efficiency"]
    common = {"machine": machine(), "version": mi.__version__, "table": table(head, rows)}
    page = OPTIONS.docs / "other_renderers.md"
    if OPTIONS.gpu:
        gpu = run("nvidia-smi", "--query-gpu=name", "--format=csv,noheader").splitlines()[0]
        return write_section(page, "mitsuba_gpu", ON_GPU.format(gpu=gpu, **common), script="mitsuba_scenes")
    count = BLOCKS * BLOCKS * 3
    expected = statistics.NormalDist().inv_cdf(1 - (1 - 0.95 ** (1 / count)) / 2)
    write_section(page, "mitsuba_scenes", SECTION.format(size=SIZE, blocks=f"{BLOCKS} x {BLOCKS}", renders=RENDERS,
                                                         expected=f"{expected:.1f}", notes=NOTES, **common))


if __name__ == "__main__":
    main()
