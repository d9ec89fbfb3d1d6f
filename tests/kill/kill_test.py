"""Renders that are killed at random moments and resumed: the image is that of an undisturbed render, and little is
rendered twice.

What a killed run has rendered since its last checkpoint is lost, and is rendered again. Every --checkpoint seconds
one is begun; a run that is killed has lost what it rendered since the youngest checkpoint on the disk was begun. That
is one interval at most, and the time that it takes to write one, during which the machine may do other things: each
run's loss is measured in seconds, from the time stamp of the part (or the start of the run, if it has not written
one) to the kill, but no more than the run's CPU time, shared by its threads: on a busy machine it has not worked all
the time. The mean over all kills has to be below one and a half intervals. And nothing that a part holds
is rendered again: the paths that the runs counted into it, one after the other, never become fewer, and in the end are
no more than the image has.
"""

import os
import pathlib
import random
import re
import signal
import subprocess
import time
import unittest

from frond_program import FROND, PIXELS, SLOW, THREADS, FrondTest, part_header

INTERVAL = 0.2
KILLS = 100 if SLOW else 20
LONGEST = 0.6  # seconds of a run that is killed, beside those that it loads its scene


class Kill(FrondTest):
    images = {}  # of undisturbed renders, by their words
    per_second = None

    def setUp(self):
        super().setUp()
        if not Kill.per_second:
            Kill.per_second = 2 * self.samples_in(0.5)
        self.output = self.folder / "killed.exr"
        self.part = self.folder / "killed.exr.part"

    def render(self, spp, *words, interval=INTERVAL):
        return self.command(self.output, "--spp", spp, "--checkpoint", interval, "--resume", *words)

    def undisturbed(self, spp, *words):
        if (spp, *words) not in self.images:
            path = self.folder / "undisturbed.exr"
            self.run_to_end(self.command(path, "--spp", spp, "-q", *words))
            self.images[(spp, *words)] = path.read_bytes()
        return self.images[(spp, *words)]

    def paths_kept(self):
        return part_header(self.part)["statistics"]["paths"] if self.part.exists() else 0

    def check_resumed(self, spp, *words):
        """Goes on to the end; the image and the part are those of an undisturbed render."""
        self.run_to_end(self.render(spp, "-q", *words))
        expected = self.undisturbed(spp, *words)
        self.assertEqual(self.output.read_bytes(), expected)
        merged = self.folder / "merged.exr"
        frond = self.command("")[0]
        self.run_to_end([frond, "merge", str(self.part), "-o", str(merged), "-q"])  # without --allow-holes
        self.assertEqual(merged.read_bytes(), expected)

    def start_and_wait_for_checkpoint(self, spp):
        process = self.start(self.render(spp))
        self.wait_for(self.part.exists, "a checkpoint")
        return process

    def test_at_random_moments(self):
        moments = random.Random(1)
        spp = self.per_second * KILLS // 4
        start = time.time()
        self.run_to_end(self.command(self.folder / "load.exr", "--spp", 1, "-q"))
        longest = LONGEST + time.time() - start
        kept, killed, loss = 0, 0, 0.0
        for _ in range(KILLS):
            start = time.time()
            process = self.start(self.render(spp, "-q"))
            try:
                process.wait(timeout=moments.uniform(0, longest))
            except subprocess.TimeoutExpired:
                process.kill()
                end = time.time()
                worked = self.cpu_seconds(process) / THREADS
                killed += 1
                since = max(start, self.part.stat().st_mtime) if self.part.exists() else start
                loss += min(max(end - since, 0), worked)
            else:
                self.assertEqual(process.returncode, 0, process.stderr.read())
            kept_before, kept = kept, self.paths_kept()
            self.assertGreaterEqual(kept, kept_before)
        self.assertGreater(killed, KILLS / 2)
        self.assertLess(loss / killed, 1.5 * INTERVAL)
        self.assertGreater(kept, 0)
        self.check_resumed(spp)
        self.assertLessEqual(self.paths_kept(), spp * PIXELS)

    def test_with_samples_where_noise_is(self):
        moments, spp = random.Random(2), self.per_second // 4
        adaptive = ("--max-rms", "0.0001")  # which it does not reach
        for _ in range(KILLS // 4):
            process = self.start(self.render(spp, "-q", *adaptive, interval=0.05))
            try:
                process.wait(timeout=moments.uniform(0.1, LONGEST / 2))
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
        self.check_resumed(spp, *adaptive)

    def test_stopped_by_a_signal(self):
        spp = self.per_second
        for number, code in ((signal.SIGTERM, 143), (signal.SIGINT, 130)):
            with self.subTest(signal=number.name):
                process = self.start_and_wait_for_checkpoint(spp)
                process.send_signal(number)
                _, err = process.communicate()
                self.assertEqual(process.returncode, code, err)
                self.assertIn("the same command with --resume goes on from there", err)
                self.assertIn(str(self.part), err)
                self.assertFalse(self.output.exists())
                self.check_resumed(spp)
                self.part.unlink()
                self.output.unlink()

    def test_terminated_twice_it_still_leaves_its_part(self):
        spp = self.per_second
        process = self.start_and_wait_for_checkpoint(spp)
        before = self.paths_kept()
        while process.poll() is None:
            process.send_signal(signal.SIGTERM)
            time.sleep(0.001)
        _, err = process.communicate()
        self.assertEqual(process.returncode, 143, err)
        self.assertIn("--resume", err)
        self.assertGreaterEqual(self.paths_kept(), before)
        self.check_resumed(spp)

    def test_a_second_interrupt_ends_it_at_once(self):
        spp = self.per_second
        process = self.start_and_wait_for_checkpoint(spp)
        process.send_signal(signal.SIGINT)
        self.wait_for(lambda: not self.catches(process, signal.SIGINT), "the first signal")
        process.send_signal(signal.SIGINT)
        process.communicate()
        self.assertIn(process.returncode, (-signal.SIGINT, 130))  # 130: it was done with the first one by then
        self.check_resumed(spp)

    def test_an_interrupt_without_a_checkpoint_says_what_is_lost(self):
        process = self.start(self.command(self.output, "--spp", 1 << 24))
        self.wait_for(lambda: self.catches(process, signal.SIGINT), "a handler")
        process.send_signal(signal.SIGINT)
        _, err = process.communicate()
        self.assertEqual(process.returncode, -signal.SIGINT)
        self.assertIn("frond: stopped; the result so far is lost: --checkpoint SECONDS keeps it", err)
        self.assertFalse(self.output.exists())

    @staticmethod
    def cpu_seconds(process):
        """CPU time of a process that has been killed."""
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        return usage.ru_utime + usage.ru_stime

    @staticmethod
    def catches(process, number):
        """Whether it has a handler for a signal."""
        if process.poll() is not None:
            return False
        with open(f"/proc/{process.pid}/status", encoding="ascii") as status:
            for line in status:
                if line.startswith("SigCgt:"):
                    return bool(int(line.split()[1], 16) >> (number - 1) & 1)
        return False


class Radiometers(FrondTest):
    """frond brf and frond flux keep what they have measured."""

    COMMANDS = (("brf", "--zenith=-30:30:30"), ("flux",), ("flux", "--by", "instance"), ("brf", "--rms", "0.00005"))

    def setUp(self):
        super().setUp()
        ball = 'ObjectBegin "ball" Shape "sphere" "float radius" .1 ObjectEnd\n'
        copies = "".join(f'AttributeBegin Translate {i} 1 0 ObjectInstance "ball" AttributeEnd\n' for i in (-1, 0, 1))
        self.scene = self.write("field.pbrt", self.scene.read_text(encoding="utf-8") + ball + copies)
        self.csv = self.folder / "measured.csv"
        self.part = self.folder / "measured.csv.part"

    def command(self, name, *words):
        common = ("--no-cache", "--threads", THREADS, "--wavelengths", "450,650", "--target=-2,2,-2,2,2")
        return [FROND, name, str(self.scene), *map(str, (*common, *words))]

    def paths_in(self, seconds, words):
        """How many paths a run of so many seconds gets to here and now."""
        _, err = self.run_for(seconds, *words, "--paths", "4e9", "--csv", self.csv)
        self.csv.unlink()
        return int(re.search(r"(\d+) paths", err)[1])

    def test_go_on_where_they_were_ended(self):
        moments = random.Random(3)
        for words in self.COMMANDS:
            with self.subTest(words=words):
                if "--rms" not in words:
                    words = (*words, "--paths", 2 * self.paths_in(0.7, words))
                expected, _ = self.run_to_end(self.command(*words, "--csv", "-", "-q"))
                kept = self.command(*words, "--csv", self.csv, "--checkpoint", 0.1, "--resume")
                killed = 0
                for i in range(KILLS // 4):
                    process = self.start(kept)
                    try:
                        process.wait(timeout=moments.uniform(0.1, LONGEST))
                    except subprocess.TimeoutExpired:
                        killed += 1
                        process.send_signal(signal.SIGTERM if i % 2 else signal.SIGKILL)
                        _, err = process.communicate()
                        if process.returncode == 143:
                            self.assertIn("--resume goes on from there", err)
                            self.assertIn(str(self.part), err)
                self.assertGreater(killed, 0)
                self.run_to_end(kept)
                self.assertEqual(self.csv.read_text(encoding="utf-8"), expected)
                self.csv.unlink()
                self.part.unlink()

    def test_a_refinement_goes_on_from_its_checkpoint(self):
        words = ("brf", "--rms", "0.00005")
        expected, _ = self.run_to_end(self.command(*words, "--csv", "-", "-q"))
        kept = self.command(*words, "--csv", self.csv, "--checkpoint", 0.05, "--resume")
        process = self.start(kept)
        self.wait_for(self.part.exists, "a checkpoint")
        process.send_signal(signal.SIGTERM)
        process.communicate()
        self.assertEqual(process.returncode, 143)  # not at its end
        before = part_header(self.part)["statistics"]["paths"]
        self.assertGreater(before, 0)
        self.run_to_end(kept)
        self.assertGreater(part_header(self.part)["statistics"]["paths"], before)
        self.assertEqual(self.csv.read_text(encoding="utf-8"), expected)

    def test_do_not_mix_measurements(self):
        for name, other in (("brf", ("--zenith", 10)), ("flux", ("--seed", 3)), ("flux", ("--by", "instance"))):
            with self.subTest(name=name, other=other):
                paths = ("--paths", 1000, "--csv", self.csv)
                self.run_to_end(self.command(name, *paths, "--checkpoint", 9))
                _, err = self.run_to_end(self.command(name, *paths, "--checkpoint", 9), code=1)
                self.assertIn("already exists", err)
                _, err = self.run_to_end(self.command(name, *other, *paths, "--resume"), code=1)
                self.assertIn("another measurement", err)
                self.part.write_bytes(self.part.read_bytes()[:-20])
                _, err = self.run_to_end(self.command(name, *paths, "--resume"), code=1)
                self.assertRegex(err, "cut short|damaged")
                self.part.unlink()

    def test_need_a_file_to_stand_beside(self):
        for words in ((), ("--csv", "-")):
            _, err = self.run_to_end(self.command("flux", "--checkpoint", 1, *words), code=1)
            self.assertIn("--csv", err)


class Import(FrondTest):
    """frond import ends at once, and the process that reads the model with it."""

    def setUp(self):
        super().setUp()
        side = 500
        rows = [f"v {i % side} {i // side} 0" for i in range(side * side)]
        rows += [f"f {i} {i + 1} {i + side + 1} {i + side}" for i in range(1, side * (side - 1)) if i % side]
        self.model = self.write("sheet.obj", "\n".join(rows))

    @staticmethod
    def is_running(pid):
        try:
            state = pathlib.Path(f"/proc/{pid}/stat").read_text(encoding="ascii").rsplit(")", 1)[1].split()[0]
        except (FileNotFoundError, ProcessLookupError):
            return False
        return state != "Z"

    def reader_of(self, process):
        """The child's process, once it is there."""
        path = pathlib.Path(f"/proc/{process.pid}/task/{process.pid}/children")
        self.wait_for(lambda: path.read_text(encoding="ascii").split(), "the reader")
        return int(path.read_text(encoding="ascii").split()[0])

    def test_its_reader_ends_with_it(self):
        for number in (signal.SIGKILL, signal.SIGTERM, signal.SIGINT):
            with self.subTest(signal=number.name):
                process = self.start([FROND, "import", str(self.model), "-o", str(self.folder / "o.pbrt")])
                reader = self.reader_of(process)
                process.send_signal(number)
                process.wait(timeout=20)
                self.wait_for(lambda reader=reader: not self.is_running(reader), "the end of the reader")
                self.assertIn(process.returncode, (-number, 128 + number))
                self.assertEqual(self.files(), ["scene.pbrt", "sheet.obj"])

    def test_killed_at_random_moments_it_leaves_all_or_nothing(self):
        output = self.folder / "output"
        output.mkdir()
        command = [FROND, "import", str(self.model), "-o", str(output / "o.pbrt"), "-q"]
        begin = time.monotonic()
        self.run_to_end(command)
        seconds = time.monotonic() - begin
        complete = sorted(path.relative_to(output) for path in output.rglob("*"))
        self.assertEqual([str(path) for path in complete],
                         ["o-files", "o-files/DefaultMaterial.ply", "o-plant.pbrt", "o.pbrt"])
        moments = random.Random(4)
        for _ in range(KILLS // 4):
            for path in (output / "o.pbrt", output / "o-plant.pbrt"):
                path.unlink(missing_ok=True)
            process = self.start(command)
            try:
                process.wait(timeout=moments.uniform(0.5, 1) * seconds)
            except subprocess.TimeoutExpired:
                process.kill()
                process.wait()
            if (output / "o.pbrt").exists():
                self.assertTrue((output / "o-plant.pbrt").exists())
        self.run_to_end(command)  # which removes the folders that the killed ones have left
        self.assertEqual(sorted(path.relative_to(output) for path in output.rglob("*")), complete)


if __name__ == "__main__":
    unittest.main()
