"""A run's figures as tables in Markdown."""

import math

import numpy
from scipy import stats

from ..shared.tools import table
from .comparison import settled

Z95 = 1.96


def mean_and_reach(rounds, further=0.0):
    """Geometric mean and half of its 95 % interval, from the variance between rounds and a further relative error."""
    logs = numpy.log(rounds.dropna())
    mean = numpy.exp(logs.mean())
    if len(logs) < 2:
        return mean, math.nan
    own = stats.sem(logs) * stats.t.ppf(0.975, len(logs) - 1)
    return mean, mean * math.hypot(own, Z95 * further)


def plus_minus(value, reach):
    """`value ± reach`, rounded to the digits that the interval determines."""
    if not reach > 0:
        return f"{value:.3g}"
    digits = max(0, 1 - math.floor(math.log10(reach)))
    return f"{value:.{digits}f} ± {reach:.{digits}f}"


def rms(counters, channel):
    value, error = (settled(counters[key]) for key in (f"rms_{channel}", f"rms_{channel}_se"))
    return plus_minus(1000 * value, 1000 * Z95 * error)


def bias(counters, channel):
    """Square root of the squared bias, or the upper end of its interval if it does not differ significantly from 0."""
    value, error = (settled(counters[key]) for key in (f"bias2_{channel}", f"bias2_{channel}_se"))
    if value < Z95 * error:
        return f"< {1000 * math.sqrt(max(0, value) + Z95 * error):.1f}"
    return plus_minus(1000 * math.sqrt(value), 1000 * Z95 * error / (2 * math.sqrt(value)))


def relative_error(counters):
    """Relative standard error of the noise's variance."""
    return settled(counters["variance_se"]) / settled(counters["variance"])


def scenes(run):
    body = []
    for name, counters in run.counters.items():
        if name.startswith("scene/"):
            _, scene, leaf = name.split("/")
            baseline = run.counters.get(f"scene/{scene}/abm", {})
            body.append([scene, f"`{leaf}`", *costs(counters), *errors(counters, baseline)])
    head = ["scene", "leaf", "µs per path", "speed-up", "at equal noise", "efficiency, 10⁹/s", "RMS·10³ red", "green", "blue",
            "bias·10³ red", "green", "blue"]
    return table(head, body) if body else ""


def costs(counters):
    return [plus_minus(*mean_and_reach(counters[key])) for key in ("us_per_path", "speedup")]


def errors(counters, baseline):
    if "variance" not in counters or "variance" not in baseline:
        return ["-"] * 8
    own = relative_error(counters)
    both = math.hypot(own, relative_error(baseline)) if counters is not baseline else 0
    efficiency, reach = mean_and_reach(counters["efficiency"], own)
    return [plus_minus(*mean_and_reach(counters["speedup_equal_noise"], both)),
            plus_minus(efficiency / 1e9, reach / 1e9),
            *(f(counters, c) for f in (rms, bias) for c in ("red", "green", "blue"))]


def calls(run):
    """CPU time of a BSDF: a hit by angle, `sample` by the number of wavelengths."""
    columns = [f"hit_and_sample/theta:{angle}" for angle in (0, 45, 80)]
    columns += [f"sample_from_everywhere/wavelengths:{n}" for n in (1, 3, 4)]
    materials = dict.fromkeys(name.split("/")[1] for name in run.times if name.startswith("bsdf/"))
    body = [[f"`{m}`"] + [nanoseconds(run.times.get(f"bsdf/{m}/{c}")) for c in columns] for m in materials]
    head = ["material", "hit and sample, 0°", "45°", "80°", "sample, 1 wavelength", "3", "4"]
    return table(head, body) if body else ""


def nanoseconds(rounds):
    return "-" if rounds is None else plus_minus(*(1e9 * x for x in mean_and_reach(rounds)))


def figures(run):
    """The tables of scenes and BSDFs."""
    return "\n".join(part for part in (scenes(run), calls(run)) if part)


def section(run):
    """The section "bench" of docs/performance.md."""
    context = run.context
    made = (f"{context['machine']}; {context['compiler']}, `{context['compiler_flags'].strip()}`; frond "
            f"{context['frond_version']}, {context['date'][:10]}; {context['rounds']} rounds of {context['repetitions']} "
            f"repetitions; maximum machine load {max(context['load_avg']):.0f}.")
    return f"### Leaf models and BSDFs\n\n{made}\n\n{figures(run)}"
