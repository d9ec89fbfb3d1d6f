"""Renders on a full disk, in a read-only folder, with an input that changes, with a second render of the same output, or killed at any
time: each reports its error and leaves no incomplete file."""

import contextlib
import errno
import json
import os
import random
import resource
import shutil
import struct
import subprocess
import time
import unittest
from pathlib import Path

from frond_program import FROND, SCENE, SLOW, FrondTest, part_header

OLD = b"an old file"
BANDS = "bands,lambdamin=400,lambdamax=800,step=10"  # makes parts of more than a megabyte

SCENE_WITH_WARNING = SCENE.replace("WorldBegin", 'Option "bool forcediffuse" true\nWorldBegin')

TRIANGLE = """ply
format ascii 1.0
element vertex 3
property float x
property float y
property float z
element face 1
property list uchar int vertex_indices
end_header
-1 0 0
1 0 0
0 {} 0
3 0 1 2
"""


def temporaries(folder):
    return [path.name for path in folder.iterdir() if path.name.endswith(".tmp")]


def limit_files(size):
    """For preexec_fn: no file grows past `size` bytes."""
    return lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))


def warning_of(process):
    """The next warning that a running program prints."""
    return next((line for line in process.stderr if "warning" in line), "")


class FullDisk(FrondTest):
    """By a limit on the size of files, and, where the test may mount one, on a file system that is full."""

    def check_failure(self, err, path, reason):
        self.assertIn(str(path), err)
        self.assertIn(os.strerror(reason), err)
        self.assertEqual(temporaries(path.parent), [])

    def small_file_system(self, size):
        place = self.folder / "small"
        place.mkdir()
        mounted = subprocess.run(
            ["mount", "-t", "tmpfs", "-o", f"size={size}", "frond_test", str(place)], capture_output=True, check=False
        )
        if mounted.returncode != 0:
            self.skipTest("nothing can be mounted here")
        self.addCleanup(subprocess.run, ["umount", str(place)], check=True)
        return place

    def test_an_image_that_does_not_fit_leaves_the_old_one(self):
        image = self.folder / "a.exr"
        image.write_bytes(OLD)
        _, err = self.run_to_end(self.command(image, "-q"), 1, preexec_fn=limit_files(4096))
        self.check_failure(err, image, errno.EFBIG)
        self.assertEqual(image.read_bytes(), OLD)

    def test_a_part_that_does_not_fit_leaves_the_old_one(self):
        command = self.command("x")
        place = command.index("-o")
        command[place : place + 2] = ["--part", str(self.folder / "a.part")]
        _, err = self.run_to_end(command + ["--samples", "0:4", "-q"], 1, preexec_fn=limit_files(4096))
        self.check_failure(err, self.folder / "a.part", errno.EFBIG)
        self.assertEqual(self.files(), ["scene.pbrt"])
        self.run_to_end(command + ["--samples", "0:4", "-q"])
        before = (self.folder / "a.part").read_bytes()
        self.run_to_end(command + ["--samples", "0:8", "--resume", "-q"], 1, preexec_fn=limit_files(4096))
        self.assertEqual((self.folder / "a.part").read_bytes(), before)

    def test_a_merged_image_that_does_not_fit_leaves_the_old_one(self):
        image, part = self.folder / "a.exr", self.folder / "a.part"
        self.run_to_end([FROND, "render", str(self.scene), "--no-cache", "--part", str(part), "-q"])
        image.write_bytes(OLD)
        for target in (["-o", str(image)], ["--part", str(image)]):
            _, err = self.run_to_end([FROND, "merge", str(part), *target, "-q"], 1, preexec_fn=limit_files(4096))
            self.check_failure(err, image, errno.EFBIG)
            self.assertEqual(image.read_bytes(), OLD)

    def test_a_checkpoint_that_does_not_fit_is_a_warning(self):
        image = self.folder / "a.exr"
        words = ("--wavelengths", BANDS, "--spp", self.samples_in(0.5))
        self.run_to_end(self.command(image, *words, "-q"))
        expected = image.read_bytes()
        image.unlink()
        limit = max(len(expected) + 4096, 1 << 16)
        command = self.command(image, *words, "--checkpoint", 0.05)
        _, err = self.run_to_end(command, preexec_fn=limit_files(limit))
        self.assertIn("no checkpoint was written", err)
        self.assertIn(os.strerror(errno.EFBIG), err)
        self.assertEqual(image.read_bytes(), expected)
        # One from the beginning, when little had been rendered, may have fitted: then it is whole.
        if "a.exr.part" in self.files():
            self.run_to_end(command + ["--resume", "-q"])
            self.assertEqual(image.read_bytes(), expected)
            (self.folder / "a.exr.part").unlink()
        self.assertEqual(self.files(), ["a.exr", "scene.pbrt"])

    def test_a_measurement_whose_part_does_not_fit_is_written(self):
        csv = self.folder / "a.csv"
        for name in ("brf", "flux"):
            with self.subTest(name=name):
                words = [FROND, name, str(self.scene), "--no-cache", "--wavelengths", "450,650", "--paths", "1000"]
                expected, _ = self.run_to_end([*words, "--csv", "-", "-q"])
                limit = len(expected) + 16
                _, err = self.run_to_end([*words, "--csv", str(csv), "--checkpoint", "60"], preexec_fn=limit_files(limit))
                self.assertIn("no checkpoint was written", err)
                self.assertEqual(csv.read_text(encoding="utf-8"), expected)
                self.assertEqual(self.files(), ["a.csv", "scene.pbrt"])
                csv.unlink()

    def test_a_stopped_render_whose_part_does_not_fit_fails(self):
        image = self.folder / "a.exr"
        command = self.command(image, "--wavelengths", BANDS, "--spp", 1 << 20, "--checkpoint", 0.05)
        process = self.start(command, preexec_fn=limit_files(1 << 10))
        self.assertIn("no checkpoint was written", warning_of(process))
        process.terminate()
        _, err = process.communicate()
        self.assertEqual(process.returncode, 1, err)
        self.assertIn("frond: cannot write", err)
        self.check_failure(err, self.folder / "a.exr.part", errno.EFBIG)
        self.assertEqual(self.files(), ["scene.pbrt"])

    def test_a_folder_that_does_not_fit_stays_as_it_was(self):
        """Man pages and the export of a scene: the first files fit, a later one does not."""
        for command, limit in ((["man", "--folder"], 1 << 12), (["export", str(self.scene), "--format", "mitsuba", "-o"], 1 << 11)):
            new, old = self.folder / "new" / command[0], self.folder / f"old-{command[0]}"
            self.run_to_end([FROND, *command, str(old)])
            for path in old.rglob("*"):
                if path.is_file():
                    path.write_bytes(OLD)
            before = sorted((path, path.is_file() and path.read_bytes()) for path in old.rglob("*"))
            for folder in (new, old):
                _, err = self.run_to_end([FROND, *command, str(folder)], 1, preexec_fn=limit_files(limit))
                self.assertIn(f'cannot write "{folder}/', err)
                self.assertIn(os.strerror(errno.EFBIG), err)
            self.assertFalse(new.parent.exists())
            self.assertEqual(sorted((path, path.is_file() and path.read_bytes()) for path in old.rglob("*")), before)

    def test_a_file_system_that_is_full(self):
        place = self.small_file_system("1m")
        image = place / "a.exr"
        image.write_bytes(OLD)
        (place / "filler").write_bytes(b"x" * 1000000)
        _, err = self.run_to_end(self.command(image, "--wavelengths", BANDS, "-q"), 1)
        self.check_failure(err, image, errno.ENOSPC)
        self.assertEqual(image.read_bytes(), OLD)
        process = self.start(self.command(image, "--spp", 1 << 20, "--checkpoint", 0.05))
        line = warning_of(process)
        self.assertIn("no checkpoint was written, rendering goes on", line)
        self.assertIn(os.strerror(errno.ENOSPC), line)
        (place / "filler").unlink()
        self.wait_for((place / "a.exr.part").exists, "the checkpoint that fits again")
        process.terminate()
        _, err = process.communicate()
        self.assertEqual(process.returncode, 143, err)
        self.assertEqual(temporaries(place), [])


class NoPlace(FrondTest):
    """Below /proc nobody writes files, not even root; and a file is no folder."""

    def test_is_refused_before_anything_is_rendered(self):
        self.write("file", "")
        for folder in ("/proc/self", str(self.folder / "file"), str(self.folder / "none")):
            for words in (["-o", f"{folder}/a.exr"], ["--part", f"{folder}/a.part"]):
                start = time.monotonic()
                command = [FROND, "render", str(self.scene), "--no-cache", "--spp", str(1 << 24), *words]
                _, err = self.run_to_end(command, 1)
                self.assertIn(words[1], err)
                self.assertLess(time.monotonic() - start, 10)

    def test_that_vanishes_while_rendering_is_named(self):
        place = self.folder / "place"
        place.mkdir()
        process = self.start(self.command(place / "a.exr", "--spp", 1 << 20, "--checkpoint", 0.05))
        self.wait_for((place / "a.exr.part").exists, "a checkpoint")
        shutil.rmtree(place)
        self.assertIn("no checkpoint was written", warning_of(process))
        process.terminate()
        _, err = process.communicate()
        self.assertEqual(process.returncode, 1, err)
        self.assertIn(f'there is no folder "{place}"', err)


class Inputs(FrondTest):
    def setUp(self):
        super().setUp()
        self.mesh = self.write("triangle.ply", TRIANGLE.format(0.5))
        self.scene.write_text(
            self.scene.read_text() + 'Shape "plymesh" "string filename" "triangle.ply"\n', encoding="utf-8"
        )
        self.output = self.folder / "a.exr"
        self.command_line = self.command(self.output, "--checkpoint", 60, "--resume", "-q")

    def refusal(self, *words):
        before = self.output.read_bytes()
        _, err = self.run_to_end(self.command_line + list(words), 1)
        self.assertEqual(self.output.read_bytes(), before)
        return err

    def test_that_change_between_runs_are_named(self):
        self.run_to_end(self.command_line)
        self.mesh.write_text(TRIANGLE.format(0.25), encoding="utf-8")
        self.assertIn("file triangle.ply: ", self.refusal())
        self.mesh.unlink()
        self.assertIn("triangle.ply", self.refusal())
        self.mesh.write_text(TRIANGLE.format(0.5), encoding="utf-8")
        self.assertIn("seed: 7 in this command, ", self.refusal("--seed", "7"))
        self.assertIn("other pixels", self.refusal("--pixels", "0,8,0,8"))
        self.assertIn("without --max-rms", self.refusal("--max-rms", "0.1"))
        self.run_to_end(self.command_line)
        with self.scene.open("a", encoding="utf-8") as scene:
            scene.write("# more\n")
        self.assertIn("scene: ", self.refusal())

    def test_a_part_that_is_there_is_not_overwritten(self):
        self.run_to_end(self.command_line)
        self.assertIn("--resume", self.run_to_end(self.command(self.output, "--checkpoint", 1), 1)[1])

    def test_a_damaged_part_is_not_gone_on_from(self):
        self.run_to_end(self.command_line)
        part = self.folder / "a.exr.part"
        data = bytearray(part.read_bytes())
        data[len(data) // 2] ^= 1
        part.write_bytes(data)
        self.assertIn("is damaged", self.refusal())
        self.assertEqual(part.read_bytes(), data)


class OneOutput(FrondTest):
    def test_the_second_with_a_checkpoint_is_refused(self):
        output = self.folder / "a.exr"
        first = self.start(self.command(output, "--spp", 1 << 20, "--checkpoint", 0.05, "--resume"))
        self.wait_for((self.folder / "a.exr.part").exists, "a checkpoint")
        _, err = self.run_to_end(self.command(output, "--spp", 4, "--checkpoint", 0.05, "--resume"), 75)
        self.assertIn("another frond process is writing", err)
        self.assertIn("a.exr.part", err)
        self.assertIsNone(first.poll())
        first.kill()
        first.wait()
        # Whatever the first has left, its lock is gone with it.
        self.assertIn("a.exr.part.lock", self.files())
        self.run_to_end(self.command(output, "--spp", 4, "--resume", "-q"))
        self.assertNotIn("a.exr.part.lock", self.files())

    def test_without_checkpoints_the_last_one_stays(self):
        output = self.folder / "a.exr"
        images = []
        for seed in (1, 2):
            self.run_to_end(self.command(output, "--seed", seed, "-q"))
            images.append(output.read_bytes())
        for _ in range(3):
            both = [self.start(self.command(output, "--seed", seed, "-q")) for seed in (1, 2)]
            for process in both:
                self.assertEqual(process.wait(), 0)
            self.assertIn(output.read_bytes(), images)
        self.assertEqual(self.files(), ["a.exr", "scene.pbrt"])


class KilledAnywhere(FrondTest):
    """SIGKILL in each phase: what is left does not disturb the next run."""

    words, expected = (), b""

    def setUp(self):
        super().setUp()
        self.output = self.folder / "a.exr"
        if not self.expected:
            KilledAnywhere.words = ("--wavelengths", BANDS, "--spp", self.samples_in(0.2), "-q")
            self.run_to_end(self.command(self.output, *self.words))
            KilledAnywhere.expected = self.output.read_bytes()
            self.output.unlink()

    def kill_when(self, command, condition):
        process = self.start(command)
        self.wait_for(lambda: process.poll() is not None or condition(process), "the moment")
        process.kill()
        process.wait()
        return process.returncode

    def check_rerun(self, command):
        self.run_to_end(command)
        self.assertEqual(self.output.read_bytes(), self.expected)

    def test_while_loading(self):
        command = self.command(self.output, *self.words, "--checkpoint", 0.05, "--resume")
        for wait in (0, 0.005, 0.01, 0.02, 0.04):
            process = self.start(command)
            time.sleep(wait)
            process.kill()
            process.wait()
        self.check_rerun(command)

    def test_while_computing_tables(self):
        scene = self.write(
            "leaf.pbrt",
            self.scene.read_text().replace(
                'Material "diffusetransmission" "rgb reflectance" [.2 .5 .1]',
                'Material "leaf_simplified" "string specimen" "soybean" "string tablemethod" "solve"',
            ),
        )
        cache = self.folder / "cache"
        command = [
            *(FROND, "render", str(scene), "--cache", str(cache), "-o", str(self.output)),
            *("--spp", "4", "--wavelengths", "smpte", "-q"),
        ]
        self.run_to_end(command)
        expected, moments = self.output.read_bytes(), random.Random(2)
        shutil.rmtree(cache)
        for _ in range(20 if SLOW else 5):
            process = self.start(command)
            time.sleep(moments.uniform(0, 0.3))
            process.kill()
            process.wait()
        for _ in range(2):  # with what the cache then has, too
            self.run_to_end(command)
            self.assertEqual(self.output.read_bytes(), expected)

    def test_while_rendering(self):
        part = self.folder / "a.exr.part"
        command = self.command(self.output, *self.words, "--checkpoint", 0.05, "--resume")
        self.kill_when(command, lambda _: part.exists())
        self.assertGreater(part_header(part)["statistics"]["paths"], 0)
        self.check_rerun(command)

    def test_while_writing_a_checkpoint(self):
        command = self.command(self.output, *self.words, "--checkpoint", 0.01, "--resume")
        for _ in range(5):
            self.kill_when(command, self.is_writing)
            if self.output.exists():
                break
        self.check_rerun(command)

    def test_while_writing_the_image(self):
        command = self.command(self.output, *self.words)
        self.output.write_bytes(OLD)
        for _ in range(20 if SLOW else 5):
            self.kill_when(command, self.is_writing)
            self.assertIn(self.output.read_bytes(), (OLD, self.expected))
        self.check_rerun(command)

    def is_writing(self, process):
        """Whether the process has a temporary file open, with or without a name, with something in it; empty ones only ask
        whether one can be made."""
        for opened in Path(f"/proc/{process.pid}/fd").iterdir():
            with contextlib.suppress(FileNotFoundError):  # closed under our eyes
                name = os.path.relpath(os.readlink(opened), self.folder)
                if name.startswith(("#", ".frond-")) and opened.stat().st_size > 0:
                    return True
        return False

    def test_what_was_left_behind_is_in_nobodys_way(self):
        for number in range(3):
            self.write(f".frond-{os.getpid() + number}-0.tmp", "half an image")
        self.write("a.exr.part.lock", "")
        self.check_rerun(self.command(self.output, *self.words, "--checkpoint", 0.05))
        self.assertEqual(temporaries(self.folder), [])


class StandardStreams(FrondTest):
    """The exit code is 0 only if all that was asked for could be written. Where messages go does not matter for it."""

    def run_with(self, redirection, *words):
        line = 'exec "$@" ' + redirection
        done = subprocess.run(
            ["sh", "-c", line, "sh", *map(str, words)], capture_output=True, check=False, stdin=subprocess.DEVNULL
        )
        return done.returncode

    def test_lost_output_is_an_error(self):
        image = self.folder / "a.exr"
        for words in (
            ["--version"],
            ["--help"],
            ["describe", "leaf"],
            ["check", self.scene],
            ["render", "--help"],
            ["render", self.scene, "--spp", 1, "-o", image, "--json", "-", "-q"],
        ):
            with self.subTest(words=words):
                self.assertEqual(self.run_with(">/dev/null", FROND, *words), 0)
                self.assertEqual(self.run_with(">/dev/full", FROND, *words), 1)
                self.assertEqual(self.run_with(">&-", FROND, *words), 1)

    def test_lost_messages_are_none(self):
        image = self.folder / "a.exr"
        for redirection in ("2>/dev/full", "2>&-", "<&- 2>&-"):
            for words in ([self.scene, "--spp", 1, "-o", image], [self.scene, "--spp", 1, "-o", image, "--strict"]):
                with self.subTest(redirection=redirection):
                    self.assertEqual(self.run_with(redirection, FROND, "render", *words), 0)
                    self.assertTrue(image.exists())
                    image.unlink()

    def test_a_reader_that_has_gone_is_no_reason_to_stop(self):
        image = self.folder / "a.exr"
        reader, writer = os.pipe()
        os.close(reader)
        words = map(str, [FROND, "render", self.scene, "--spp", 1, "-o", image])
        with os.fdopen(writer, "wb") as pipe:
            done = subprocess.run(list(words), stdout=subprocess.DEVNULL, stderr=pipe, check=False)
        self.assertEqual(done.returncode, 0)
        self.assertTrue(image.exists())

    def test_a_closed_stream_is_no_file_of_the_program(self):
        # Else the image would get number 2, and a warning would be written into it.
        scene = self.write("warns.pbrt", SCENE_WITH_WARNING)
        images = [self.folder / name for name in ("a.exr", "b.exr")]
        for image, redirection in zip(images, ("2>/dev/null", "2>&-")):
            words = ["env", "SOURCE_DATE_EPOCH=0", FROND, "render", scene, "--spp", 1, "-o", image]
            self.assertEqual(self.run_with(redirection, *words), 0)
        self.assertEqual(images[0].read_bytes(), images[1].read_bytes())

    def test_names_that_are_not_utf8_are_reported(self):
        name = os.fsencode(self.folder) + b"/\xff.exr"
        done = subprocess.run(
            [FROND, "render", str(self.scene), "--spp", "1", "-o", name, "--json", "-", "-q"], capture_output=True, check=False
        )
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertTrue(os.path.exists(name))
        json.loads(done.stdout)

    def test_quiet_hides_no_warning(self):
        scene = self.write("warns.pbrt", SCENE_WITH_WARNING)
        _, err = self.run_to_end([FROND, "render", str(scene), "--spp", "1", "-o", str(self.folder / "a.exr"), "-q"])
        self.assertIn("warning: ", err)
        spectra = self.write("m.csv", "nm,R,T\n" + "".join(f"{nm},{20 + nm / 100},20\n" for nm in range(450, 1000, 10)))
        _, err = self.run_to_end([FROND, "fit", str(spectra), "-q"])
        self.assertIn("values of R and T are in percent", err)


class FilmFile(FrondTest):
    """A scene cannot choose a file outside of the working folder; -o can."""

    def render(self, name, *words, code=0):
        text = SCENE.replace('Film "rgb"', f'Film "rgb" "string filename" "{name}"')
        scene = self.write("scene.pbrt", text)
        work = self.folder / "work"
        work.mkdir(exist_ok=True)
        return self.run_to_end([FROND, "render", str(scene), "--spp", "1", "-q", *words], code, cwd=work)

    def test_outside_is_refused(self):
        victim = self.folder / "victim.exr"
        victim.write_bytes(OLD)
        (self.folder / "work").mkdir()
        (self.folder / "work" / "link").symlink_to(self.folder)
        for name in (victim, "../victim.exr", "link/victim.exr", "a/../../victim.exr"):
            _, err = self.render(name, code=1)
            self.assertIn("scene.pbrt:4:6: the scene asks to write", err)
            self.assertIn("give a file with -o", err)
            self.assertEqual(victim.read_bytes(), OLD)

    def test_inside_is_written(self):
        self.render("a.exr")
        self.assertTrue((self.folder / "work" / "a.exr").exists())
        self.render("../b.exr", "-o", str(self.folder / "c.exr"))
        self.assertTrue((self.folder / "c.exr").exists())


class ChangingTables(FrondTest):
    """An instance table that changes during a render."""

    TABLE_SCENE = SCENE.replace(
        'Shape "sphere" "float radius" .5',
        'ObjectBegin "o" Shape "sphere" "float radius" .02 ObjectEnd\n'
        'Shape "instances" "string object" "o" "string filename" "t.npy"',
    )

    def table(self, shift):
        header = "{'descr': '<f4', 'fortran_order': False, 'shape': (5000, 12), }".ljust(117) + "\n"
        rows = (
            struct.pack("<12f", 1, 0, 0, i % 100 / 50 - 1 + shift, 0, 1, 0, i // 100 / 25 - 1, 0, 0, 1, 0)
            for i in range(5000)
        )
        return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header.encode() + b"".join(rows)

    def test_no_signal_and_the_same_image(self):
        scene = self.write("scene.pbrt", self.TABLE_SCENE)
        path = self.folder / "t.npy"
        path.write_bytes(self.table(0))
        command = [FROND, "render", str(scene), "--spp", "64", "--no-cache", "--threads", "2", "-q", "-o"]
        first, second = (self.folder / name for name in ("a.exr", "b.exr"))
        self.run_to_end([*command, str(first)])
        def overwrite():
            with path.open("r+b") as file:
                file.write(b"\x7f" * 100_000)

        for fault in (lambda: os.truncate(path, 200), overwrite):
            path.write_bytes(self.table(0))
            (self.folder / "b.exr.part").unlink(missing_ok=True)
            process = self.start([*command[:-1], "--checkpoint", "0.02", "-o", str(second)])
            part = self.folder / "b.exr.part"
            self.wait_for(lambda: part.exists() or process.poll() is not None, "a checkpoint")
            fault()
            _, err = process.communicate()
            self.assertEqual(process.returncode, 0, err)
            self.assertEqual(second.read_bytes(), first.read_bytes())


if __name__ == "__main__":
    unittest.main()
