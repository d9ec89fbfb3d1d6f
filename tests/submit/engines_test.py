"""Jobs of frond submit, run by OpenJD and Snakemake on this machine: tasks are killed, and the image is that of a single
render, to the byte. The programs are those in FROND_ENGINES or PATH; tests are skipped, by name, where one is missing."""

import os
import pathlib
import shlex
import shutil
import signal
import subprocess
import unittest

from frond_program import FROND, FrondTest

PATH = f"{os.environ['FROND_ENGINES']}:{os.environ['PATH']}"
ENVIRONMENT = dict(os.environ, PATH=PATH)
TASKS = 3
CHECKPOINT = 0.1  # seconds
FASTER_CHECKPOINTS = {"openjd": ["-p", f"CheckpointSeconds={CHECKPOINT}"],
                      "snakemake": ["--config", f"checkpoint_seconds={CHECKPOINT}"]}


class EnginesTest(FrondTest):
    spp = 0

    def setUp(self):
        super().setUp()
        if not EnginesTest.spp:
            EnginesTest.spp = TASKS * self.samples_in(0.5)  # a task takes half a second
        # Much that a shell, YAML or Python might take for its own.
        self.odd = self.folder / "a job's $HOME & \"more\" {x} #é"
        self.odd.mkdir()
        self.scene = self.scene.rename(self.odd / "a 'scene'.pbrt")

    def submit(self, engine, *words):
        """The folder of a job for the image self.image, and what frond submit printed."""
        if not shutil.which(engine, path=PATH):
            self.skipTest(f"{engine} is not installed")
        # Snakemake refuses {} in the name of the image alone.
        self.image = self.folder / "an 'image' of \"more\" é.exr"
        folder = self.odd / f"job of {engine}"
        out, _ = self.run_to_end(
            [FROND, "submit", str(self.scene), "-o", str(self.image), "--spp", str(self.spp), "--tasks", str(TASKS), "--engine",
             engine, "--folder", str(folder), "--no-cache", "--seed", "5", *words], environment=ENVIRONMENT)
        return folder, out

    def written(self, engine):
        """The folder of a job, and the command that starts it."""
        folder, out = self.submit(engine)
        return folder, shlex.split(out.splitlines()[0]) + FASTER_CHECKPOINTS[engine]

    def single(self):
        path = self.folder / "single.exr"
        self.run_to_end(self.command(path, "--spp", self.spp, "--seed", 5, "-q"))
        return path.read_bytes()

    def task(self, folder, index):
        """The process that renders this part, or None."""
        part = f"\0parts/{index:05}.part\0".encode()
        for process in pathlib.Path("/proc").glob("[0-9]*"):
            try:
                words = (process / "cmdline").read_bytes()
                if words.startswith(FROND.encode()) and part in words and (process / "cwd").samefile(folder):
                    return int(process.name)
            except OSError:  # it has ended
                pass
        return None

    def kill_task(self, folder, index):
        """Kills a task once it has a checkpoint."""
        checkpoint = folder / f"parts/{index:05}.part.checkpoint"
        self.wait_for(checkpoint.exists, f"a checkpoint of task {index}", seconds=60)
        os.kill(self.task(folder, index), signal.SIGKILL)

    def check_image(self):
        self.assertEqual(self.image.read_bytes(), self.single())

    def test_openjd_renders_what_a_killed_task_left(self):
        folder, command = self.written("openjd")
        run = self.start(command, ENVIRONMENT)
        self.kill_task(folder, 1)
        run.communicate()
        self.assertNotEqual(run.returncode, 0)
        self.assertTrue((folder / "parts/00000.part").exists())
        self.assertFalse(self.image.exists())
        self.run_to_end(command, environment=ENVIRONMENT)
        self.check_image()

    def test_snakemake_repeats_a_killed_task(self):
        folder, command = self.written("snakemake")
        self.image.write_bytes(b"an image of an earlier render")
        run = self.start(command, ENVIRONMENT)
        self.kill_task(folder, 1)
        _, err = run.communicate()
        self.assertEqual(run.returncode, 0, err)
        self.assertIn("Trying to restart job", err)
        self.check_image()

    def test_snakemake_goes_on_after_it_was_killed_itself(self):
        folder, command = self.written("snakemake")
        run = self.start(command, ENVIRONMENT, start_new_session=True)
        self.wait_for(lambda: any(folder.glob("parts/*.checkpoint")), "a checkpoint", seconds=60)
        os.killpg(run.pid, signal.SIGKILL)
        run.communicate()
        self.run_to_end([*command, "--unlock"], environment=ENVIRONMENT)
        self.run_to_end(command, environment=ENVIRONMENT)
        self.check_image()

    def test_run_runs_the_job(self):
        self.spp = 7
        for engine in FASTER_CHECKPOINTS:
            with self.subTest(engine):
                self.submit(engine, "--run")
                self.check_image()
                self.image.unlink()

    def check_measurement(self, engine, job, amount, *words):
        """Runs a job of a measurement in three tasks, and compares its table with that of one run."""
        if not shutil.which(engine, path=PATH):
            self.skipTest(f"{engine} is not installed")
        scene = self.odd / "a 'canopy'.pbrt"
        scene.write_text("""Option "float period" [ 1 1 ]
WorldBegin
LightSource "sky"
Material "diffuse" "spectrum reflectance" [ 300 0.2  2500 0.2 ]
Shape "bilinearmesh" "point3 P" [ 0 0 0  1 0 0  0 1 0  1 1 0 ]
Material "diffusetransmission"
Shape "bilinearmesh" "point3 P" [ 0 0 1  0.5 0 1  0 1 1  0.5 1 1 ]
""")
        table, single = (self.folder / name for name in ("a 'table' é.csv", "single.csv"))
        command = ["--no-cache", *words, "--paths", str(amount)]
        self.run_to_end([FROND, job, str(scene), *command, "--csv", str(single), "-q"])
        self.run_to_end([FROND, "submit", job, str(scene), *command, "--csv", str(table), "--tasks", str(TASKS), "--engine",
                         engine, "--folder", str(self.odd / f"{job} by {engine}"), "--run"], environment=ENVIRONMENT)
        self.assertEqual(table.read_bytes(), single.read_bytes())
        return table

    def test_a_flux_of_tasks_is_that_of_one_run(self):
        times = self.folder / "a day's.csv"
        times.write_text("time,elevation\n2026-06-21T08:00,20\n2026-06-21T12:00,60\n2026-06-21T23:00,-10\n")
        table = self.check_measurement("snakemake", "flux", 10000, "--bands", "par,nir", "--by", "mesh", "--times", str(times))
        self.assertTrue(list(table.parent.glob(f"{table.stem}-*_days.csv")))

    def test_a_brf_of_tasks_is_that_of_one_run(self):
        self.check_measurement("openjd", "brf", 1000, "--zenith=-30:30:30", "--wavelengths", "550,800")


if __name__ == "__main__":
    unittest.main()
