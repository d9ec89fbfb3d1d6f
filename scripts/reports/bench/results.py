"""One run of the benchmarks, as Google Benchmark writes it, in several rounds: a process each."""

import json
import statistics

SECONDS = {"ns": 1e-9, "us": 1e-6, "ms": 1e-3, "s": 1.0}

# What Google Benchmark itself says of a benchmark; all other numbers are counters of ours.
FIELDS = {"family_index", "per_family_instance_index", "repetitions", "repetition_index", "threads", "iterations",
          "real_time", "cpu_time", "items_per_second", "bytes_per_second", "round"}


class Run:
    """times[benchmark][round]: CPU seconds of an iteration, of the fastest repetition of a round, which the machine
    disturbed least. counters[benchmark][counter][round]: the mean of a round."""

    def __init__(self, document):
        self.context = document["context"]
        self.times, self.counters = {}, {}
        values = {}
        for entry in document["benchmarks"]:
            if entry.get("run_type", "iteration") != "iteration" or entry.get("error_occurred"):
                continue
            name, index = entry["name"], entry.get("round", entry.get("repetition_index", 0))
            seconds = entry["cpu_time"] * SECONDS[entry["time_unit"]]
            rounds = self.times.setdefault(name, {})
            rounds[index] = min(seconds, rounds.get(index, seconds))
            for counter, value in counters_of(entry):
                values.setdefault((name, counter, index), []).append(value)
        for (name, counter, index), all_of_round in values.items():
            rounds = self.counters.setdefault(name, {}).setdefault(counter, {})
            rounds[index] = sum(all_of_round) / len(all_of_round)

    @property
    def label(self):
        return self.context.get("commit", "a commit that nobody noted")

    def mean_of(self, names):
        """As a benchmark of its own: the geometric mean of these in each round that has them all."""
        common = set.intersection(*(set(self.times[name]) for name in names))
        return {index: statistics.geometric_mean(self.times[name][index] for name in names) for index in common}

    @property
    def rounds(self):
        return len({index for rounds in self.times.values() for index in rounds})


def counters_of(entry):
    return [(k, v) for k, v in entry.items() if k not in FIELDS and isinstance(v, (int, float))]


def read(path):
    try:
        with open(path, encoding="utf-8") as file:
            return Run(json.load(file))
    except (OSError, ValueError, KeyError) as error:
        raise SystemExit(f"{path} is not what scripts/bench or frond_bench writes: {error}") from error


def family(name):
    """The benchmarks that belong together: what stands before the first slash."""
    return name.split("/")[0]
