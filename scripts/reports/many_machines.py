"""What a render in parts costs beside its paths: scripts/many_machines, docs/many_machines.md.

CPU time, user and system together, as the kernel counts it for each process: other programs on the machine disturb it
less than the clock."""

import json
import os
import pathlib
import statistics
import subprocess
import tempfile

import tools

SCENE = tools.ROOT / "scenes" / "hundred-leaves"
WIDTH, HEIGHT = 1920, 1080
PARTS = (1, 2, 4, 8)
SAMPLES = 4  # of a part

# The picture of the calculation.
LARGE_WIDTH, LARGE_HEIGHT, LARGE_SAMPLES, NODES = 3840, 2160, 4096, 1000


class Use:
    """What a process took."""

    def __init__(self, output, usage):
        self.output = output
        self.cpu = usage.ru_utime + usage.ru_stime
        self.megabytes = usage.ru_maxrss / 1024


def frond(*words):
    """Runs frond by itself, so that the kernel tells its own use."""
    with tempfile.TemporaryFile() as output:
        process = subprocess.Popen([str(tools.FROND), *map(str, words)], stdout=output,
                                   env={**os.environ, "SOURCE_DATE_EPOCH": "0"})
        _, status, usage = os.wait4(process.pid, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        if process.returncode != 0:
            raise SystemExit(f"frond {' '.join(map(str, words))} ended with {process.returncode}")
        output.seek(0)
        return Use(output.read().decode(), usage)


def median_cpu(*words, runs=5):
    return statistics.median(frond(*words).cpu for _ in range(runs))


def scene_of_size(folder, width, height):
    """scene.pbrt with another film."""
    text = (SCENE / "scene.pbrt").read_text()
    for old, new in ((f'"integer {axis}resolution" 512', f'"integer {axis}resolution" {size}')
                     for axis, size in (("x", width), ("y", height))):
        if old not in text:
            raise SystemExit(f"{SCENE}/scene.pbrt has no {old}")
        text = text.replace(old, new)
    path = folder / f"{width}x{height}.pbrt"
    path.write_text(text.replace('Include "world.pbrt"', f'Include "{SCENE}/world.pbrt"'))
    return path


def line(points):
    """Least squares: what each part takes, and what the whole takes beside."""
    xs, ys = zip(*points)
    slope, start = statistics.linear_regression(xs, ys)
    return slope, start


def start_and_load(folder, scene):
    part = folder / "one_pixel.part"
    one_pixel = ["render", scene, "--pixels", "0,1,0,1", "--spp", 1, "-q", "--part", part]

    def load(*words):
        def once():
            part.unlink(missing_ok=True)
            return frond(*one_pixel, *words).cpu
        once()  # fills the cache
        return statistics.median(once() for _ in range(5))

    return {"list": median_cpu("list"), "describe": median_cpu("describe", "abm"),
            "load": load("--cache", folder / "cache"), "load without cache": load("--no-cache")}


def bytes_a_pixel(folder):
    """Of parts of more and more samples, of a small picture of the same view."""
    width, height = 160, 90
    scene = scene_of_size(folder, width, height)
    sizes = {}
    for samples in (4, 64, 1024, 4096):
        part = folder / f"small_{samples}.part"
        frond("render", scene, "--spp", samples, "-q", "--part", part, "--cache", folder / "cache")
        sizes[samples] = part.stat().st_size / (width * height)
    return sizes


def render_parts(folder, scene):
    """Parts by samples, and the CPU time of a path."""
    parts, seconds, paths = [], 0, 0
    for i in range(max(PARTS)):
        parts.append(folder / f"samples_{i}.part")
        use = frond("render", scene, "--samples", f"{SAMPLES * i}:{SAMPLES * (i + 1)}", "--part", parts[-1], "-q", "--json",
                    "--cache", folder / "cache")
        report = json.loads(use.output)
        seconds += report["cpu_seconds"]
        paths += report["paths"]
    return parts, seconds / paths


def render_strips(folder, scene):
    """The first of those parts once more, in strips of whole tiles."""
    rows = [144 * i for i in range(8)] + [HEIGHT]
    strips = []
    for top, bottom in zip(rows, rows[1:]):
        strips.append(folder / f"rows_{top}.part")
        frond("render", scene, "--samples", f"0:{SAMPLES}", "--pixels", f"0,{WIDTH},{top},{bottom}", "--part", strips[-1],
              "-q", "--cache", folder / "cache")
    return strips


def same_picture(folder, parts, others):
    """Whether two lists of parts make the same file."""
    pictures = []
    for i, list_of_parts in enumerate((parts, others)):
        pictures.append(folder / f"same_{i}.exr")
        frond("merge", *list_of_parts, "-o", pictures[-1], "-q")
    return pictures[0].read_bytes() == pictures[1].read_bytes()


def merges(folder, parts):
    """By number of parts: into an image, and into a part."""
    def merge(count, *to):
        return [frond("merge", *parts[:count], *to, "-q") for _ in range(3)]

    result = {}
    for count in PARTS:
        image = merge(count, "-o", folder / "merged.exr")
        part = merge(count, "--part", folder / "merged.part")
        result[count] = (statistics.median(u.cpu for u in image), statistics.median(u.cpu for u in part),
                         max(u.megabytes for u in image))
    return result


def hours(seconds):
    return f"{seconds / 3600:.1f} h" if seconds >= 3600 else f"{seconds / 60:.1f} min" if seconds >= 60 else f"{seconds:.1f} s"


def size(count):
    return f"{count / 1e9:.1f} GB" if count >= 1e9 else f"{count / 1e6:.1f} MB"


def main():
    with tempfile.TemporaryDirectory(prefix="frond_many_machines.") as name:
        folder = pathlib.Path(name)
        scene = scene_of_size(folder, WIDTH, HEIGHT)
        start = start_and_load(folder, scene)
        sizes = bytes_a_pixel(folder)
        parts, path_seconds = render_parts(folder, scene)
        part_bytes = statistics.mean(p.stat().st_size for p in parts)
        strips = render_strips(folder, scene)
        if not same_picture(folder, parts[:1], strips) or not same_picture(folder, parts, reversed(parts)):
            raise SystemExit("parts of the same samples make other pictures")
        by_parts = merges(folder, parts)
        strips_cpu = statistics.median(frond("merge", *strips, "-o", folder / "strips.exr", "-q").cpu for _ in range(3))
        image_bytes = (folder / "strips.exr").stat().st_size

    megapixels = WIDTH * HEIGHT / 1e6
    print(tools.machine(), "\n")
    print(tools.table(["start and load", "CPU s"], [
        ["`frond list`", f"{start['list']:.2f}"], ["`frond describe abm`", f"{start['describe']:.2f}"],
        ["one pixel of the hundred leaves, tables from the cache", f"{start['load']:.2f}"],
        ["the same with `--no-cache`", f"{start['load without cache']:.2f}"]]))
    print(f"A path takes {path_seconds * 1e6:.2f} µs of CPU.\n")
    print(tools.table(["samples of a pixel", "part, bytes a pixel"], [[tools.thousands(n), f"{b:.1f}"] for n, b in sizes.items()]))
    print(f"{WIDTH} × {HEIGHT} pixels, {SAMPLES} samples a part, {size(part_bytes)} each; the image has {size(image_bytes)}:\n")
    print(tools.table(["parts", "merged into an image, CPU s", "into a part, CPU s", "most memory, MB"],
                      [[n, f"{i:.2f}", f"{p:.2f}", f"{m:.0f}"] for n, (i, p, m) in by_parts.items()]))
    each, beside = line([(n, i) for n, (i, _, _) in by_parts.items()])
    _, beside_part = line([(n, p) for n, (_, p, _) in by_parts.items()])
    memory = max(m for _, _, m in by_parts.values())
    print(f"A further part takes {each / megapixels:.3f} CPU s a megapixel, what comes once {beside / megapixels:.2f} for an "
          f"image and {beside_part / megapixels:.2f} for a part. The same {SAMPLES} samples in {len(strips)} strips of rows "
          f"take {strips_cpu:.2f} CPU s.\n")

    large = LARGE_WIDTH * LARGE_HEIGHT / 1e6
    paths = LARGE_WIDTH * LARGE_HEIGHT * LARGE_SAMPLES
    pixel_part, sample_part = sizes[4096] * large * 1e6 / NODES, part_bytes / megapixels * large
    per_part = each * large / megapixels
    once = beside * large / megapixels
    tree = 32  # parts that a first merge takes
    by_tree = 2 * (tree * per_part + beside_part * large / megapixels)
    print(f"{LARGE_WIDTH} × {LARGE_HEIGHT}, {LARGE_SAMPLES} samples, {NODES} tasks of one thread:\n")
    print(tools.table(["", "by samples", "by rows"], [
        ["paths, CPU time of all", *[hours(paths * path_seconds)] * 2],
        ["of one task", *[hours(paths * path_seconds / NODES)] * 2],
        ["start and load of one task", *[hours(start["load"])] * 2],
        ["one part", size(sample_part), size(pixel_part)],
        ["all parts", size(sample_part * NODES), size(pixel_part * NODES)],
        ["merge, CPU time", hours(per_part * NODES + once), hours(per_part + once)],
        [f"the same by {tree} at a time, in two steps", hours(by_tree), ""],
        ["memory of the merge", *[size(memory * 1.048576e6 * large / megapixels)] * 2]]))


if __name__ == "__main__":
    main()
