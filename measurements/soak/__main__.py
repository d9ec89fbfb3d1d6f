"""Soak: random scenes of all plug-ins in one process for hours (section "soak" of docs/reliability.md)

Checks memory, open files, numbers that are not finite, images that differ when they are rendered again, and drift of means. A
process renders scene after scene and writes log.jsonl; this one watches it. When it dies, another continues with the next scene.
The log and the scenes of all findings are in build/soak_report. Exit code 1 if there is a finding. Ctrl-C or SIGTERM end it with
the table of what has run.
  --hours H   default: 1
  --seed N    default: 1
  --scene N   renders scene N of the seed alone
  --quick     two minutes, and the section into build/soak_report
"""

import collections
import ctypes
import gc
import json
import logging
import os
import pathlib
import random
import re
import shutil
import signal
import subprocess
import sys
import time

import numpy
import scipy.stats

from ..shared.tools import ROOT, arguments, machine, table, write_section
from .scenes import FIXED, Generator, make_inputs, plugins

FOLDER = ROOT / "build" / "soak_report"
INPUTS, LAST, LOG, FIRST = FOLDER / "inputs", FOLDER / "last.pbrt", FOLDER / "log.jsonl", FOLDER / "references.json"
RATE = 1e-4  # false alarms of a test of one run
REPEAT, JOB, MEASURE = 5, 20, 10  # every so many scenes: one is rendered again, another job is run, memory is measured
REFERENCES, CHECK = 40, 120  # renders of each fixed scene at the beginning, seconds between later ones
LONGEST, GRACE = 120, 60  # seconds after which a scene is stopped, and until it has to have stopped
DIES, WARM, BLOCKS, LEAST = 20, 500, 20, 5  # crashes after which the soak ends; scenes before memory counts; blocks of its measurements, and how many each has at least


def check_finite(arrays):
    if wrong := [name for name, array in arrays.items() if not numpy.isfinite(array).all()]:
        raise ArithmeticError(f"not finite: {', '.join(wrong)}")


def general(message):
    """A message without the place in the scene, and with N for numbers."""
    return re.sub(r"(?<![\w\"])[-\d.e+]*\d", "N", re.sub(r"^\S*<string>[:\d]*: ", "", message.split("\n")[0]))


class Worker(logging.Handler):
    """The process that renders. It receives the warnings of frond."""

    def __init__(self, options):
        super().__init__(logging.WARNING)
        def late(*_):
            raise TimeoutError
        signal.signal(signal.SIGALRM, late)
        signal.signal(signal.SIGINT, signal.SIG_IGN if options.worker else signal.default_int_handler)
        signal.signal(signal.SIGTERM, signal.default_int_handler)
        import frond
        self.frond, self.seed, self.first, self.number = frond, options.seed, options.scene, options.scene
        self.log, self.warned, self.trim = LOG.open("a", encoding="utf-8", buffering=1), [], ctypes.CDLL(None).malloc_trim
        self.sessions = [frond.Session(threads=2, cache=False), frond.Session(threads=1, cache=FOLDER / "cache")]
        logging.getLogger("frond").addHandler(self)
        logging.getLogger("frond").propagate = False
        make_inputs(frond, INPUTS)
        os.chdir(INPUTS)
        self.kinds = plugins(frond.describe(markdown=True).text)
        self.write("plugins", names=[f"{kind} {name}" for kind, names in self.kinds.items() for name in names])

    def emit(self, record):
        self.warned += [record.getMessage()] if re.search("not a number|not finite", record.getMessage()) else []

    def write(self, what, **values):
        self.log.write(json.dumps({"what": what, "number": self.number, **values}) + "\n")

    def finding(self, kind, text, message):
        path = FOLDER / f"{kind.replace(' ', '-')}-{self.number}.pbrt"
        path.write_text(text, encoding="utf-8")
        self.write("finding", kind=kind, message=general(message), file=path.name)
        print(f"scene {self.number} of seed {self.seed}: {message}", flush=True)

    def attempt(self, what, text, function):
        """(end, result): done, refused, stopped after LONGEST seconds, or failed. Failures and numbers counted as black are findings."""
        text = f"# scene {self.number} of seed {self.seed}, {what}\n{text}"
        LAST.write_text(text, encoding="utf-8")
        self.warned, begin, result, why = [], time.monotonic(), None, ""
        signal.setitimer(signal.ITIMER_REAL, LONGEST)
        try:
            end, result = "done", function()
        except TimeoutError:
            end = "stopped"
            shutil.copy(LAST, FOLDER / f"stopped-{self.number}.pbrt")
        except self.frond.InputError as error:
            end, why = "refused", re.sub(r'"[^"]*"', '"..."', general(str(error)))
        except Exception as error:  # pylint: disable=broad-except
            end, kind = "failed", "not finite" if isinstance(error, ArithmeticError) else "error"
            self.finding(kind, text, f"{what.split(',')[0]}: {type(error).__name__}: {error}")
        finally:
            signal.setitimer(signal.ITIMER_REAL, 0)
        self.write(what.split(",")[0].split()[0], end=end, why=why, seconds=time.monotonic() - begin)
        for warning in self.warned if not what.startswith("again") else []:
            self.finding("not finite", text, warning)
        return end, result

    def render(self):
        made = Generator(self.kinds, self.number, self.seed)
        text, more = made.scene()
        sessions = self.sessions[:: made.random.choice((1, -1))]
        def image_in(session):
            image = self.frond.loads(text, INPUTS, session=session, **more).render()
            check_finite({channel: image[channel] for channel in image.channels})
            return image.array.tobytes()
        end, bits = self.attempt(f"render, {more}", text, lambda: image_in(sessions[0]))
        self.write("uses", names=sorted(made.used) if end == "done" else [])
        if self.number % REPEAT == 0 and end == "done":
            end, again = self.attempt(f"again, {more}", text, lambda: image_in(sessions[1]))
            if end == "refused" or (end == "done" and again != bits):
                self.finding("other bits", f"# {more}\n{text}", "other bits when it is rendered again")

    def job(self):
        """One of the other jobs, at cheap settings."""
        made = Generator(self.kinds, -self.number - 1, self.seed)
        frond, r, session, nm, scene = self.frond, made.random, self.sessions[0], [450, 550, 650], INPUTS / "job.pbrt"
        material, leaf = made.words("material"), f"leaf_solved,thickness={r.uniform(1e-4, 4e-4):.6g}"
        def conform():
            laws = frond.conform(material, samples=1000, angles="30", given_only=True, session=session, false_alarm_rate=1e-9)
            if not laws["all_hold"]:
                raise ValueError(f"broken: {[law for law, is_ in laws['laws'].items() if is_['verdict'] not in ('holds', 'not tested')]}")
            return 0
        jobs = {"spectrophotometer": lambda: frond.spectrophotometer(material, nm, rays=1000, session=session),
            "goniophotometer": lambda: frond.goniophotometer(material, nm, rays=1000, patches=(4, 8), session=session)["f"],
            "brf": lambda: frond.brf(scene, nm, zenith="-60:60:30", paths=500, session=session), "flux": lambda: frond.flux(scene, nm, paths=1000, session=session),
            "leaf_table": lambda: frond.leaf_table(leaf, nm, tolerance=0.01, session=session)["adaxial_reflected"],
            "fit": lambda: list(frond.fit([450, 550, 650, 800], [0.05, 0.12, 0.06, 0.45], [0.02, 0.1, 0.04, 0.45], like="soybean", session=session).leaf.values()), "conform": conform,
            "bsdf": lambda: frond.bsdf(material, nm, session=session).f([[0, 0.6, 0.8]], [[0.6, 0, 0.8], [0.6, 0, -0.8]]),
            "check": lambda: len(frond.check(str(scene), session=session).text)}
        name = r.choice(sorted(jobs))
        def numbers():
            found = jobs[name]()
            columns = dict(found.select_dtypes("number")) if hasattr(found, "select_dtypes") else {"result": numpy.asarray(found)}
            check_finite({key: column for key, column in columns.items() if key[:2] not in ("Rs", "Rd")})  # not all materials tell Rs from Rd
        self.attempt(f"job {name}, material {material}, leaf {leaf}", "", numbers)

    def fixed(self, name, seed):
        """Bits of a fixed scene, and the mean of its channel G."""
        image = self.frond.loads(FIXED[name], INPUTS, session=self.sessions[1], seed=seed, wavelengths="smpte").render(16)
        return image.array.tobytes().hex(), float(image["G"].mean(dtype=float))

    def check_fixed(self):
        """The fixed scenes with the seed of the first reference, whose bits they must have, and with one that is new."""
        for name, found in json.loads(FIRST.read_text(encoding="utf-8")).items():
            end, two = self.attempt(f"fixed {name}", FIXED[name], lambda: [self.fixed(name, seed) for seed in (0, REFERENCES + self.number)])
            if end == "done":
                self.write("mean", name=name, mean=two[1][1])
            if end == "refused" or (end == "done" and two[0][0] != found[0][0]):
                self.finding("other bits", FIXED[name], f"{name}: other bits than at the beginning")

    def measure(self):
        """Resident memory in MB, after free memory has been returned to the system; open files; threads."""
        gc.collect(), self.trim(0)
        status = pathlib.Path("/proc/self/status").read_text(encoding="utf-8")
        kilobytes, threads = (int(re.search(rf"^{key}:\s+(\d+)", status, re.MULTILINE)[1]) for key in ("VmRSS", "Threads"))
        self.write("memory", first=self.first, megabytes=kilobytes / 1024, files=len(os.listdir("/proc/self/fd")), threads=threads)

    def run(self, hours):
        if hours == 0:  # one scene
            return self.render() or (self.number % JOB == 0 and self.job()) or print(LOG.read_text(encoding="utf-8"))
        if not FIRST.exists():  # references of this process and those after it
            found = {name: [self.fixed(name, seed) for seed in range(REFERENCES)] for name in FIXED}
            FIRST.write_text(json.dumps(found), encoding="utf-8")
        begin = checked = time.monotonic()
        parent, every = os.getppid(), min(CHECK, 360 * hours)
        while time.monotonic() < begin + 3600 * hours and os.getppid() == parent:
            self.render()
            if self.number % JOB == 0:
                self.job()
            if self.number % MEASURE == 0:
                self.measure()
            if time.monotonic() - checked > every:
                self.check_fixed()
                checked = time.monotonic()
            self.number += 1


def growth(memory):
    """Growth in kB per scene of memory in MB, half width of its 95 % interval, probability of such a growth if there is none."""
    steps = numpy.diff([block.mean() for block in numpy.array_split(numpy.array(memory), BLOCKS)])
    mean, error, unit = steps.mean(), scipy.stats.sem(steps), 1024 * BLOCKS / (len(memory) * MEASURE)
    probability = scipy.stats.t.sf(mean / error, BLOCKS - 2) if error > 0 else float(mean <= 0)
    return mean * unit, scipy.stats.t.ppf(0.975, BLOCKS - 2) * error * unit, probability


SECTION = """## Soak

Measured on {machine}. `measurements/run soak --seed {seed}` rendered random scenes in one process for {hours:.3g} h: plug-ins and
parameters are drawn from the ranges that `frond describe` states, films have at most 20 × 20 pixels. Every {REPEAT} scenes the
scene is rendered again with another number of threads, every {JOB} scenes another job runs (BRF, flux, instruments, leaf tables,
fits, laws of BSDFs).

{summary}
A scene is refused, with an `InputError`, if its parameters exclude each other. Numbers that are not finite are those of images, of
results of jobs, and those that frond counts as black with a warning. `measurements/run soak --seed {seed} --scene N` repeats scene N.

**Memory** is resident memory after free memory has been returned to the system, measured every {MEASURE} scenes. The first fifth of
the measurements, and at least {WARM} scenes, are warm-up. The means of {BLOCKS} successive blocks of the others must not increase:
Student's t-test of their differences. A probability below {RATE:g} is a finding, at this false-alarm rate if memory varies like a random
walk, at a lower one if blocks vary independently. Open files, threads: a finding if the last block is above the first everywhere.

**Drift.** Four fixed scenes are rendered every {every:.0f} s with two seeds. With the first, the image must have the bits that it had at
the beginning. With the other, new each time, the means must be those of {REFERENCES} renders at the beginning: Student's t-test. A
probability below {RATE:g} / {count} is a finding: the false-alarm rate of the table is {RATE:g}.

{drift}
{findings}
"""


def report(options, seconds, crashes):
    """Writes the section from the log and the findings of crashes. Returns the number of all findings."""
    log, rows = collections.defaultdict(list), []
    for record in map(json.loads, LOG.read_text(encoding="utf-8").splitlines() if LOG.exists() else []):
        log[record["what"]].append(record)
    findings = [(one["kind"], one["message"], one["file"]) for one in log["finding"]] + crashes
    attempts = [one for what in ("render", "again", "job", "fixed") for one in log[what]]
    ends = {what: collections.Counter(one["end"] for one in log[what]) for what in ("render", "again", "job")}
    findings += [] if ends["render"]["done"] else [("error", "no scene was rendered", "")]
    late = max(([one for one in log["memory"] if one["first"] == first] for first in {one["first"] for one in log["memory"]}), key=len, default=[])
    eighths = [f"{late[len(late) * i // 8 - 1]['megabytes']:.0f}" for i in range(1, 9)] if len(late) >= 8 else []
    late = late[max(len(late) // 5, WARM // MEASURE):]
    memory = [[f"memory, tested with {BLOCKS * LEAST} measurements after warm-up", f"{len(late)} measurements"]]
    if len(late) >= BLOCKS * LEAST:
        grows, half, probability = growth([one["megabytes"] for one in late])
        says, size = f"{grows:.2f} ± {half:.2f} kB per scene, probability {probability:.2g}", len(late) // BLOCKS
        memory = [["memory after each eighth of the scenes, MB", ", ".join(eighths)],
                  ["growth of memory, with its 95 % interval", says], ["open files, threads", f"{late[-1]['files']}, {late[-1]['threads']}"]]
        findings += [("leak", f"growth of memory: {says}", "")] if probability < RATE else []
        findings += [("leak", f"{key} become more", "") for key in ("files", "threads") if min(x[key] for x in late[-size:]) > max(x[key] for x in late[:size])]
    for name, first in json.loads(FIRST.read_text(encoding="utf-8")).items() if FIRST.exists() else []:
        later, reference, texts = [one["mean"] for one in log["mean"] if one["name"] == name], [mean for _, mean in first], ["not tested", ""]
        if len(later) > 1:
            test = scipy.stats.ttest_ind(later, reference)
            low, high = (100 * end / numpy.mean(reference) for end in test.confidence_interval(0.95))
            texts = [f"{(low + high) / 2:+.3f} ± {(high - low) / 2:.3f}", f"{test.pvalue:.2g}"]
            findings += [] if test.pvalue >= RATE / len(FIXED) else [("drift", f"drift of {name}: probability {test.pvalue:.2g}", "")]
        rows.append([name, len(later), *texts])
    uses = collections.Counter({name: 0 for one in log["plugins"] for name in one["names"]})
    uses.update(name for one in log["uses"] for name in one["names"])
    least, count = min(uses.items(), key=lambda use: use[1], default=("none", 0))
    kinds = collections.Counter(kind for kind, _, _ in findings)
    summary = table(["", ""], [["scenes rendered; refused", f"{ends['render']['done']}; {ends['render']['refused']}"],
        ["other jobs; refused", f"{ends['job']['done']}; {ends['job']['refused']}"],
        [f"stopped after {LONGEST} s", sum(one["end"] == "stopped" for one in attempts)],
        ["longest scene or job", f"{max((one['seconds'] for one in attempts), default=0):.1f} s"],
        ["plug-ins used; least", f"{sum(map(bool, uses.values()))} of {len(uses)}; {least}, {count} times"],
        ["rendered again", ends["again"]["done"]], *memory, *([f"findings: {kind}", kinds[text]] for kind, text in (
            ("numbers that are not finite", "not finite"), ("other bits", "other bits"), ("errors", "error"), ("leaks", "leak"), ("drift", "drift"), ("crashes", "crash")))])
    listed, files = collections.Counter(message for _, message, _ in findings), {message: file for _, message, file in findings[::-1]}
    lines = [f"- {number} × {message}{f' ({files[message]})' if files[message] else ''}" for message, number in listed.most_common()]
    refused = collections.Counter(one["why"] for one in attempts if one["end"] == "refused")
    print(summary, *(f"{number} times refused: {message}" for message, number in refused.most_common(20)), *lines, sep="\n")
    write_section(options.docs / "reliability.md", "soak", SECTION.format(
        machine=machine(), seed=options.seed, hours=seconds / 3600, summary=summary, JOB=JOB, REPEAT=REPEAT, MEASURE=MEASURE, WARM=WARM,
        BLOCKS=BLOCKS, RATE=RATE, REFERENCES=REFERENCES, count=len(FIXED), every=min(CHECK, 360 * options.hours),
        drift=table(["scene", "renders", "difference of the mean, %, 95 %", "probability"], rows), findings="\n".join(lines) or "No finding."))
    return len(findings)


def watch(words, stops):
    """Exit code of the process that renders, which is ended by a signal in `stops`, or by a scene that does not stop."""
    LAST.write_text("# start\n", encoding="utf-8")
    with subprocess.Popen([sys.executable, "-B", "-m", "measurements.soak", *map(str, words)]) as process:
        told = False
        while process.poll() is None:
            time.sleep(0.5)
            if stops and not told:
                told = not process.terminate()
            if time.time() - LAST.stat().st_mtime > LONGEST + GRACE:
                process.kill()
                return f"none after {LONGEST + GRACE} s"
    return 0 if told and process.returncode == -signal.SIGTERM else process.returncode


def supervise(options):
    """Runs the process that renders, and again with the next scene when it has died. Returns the number of findings."""
    shutil.rmtree(FOLDER, ignore_errors=True)
    FOLDER.mkdir(parents=True)
    stops, first, crashes, begin = [], 0, [], time.monotonic()
    for number in (signal.SIGINT, signal.SIGTERM):
        signal.signal(number, lambda caught, _: stops.append(caught))
    while (left := options.hours - (time.monotonic() - begin) / 3600) > 0 and not stops and len(crashes) < DIES and first is not None:
        if not (code := watch(["--worker", "--hours", left, "--seed", options.seed, "--scene", first], stops)):
            break
        copy = shutil.copy(LAST, FOLDER / f"crash-{len(crashes)}.pbrt")
        crashes.append(("crash", f"the process ended; exit code: {code}", copy.name))
        at = re.match(r"# scene (\d+)", copy.read_text(encoding="utf-8"))
        first = int(at[1]) + 1 if at else None  # None: it cannot start
    return report(options, time.monotonic() - begin, crashes)


def main():
    options = arguments("soak", ("--hours", {"type": float}), ("--seed", {"type": int, "default": 1}), ("--scene", {"type": int}), ("--worker", {"action": "store_true"}))
    options.hours = options.hours or (1 / 30 if options.quick else 1) * (options.scene is None)
    if options.scene is None:
        sys.exit(1 if supervise(options) else 0)
    try:
        FOLDER.mkdir(parents=True, exist_ok=True)
        Worker(options).run(options.hours)
    except KeyboardInterrupt:  # SIGTERM
        pass


if __name__ == "__main__":
    main()
