"""measurements/run pbrt --scenes FOLDER: checks and renders every scene file below a folder, beside pbrt-v4 where it is there, and writes a
table, FOLDER.md by default, with the images in a folder beside it."""

import pathlib
import re
import shutil
import subprocess
import sys

import numpy

import frond

from ..shared.tools import FROND, machine, table, write

SEEDS = (1, 2)
LONGEST = 3600  # seconds of one render


def roots(folder):
    """Scene files: those with a WorldBegin that is no comment; the others are parts that these include."""
    def is_root(path):
        return re.search(r"^[^#\n]*\bWorldBegin\b", path.read_text(encoding="utf-8", errors="replace"), re.MULTILINE)
    return sorted(path for path in folder.rglob("*.pbrt") if is_root(path))


def first_error(text):
    """The first error of a program's messages, without colours and the folder of the file."""
    lines = [re.sub(r"\x1b\[[0-9;]*m", "", line) for line in text.splitlines() if line.strip() and "warning" not in line.lower()]
    return re.sub(r"^\s*((frond|Error): )?(\S*/)?", "", lines[0]).strip().replace("|", "\\|")[:160] if lines else "no message"


def run(*words):
    """Nothing if the command succeeds, else its first error."""
    try:
        done = subprocess.run(list(map(str, words)), capture_output=True, text=True, errors="replace", timeout=LONGEST, check=False)
    except subprocess.TimeoutExpired:
        return f"not done after {LONGEST} s"
    return None if done.returncode == 0 else first_error(done.stderr or done.stdout) if done.returncode > 0 else "crashed"


def renders(command, folder, name):
    """The images of two seeds, or the first error. `command`: of seed and file."""
    images = []
    for seed in SEEDS:
        image = folder / f"{name}-{seed}.exr"
        if error := run(*command(seed, image)):
            return error
        channels, values = frond.read_image(image)
        images.append(values[..., [channels.index(c) for c in "RGB"]].astype(float))
    return images


def difference(ours, theirs):
    """Relative difference of the means of all colours, and its standard error from the difference of two seeds."""
    means = [numpy.array([image.mean() for image in images]) for images in (ours, theirs)]
    reference = means[1].mean()
    if not reference:
        return 0.0, 0.0
    # Pixels are independent: the difference of two images of one scene has twice the variance of one of them.
    variance = sum(((a - b) ** 2).sum() / 4 / a.size**2 for a, b in (ours, theirs))
    return (means[0].mean() - reference) / reference, numpy.sqrt(variance) / reference


def examine(path, samples, peer, images):
    """(result, difference) of a scene file, as words."""
    name = "-".join(path.with_suffix("").parts[-2:])
    if error := run(FROND, "check", "-q", path):
        also = peer and run(peer, "--format", path)
        return f"refused: {error}" + (f"; by pbrt-v4 too: {also}" if also else ""), ""
    ours = renders(lambda seed, image: (FROND, "render", path, "-q", "--spp", samples, "--seed", seed, "-o", image), images, name)
    if isinstance(ours, str):
        return f"not rendered: {ours}", ""
    if not peer:
        return "rendered", ""
    theirs = renders(lambda seed, image: (peer, "--quiet", "--spp", samples, "--seed", seed, "--outfile", image, path), images,
                     f"{name}-pbrt")
    if isinstance(theirs, str):
        return f"rendered; not by pbrt-v4: {theirs}", ""
    if ours[0].shape != theirs[0].shape:
        return "rendered; pbrt-v4's image has another size", ""
    relative, error = difference(ours, theirs)
    return "rendered", f"{100 * relative:+.2f} ± {100 * error:.2f} %"


def page(folder, rows, samples, peer):
    folders = {path.parent for path, _, _ in rows}
    good = [path for path, result, _ in rows if result.startswith("rendered")]
    text = f"""# Scenes of {folder.name}

{len(good)} of {len(rows)} scene files render as they are; {len({path.parent for path in good})} of {len(folders)} folders have one
that does. {samples} samples per pixel; {machine()}.

"""
    head = ["file", "frond"] + (["mean relative to pbrt-v4"] if peer else [])
    return text + table(head, [[f"`{path.relative_to(folder)}`", result, *([found] if peer else [])] for path, result, found in rows])


def scenes(folder, samples, peer, output):
    """Writes the table and the images of all scene files below a folder."""
    folder = folder.resolve()
    files = roots(folder) if folder.is_dir() else []
    if not files:
        raise SystemExit(f"measurements/run pbrt: {folder} has no scene files")
    if peer and not shutil.which(peer):
        raise SystemExit(f"measurements/run pbrt: there is no program {peer}")
    output = output or pathlib.Path.cwd() / f"{folder.name}.md"
    images = output.with_suffix("")
    images.mkdir(parents=True, exist_ok=True)
    rows = []
    for path in files:
        rows.append((path, *examine(path, samples, peer, images)))
        print(f"{path.relative_to(folder)}: {' '.join(rows[-1][1:])}", file=sys.stderr, flush=True)
    write(output, page(folder, rows, samples, peer))
