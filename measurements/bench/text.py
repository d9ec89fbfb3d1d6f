"""A comparison as text: formatted values, and the summary on the terminal."""

import math

from .comparison import warnings


def seconds(value):
    for unit, size in (("s", 1), ("ms", 1e-3), ("µs", 1e-6)):
        if value >= size:
            return f"{value / size:.3g} {unit}"
    return f"{value / 1e-9:.3g} ns"


def change(ratio):
    """A ratio as a change in per cent, or as a factor below 0.5 and above 2."""
    if math.isinf(ratio) or ratio == 0:
        return "unknown"
    if not 0.5 < ratio < 2:
        return f"×{ratio:.3g}"
    percent = round(100 * (ratio - 1), 1)
    return f"{percent:+.1f} %".replace("-", "−") if percent else "0.0 %"


def interval(low, high):
    return "unknown" if math.isinf(high) else f"{change(low)} to {change(high)}"


def count(number, what):
    return f"{number} {what}" if number != 1 else f"1 {what.removesuffix('s')}"


def verdict(comparison):
    slower, faster, changed = comparison.slower(), comparison.faster(), comparison.changed_figures()
    found = [f"{count(len(changes), 'benchmarks')} {word}, by up to {change(changes[0].ratio).lstrip('+−')}"
             for changes, word in ((slower, "slower"), (faster, "faster")) if changes]
    times = "; ".join(found) if found else f"none of {count(len(comparison.times), 'benchmarks')} faster or slower"
    return f"{times[0].upper()}{times[1:]}. {images(comparison)}" + (" Look at them first." if changed else "")


def images(comparison):
    marks = [f.mark for f in comparison.figures]
    if not marks:
        return "No images were compared."
    if set(marks) == {"same"}:
        return f"Images are the same: all {len(marks)} figures of their errors, to the last digit."
    return (f"Figures of the images' errors: {marks.count('same')} the same to the last digit, "
            f"{marks.count('within errors')} within standard errors, {marks.count('changed')} changed.")


def summary(comparison):
    a, b = comparison.a, comparison.b
    lines = [f"A {a.label}, {a.rounds} rounds; B {b.label}, {b.rounds} rounds" +
             (", in turn" if comparison.paired else "")]
    lines += [f"  {w}" for w in warnings(comparison)]
    lines += ["", f"{'':14}{'benchmarks':>10}{'slower':>8}{'faster':>8}   mean change"]
    for name, (changes, mean) in comparison.families().items():
        marks = [c.mark for c in changes]
        lines.append(f"{name:14}{len(changes):10}{marks.count('slower'):8}{marks.count('faster'):8}   "
                     f"{change(mean.ratio)} ({interval(mean.low, mean.high)})")
    for word, changes in (("Slower", comparison.slower()), ("Faster", comparison.faster())):
        if changes:
            lines += ["", f"{word}, with 95 % intervals:"]
            lines += [f"  {change(c.ratio):>9}  {interval(c.low, c.high):22} {c.name}" for c in changes]
    if comparison.changed_figures():
        lines += ["", "Changed images:"]
        lines += [f"  {f.name} {f.counter}: {f.a:.4g} ± {f.a_se:.1g}, now {f.b:.4g} ± {f.b_se:.1g}"
                  for f in comparison.changed_figures()]
    return "\n".join(lines + ["", verdict(comparison)])
