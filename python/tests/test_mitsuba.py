"""The leaf in Mitsuba 3, run there for real; skipped where it, or an LLVM that it works with, is not installed. With
FROND_MITSUBA_BACKEND=cuda in the variants for NVIDIA's GPUs instead of llvm's."""

import os
import re
import sys

import numpy
import pytest

mitsuba = pytest.importorskip("mitsuba")
import frond

for path in ("/usr/lib/x86_64-linux-gnu/libLLVM-19.so", "/usr/lib/llvm-19/lib/libLLVM.so.1"):
    if "DRJIT_LIBLLVM_PATH" not in os.environ and os.path.exists(path):
        os.environ["DRJIT_LIBLLVM_PATH"] = path
BACKEND = os.environ.get("FROND_MITSUBA_BACKEND", "llvm")
if BACKEND == "llvm" and "DRJIT_LIBLLVM_PATH" not in os.environ:
    pytest.skip("libllvm19 is not installed: others of Debian 12 do not work with Mitsuba", allow_module_level=True)

RGB_NM = [608, 551, 455]


def variant(name):
    mitsuba.set_variant(name.replace("llvm", BACKEND))
    if "frond.mitsuba" in sys.modules:
        sys.modules["frond.mitsuba"].register()
    else:
        import frond.mitsuba
    import drjit
    return mitsuba, drjit


def directions(count, seed=1):
    w = numpy.random.default_rng(seed).normal(size=(2, count, 3))
    # None that is flatter than 89.4 degrees: floats of f along the leaf have few digits, and no meaning there.
    w[:, :, 2] = numpy.copysign(numpy.maximum(abs(w[:, :, 2]), 0.01 * numpy.linalg.norm(w, axis=2)), w[:, :, 2])
    return (w / numpy.linalg.norm(w, axis=2)[:, :, None]).astype(numpy.float32)


def evaluated(mi, dr, bsdf, wo, wi, nm=None):
    si = dr.zeros(mi.SurfaceInteraction3f, len(wo))
    si.wi = mi.Vector3f(wo.T)
    if nm is not None:
        si.wavelengths = type(si.wavelengths)(nm)
    value = bsdf.eval(mi.BSDFContext(), si, mi.Vector3f(wi.T))
    return numpy.array(value).reshape(-1, len(wo)).T / abs(wi[:, 2:])


@pytest.mark.parametrize("incident", ["traced", "light", "reciprocal"])
@pytest.mark.parametrize("specimen", ["soybean", "maize"])
def test_f_is_ours(specimen, incident):
    mi, dr = variant("llvm_ad_rgb")
    bsdf = mi.load_dict({"type": "frond_leaf", "specimen": specimen, "incident": incident})
    wo, wi = directions(20_000)
    expected = frond.bsdf(f"leaf_solved,specimen={specimen},incident={incident}", RGB_NM).f(wo, wi)
    difference = numpy.pi * (evaluated(mi, dr, bsdf, wo, wi) - expected)
    assert numpy.sqrt((difference**2).mean()) < 5e-4


def test_mono_and_spectral_variants():
    wo, wi = directions(5000)
    mi, dr = variant("llvm_ad_mono")
    bsdf = mi.load_dict({"type": "frond_leaf", "wavelengths": "800"})
    expected = frond.bsdf("leaf_solved", [800]).f(wo, wi)
    assert abs(numpy.pi * (evaluated(mi, dr, bsdf, wo, wi) - expected)).max() < 2e-3
    with pytest.raises(Exception, match="mono variants require"):
        mi.load_dict({"type": "frond_leaf"})
    mi, dr = variant("llvm_ad_spectral")
    bsdf = mi.load_dict({"type": "frond_leaf", "incident": "reciprocal"})
    nm = [450.0, 551.3, 620.0, 701.1]
    expected = frond.bsdf("leaf_solved,incident=reciprocal", nm).f(wo, wi)
    found = evaluated(mi, dr, bsdf, wo, wi, nm)
    assert numpy.sqrt(((numpy.pi * (found - expected)) ** 2).mean()) < 5e-4


@pytest.mark.parametrize("incident", ["traced", "reciprocal"])
@pytest.mark.parametrize("theta_deg", [8, 60, 105, 172])
def test_samples_follow_their_density(incident, theta_deg):
    """Mitsuba's own chi-square test."""
    mi, dr = variant("llvm_ad_rgb")
    from mitsuba.chi2 import BSDFAdapter, ChiSquareTest, SphericalDomain
    theta = numpy.radians(theta_deg)
    sample, pdf = BSDFAdapter("frond_leaf", f'<string name="incident" value="{incident}"/>',
                              wi=[float(numpy.sin(theta)), 0.0, float(numpy.cos(theta))])
    test = ChiSquareTest(domain=SphericalDomain(), sample_func=sample, pdf_func=pdf, sample_dim=3, sample_count=1_000_000,
                         res=101, ires=16)
    assert test.run(significance_level=1e-4)


@pytest.mark.parametrize("theta_deg", [8, 45, 172])
def test_reflectance_and_transmittance_are_ours(theta_deg):
    mi, dr = variant("llvm_ad_rgb")
    bsdf = mi.load_dict({"type": "frond_leaf"})
    count, theta = 1_000_000, numpy.radians(theta_deg)
    si = dr.zeros(mi.SurfaceInteraction3f, count)
    si.wi = mi.Vector3f(float(numpy.sin(theta)), 0, float(numpy.cos(theta)))
    random = mi.PCG32(count)
    bs, weight = bsdf.sample(mi.BSDFContext(), si, random.next_float32(),
                             mi.Point2f(random.next_float32(), random.next_float32()))
    weight, reflects = numpy.array(weight), numpy.array(bs.wo.z) * numpy.cos(theta) > 0
    for lane, nm in enumerate(RGB_NM):
        expected = frond.goniophotometer("leaf_solved", nm, theta_deg, patches=(40, 40), integrate=True)
        share = expected["f"][0, 0] * expected["projected_solid_angle_sr"]
        lit = (expected["theta_o_deg"] < 90) == (theta_deg < 90)
        for side, mask in ((lit, reflects), (~lit, ~reflects)):
            values = weight[lane] * mask
            error = values.std() / numpy.sqrt(count)
            assert abs(values.mean() - share[side].sum()) < 5 * error + 1e-4


def test_a_scalar_variant():
    """One direction at a time: means of a small image are those of the compiled variant."""
    world = {"type": "scene", "integrator": {"type": "path", "max_depth": 2}, "sky": {"type": "constant"}}
    means = {}
    for name in ("scalar_rgb", "llvm_ad_rgb"):
        mi, dr = variant(name)
        to_world = mi.ScalarTransform4f()
        film = {"type": "hdrfilm", "width": 16, "height": 16, "rfilter": {"type": "box"}}
        sensor = {"type": "orthographic", "to_world": to_world.look_at([0, 0, 3], [0, 0, 0], [0, 1, 0]), "film": film}
        scene = mi.load_dict({**world, "sensor": sensor, "leaf": {"type": "rectangle", "to_world": to_world.scale(2),
                                                                  "bsdf": {"type": "frond_leaf", "incident": "reciprocal"}}})
        pixels = numpy.array(mi.render(scene, spp=64))[:, :, :3].reshape(-1, 3)
        means[name] = pixels.mean(axis=0), pixels.std(axis=0) / numpy.sqrt(len(pixels))
    (a, ea), (b, eb) = means.values()
    assert (abs(a - b) < 5 * numpy.hypot(ea, eb)).all()


def test_gradients_by_chemistry():
    """Of f by each number: against finite differences of the plug-in, and of the leaf itself."""
    mi, dr = variant("llvm_ad_rgb")
    wo, wi = directions(64, seed=3)
    bsdf = mi.load_dict({"type": "frond_leaf", "incident": "reciprocal", "differentiable": True, "tolerance": 1e-4})
    params = mi.traverse(bsdf)
    context = mi.BSDFContext()
    si = dr.zeros(mi.SurfaceInteraction3f, len(wo))
    si.wi, direction = mi.Vector3f(wo.T), mi.Vector3f(wi.T)
    values = {"chlorophylla": 3.9775, "carotenoids": 1.1323, "thickness": 1.66e-4}
    for name, value in values.items():
        assert abs(params[name][0] / value - 1) < 1e-6
        dr.enable_grad(params[name])
        params.update()
        total = dr.sum(dr.mean(bsdf.eval(context, si, direction)))
        dr.backward(total)
        gradient = dr.grad(params[name])[0]
        dr.disable_grad(params[name])

        def mean(x):
            params[name] = mi.Float(x)
            params.update()
            return float(numpy.sum(numpy.mean(numpy.array(bsdf.eval(context, si, direction), dtype=numpy.float64), axis=0)))

        step = 0.002 * value  # within a cell of the table's depth
        difference = (mean(value + step) - mean(value - step)) / (2 * step)
        mean(value)

        def of_leaf(x):
            f = frond.bsdf(f"leaf_solved,incident=reciprocal,tolerance=1e-5,{name}={x!r}", RGB_NM).f(wo, wi)
            return float((f.astype(numpy.float64) * abs(wi[:, 2:])).mean(axis=1).sum())

        step = 0.05 * value
        exact = (of_leaf(value + step) - of_leaf(value - step)) / (2 * step)
        assert gradient < 0
        assert abs(gradient / difference - 1) < 0.02
        assert abs(gradient / exact - 1) < 0.05


def test_chemistry_by_textures():
    mi, dr = variant("llvm_ad_rgb")
    wo, wi = directions(2000)
    map_of_2 = {"type": "bitmap", "data": mi.TensorXf(numpy.full((4, 4, 1), 2.0)), "raw": True}
    bsdf = mi.load_dict({"type": "frond_leaf", "chlorophylla": map_of_2})
    expected = frond.bsdf("leaf_solved,chlorophylla=2", RGB_NM).f(wo, wi)
    difference = numpy.pi * (evaluated(mi, dr, bsdf, wo, wi) - expected)
    assert numpy.sqrt((difference**2).mean()) < 5e-4


def test_what_is_refused():
    mi, dr = variant("llvm_ad_rgb")
    with pytest.raises(Exception, match="soyabean"):
        mi.load_dict({"type": "frond_leaf", "specimen": "soyabean"})
    mi, dr = variant("scalar_spectral")
    with pytest.raises(Exception, match="JIT variants"):
        mi.load_dict({"type": "frond_leaf"})
    variant("llvm_ad_rgb")


SCENE = """Scale -1 1 1
LookAt 0 -5 3  0 0 0.5  0 0 1
Camera "perspective" "float fov" 30
Film "rgb" "integer xresolution" 48 "integer yresolution" 32
Sampler "lattice" "integer pixelsamples" 16
Integrator "path" "integer maxdepth" 6
PixelFilter "box"
WorldBegin
LightSource "distant" "point3 from" [ 1 -1 2 ] "point3 to" [ 0 0 0 ] "float scale" 3
LightSource "infinite" "rgb L" [ 0.4 0.5 0.7 ]
MakeNamedMaterial "leaf" "string type" "leaf_solved" "string incident" "reciprocal"
MakeNamedMaterial "paper" "string type" "diffusetransmission" "rgb reflectance" [ 0.5 0.3 0.2 ] "float scale" 1.2
ObjectBegin "card"
NamedMaterial "leaf"
Shape "trianglemesh" "integer indices" [ 0 1 2 1 3 2 ] "point3 P" [ -0.5 0 0  0.5 0 0  -0.5 0.3 1  0.5 0.3 1 ]
ObjectEnd
NamedMaterial "paper"
Shape "disk" "float radius" 2.5
AttributeBegin
Translate -0.6 0 0.1
ObjectInstance "card"
AttributeEnd
AttributeBegin
Translate 0.6 0 0.1
Rotate 200 0 0 1
ObjectInstance "card"
AttributeEnd
"""


@pytest.mark.parametrize("name", ["llvm_ad_rgb", "scalar_rgb"])
def test_an_exported_scene_is_the_same_image(name, tmp_path):
    """Means of the image, in three colours: a difference of 4.5 standard errors fails. The chance of a false alarm is 2e-5."""
    mi, dr = variant(name)
    (tmp_path / "scene.pbrt").write_text(SCENE)
    frond.export(str(tmp_path / "scene.pbrt"), format="mitsuba", output=str(tmp_path / "out"))
    scene = mi.load_file(str(tmp_path / "out" / "scene.xml"))
    samples = 128 if name == "llvm_ad_rgb" else 8
    theirs = [numpy.array(mi.render(scene, spp=samples, seed=s), dtype=numpy.float64)[:, :, :3] for s in (1, 2)]
    ours = [frond.load(tmp_path / "scene.pbrt", wavelengths="smpte", seed=s).render(128).rgb.astype(numpy.float64) for s in (1, 2)]
    difference = (sum(theirs) - sum(ours)).mean((0, 1)) / 2
    # The difference of two renders estimates each pixel's variance.
    error = numpy.sqrt(sum((a - b) ** 2 / 4 for a, b in (ours, theirs)).sum((0, 1))) / ours[0][:, :, 0].size
    assert (error < 0.01 * sum(ours).mean()).all()
    assert (abs(difference) < 4.5 * error).all()


@pytest.mark.parametrize("old, new, message", [
    ('Camera "perspective" "float fov" 30', 'Camera "spherical"', "camera .spherical. has no equivalent"),
    ('"leaf_solved" "string incident" "reciprocal"', '"coateddiffuse"', "coateddiffuse.* has no equivalent.*--swap"),
    ('"float radius" 2.5', '"float radius" 2.5 "float phimax" 90', "part of a disk has no equivalent"),
])
def test_an_export_refuses_what_mitsuba_lacks(old, new, message, tmp_path):
    (tmp_path / "scene.pbrt").write_text(SCENE.replace(old, new))
    with pytest.raises(frond.InputError, match=message):
        frond.export(str(tmp_path / "scene.pbrt"), format="mitsuba", output=str(tmp_path / "out"))
    assert not (tmp_path / "out" / "scene.xml").exists()


def test_an_export_reports_all_obstacles_and_can_approximate_them(tmp_path):
    """The sun and the sky of `sky`, and the mean of a checkerboard: mean radiances within 1 %, far above the noise."""
    mi, dr = variant("llvm_ad_rgb")
    text = re.sub('LightSource "distant".*\n', 'LightSource "sky" "float elevation" 50 "float illuminance" 3\n', SCENE)
    text = text.replace('MakeNamedMaterial "paper"', 'Texture "t" "spectrum" "checkerboard" "float uscale" 8 "float vscale" 8\nMakeNamedMaterial "paper"')
    text = text.replace('"diffusetransmission" "rgb reflectance" [ 0.5 0.3 0.2 ] "float scale" 1.2', '"diffuse" "texture reflectance" "t"')
    (tmp_path / "scene.pbrt").write_text(text)
    with pytest.raises(frond.InputError, match="(?s)checkerboard.*light .sky. has no equivalent"):
        frond.export(str(tmp_path / "scene.pbrt"), format="mitsuba", output=str(tmp_path / "out"))
    assert not (tmp_path / "out").exists()
    frond.export(str(tmp_path / "scene.pbrt"), format="mitsuba", output=str(tmp_path / "out"), ignore_unsupported="all")
    theirs = numpy.array(mi.render(mi.load_file(str(tmp_path / "out" / "scene.xml")), spp=128))[:, :, :3]
    plain = text.replace('"texture reflectance" "t"', '"float reflectance" 0.5')
    (tmp_path / "plain.pbrt").write_text(plain.replace('"float reflectance" 0.5', '"rgb reflectance" [ 0.5 0.5 0.5 ]'))
    ours = frond.load(tmp_path / "plain.pbrt", wavelengths="smpte").render(128).rgb
    assert (abs(theirs.mean((0, 1)) / ours.mean((0, 1)) - 1) < 0.01).all()


@pytest.mark.parametrize("scene, output, message", [
    (None, "out.exr", "scene.xml.*does not exist"),
    ('<scene version="3.0.0"><shape type="none"/></scene>', "out.exr", "line 1, col 25"),
    ('<scene version="3.0.0"/>', "out.tif", "the name ends in .exr, .png or .jpg"),
    ('<scene version="3.0.0"/>', "none/out.exr", "there is no folder"),
])
def test_the_command_reports_invalid_input(scene, output, message, tmp_path, capsys):
    variant("llvm_ad_rgb")
    if scene:
        (tmp_path / "scene.xml").write_text(scene)
    with pytest.raises(SystemExit) as ended:
        sys.modules["frond.mitsuba"].main([str(tmp_path / "scene.xml"), "-o", str(tmp_path / output)])
    assert ended.value.code != 0
    assert re.search(message, capsys.readouterr().err)
