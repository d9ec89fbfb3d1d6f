"""Agreement with pbrt-v4, feature by feature (section "pbrt" of docs/pbrt.md)

Renders the scenes of tests/pbrt_reference, each of which tests one feature, with several seeds and compares the means of blocks
of 8 x 8 pixels with those of pbrt-v4, which are stored beside the scenes. Also writes tests/pbrt_reference/agrees.txt, which
ctest checks. Takes some ten minutes on one core.
  --only PATTERN, --no-docs           print only
  --spp N, --seeds N, --z LIMIT       settings
  --test                              checks agrees.txt, as ctest does
  --scenes FOLDER [-o FILE.md]        instead checks and renders all scene files below a folder of your own and writes a table,
                                      FOLDER.md by default, and the images
  --pbrt PROGRAM                      with --scenes: renders with pbrt-v4, too, and compares the means of the images

The z of a block is its difference over the standard errors of both sides and a systematic tolerance of 0.2 %. A scene agrees if
none of its 192 values of z (8 x 8 blocks, three channels) exceeds the limit. The standard errors are themselves estimates, with
some 20 degrees of freedom: with the limit of 8 of the test, a run over 125 scenes has a false alarm with probability 22,000 P(|t|
> 8) = 0.002. Seeds are fixed, so the result is the same in every run of one version of the code
"""

import argparse
import fnmatch
import pathlib
import re
import sys

import numpy
from scipy.ndimage import uniform_filter

import frond

from ..shared.tools import ROOT, machine, table, write_section
from . import scenes as scene_files

FOLDER = ROOT / "tests" / "pbrt_reference"
AGREES = FOLDER / "agrees.txt"
PAGE = ROOT / "docs" / "pbrt.md"
GROUPS = {"10": "Materials and spectra", "20": "Textures", "25": "Bumps and textured parameters", "30": "Shapes",
          "40": "Lights", "50": "Cameras", "60": "Pixel filters", "70": "Film and colour", "80": "Format",
          "90": "Media", "92": "Media on grids", "95": "Motion"}

# Intended differences: pattern of scene names, reason.
ON_PURPOSE = [
    ("10_coateddiffuse_rough", "pbrt-v4 is too bright: the weights of its two strategies for paths that leave through a rough "
                               "coat do not add up to 1"),
    ("20_image_nonpow2", "pbrt-v4 resamples images whose sides are not powers of two before any lookup; frond uses the original "
                         "texels"),
    ("25_bump", "in pbrt-v4 the derivatives of normals, and so a bump-mapped ball, depend on the scale of the transform: a ball "
                "of radius 0.5 and one of radius 1 under Scale .5 .5 .5 differ by 4 %; in frond they are equal, and agree with the "
                "former"),
    ("30_curve_*", "pbrt-v4 samples lights from a point beside the curve, at a distance of its width; without this offset in "
                   "pbrt-v4 the two agree to 0.03 % of the mean"),
    ("50_ortho_dof", "in pbrt-v4 all rays start at the lens around the axis, which makes the image a perspective one; "
                     "frond's orthographic camera has parallel rays"),
    ("40_infinite_image_illuminance_exr", "pbrt-v4 weights the channels of an EXR in the order of the file, B G R, by the "
                                          "luminances of R G B; frond weights each channel by its own"),
]


class Reference:
    """pbrt-v4's values of one scene: means of blocks and their standard errors, `[row][column][channel]`. The channels are R, G
    and B, and those that the head names after them."""

    def __init__(self, path):
        lines = path.read_text(encoding="utf-8").splitlines()
        heads = (line[1:].partition(":") for line in lines if line.startswith("#"))
        head = {key.strip(): value.strip() for key, _, value in heads}
        self.feature, self.block = next(iter(head.values())), int(head["block"].split()[0])
        self.channels = head.get("channels", "R G B").split()
        values = numpy.array([line.split(",") for line in lines if line and not line.startswith(("#", "block"))], float)
        across = len(numpy.unique(values[:, 0]))
        self.mean, self.error = (part.reshape(-1, across, len(self.channels)) for part in numpy.split(values[:, 2:], 2, axis=1))


def block_means(image, size):
    """Means of all complete blocks, `[row][column][channel]`."""
    down, across = (n // size for n in image.shape[:2])
    return image[:down * size, :across * size].reshape(down, size, across, size, -1).mean(axis=(1, 3), dtype=float)


def smoothed(variances):
    """Smoothed variances, since few seeds estimate them: mean of a block's own and that of its 3 x 3 neighbourhood."""
    return (variances + uniform_filter(variances, (3, 3, 1), mode="nearest")) / 2


def compare(reference, renders, tolerance=0.002):
    """The z of largest magnitude, and the relative difference of each channel's mean."""
    seeds, true = len(renders), reference.mean
    if any(r.shape != true.shape for r in renders):
        return numpy.inf, [numpy.inf] * 3
    mean, own = numpy.mean(renders, axis=0), numpy.var(renders, axis=0, ddof=1) / seeds
    theirs = smoothed(reference.error**2)
    ratio = own.sum(axis=(0, 1)) / numpy.maximum(theirs.sum(axis=(0, 1)), 1e-30)
    variance = ((seeds - 1) * smoothed(own) + 8 * ratio * theirs) / (seeds + 7)
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
            buckets = [image[name][..., None] for name in reference.channels[3:]]
            renders.append(block_means(numpy.concatenate([image.rgb, *buckets], axis=2), reference.block))
    except frond.InputError as error:
        return reference, "refused", 0, re.sub(r"^\S*?([^/ ]+\.pbrt)", r"\1", str(error).strip().splitlines()[0])
    z, difference = compare(reference, renders)
    return reference, "agrees" if abs(z) <= options.z else "differs", z, difference[:3]


def percent(differences):
    return ", ".join(f"{100 * d:+.2f}" for d in differences)


def page(results, options):
    count = {s: sum(1 for r in results.values() if r[1] == s) for s in ("agrees", "differs", "refused")}
    text = f"""## Agreement with pbrt-v4

`measurements/run pbrt` renders {len(results)} small scenes, each of which tests one feature of the format
([tests/pbrt_reference](../tests/pbrt_reference/README.md)), with {options.seeds} seeds of {options.spp} samples per pixel. It
compares the means of blocks of 8 × 8 pixels with those of pbrt-v4 (commit 5f7a606). z is the largest of a scene's 192 differences
over the standard errors of both sides and a tolerance of 0.2 %; a scene agrees if it is at most {options.z:g}. The last column is
the difference of the whole image's mean, red, green and blue, in per cent.

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
            text += f"\n### {title}\n\n" + table(["scene", "feature", "", "z", "difference, %"], rows)
    return text


def agreeing(listed, results, others, forget):
    """The names for agrees.txt. A name that was listed stays, unless `forget` and the scene no longer agrees."""
    kept = [name for name in listed if not forget or name not in others]
    return sorted({*kept, *(name for name in results if name not in others)})


def main():
    parser = argparse.ArgumentParser(prog="measurements/run pbrt")
    parser.add_argument("--only", nargs="*", default=["*"],
                        help="render only scenes whose names match these patterns; write no files")
    parser.add_argument("--spp", type=int, default=256)
    parser.add_argument("--seeds", type=int, default=4)
    parser.add_argument("--threads", type=int, default=1)
    parser.add_argument("--z", type=float, default=6)
    parser.add_argument("--no-docs", action="store_true")
    parser.add_argument("--test", action="store_true",
                        help="render only the scenes of agrees.txt; exit with an error if one differs")
    parser.add_argument("--forget", action="store_true",
                        help="remove scenes that no longer agree from agrees.txt; without this option they stay and cause an error")
    parser.add_argument("--scenes", type=pathlib.Path, metavar="FOLDER",
                        help="instead check and render all scene files below this folder (measurements/pbrt/scenes.py)")
    parser.add_argument("--pbrt", metavar="PROGRAM", help="with --scenes: pbrt-v4, to compare with")
    parser.add_argument("-o", "--output", type=pathlib.Path, metavar="FILE.md", help="with --scenes: where the table goes")
    options = parser.parse_args()
    if options.scenes:
        return scene_files.scenes(options.scenes, options.spp, options.pbrt, options.output)
    if options.seeds < 2:
        parser.error("--seeds: 2 at least are needed to estimate the noise")
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
        raise SystemExit("--only: no scene has a name that matches")
    print(f"{len(results) - len(others)} of {len(results)} agree")
    if options.test:
        return 1 if others else 0
    listed = AGREES.read_text().split()
    lost = [name for name in listed if name in others]
    if not options.no_docs and options.only == ["*"]:
        write_section(PAGE, "pbrt", page(results, options))
        AGREES.write_text("".join(f"{name}\n" for name in agreeing(listed, results, others, options.forget)))
    if lost and not options.forget:
        print(f"{', '.join(lost)}: listed in agrees.txt, but no longer agree", file=sys.stderr)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main())
