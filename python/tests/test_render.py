import logging
import os
import pathlib
import signal
import subprocess
import sys
import threading
import time

import frond
import numpy
import pytest


def test_an_image_is_that_of_the_command(scene_text, tmp_path):
    (tmp_path / "scene.pbrt").write_text(scene_text)
    image = frond.load(tmp_path / "scene.pbrt", wavelengths="smpte").render(4)
    image.save(tmp_path / "module.exr")
    command = [os.environ["FROND"], "render", "scene.pbrt", "--spp", "4", "--wavelengths", "smpte", "-o", "command.exr", "-q"]
    subprocess.run(command, cwd=tmp_path, check=True)
    (names, ours), (_, theirs) = (frond.read_image(tmp_path / f"{name}.exr") for name in ("module", "command"))
    assert numpy.array_equal(ours, theirs)
    assert numpy.array_equal(ours[:, :, names.index("G")], image["G"])


def test_parts_that_are_not_read_are_named(caplog):
    parts = pathlib.Path(__file__).resolve().parents[2] / "tests" / "public" / "exr-parts" / "parts.exr"
    with caplog.at_level(logging.WARNING, "frond"):
        names, values = frond.read_image(parts)
    assert (list(names), values.shape) == (["R", "G", "B"], (2, 2, 3))
    assert "2 are left out: \"depth\", \"diffuse_of_leaves\"" in caplog.text


def test_channels_and_arrays(scene_text):
    image = frond.loads(scene_text, channels=["normal", "depth"]).render(4)
    assert image.array.shape == (16, 16, len(image.channels))
    assert image.array.dtype == numpy.float32
    assert numpy.array_equal(image["G"], image.rgb[:, :, 1])
    assert image.variance.shape == (16, 16, 3)
    assert image.samples == (4, 4)
    with pytest.raises(KeyError, match="no channel 'Q': there are R, G, B"):
        image["Q"]


def test_what_a_denoiser_needs(scene_text, tmp_path):
    image = frond.loads(scene_text, for_denoiser=True).render(4)
    assert image["albedo"].shape == image["normal"].shape == image.rgb.shape == (16, 16, 3)
    assert numpy.array_equal(image["albedo"][:, :, 1], image["albedo.G"])
    assert 0 < image["albedo"].max() <= 1
    assert "frond:correlated_pixels" not in image.attributes
    with pytest.raises(KeyError, match="no channel 'albed'"):
        image["albed"]


def test_colours_of_another_program_are_written(scene_text, tmp_path):
    image = frond.loads(scene_text, wavelengths="smpte").render(4)
    image.save(tmp_path / "a.exr")
    frond.write_image(tmp_path / "b.exr", image.rgb[:, ::-1], like=tmp_path / "a.exr")
    names, pixels = frond.read_image(tmp_path / "b.exr")
    assert sorted(names) == ["B", "G", "R"]
    assert numpy.array_equal(pixels[:, :, names.index("G")], image["G"][:, ::-1])
    data = (tmp_path / "b.exr").read_bytes()
    assert b"linear SMPTE-C" in data and b"frond:scene_hash" in data and b"frond:correlated_pixels" not in data
    frond.write_image(tmp_path / "a.png", image.rgb.astype(float), color_space=image.color_space)
    frond.convert([tmp_path / "a.exr"], output=tmp_path / "c.png")
    ours, theirs = (frond.read_image(tmp_path / f"{name}.png")[1] for name in "ac")
    assert numpy.array_equal(ours, theirs)
    frond.write_image(tmp_path / "d.exr", image.rgb)
    assert b"linear sRGB" in (tmp_path / "d.exr").read_bytes()
    with pytest.raises(ValueError, match=r"\[row\]\[column\]\[3\] is needed"):
        frond.write_image(tmp_path / "e.exr", image["G"])
    with pytest.raises(frond.InputError, match="unknown color space"):
        frond.write_image(tmp_path / "e.exr", image.rgb, color_space="nonsense")
    assert not (tmp_path / "e.exr").exists()


def test_an_image_goes_on(scene_text):
    scene = frond.loads(scene_text)
    whole, pieces = scene.render(8), scene.render(3)
    pieces.render_more(8)
    assert numpy.array_equal(whole.array, pieces.array)
    with pytest.warns(UserWarning, match="has 8 samples already, 4 in total"):
        pieces.render_more(4)


def test_bands_have_no_colours(scene_text):
    image = frond.loads(scene_text, wavelengths=[551, 800]).render(4)
    assert image.color_space == ""
    with pytest.raises(ValueError, match="this image has bands, not colours: "):
        _ = image.rgb
    assert any("800" in name for name in image.channels)


def test_swap_and_pixels(scene_text):
    one = frond.loads(scene_text, swap="leaf_lambert,specimen=maize", pixels=(0, 8, 0, 4))
    assert one.materials[-1] == ("leaf", "leaf_lambert")
    assert one.render(1).array.shape[:2] == (4, 8)
    with pytest.raises(frond.InputError, match="pixels 30,40,0,1 holds no pixel of the 16 x 16 film"):
        frond.loads(scene_text, pixels=(30, 40, 0, 1))


def test_adaptive(scene_text):
    scene = frond.loads(scene_text, adaptive=True)
    assert scene.render(max_rms=0.02).samples[0] >= 32
    assert scene.render(100, max_rms=1e-9).samples == (100, 100)
    image = scene.render(48)
    image.render_more(max_rms=1e-9, samples=70)
    assert image.samples == (70, 70)
    with pytest.raises(frond.InputError, match="at least 32 samples"):
        scene.render(16, max_rms=0.1)
    with pytest.raises(ValueError, match="adaptive=True"):
        frond.loads(scene_text).render(max_rms=0.02)


def test_an_open_leaf_is_chosen(scene_text):
    scene = frond.loads(scene_text.replace("leaf_solved", "leaf"))
    assert scene.choice is not None


def test_errors_have_a_place(scene_text, tmp_path):
    path = tmp_path / "scene.pbrt"
    path.write_text(scene_text.replace("bilinearmesh", "bilinearmess").replace("orthographic", "ortographic"))
    with pytest.raises(frond.InputError, match="orthographic") as caught:
        frond.load(path)
    error = caught.value
    assert error.file == str(path) and error.line == 2 and error.column > 1
    path.write_text(scene_text.replace("WorldBegin", "Wordl").replace("NamedMaterial \"leaf\"", "NamedMaterial leaf"))
    with pytest.raises(frond.InputError) as caught:
        frond.load(path)
    assert len(caught.value.problems) >= 2
    assert isinstance(error, ValueError)
    with pytest.raises(frond.InputError, match="nowhere.pbrt"):
        frond.load(tmp_path / "nowhere.pbrt")


def test_messages_go_to_logging(scene_text, caplog):
    with caplog.at_level(logging.INFO, logger="frond"):
        frond.loads(scene_text)
    assert any("mode table" in record.getMessage() for record in caplog.records)


def test_progress_is_told_and_may_throw(scene_text):
    told = []
    frond.loads(scene_text).render(16, progress=told.append)
    assert told[-1] == 1

    def throws(share):
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        frond.loads(scene_text).render(200_000, progress=throws)


def test_the_lock_is_free_while_rendering(scene_text):
    """Another thread of Python goes on meanwhile."""
    scene, count, over = frond.loads(scene_text), [0], threading.Event()

    def work():
        while not over.is_set():
            count[0] += 1
            time.sleep(0.001)

    thread = threading.Thread(target=work)
    thread.start()
    before = count[0]
    scene.render(4_000)
    during = count[0] - before
    over.set()
    thread.join()
    assert during > 5


def test_ctrl_c_ends_a_render(scene_text):
    scene, code = frond.loads(scene_text), (
        "import sys, frond; scene = frond.loads(sys.argv[1]); print('ready', flush=True)\n"
        "try: scene.render(100_000_000)\n"
        "except KeyboardInterrupt: print('stopped', flush=True)\n")
    environment = dict(os.environ, PYTHONPATH=os.pathsep.join(sys.path))
    process = subprocess.Popen([sys.executable, "-c", code, scene_text], stdout=subprocess.PIPE, text=True, env=environment)
    assert process.stdout.readline() == "ready\n"
    time.sleep(0.5)
    process.send_signal(signal.SIGINT)
    assert process.stdout.read() == "stopped\n"
    assert process.wait() == 0


def test_two_sessions_side_by_side(scene_text):
    one, two = frond.Session(threads=1, cache=False), frond.Session(threads=2, cache=False)
    images = [session.loads(scene_text).render(4).array for session in (one, two)]
    assert one.threads == 1 and two.threads == 2
    assert numpy.array_equal(*images)


def test_a_plugin_from_a_shared_object():
    session = frond.Session(cache=False, plugins=[os.environ["FROND_TEST_PLUGIN"]])
    assert "wrong_pdf" in session.names("material")
    assert not frond.conform("wrong_pdf", session=session)["all_hold"]
    assert "wrong_pdf" not in frond.Session(cache=False).names("material")


@pytest.mark.skipif("libasan" in os.environ.get("LD_PRELOAD", ""), reason="AddressSanitizer keeps freed memory")
def test_nothing_is_left_behind(scene_text):
    """Memory after many renders is what it was after some."""
    def resident():
        with open("/proc/self/statm", encoding="ascii") as file:
            return int(file.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")

    scene = frond.loads(scene_text)

    def renders(count):
        for _ in range(count):
            scene.render(1).array.sum()

    renders(100)
    before = resident()
    renders(400)
    assert resident() - before < 8e6  # an image and its film are 40 kB


def test_import_brings_nothing_along():
    code = "import sys, frond; print([m for m in ('numpy', 'pandas') if m in sys.modules])"
    environment = dict(os.environ, PYTHONPATH=os.pathsep.join(sys.path))
    found = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True, env=environment)
    assert found.stdout == "[]\n"
