#!/usr/bin/env python3
"""Does frond agree with pbrt-v4? Renders the scenes of tests/pbrt_reference at several seeds and compares the means of blocks
of 8 x 8 pixels with pbrt-v4's, whose figures lie beside the scenes.

A block's z is its difference over the standard errors of both sides and a systematic tolerance of 0.2 %. A scene agrees if no
z of its 192 (8 x 8 blocks, three channels) is beyond the limit. The standard errors are themselves estimates, with some 20
degrees of freedom: with the limit of 8 of the test a run over 107 scenes is falsely alarmed with probability 20,000
P(|t| > 8) = 0.002. Seeds are fixed, so that this is decided once for each version of the code."""

import argparse
import fnmatch
import math
import pathlib
import re
import subprocess
import sys
import tempfile

import exr
from tools import FROND, ROOT, machine, table

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
    ("50_ortho_dof", "pbrt-v4's rays all start at the lens around the axis, which makes the picture a perspective one; "
                     "frond's orthographic camera keeps its parallels"),
    ("40_infinite_image_illuminance_exr", "pbrt-v4 weighs an EXR's channels in the file's order, B G R, with the "
                                          "luminances of R G B: frond's have their own"),
]


class Reference:
    """pbrt-v4's figures of one scene: by block, then channel."""

    def __init__(self, path):
        self.head, self.mean, self.error = {}, {}, {}
        across = set()
        for line in path.read_text().splitlines():
            if line.startswith("#"):
                key, _, value = line[1:].partition(":")
                self.head[key.strip()] = value.strip()
            elif line and not line.startswith("block"):
                v = [float(t) for t in line.split(",")]
                place = len(self.mean)
                self.mean[place], self.error[place] = v[2:5], v[5:8]
                across.add(v[0])
        self.columns = len(across)
        self.block = int(self.head["block"].split()[0])
        self.feature = next(iter(self.head.values()))


def block_means(rows, size):
    """Of all whole blocks, row by row: R, G, B."""
    means = []
    for y in range(0, len(rows) - size + 1, size):
        for x in range(0, len(rows[0]["R"]) - size + 1, size):
            means.append([sum(sum(row[c][x:x + size]) for row in rows[y:y + size]) / size**2 for c in "RGB"])
    return means


def near(values, columns):
    """Mean over the blocks around each, which steadies variances that come from few seeds."""
    lines = len(values) // columns
    inside = lambda at, count: min(max(at, 0), count - 1)
    return [[sum(values[inside(i // columns + dy, lines) * columns + inside(i % columns + dx, columns)][c]
                 for dx in (-1, 0, 1) for dy in (-1, 0, 1)) / 9 for c in range(3)] for i in range(len(values))]


def compare(reference, renders, tolerance=0.002):
    """The largest z, and the mean difference of each channel over its mean."""
    seeds, count = len(renders), len(reference.mean)
    if any(len(r) != count for r in renders):
        return math.inf, [math.inf] * 3
    mean = [[sum(r[i][c] for r in renders) / seeds for c in range(3)] for i in range(count)]
    own = [[sum((r[i][c] - mean[i][c])**2 for r in renders) / (seeds - 1) / seeds for c in range(3)] for i in range(count)]
    theirs = [[e * e for e in reference.error[i]] for i in range(count)]
    half = lambda a, b: [[(x + y) / 2 for x, y in zip(p, q)] for p, q in zip(a, b)]
    theirs = half(theirs, near(theirs, reference.columns))
    smooth = half(own, near(own, reference.columns))
    total = lambda v, c: sum(row[c] for row in v)
    ratio = [total(own, c) / max(total(theirs, c), 1e-30) for c in range(3)]
    brightness = sum(max(map(abs, m)) for m in reference.mean.values()) / count
    worst = 0.0
    for i in range(count):
        most = max(map(abs, reference.mean[i]))
        for c in range(3):
            variance = ((seeds - 1) * smooth[i][c] + 8 * ratio[c] * theirs[i][c]) / (seeds + 7)
            allowed = tolerance * max(abs(reference.mean[i][c]), 0.1 * most) + 2e-5 * brightness
            z = (mean[i][c] - reference.mean[i][c]) / math.sqrt(theirs[i][c] + variance + allowed**2)
            worst = z if not abs(z) <= abs(worst) else worst
    difference = [(total(mean, c) - sum(m[c] for m in reference.mean.values()))
                  / max(sum(m[c] for m in reference.mean.values()), 1e-12) for c in range(3)]
    return worst, difference


def examine(name, options):
    """(status, z, mean differences or message)."""
    reference, renders = Reference(FOLDER / f"{name}.csv"), []
    with tempfile.TemporaryDirectory() as folder:
        out = pathlib.Path(folder) / "out.exr"
        for seed in range(9001, 9001 + options.seeds):
            done = subprocess.run([FROND, "render", FOLDER / f"{name}.pbrt", "-o", out, "--spp", str(options.spp), "--seed",
                                   str(seed), "--threads", str(options.threads), "--no-cache", "-q"],
                                  capture_output=True, text=True, check=False)
            if done.returncode != 0:
                first = (done.stderr.strip().splitlines() or [f"exit code {done.returncode}"])[0]
                return reference, "refused", 0, re.sub(r"^frond: \S*?([^/ ]+\.pbrt)", r"\1", first)
            renders.append(block_means(exr.read(out.read_bytes()), reference.block))
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
column is the difference of the whole picture's mean, red, green and blue, in per cent.

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
    for name in names:
        if not any(fnmatch.fnmatch(name, pattern) for pattern in options.only):
            continue
        results[name] = reference, status, z, found = examine(name, options)
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
