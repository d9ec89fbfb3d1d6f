"""What renders do when a disk is full, a folder takes no file, an input changes, a second render has the same output, or
they are killed at a bad moment: each says what is wrong, and leaves nothing half-written."""

import errno
import os
import random
import resource
import shutil
import subprocess
import time
import unittest

from frond_program import FROND, SLOW, FrondTest, part_header

OLD = b"an old file"
BANDS = "bands,lambdamin=400,lambdamax=800,step=10"  # makes parts of more than a megabyte

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
        process = self.start(command, preexec_fn=limit_files(1 << 16))
        self.assertIn("no checkpoint was written", process.stderr.readline())
        process.terminate()
        _, err = process.communicate()
        self.assertEqual(process.returncode, 1, err)
        self.assertIn("frond: cannot write", err)
        self.check_failure(err, self.folder / "a.exr.part", errno.EFBIG)
        self.assertEqual(self.files(), ["scene.pbrt"])

    def test_a_file_system_that_is_full(self):
        place = self.small_file_system("1m")
        image = place / "a.exr"
        image.write_bytes(OLD)
        (place / "filler").write_bytes(b"x" * 1000000)
        _, err = self.run_to_end(self.command(image, "--wavelengths", BANDS, "-q"), 1)
        self.check_failure(err, image, errno.ENOSPC)
        self.assertEqual(image.read_bytes(), OLD)
        process = self.start(self.command(image, "--spp", 1 << 20, "--checkpoint", 0.05))
        line = process.stderr.readline()
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
        self.assertIn("no checkpoint was written", process.stderr.readline())
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
        left = []
        for _ in range(5):
            self.kill_when(command, lambda _: len(temporaries(self.folder)) > len(left))
            left = temporaries(self.folder)
            if self.output.exists():
                break
        self.check_rerun(command)

    def test_while_writing_the_image(self):
        command = self.command(self.output, *self.words)
        self.output.write_bytes(OLD)
        for _ in range(20 if SLOW else 5):
            left = temporaries(self.folder)
            self.kill_when(command, lambda _, left=left: self.writes_more_than(left))
            self.assertIn(self.output.read_bytes(), (OLD, self.expected))
        self.check_rerun(command)

    def writes_more_than(self, left):
        """Whether there is a new temporary file with something in it; empty ones only ask whether one can be made."""
        try:
            return any((self.folder / name).stat().st_size > 0 for name in set(temporaries(self.folder)) - set(left))
        except FileNotFoundError:
            return True  # renamed under our eyes

    def test_what_was_left_behind_is_in_nobodys_way(self):
        for number in range(3):
            self.write(f".frond-{os.getpid() + number}-0.tmp", "half an image")
        self.write("a.exr.part.lock", "")
        self.check_rerun(self.command(self.output, *self.words, "--checkpoint", 0.05))


if __name__ == "__main__":
    unittest.main()
