"""docs/race.md, from the figures of a run."""

import statistics

from tools import table

from . import scenes
from .programs import MOST_TRACED

PAGE = """# Beside others

Written by `scripts/race`: the same scenes by frond, Mitsuba 3 and pbrt-v4, in turn, in one run.

{machine}, {system}; {versions}.
{missing}
{tables}
## What is measured

- **The same**: meshes and instances, camera, lights, paths of up to {depth} scattering events, filter, samples a pixel, and
  low-discrepancy samplers: `paddedsobol` of frond and pbrt-v4, Mitsuba's `ldsampler`. Triangles are flat, since programs differ in
  what they make of vertices' normals; Mitsuba has lengths in centimetres, the others in metres. All materials are grey, light is
  D65: so the image is the same by three wavelengths, by colours and by spectra. Opaque leaves reflect {opaque} on both sides. The
  others reflect {reflectance} and transmit {transmittance}: `diffusetransmission` in frond and pbrt-v4. Mitsuba has none; it runs
  one of a page of Python (`scripts/reports/race/mitsuba_worker.py`), which its LLVM variants compile; scalar variants are left out.
  LLVM variants are left out where there are more than {most_traced} instances: they make code for each of them.
  Roulette is each program's own. The Gaussian has a sigma of {sigma} pixels and a radius of {radius}: Mitsuba's default.
- **Two groups**: three values a path, which is colours in Mitsuba's `rgb` variants and `--wavelengths smpte` in frond; and four
  wavelengths chosen along the spectrum anew for each path, as all others do. The reference of a group is frond.
- **CPU**: time of a path on a core, median of the rounds (least to largest). A render of one sample is taken off, so that loading,
  compiling and writing are not in it. **Wall**: the same by the clock. **Set-up**: CPU time of all the rest of one render; with
  Mitsuba's LLVM variants that is compiling, in a folder without kernels of earlier runs. **All**: both together, of one render
  from nothing.
- **Noise**: standard deviation of a pixel's luminance between the rounds' seeds, root mean square over pixels without the two
  outermost, relative to the image's mean, with the standard error of that.
- **Efficiency**: 1 / (variance × CPU time), the group's frond = 1: median over the rounds (least to largest), with the times of
  the same round. Above 1 a program gets to an error sooner than frond.
- **Mean**: of the image, less that of the group's frond, with the standard error from the spread between seeds, block by block.
  **Blocks**: the same within blocks of 16 × 16 pixels, root mean square, less what noise makes of it: light in another place.
  Renders that differ by more than four standard errors and 0.1 % are marked **!**: their efficiency means little.

How close frond is to Embree alone is not measured here: `replay_rays` of [the benchmarks](benchmarks.md) is what there is.
"""


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


def whole(result, paths):
    """CPU time of a render from nothing, seconds."""
    return max(0, result["set_up_cpu"]) + statistics.median(result["cpu"]) * paths / 1e6


def scene_tables(name, raced):
    setting, results = raced["setting"], raced["results"]
    paths = setting["size"]**2 * setting["samples"]
    threads = "One thread" if setting["threads"] == 1 else f"{setting['threads']} threads"
    text = f"""## {name}

{raced["what"]} {setting["size"]} × {setting["size"]} pixels, {setting["samples"]} samples each, {setting["rounds"]} rounds.
{threads}; the machine's load was up to {raced["load"]:.1f}.

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
                             f"{max(0, r['set_up_cpu']):.1f} s", f"{whole(r, paths):.1f} s", noise(r), "1" if own else span(efficiencies(r, reference), ".2f"), "" if own else mean(r),
                             "" if own else f"{100 * r['blocks']:.2f} %"])
            kind = "opaque leaves" if leaf == "opaque" else "leaves that transmit"
            head = [f"{kind}, {reconstruction}", "CPU, µs", "wall, µs", "set-up", "all", "noise", "efficiency", "mean", "blocks"]
            text += table(head, body) + "\n"
    return text


def page(about, raced):
    missing = "\nLeft out: " + "; ".join(about["missing"]) + ".\n" if about["missing"] else ""
    tables = "".join(scene_tables(name, of_scene) for name, of_scene in raced.items())
    reflectance, transmittance = scenes.LEAVES["leaf"]
    return PAGE.format(machine=about["machine"], system=about["system"], missing=missing, tables=tables,
                       versions="; ".join(v for v in about["versions"] if not v.startswith("frond")), depth=scenes.DEPTH,
                       most_traced=f"{MOST_TRACED:,}", opaque=scenes.LEAVES["opaque"][0],
                       reflectance=reflectance, transmittance=transmittance,
                       **scenes.GAUSSIAN)
