"""The section "race" of docs/performance.md, from the figures of a run."""

import statistics

from ..shared.tools import table

SECTION = """### Comparison with Mitsuba 3 and pbrt-v4

{machine}, {system}; {versions}.
{missing}
Efficiency relative to frond, over all tables below: {summary}.

{tables}"""


def span(values, form):
    return f"{statistics.median(values):{form}} ({min(values):{form}} to {max(values):{form}})"


def noise(result):
    deviation = result["variance"]**0.5
    return f"{100 * deviation:.2f} ± {100 * result['variance_error'] / 2 / deviation:.2f} %"


def mean(result):
    differs = abs(result["difference"]) > max(0.001, 4 * result["difference_error"])
    return f"{100 * result['difference']:+.2f} ± {100 * result['difference_error']:.2f} %" + (" **!**" if differs else "")


def short(result):
    return f"{result['program']}: {span(result['cpu'], '.2f')} µs, noise {noise(result)}, mean {mean(result)}"


def efficiencies(result, reference):
    ratio = reference["variance"] / result["variance"]
    return [ratio * a / b for a, b in zip(reference["cpu"], result["cpu"])]


def efficiencies_in(results, result):
    return efficiencies(result, next(x for x in results if x["program"] == result["reference"] and
                                     (x["leaf"], x["filter"]) == (result["leaf"], result["filter"])))


def total(result, paths):
    """CPU time of a render with its set-up, seconds."""
    return max(0, result["set_up_cpu"]) + statistics.median(result["cpu"]) * paths / 1e6


def scene_tables(name, raced):
    setting, results = raced["setting"], raced["results"]
    paths = setting["size"]**2 * setting["samples"]
    threads = "One thread" if setting["threads"] == 1 else f"{setting['threads']} threads"
    text = f"""#### {name}

{raced["what"]} {setting["size"]} × {setting["size"]} pixels, {setting["samples"]} samples each, {setting["rounds"]} rounds.
{threads}; maximum machine load {raced["load"]:.1f}.

"""
    for leaf in dict.fromkeys(r["leaf"] for r in results):
        for reconstruction in dict.fromkeys(r["filter"] for r in results):
            chosen = [r for r in results if (r["leaf"], r["filter"]) == (leaf, reconstruction)]
            chosen.sort(key=lambda r: "hero" in r["reference"])
            body = []
            for r in chosen:
                reference = next(x for x in chosen if x["program"] == r["reference"])
                own = r is reference
                body.append([r["program"], span(r["cpu"], ".2f"), f"{statistics.median(r['wall']):.2f}",
                             f"{max(0, r['set_up_cpu']):.1f} s", f"{total(r, paths):.1f} s", noise(r),
                             "1" if own else span(efficiencies(r, reference), ".2f"), "" if own else mean(r),
                             "" if own else f"{100 * r['blocks']:.2f} %"])
            kind = "opaque leaves" if leaf == "opaque" else "transmitting leaves"
            head = [f"{kind}, {reconstruction}", "CPU, µs", "wall, µs", "set-up", "total", "noise", "efficiency", "mean", "blocks"]
            text += table(head, body) + "\n"
    return text


def summary(raced):
    """Of each program that is no reference: the least and the largest of its median efficiencies."""
    found = {}
    for of_scene in raced.values():
        results = of_scene["results"]
        for r in results:
            if r["program"] != r["reference"]:
                found.setdefault(r["program"], []).append(statistics.median(efficiencies_in(results, r)))
    return "; ".join(f"{name} {min(values):.2f} to {max(values):.2f}" for name, values in found.items())


def overview(raced):
    """Efficiency of Mitsuba llvm_ad_rgb by scene and leaf, over the rounds of all filters."""
    name, body, compiled = "Mitsuba llvm_ad_rgb", [], []
    for scene, of_scene in raced.items():
        results, row = of_scene["results"], [of_scene["what"].split(";")[0].split("\n")[0].rstrip(".")]
        for leaf in ("opaque", "leaf"):
            of_leaf = [r for r in results if (r["program"], r["leaf"]) == (name, leaf)]
            compiled += [r["set_up_cpu"] for r in of_leaf]
            row.append(span([e for r in of_leaf for e in efficiencies_in(results, r)], ".2f") if of_leaf else "")
        if any(row[1:]):
            body.append([scene, *row])
    if not body:
        return ""
    return (f"Efficiency of Mitsuba's vectorised variant `llvm_ad_rgb` relative to frond, median (least to largest of the rounds); above 1,\n"
            f"Mitsuba reaches an error sooner. The {min(compiled):.1f} to {max(compiled):.1f} s that it takes to compile its kernels "
            "are not counted.\n\n" +
            table(["scene", "", "opaque leaves", "transmitting leaves"], body))


def section(about, raced):
    missing = "\nLeft out: " + "; ".join(about["missing"]) + ".\n" if about["missing"] else ""
    tables = "".join(scene_tables(name, of_scene) for name, of_scene in raced.items())
    return SECTION.format(machine=about["machine"], system=about["system"], missing=missing, tables=tables,
                          versions="; ".join(v for v in about["versions"] if not v.startswith("frond")), summary=summary(raced))
