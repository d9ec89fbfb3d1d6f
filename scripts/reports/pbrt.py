#!/usr/bin/env python3
"""Does frond agree with pbrt-v4? Renders the scenes of tests/pbrt_reference at several seeds and compares the means of blocks
of 8 x 8 pixels with pbrt-v4's, whose figures lie beside the scenes.

A block's z is its difference over the standard errors of both sides and a systematic tolerance of 0.2 %. A scene agrees if no
z of its 192 (8 x 8 blocks, three channels) is beyond the limit. The standard errors are themselves estimates, with some 20
degrees of freedom: with the limit of 8 of the test a run over 107 scenes is falsely alarmed with probability 20,000
P(|t| > 8) = 0.002. Seeds are fixed, so that this is decided once for each version of the code."""

import argparse
import fnmatch
import re
import sys

import numpy
from scipy.ndimage import uniform_filter

import frond
from tools import ROOT, machine, table

FOLDER = ROOT / "tests" / "pbrt_reference"
AGREES = FOLDER / "agrees.txt"
PAGE = ROOT / "docs" / "pbrt.md"
GROUPS = {"10": "Materials and spectra", "20": "Textures", "25": "Bumps and textured parameters", "30": "Shapes",
          "40": "Lights", "50": "Cameras", "60": "Pixel filters", "70": "Film and colour", "80": "Format"}

# What is done otherwise on purpose: pattern of scenes, reason.
ON_PURPOSE = [
    ("10_coateddiffuse_rough", "where pbrt-v4's walk leaves through a rough coat, the weights of its two strategies do not add up "
                               "to 1: it is too bright"),
    ("20_image_nonpow2", "pbrt-v4 stretches an image whose sides are no powers of two before it is looked up, frond shows its own "
                         "texels"),
    ("25_bump", "in pbrt-v4 derivatives of normals change with the scale of the transform, and a bumpy ball with it: that of radius "
                "0.5 and that of radius 1 under Scale .5 .5 .5 differ by 4 %; frond's are the same, and agree with the former"),
    ("30_curve_*", "pbrt-v4 sees lights from a point beside the curve, its width away; where that is taken out of pbrt-v4, the two "
                   "agree to 0.03 % of the mean"),
    ("50_ortho_dof", "pbrt-v4's rays all start at the lens around the axis, which makes the image a perspective one; "
                     "frond's orthographic camera keeps its parallels"),
    ("40_infinite_image_illuminance_exr", "pbrt-v4 weighs an EXR's channels in the file's order, B G R, with the "
                                          "luminances of R G B: frond's have their own"),
]


class Reference:
    """pbrt-v4's figures of one scene: means of blocks and their standard errors `[row][column][channel]`."""

    def __init__(self, path):
        lines = path.read_text(encoding="utf-8").splitlines()
        heads = (line[1:].partition(":") for line in lines if line.startswith("#"))
        head = {key.strip(): value.strip() for key, _, value in heads}
        self.feature, self.block = next(iter(head.values())), int(head["block"].split()[0])
        values = numpy.array([line.split(",") for line in lines if line and not line.startswith(("#", "block"))], float)
        across = len(numpy.unique(values[:, 0]))
        self.mean, self.error = (values[:, part].reshape(-1, across, 3) for part in (slice(2, 5), slice(5, 8)))


def block_means(image, size):
    """Of all whole blocks, `[row][column][channel]`."""
    down, across = (n // size for n in image.shape[:2])
    return image[:down * size, :across * size].reshape(down, size, across, size, 3).mean(axis=(1, 3), dtype=float)


def steadied(variances):
    """Variances that come from few seeds: half a block's own, half the mean over the blocks around it."""
    return (variances + uniform_filter(variances, (3, 3, 1), mode="nearest")) / 2


def compare(reference, renders, tolerance=0.002):
    """The largest z, and the mean difference of each channel over its mean."""
    seeds, true = len(renders), reference.mean
    if any(r.shape != true.shape for r in renders):
        return numpy.inf, [numpy.inf] * 3
    mean, own = numpy.mean(renders, axis=0), numpy.var(renders, axis=0, ddof=1) / seeds
    theirs = steadied(reference.error**2)
    ratio = own.sum(axis=(0, 1)) / numpy.maximum(theirs.sum(axis=(0, 1)), 1e-30)
    variance = ((seeds - 1) * steadied(own) + 8 * ratio * theirs) / (seeds + 7)
    most = abs(true).max(axis=2, keepdims=True)
    allowed = tolerance * numpy.maximum(abs(true), 0.1 * most) + 2e-5 * most.mean()
    z = (mean - true) / numpy.sqrt(theirs + variance + allowed**2)
    worst = z.flat[numpy.argmax(numpy.nan_to_num(abs(z), nan=numpy.inf))]
    return worst, (mean - true).sum(axis=(0, 1)) / numpy.maximum(true.sum(axis=(0, 1)), 1e-12)


def examine(name, options, session):
    """(reference, status, z, mean differences or message)."""
    reference, renders = Reference(FOLDER / f"{name}.csv"), []
    try:
        for seed in range(9001, 9001 + options.seeds):
            image = session.load(FOLDER / f"{name}.pbrt", seed=seed).render(options.spp)
            renders.append(block_means(image.rgb, reference.block))
    except frond.InputError as error:
        return reference, "refused", 0, re.sub(r"^\S*?([^/ ]+\.pbrt)", r"\1", str(error).strip().splitlines()[0])
    z, difference = compare(reference, renders)
    return reference, "agrees" if abs(z) <= options.z else "differs", z, difference


def percent(differences):
    return ", ".join(f"{100 * d:+.2f}" for d in differences)


def page(results, options):
    count = {s: sum(1 for r in results.values() if r[1] == s) for s in ("agrees", "differs", "refused")}
    text = f"""# Beside pbrt-v4

Written by `scripts/pbrt`: {len(results)} small scenes of one feature of pbrt-v4's format each
([tests/pbrt_reference](../tests/pbrt_reference/README.md)), rendered with {options.seeds} seeds of {options.spp} samples per
pixel and compared with pbrt-v4's own figures (commit 5f7a606), means of blocks of 8 x 8 pixels. z is the largest of a scene's
192 differences over the standard errors of both sides and a tolerance of 0.2 %; up to {options.z:g} a scene agrees. The last
column is the difference of the whole image's mean, red, green and blue, in per cent.

{count["agrees"]} agree, {count["differs"]} differ, {count["refused"]} are refused. {machine()}.
"""
    for prefix, title in GROUPS.items():
        rows = []
        for name, (reference, status, z, found) in results.items():
            if not name.startswith(prefix):
                continue
            reason = next((why for pattern, why in ON_PURPOSE if fnmatch.fnmatch(name, pattern)), "")
            if status == "refused":
                rows.append([name[3:], reference.feature, status, "", found.replace("|", "\\|")])
            else:
                what = status + (f" on purpose: {reason}" if status == "differs" and reason else "")
                rows.append([name[3:], reference.feature, what, f"{z:.1f}", percent(found)])
        if rows:
            text += f"\n## {title}\n\n" + table(["scene", "feature", "", "z", "difference, %"], rows)
    return text


def agreeing(listed, results, others, forget):
    """The names for agrees.txt: none goes by itself."""
    kept = [name for name in listed if not forget or name not in others]
    return sorted({*kept, *(name for name in results if name not in others)})


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--only", nargs="*", default=["*"], help="patterns of scenes' names; nothing is written")
    parser.add_argument("--spp", type=int, default=256)
    parser.add_argument("--seeds", type=int, default=4)
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--z", type=float, default=6)
    parser.add_argument("--no-docs", action="store_true")
    parser.add_argument("--test", action="store_true", help="those of agrees.txt alone; an error where one does not agree")
    parser.add_argument("--forget", action="store_true",
                        help="take scenes that agree no longer out of agrees.txt; without it they stay, and are an error")
    options = parser.parse_args()
    if options.seeds < 2:
        parser.error("--seeds: 2 at least tell how much renders differ")
    names = sorted(path.stem for path in FOLDER.glob("*.csv"))
    if options.test:
        names = AGREES.read_text().split()
    results, others = {}, []
    session = frond.Session(threads=options.threads, cache=False)
    for name in names:
        if not any(fnmatch.fnmatch(name, pattern) for pattern in options.only):
            continue
        results[name] = reference, status, z, found = examine(name, options, session)
        if status != "agrees":
            others.append(name)
        print(f"{status:8} {name:36} {found if status == 'refused' else f'z {z:6.1f}   {percent(found)} %'}", flush=True)
    if not results:
        raise SystemExit("no scene is called so")
    print(f"{len(results) - len(others)} of {len(results)} agree")
    if options.test:
        return 1 if others else 0
    listed = AGREES.read_text().split()
    lost = [name for name in listed if name in others]
    if not options.no_docs and options.only == ["*"]:
        PAGE.write_text(page(results, options))
        AGREES.write_text("".join(f"{name}\n" for name in agreeing(listed, results, others, options.forget)))
    if lost and not options.forget:
        print(f"{', '.join(lost)}: agreed, and now no longer", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
