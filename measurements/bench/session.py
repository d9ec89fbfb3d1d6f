"""Builds and runs the benchmarks: several rounds, each a separate process, with the programs in turn."""

import contextlib
import dataclasses
import json
import os
import pathlib
import subprocess
import tempfile
import time
import uuid

from ..shared.tools import ROOT, run

WORKTREES = ROOT / "build" / "bench"
QUICK_FILTER = r"^(scene/(soybean-front|hundred-leaves)|bsdf/.*/(hit_and|sample_from)|walk/soybean/|table/.*/smpte)"


@dataclasses.dataclass
class Setting:
    """Number and length of measurements. Google Benchmark runs the repetitions of a round in random order."""
    rounds: int = 12
    repetitions: int = 3
    min_time: float = 0.02  # seconds
    filter: str = "."


QUICK = Setting(rounds=5, min_time=0.01, filter=QUICK_FILTER)


class Program:
    """frond_bench built from a commit, or from the working tree that contains this file."""

    def __init__(self, commit=None):
        if commit in (None, "."):
            self.tree = ROOT
            self.commit = git("describe", "--always", "--abbrev=12", "--exclude=*", "--dirty")
        else:
            self.commit = git("rev-parse", "--verify", "--short=12", f"{commit}^{{commit}}")
            self.tree = WORKTREES / self.commit
            if not self.tree.exists():
                git("worktree", "add", "--detach", self.tree, self.commit)
        self.rounds = []

    def build(self):
        command = 'source "$0/scripts/setup.sh"; install_missing "${build_packages[@]}"; build frond_bench'
        done = subprocess.run(["bash", "-euo", "pipefail", "-c", command, str(self.tree)], check=False,
                              env=os.environ | {"CCACHE_BASEDIR": str(self.tree)})  # worktrees share ccache entries
        if done.returncode != 0:
            raise SystemExit(f"{self.tree} does not build")

    def run_round(self, setting, cache):
        with tempfile.NamedTemporaryFile(suffix=".json") as out:
            words = [self.tree / "build/release/bench/frond_bench", f"--benchmark_filter={setting.filter}",
                     f"--benchmark_repetitions={setting.repetitions}", "--benchmark_enable_random_interleaving=true",
                     f"--benchmark_min_time={setting.min_time}", "--benchmark_out_format=json",
                     f"--benchmark_out={out.name}"]
            done = subprocess.run(list(map(str, words)), env=os.environ | {"FROND_BENCH_CACHE": cache},
                                  capture_output=True, text=True, check=False)
            text = pathlib.Path(out.name).read_text(encoding="utf-8")
        if done.returncode != 0 or not text:
            raise SystemExit(f"{' '.join(map(str, words))}\n{done.stderr}")
        self.rounds.append(json.loads(text))


def git(*words):
    return run("git", "-C", ROOT, *words).strip()


def measure(programs, setting):
    """One document for each program, in the JSON format of Google Benchmark."""
    for program in programs:
        program.build()
    with film_cache() as cache:
        for index in range(setting.rounds):
            for program in programs if index % 2 == 0 else reversed(programs):
                start = time.monotonic()
                program.run_round(setting, cache)
                print(f"Round {index + 1} of {setting.rounds}, {program.commit}: {time.monotonic() - start:.0f} s",
                      flush=True)
    session = uuid.uuid4().hex
    return [document(program, setting, session) for program in programs]


def film_cache():
    """The folder of the films from which errors of scenes are computed; all rounds share it. The user's, or a temporary one."""
    own = os.environ.get("FROND_BENCH_CACHE")
    return contextlib.nullcontext(own) if own else tempfile.TemporaryDirectory()


def document(program, setting, session):
    contexts = [r["context"] for r in program.rounds]
    context = contexts[0] | {"commit": program.commit, "session": session, **dataclasses.asdict(setting),
                             "load_avg": [max(c["load_avg"][0] for c in contexts)]}
    entries = [entry | {"round": index} for index, r in enumerate(program.rounds) for entry in r["benchmarks"]
               if entry["run_type"] == "iteration"]
    entries.sort(key=lambda e: (e["family_index"], e["per_family_instance_index"], e["round"], e["repetition_index"]))
    return {"context": context, "benchmarks": entries}
