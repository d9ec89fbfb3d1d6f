"""Random faults with a fixed seed: runs of render, brf, flux, compare, fit and merge that are killed, stopped, given a full
disk, closed streams or changing inputs, or share an output or a cache with others.

After each fault the output is that of an undisturbed run, to the last bit, or the run has failed with a message and has left
each old file as it was: no file is half-written. Exit code 0 means that all files and all text on standard output are
complete. A run that a signal ends, which is not the one that was sent, is a failure of the test. The same command is then
run again without a fault: it succeeds, and removes the temporary files that a killed run has left.

FROND_FAULTS is the number of faults: 24, and 200 where FROND_SLOW_TESTS=1. FROND_FAULT_SEED is the seed. FROND_FAULT_ONLY=17
runs this fault alone; its moments depend on the machine's speed, so that a failure may take some runs to be seen again.
"""

import contextlib
import csv
import dataclasses
import io
import json
import os
import pathlib
import random
import resource
import shutil
import signal
import struct
import subprocess
import tempfile
import time
import types
import unittest

from frond_program import FROND, SLOW

SEED = os.environ.get("FROND_FAULT_SEED", "1")
COUNT = int(os.environ.get("FROND_FAULTS", "200" if SLOW else "24"))
ONLY = os.environ.get("FROND_FAULT_ONLY")
LONGEST = 120  # seconds that a run may take before it counts as one that does not end
OLD = b"an old file"

SCENE = """
LookAt 0 -2.5 1.5  0 0 0  0 0 1
Camera "perspective" "float fov" 45
Film "rgb" "integer xresolution" 32 "integer yresolution" 32
Sampler "lattice" "integer pixelsamples" 64
WorldBegin
LightSource "infinite" "spectrum L" "light.spd"
Texture "image" "spectrum" "imagemap" "string filename" "texture.exr"
Material "diffuse" "texture reflectance" "image"
Shape "trianglemesh" "point3 P" [-2 -2 0  2 -2 0  2 2 0  -2 2 0] "integer indices" [0 1 2  0 2 3]
Material "leaf_simplified" "string tablefile" "leaf.csv"
Shape "plymesh" "string filename" "mesh.ply"
ObjectBegin "leaf"
  Shape "disk" "float radius" 1
ObjectEnd
Shape "instances" "string object" "leaf" "string filename" "leaves.npy"
"""

LEAF = 'Material "leaf_simplified" "string tablefile" "leaf.csv"'
COMPARED = SCENE.replace(LEAF, 'Material "leaf_simplified" "string specimen" "soybean"')
PLAIN = COMPARED.replace('"imagemap" "string filename" "texture.exr"', '"constant"')

COMPARED_FILES = ("compared.pbrt", "light.spd", "texture.exr", "mesh.ply", "leaves.npy")
SCENE_FILES = ("scene.pbrt", "light.spd", "texture.exr", "leaf.csv", "mesh.ply", "leaves.npy")


def mesh(height):
    """A PLY mesh of 400 small triangles at a height."""
    corners = [f"{0.1 * x + dx:g} {0.1 * y + dy:g} {height:g}" for x in range(-10, 10) for y in range(-10, 10)
               for dx, dy in ((0, 0), (0.08, 0), (0, 0.08))]
    head = f"ply\nformat ascii 1.0\nelement vertex {len(corners)}\nproperty float x\nproperty float y\nproperty float z\n"
    faces = "element face 400\nproperty list uchar int vertex_indices\nend_header"
    return "\n".join([head + faces, *corners, *(f"3 {i} {i + 1} {i + 2}" for i in range(0, 1200, 3))]) + "\n"


@dataclasses.dataclass(frozen=True)
class Job:
    words: tuple  # the command, with relative names of files
    inputs: tuple
    outputs: tuple
    text: object = None  # what of its standard output is compared; None if it prints nothing that was asked for
    table: object = None  # what of its files is compared, if not their bytes
    resume: tuple = ()  # words with which a stopped run goes on
    keeps: tuple = ()  # files that stay then
    folder: str = None  # a further output, whose files are counted
    replaces: bool = True  # whether an old file is replaced


def without_times(data):
    """Rows of a comparison, without the columns that depend on times."""
    rows = list(csv.DictReader(line for line in io.StringIO(data.decode()) if not line.startswith("#")))
    names = [name for name in rows[0] if name.endswith("material") or name in ("spp", "samples", "region", "channel", "rms")]
    assert len(rows) > 4 and len(names) > 2, "the table of compare has other columns"
    return [[row[name] for name in names] for row in rows]


def without_statistics(data):
    """A part without the seconds that it took."""
    begin = data.index(b"\n") + 1
    end = begin + 8 + struct.unpack_from("<Q", data, begin)[0]
    header = json.loads(data[begin + 8 : end])
    header.pop("statistics")
    return header, data[end + 8 :]


RENDER = ("render", "scene.pbrt", "--no-cache", "--threads", "2", "--seed", "3", "-o", "a.exr")
CHECKPOINTS = ("--checkpoint", "0.03", "--resume")
BRF = ("brf", "scene.pbrt", "--no-cache", "--threads", "2", "--wavelengths", "450,550", "--zenith=-60:60:30", "--paths",
       "30000")
FLUX = ("flux", "scene.pbrt", "--no-cache", "--threads", "2", "--wavelengths", "450,550", "--paths", "200000")
COMPARE = ("compare", "compared.pbrt", "--no-cache", "--threads", "2", "--size", "16", "--spp", "8", "--reference-spp", "16",
           "--materials", "leaf_lambert;leaf_simplified", "--reference", "leaf_solved", "--wavelengths", "smpte")
FIT = ("fit", "spectra.csv", "--threads", "2", "--structure", "bifacial", "--sieve", "off")

JOBS = [
    Job(RENDER, SCENE_FILES, ("a.exr",)),
    Job((*RENDER, "--json", "-"), SCENE_FILES, ("a.exr",), text=lambda text: sorted(json.loads(text))),
    Job(RENDER, SCENE_FILES, ("a.exr",), resume=CHECKPOINTS, keeps=("a.exr.part",)),
    Job((*RENDER[:-2], "--samples", "0:32", "--part", "c.part"), SCENE_FILES, ("c.part",), table=without_statistics,
        resume=("--resume",), replaces=False),
    Job((*BRF, "--csv", "a.csv", "--json", "-"), SCENE_FILES, ("a.csv",), text=str),
    Job((*BRF, "--csv", "a.csv"), SCENE_FILES, ("a.csv",), resume=CHECKPOINTS, keeps=("a.csv.part",)),
    Job((*FLUX, "--json", "a.json", "--csv", "-"), SCENE_FILES, ("a.json",), text=str),
    Job((*FLUX, "--csv", "a.csv"), SCENE_FILES, ("a.csv",), resume=CHECKPOINTS, keeps=("a.csv.part",)),
    Job((*COMPARE, "--csv", "a.csv", "-o", "report"), COMPARED_FILES, ("a.csv",), table=without_times, folder="report"),
    Job((*FIT, "-o", "a.pbrt", "--json", "-"), ("spectra.csv",), ("a.pbrt",), text=str),
    Job(("merge", "a.part", "b.part", "-o", "a.exr"), ("a.part", "b.part"), ("a.exr",)),
    Job(("merge", "a.part", "b.part", "--part", "c.part"), ("a.part", "b.part"), ("c.part",), table=without_statistics),
]
CACHE_JOB = Job(("render", "compared.pbrt", "--threads", "1", "--spp", "16", "--wavelengths", "smpte", "--cache", "cache", "-o",
                 "a.exr"), COMPARED_FILES, ("a.exr",))
SIGNALS = ("INT", "TERM", "KILL", "KILL", "HUP", "PIPE", "QUIT", "USR1", "ALRM", "WINCH", "CONT")


class Expected:
    """The inputs, and what each command makes of them when nothing disturbs it."""

    def __init__(self, folder):
        self.folder, self.results, self.seconds, self.sizes, self.reports = folder, {}, {}, {}, {}
        folder.mkdir()
        for name, text in (("scene.pbrt", SCENE), ("plain.pbrt", PLAIN), ("compared.pbrt", COMPARED), ("mesh.ply", mesh(0.3)),
                           ("light.spd", "".join(f"{nm} {1 + nm / 1000}\n" for nm in range(360, 831, 5)))):
            (folder / name).write_text(text, encoding="utf-8")
        self.frond(folder, "table", "--specimen", "soybean", "--wavelengths", "360:830:10", "-o", "leaf.csv")
        self.frond(folder, "canopy", "--count", "200", "--size", "2,2", "--seed", "1", "-o", "leaves.npy")
        self.frond(folder, "render", "plain.pbrt", "--no-cache", "--wavelengths", "smpte", "--spp", "4", "-o", "texture.exr")
        self.frond(folder, "spectrophotometer", "leaf_solved", "--wavelengths", "400:1000:30", "--rays", "2000", "--csv",
                   "spectra.csv")
        for name, samples in (("a", "0:32"), ("b", "32:64")):
            self.frond(folder, *RENDER[:-2], "--samples", samples, "--part", f"{name}.part")
        self.inputs = sorted(path.name for path in folder.iterdir())
        self.variants = {"scene.pbrt": SCENE.replace('fov" 45', 'fov" 55').encode(), "mesh.ply": mesh(0.4).encode(),
                         "leaf.csv": b"theta_deg,wavelength_nm,Rs,Rd,T\n0,550,0.05,.1,.2\n", "light.spd": b"300 1\n900 1.5\n"}

    @staticmethod
    def frond(folder, *words):
        done = run([FROND, *words, "-q"], folder)
        assert done.code == 0, f"frond {' '.join(words)}: exit code {done.code}\n{done.err}"
        return done

    def of(self, job):
        """Files and text of an undisturbed run; measured once."""
        if job not in self.results:
            folder = self.folder.parent / str(len(self.results))
            shutil.copytree(self.folder, folder)
            begin = time.monotonic()
            self.results[job] = result_of(job, folder, self.frond(folder, *job.words).out)
            self.seconds[job] = time.monotonic() - begin
            self.sizes[job] = max((folder / name).stat().st_size for name in job.outputs)
            self.reports[job] = files_below(folder / job.folder) if job.folder else []
        return self.results[job]


def files_below(folder):
    return sorted(str(path.relative_to(folder)) for path in folder.rglob("*") if path.is_file())


def content(job, path):
    """What of a file is compared: None if there is none, OLD for the old one."""
    data = path.read_bytes() if path.is_file() else None
    try:
        return job.table(data) if job.table and data not in (None, OLD) else data
    except (KeyError, ValueError, IndexError, AssertionError, struct.error):
        return ("half a table", data)


def result_of(job, folder, out):
    try:
        text = job.text(out) if job.text else None
    except ValueError:
        text = ("half a text", out)
    return {name: content(job, folder / name) for name in job.outputs}, text


def start(command, folder, **more):
    environment = dict(os.environ, SOURCE_DATE_EPOCH="0")
    settings = {"stdin": subprocess.DEVNULL, "stdout": subprocess.PIPE, "stderr": subprocess.PIPE, **more}
    return subprocess.Popen(command, cwd=folder, env=environment, text=True, errors="replace", **settings)


def finish(process, signals=()):
    try:
        out, err = process.communicate(timeout=LONGEST)
    except subprocess.TimeoutExpired:
        process.kill()
        out, err = process.communicate()
        raise AssertionError(f"it had not ended after {LONGEST} s\n{err}") from None
    return types.SimpleNamespace(code=process.returncode, out=out, err=err, signals=signals)


def run(command, folder, **more):
    return finish(start(command, folder, **more))


class RandomFaults(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        folder = tempfile.TemporaryDirectory(prefix="frond_faults_")
        cls.addClassCleanup(folder.cleanup)
        cls.expected = Expected(pathlib.Path(folder.name) / "inputs")

    def begin(self, number):
        folder = tempfile.TemporaryDirectory(prefix="frond_faults_", ignore_cleanup_errors=True)
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name) / "run"
        shutil.copytree(self.expected.folder, self.folder)
        self.random, self.what, self.command = random.Random(f"{SEED}:{number}"), [], []

    def choose(self, suits=lambda job: True):
        self.use(self.random.choice([job for job in JOBS if suits(job)]))

    def use(self, job):
        self.job = job
        self.expected.of(job)
        self.command = [FROND, *job.words, *job.resume] + (["-q"] if self.random.random() < 0.5 else [])
        self.olds = {name: OLD if self.random.random() < 0.5 and job.replaces else None for name in job.outputs}
        for name in filter(self.olds.get, self.olds):
            (self.folder / name).write_bytes(OLD)

    def moment(self, early=False):
        """A random time of the run; `early`: as often while it reads its inputs as at any other time."""
        longest = 0.06 if early and self.random.random() < 0.5 else 1.1 * self.expected.seconds[self.job]
        moment = self.random.uniform(0, longest)
        self.what.append(f"after {moment:.4f} s")
        return moment

    def temporaries(self):
        names = [name for name in files_below(self.folder) if not name.startswith("cache/")]
        return [name for name in names if name.split("/")[-1].startswith(".frond-")]

    def check(self, done, *, text=True, message=True, code=None, others=()):
        """That a run is complete, or has failed and left nothing half-written. `text`: its standard output was read;
        `message`: so was its standard error; `code`: what it must end with; `others`: further results that are right."""
        files, wanted = self.expected.of(self.job)
        found, out = result_of(self.job, self.folder, done.out or "")
        sizes = {name: path.stat().st_size for name in self.job.outputs if (path := self.folder / name).is_file()}
        told = f"exit code {done.code}; bytes {sizes}; standard error:\n{done.err}"
        if done.code < 0:
            self.assertIn(-done.code, done.signals, f"ended by a signal that was not sent: {told}")
        if code is not None:
            self.assertEqual(done.code, code, told)
        if done.code == 0:
            is_right = any(found == f and (not self.job.text or (text and out == t)) for f, t in [(files, wanted), *others])
            self.assertTrue(is_right, f"exit code 0, but the output is not complete or not right: {told}")
        elif done.code > 0 and message and not (done.code in (129, 130, 143) and "-q" in self.command):
            self.assertRegex(done.err, "(?m)^(frond: |stopped; )", f"no message: {told}")
        for name, data in found.items():
            right = [files[name], self.olds[name], *(f[name] for f, _ in others)]
            self.assertIn(data, right, f"{name} is half-written: {told}")
        if done.code >= 0:
            self.assertEqual(self.temporaries(), [], told)

    def check_again(self):
        """The same command without a fault: complete, and nothing is left of the runs before."""
        done = run(self.command, self.folder)
        self.check(done, code=0)
        files = [name for name in files_below(self.folder) if not (self.job.folder and name.startswith(self.job.folder))]
        wanted = sorted({*self.expected.inputs, *self.job.outputs, *self.job.keeps})
        self.assertEqual([name for name in files if not name.startswith("cache/")], wanted)
        if self.job.folder:
            self.assertEqual(files_below(self.folder / self.job.folder), self.expected.reports[self.job])

    def signals(self):
        """A run, or several of which each goes on where the one before was, ended by signals."""
        several = self.random.random() < 0.4
        self.choose(lambda job: job.resume or not several)
        for _ in range(self.random.randint(1, 4) if several else 1):
            name = self.random.choice(SIGNALS)
            numbers = [getattr(signal, f"SIG{name}")] * (2 if name in ("INT", "TERM") and self.random.random() < 0.3 else 1)
            self.what.append(f"{name} {len(numbers)} times")
            process = start(self.command, self.folder)
            time.sleep(self.moment())
            for number in numbers:
                process.send_signal(number)
            done = finish(process, numbers)
            self.check(done, code=0 if name in ("WINCH", "CONT") else None)
            if done.code == 0:
                self.olds = dict(self.expected.of(self.job)[0])
        self.check_again()

    def stop_and_continue(self):
        self.choose()
        self.what.append("signals STOP and CONT")
        process = start(self.command, self.folder)
        time.sleep(self.moment())
        process.send_signal(signal.SIGSTOP)
        time.sleep(self.random.uniform(0, 0.3))
        process.send_signal(signal.SIGCONT)
        self.check(finish(process), code=0)

    def limits(self):
        """A small limit on the size of files or on the number of open ones."""
        self.choose()
        name = self.random.choice(("RLIMIT_FSIZE", "RLIMIT_NOFILE"))
        small = self.random.randrange(4, 25 if name == "RLIMIT_NOFILE" else int(1.1 * self.expected.sizes[self.job]))
        self.what.append(f"{name} {small}")
        done = run(self.command, self.folder, preexec_fn=lambda: resource.setrlimit(getattr(resource, name), (small, small)))
        self.check(done, message=name == "RLIMIT_FSIZE")
        self.assertTrue(done.code == 0 or done.err)  # that of the dynamic linker, perhaps
        self.check_again()

    def full_file_system(self):
        """A small file system that is full, or filled at some moment."""
        self.choose()
        size = sum(path.stat().st_size for path in self.folder.iterdir()) // 4096 + (500 if self.job.folder else 120)
        place = self.folder.parent / "small"
        place.mkdir()
        mount = ["mount", "-t", "tmpfs", "-o", f"size={4 * size}k", "frond_test", str(place)]
        if subprocess.run(mount, capture_output=True, check=False).returncode != 0:
            self.skipTest("nothing can be mounted here")
        self.addCleanup(subprocess.run, ["umount", "-l", str(place)], check=True)
        shutil.copytree(self.folder, place, dirs_exist_ok=True)
        self.folder = place
        late = self.random.random() < 0.5
        self.what.append("a full file system" + (", filled" if late else ""))
        process = start(self.command, place) if late else None
        time.sleep(self.moment() if late else 0)
        filler = place / "filler"
        with contextlib.suppress(OSError), filler.open("wb", buffering=0) as file:
            while file.write(b"x" * 4096) == 4096:
                pass
        os.truncate(filler, max(0, filler.stat().st_size - self.random.choice((0, 1, 2, 5)) * 4096))
        self.check(finish(process or start(self.command, place)))
        filler.unlink()
        self.check_again()

    def stream(self):
        """A standard stream that is closed, /dev/full, or a pipe that nobody reads."""
        self.choose(lambda job: job.text or self.random.random() < 0.5)
        streams = self.random.choice(((0,), (1,), (2,), (1,), (2,), (0, 1), (1, 2), (0, 1, 2)))
        how = self.random.choice(("closed", "full", "broken"))
        self.what.append(f"streams {streams} {how}")
        names = ("stdin", "stdout", "stderr")
        closed = [number for number in streams if how == "closed" or number == 0]
        reader, broken = os.pipe()
        os.close(reader)
        full = os.open("/dev/full", os.O_WRONLY)
        more = {names[number]: full if how == "full" else broken for number in streams if number not in closed}
        more |= {names[number]: subprocess.DEVNULL for number in closed}
        process = start(self.command, self.folder, preexec_fn=lambda: [os.close(number) for number in closed], **more)
        os.close(broken)
        os.close(full)
        done = finish(process, [signal.SIGPIPE] if how == "broken" and streams != (0,) else [])
        self.check(done, text=1 not in streams, message=2 not in streams)
        if how != "broken" and not (1 in streams and self.elsewhere()[0].out):  # a pipe without a reader may end a program
            self.assertEqual(done.code, 0, f"the output is complete, but the exit code is not 0: {done.err}")
        self.check_again()

    def elsewhere(self, **inputs):
        """This command without a fault, with other contents of inputs: how it ended, and its files in a folder that is kept."""
        folder = self.folder.parent / "elsewhere"
        shutil.copytree(self.expected.folder, folder)
        (folder / "out").mkdir()
        for name, data in inputs.items():
            (folder / name).write_bytes(data)
        return run(self.command, folder), folder

    def input(self):
        """An input that changes while the program runs: the result is that with the old or the new content, or an error."""
        self.choose(lambda job: not job.resume)
        name = self.random.choice(self.job.inputs)
        path, data = self.folder / name, (self.folder / name).read_bytes()
        new = self.expected.variants.get(name) or bytes(byte ^ (self.random.random() < 0.01) for byte in data)
        how = self.random.choice(("truncated", "replaced", "overwritten", "deleted"))
        self.what.append(f"{name} {how}")
        if how == "truncated":
            new = data[: self.random.randrange(len(data))]
        moment = self.moment(early=True)
        process = start(self.command, self.folder)
        time.sleep(moment)
        if how == "overwritten":
            with path.open("r+b", buffering=0) as file:
                file.write(new)
        if how in ("overwritten", "truncated"):
            os.truncate(path, len(new))
        elif how == "replaced":
            (self.folder / "other").write_bytes(new)
            (self.folder / "other").replace(path)
        else:
            path.unlink()
        done = finish(process)
        others = []
        if how != "deleted" and not done.code:
            again, folder = self.elsewhere(**{name: new})
            others = [result_of(self.job, folder, again.out)] if again.code == 0 else []
        self.check(done, others=others)
        path.write_bytes(data)
        if not done.code:
            self.olds = {name: content(self.job, self.folder / name) for name in self.job.outputs}
        self.check_again()

    def output_place(self):
        """An output that becomes read-only or a folder, or whose folder is removed or becomes read-only."""
        self.choose(lambda job: not (job.resume or job.folder or job.table))
        how = self.random.choice(("read-only", "a folder", "folder removed", "folder read-only"))
        (self.folder / "out").mkdir()
        name, place = self.job.outputs[0], self.folder / "out"
        self.command[self.command.index(name)] = f"out/{name}"
        output = place / name
        if self.olds[name]:
            (self.folder / name).replace(output)
        self.what.append(f"the output {how}")
        process = start(self.command, self.folder)
        time.sleep(self.moment())
        if how == "read-only" and output.exists():
            output.chmod(0o444)
        elif how == "a folder" and not output.exists():
            output.mkdir()
        elif how == "folder removed":
            shutil.rmtree(place, ignore_errors=True)
        elif how == "folder read-only":
            place.chmod(0o555)
        ended = process.poll() is not None
        done = finish(process)
        told = f"exit code {done.code}: {done.err}"
        self.assertGreaterEqual(done.code, 0, told)
        self.assertTrue("frond: " in done.err if done.code else ended or output.is_file(), told)
        if output.is_file():
            whole = (self.elsewhere()[1] / "out" / name).read_bytes()
            self.assertIn(output.read_bytes(), [whole, self.olds[name] if done.code else whole], f"half-written: {told}")
        self.assertEqual(self.temporaries(), [], told)

    def two_runs(self):
        """Two runs with one output, of which one may be killed."""
        self.choose()
        kills = self.random.random() < 0.4
        self.what.append("two runs with one output" + (", one killed" if kills else ""))
        first = start(self.command, self.folder)
        time.sleep(self.random.uniform(0, 0.5 * self.expected.seconds[self.job]))
        second = start(self.command, self.folder)
        if kills:
            time.sleep(self.moment())
            first.kill()
        ended = [finish(first), finish(second)]
        for done in ended[kills:]:
            self.assertIn(done.code, (0, 75) if self.job.resume else (0,), done.err)
            if done.code == 0:
                self.assertEqual(result_of(self.job, self.folder, done.out), self.expected.of(self.job))
        self.check_again()

    def cache(self):
        """Runs that share a cache, of which some are killed: the others are right, and so is the cache."""
        self.use(CACHE_JOB)
        others = [self.folder.parent / f"other{number}" for number in range(self.random.randint(1, 3))]
        for other in others:
            shutil.copytree(self.expected.folder, other)
        self.command = [str(self.folder / "cache") if word == "cache" else word for word in self.command]
        processes = [start(self.command, folder) for folder in (self.folder, *others)]
        for process in processes[1:]:
            time.sleep(self.moment() / 2)
            process.kill()
        for process in processes[1:]:
            process.communicate()
        self.check(finish(processes[0]), code=0)
        self.check_again()


FAULTS = ("signals", "stream", "input", "limits", "signals", "cache", "input", "signals", "two_runs", "output_place", "stream",
          "full_file_system", "signals", "input", "stop_and_continue", "limits")

resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def test_of(number):
    def test(self):
        name = FAULTS[number % len(FAULTS)]
        self.begin(number)
        try:
            getattr(self, name)()
        except AssertionError as error:
            again = f"FROND_FAULT_SEED={SEED} FROND_FAULT_ONLY={number}"
            words = f"fault: {name}: {'; '.join(self.what)}\ncommand: {' '.join(self.command)}\nagain: {again}"
            raise AssertionError(f"{error}\n{words}") from None

    return test


for index in [int(ONLY)] if ONLY else range(COUNT):
    setattr(RandomFaults, f"test_{index:03}_{FAULTS[index % len(FAULTS)]}", test_of(index))

if __name__ == "__main__":
    unittest.main()
