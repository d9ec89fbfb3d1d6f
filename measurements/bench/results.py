"""One run of the benchmarks in Google Benchmark's format, with several rounds (one process each)."""

import json

import pandas

SECONDS = {"ns": 1e-9, "us": 1e-6, "ms": 1e-3, "s": 1.0}

# Google Benchmark's own fields of a benchmark; all other numbers are frond's counters.
FIELDS = {"family_index", "per_family_instance_index", "repetitions", "repetition_index", "threads", "iterations",
          "real_time", "cpu_time", "items_per_second", "bytes_per_second", "round", "seconds"}


class Run:
    """`times[benchmark][round]`: CPU seconds of an iteration in the fastest repetition of a round, which other work disturbed
    least. `counters[benchmark][counter][round]`: mean of a round."""

    def __init__(self, document):
        self.context = document["context"]
        entries = pandas.DataFrame([
            e | {"round": e.get("round", e.get("repetition_index", 0)), "seconds": e["cpu_time"] * SECONDS[e["time_unit"]]}
            for e in document["benchmarks"] if e.get("run_type", "iteration") == "iteration" and not e.get("error_occurred")])
        self.times = entries.pivot_table("seconds", "round", "name", "min")[list(entries["name"].unique())]
        ours = [name for name in entries.select_dtypes("number") if name not in FIELDS]
        means = entries.groupby(["name", "round"])[ours].mean()
        self.counters = {name: means.loc[name].dropna(axis=1, how="all") if ours else pandas.DataFrame() for name in self.times}

    @property
    def label(self):
        return self.context.get("commit", "unknown commit")

    @property
    def rounds(self):
        return len(self.times)


def read(path):
    try:
        with open(path, encoding="utf-8") as file:
            return Run(json.load(file))
    except (OSError, ValueError, KeyError) as error:
        raise SystemExit(f"{path} is not what measurements/run bench or frond_bench writes: {error}") from error


def family(name):
    """The family of a benchmark: its name up to the first slash."""
    return name.split("/")[0]
