"""Made-up runs of the benchmarks, for the tests."""

import json
import math
import random

from measurements.bench.results import Run

CONTEXT = {"commit": "0123456789ab", "machine": "a machine", "num_cpus": 2, "mhz_per_cpu": 2300, "compiler": "g++ 12",
           "compiler_flags": "-O2", "load_avg": [0.5], "date": "2026-11-21", "frond_version": "0.1.0", "rounds": 10,
           "repetitions": 1}


def entry(name, index, seconds, **counters):
    return {"name": name, "run_type": "iteration", "repetition_index": 0, "round": index, "cpu_time": seconds * 1e9,
            "real_time": seconds * 1e9, "time_unit": "ns", "iterations": 100, "family_index": 0,
            "per_family_instance_index": 0, **counters}


def document(entries, **context):
    return {"context": CONTEXT | context, "benchmarks": entries}


def noisy(rng, names, rounds=10, noise=0.02, slower=(), drift=None, **context):
    """Times whose logarithms are normal; `slower` ones take a tenth longer; `drift` is added to those of each round."""
    entries = []
    for index in range(rounds):
        for name in names:
            shift = math.log(1.1) if name in slower else 0
            log = shift + rng.gauss(0, noise) + (drift[index] if drift else 0)
            entries.append(entry(name, index, 1e-6 * math.exp(log)))
    return document(entries, **context)


def in_turn(rng, names, slower=(), noise=0.02):
    """Two runs of one session, on a machine whose speed changes from round to round."""
    drift = [rng.gauss(0, 0.2) for _ in range(10)]
    return (Run(noisy(rng, names, noise=noise, drift=drift, session="s")),
            Run(noisy(rng, names, noise=noise, slower=slower, drift=drift, session="s")))


def apart(rng, names, slower=(), noise=0.02):
    return Run(noisy(rng, names, noise=noise)), Run(noisy(rng, names, noise=noise, slower=slower))


def images(rms, error=1e-4, name="scene/soybean-front/abm", **more):
    counters = {f"{kind}_{c}{se}": error if se else rms for kind in ("rms", "bias2", "offset") for c in ("red", "green", "blue")
                for se in ("", "_se")}
    counters |= {"variance": 1e-4, "variance_se": 1e-5, "speedup": 2.0, "speedup_equal_noise": 3.0, "efficiency": 1e9,
                 "us_per_path": 0.5}
    return document([entry(name, i, 1e-3 * (1 + i / 100), **(counters | more)) for i in range(10)])


def save(path, content):
    path.write_text(json.dumps(content), encoding="utf-8")
    return path


def seeded(seed=1):
    return random.Random(seed)
