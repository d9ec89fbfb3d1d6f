"""Rendering in parts: costs apart from the paths (prints the tables of docs/many_machines.md)

Measures start, load, parts and merge, and extrapolates to a large image on many nodes. Times are CPU time, user and system
together, as the kernel counts it for each process: other programs on the machine disturb it less than wall-clock time. Takes some
minutes.
  --quick   a small image
"""

import json
import os
import pathlib
import tempfile
from statistics import mean, median

import numpy

from .shared.tools import FROND, ROOT, Use, arguments, machine, run, sized, table

SCENE = ROOT / "scenes" / "hundred-leaves" / "scene.pbrt"
WIDTH, HEIGHT = 1920, 1080
PARTS = (1, 2, 4, 8)
SAMPLES = 4  # per pixel of a part

# The image of the extrapolation.
LARGE_WIDTH, LARGE_HEIGHT, LARGE_SAMPLES, NODES = 3840, 2160, 4096, 1000


def use(*words):
    return Use(FROND, *words)


def median_cpu(*words, runs=5):
    return median(use(*words).cpu for _ in range(runs))


def start_and_load(folder, scene):
    part = folder / "one_pixel.part"
    one_pixel = ["render", scene, "--pixels", "0,1,0,1", "--spp", 1, "-q", "--part", part]

    def load(*words):
        def once():
            part.unlink(missing_ok=True)
            return use(*one_pixel, *words).cpu
        once()  # fills the cache
        return median(once() for _ in range(5))

    return {"list": median_cpu("list"), "describe": median_cpu("describe", "abm"),
            "load": load("--cache", folder / "cache"), "load without cache": load("--no-cache"),
            "megabytes": use(*one_pixel, "--resume", "--cache", folder / "cache").megabytes}


def bytes_a_pixel(folder):
    """By samples per pixel: bytes per pixel of a part, of a small image of the same view."""
    width, height = 160, 90
    scene, sizes = sized(SCENE, folder, width, height), {}
    for samples in (4, 64, 1024, 4096):
        part = folder / f"small_{samples}.part"
        use("render", scene, "--spp", samples, "-q", "--part", part, "--cache", folder / "cache")
        sizes[samples] = part.stat().st_size / (width * height)
    return sizes


def render_parts(folder, scene, count):
    """Parts of samples, the CPU time of a path, and the most memory of a render."""
    parts = [folder / f"samples_{i}.part" for i in range(count)]
    uses = [use("render", scene, "--samples", f"{SAMPLES * i}:{SAMPLES * (i + 1)}", "--part", part, "-q", "--json", "-", "--cache",
                folder / "cache") for i, part in enumerate(parts)]
    seconds, paths = numpy.sum([[(report := json.loads(of.output))["cpu_seconds"], report["paths"]] for of in uses], axis=0)
    return parts, seconds / paths, max(of.megabytes for of in uses)


def render_strips(folder, scene, width, height):
    """The samples of the first of those parts again, as parts of pixels: strips of whole tiles."""
    strips = []
    for top in range(0, height, 144):
        strips.append(folder / f"rows_{top}.part")
        use("render", scene, "--samples", f"0:{SAMPLES}", "--pixels", f"0,{width},{top},{min(height, top + 144)}", "--part",
            strips[-1], "-q", "--cache", folder / "cache")
    return strips


def merged(folder, parts):
    """Bytes of the image that `frond merge` writes."""
    use("merge", *parts, "-o", folder / "same.exr", "-q")
    return (folder / "same.exr").read_bytes()


def merges(folder, parts, counts):
    """By number of parts: CPU time of a merge into an image, and into a part, and most memory."""
    result = {}
    for count in counts:
        image, part = ([use("merge", *parts[:count], *to, "-q") for _ in range(3)]
                       for to in (("-o", folder / "merged.exr"), ("--part", folder / "merged.part")))
        result[count] = median(u.cpu for u in image), median(u.cpu for u in part), max(u.megabytes for u in image)
    return result


def libraries():
    """Number of shared libraries that the program loads, and their bytes."""
    words = [line.split() for line in run("ldd", FROND).splitlines()]
    files = {pathlib.Path(w[2]).resolve() for w in words if len(w) > 2 and w[1] == "=>" and w[2].startswith("/")}
    return len(files), sum(f.stat().st_size for f in files)


def hours(seconds):
    for unit, name in ((3600, "h"), (60, "min")):
        if seconds >= unit:
            return f"{seconds / unit:.1f} {name}"
    return f"{seconds:.1f} s" if seconds >= 1 else f"{seconds:.2f} s"


def size(count):
    return f"{count / 1e9:.1f} GB" if count >= 1e9 else f"{count / 1e6:.1f} MB"


def main():
    options = arguments("many_machines")
    os.environ["SOURCE_DATE_EPOCH"] = "0"
    width, height, counts = (480, 432, (1, 2)) if options.quick else (WIDTH, HEIGHT, PARTS)
    with tempfile.TemporaryDirectory(prefix="frond_many_machines.") as name:
        folder = pathlib.Path(name)
        scene = sized(SCENE, folder, width, height)
        start = start_and_load(folder, scene)
        sizes = bytes_a_pixel(folder)
        parts, path_seconds, render_memory = render_parts(folder, scene, max(counts))
        part_bytes = mean(p.stat().st_size for p in parts)
        strips = render_strips(folder, scene, width, height)
        if merged(folder, parts[:1]) != merged(folder, strips) or merged(folder, parts) != merged(folder, parts[::-1]):
            raise SystemExit("parts of the same samples give different images")
        by_parts = merges(folder, parts, counts)
        strips_cpu = median_cpu("merge", *strips, "-o", folder / "strips.exr", "-q", runs=3)
        image_bytes = (folder / "strips.exr").stat().st_size

    megapixels = width * height / 1e6
    print(machine(), "\n")
    print(table(["start and load", "CPU s"], [
        ["`frond list`", f"{start['list']:.2f}"], ["`frond describe abm`", f"{start['describe']:.2f}"],
        ["one pixel of the hundred leaves, tables from the cache", f"{start['load']:.2f}"],
        ["the same with `--no-cache`", f"{start['load without cache']:.2f}"]]))
    count, bytes_on_disk = libraries()
    print(f"The program loads {count} shared libraries of {size(bytes_on_disk)}.\n")
    print(f"A path takes {path_seconds * 1e6:.2f} µs of CPU.\n")
    print(table(["samples per pixel", "part, bytes per pixel"], [[f"{n:,}", f"{b:.1f}"] for n, b in sizes.items()]))
    print(f"{width} × {height} pixels, {SAMPLES} samples per part, {size(part_bytes)} each; the image has {size(image_bytes)}:\n")
    print(table(["parts", "merged into an image, CPU s", "into a part, CPU s", "most memory, MB"],
                [[n, f"{i:.2f}", f"{p:.2f}", f"{m:.0f}"] for n, (i, p, m) in by_parts.items()]))
    of_image, of_part, memory = zip(*by_parts.values())
    # Least squares: cost of each part, and fixed cost.
    (each, beside), (_, beside_part) = (numpy.polyfit(counts, seconds, 1) / megapixels for seconds in (of_image, of_part))
    print(f"Each further part takes {each:.3f} CPU s per megapixel. The fixed cost per megapixel is {beside:.2f} CPU s\n"
          f"for an image and {beside_part:.2f} for a part. The same {SAMPLES} samples in {len(strips)} strips of its pixels take\n"
          f"{strips_cpu:.2f} CPU s.\n")

    print_calculation(start["load"], path_seconds, sizes, part_bytes / megapixels, each, beside, beside_part, start["megabytes"],
                      (max(memory) - start["megabytes"]) / megapixels, (render_memory - start["megabytes"]) / megapixels)


def print_calculation(load, path, sizes, part_bytes, each, image, part, least_memory, merge_memory, render_memory):
    """Extrapolates figures per megapixel to the large image."""
    large = LARGE_WIDTH * LARGE_HEIGHT / 1e6
    seconds = large * 1e6 * LARGE_SAMPLES * path

    def memory(of_megapixel, megapixels):
        return size((least_memory + of_megapixel * megapixels) * 1.048576e6)

    def by_samples(tasks):
        """A part has few samples of all pixels."""
        samples = LARGE_SAMPLES / tasks
        nearest = min(sizes, key=lambda n: abs(n - samples))
        bytes_each = part_bytes * large * sizes[nearest] / sizes[SAMPLES]
        group = max(2, round(tasks**0.5))
        return [hours(seconds / tasks), hours(load), size(bytes_each), size(bytes_each * tasks),
                hours(large * (each * tasks + image)), hours(large * (each * group + part + each * tasks / group + image)),
                memory(render_memory, large)]

    def by_pixels(tasks):
        """A part has all samples of few pixels."""
        everything = sizes[LARGE_SAMPLES] * large * 1e6
        return [hours(seconds / tasks), hours(load), size(everything / tasks), size(everything),
                hours(large * (each + image)), "", memory(render_memory, large / tasks)]

    names = ["paths of one task, CPU time", "start and load of one task", "one part", "all parts", "merge, CPU time",
             "merge in two steps, the first in parallel, CPU time", "memory of one task"]
    columns = [by_samples(NODES), by_samples(64), by_pixels(NODES)]
    print(f"{LARGE_WIDTH} × {LARGE_HEIGHT}, {LARGE_SAMPLES:,} samples: {hours(seconds)} of CPU time for paths, "
          f"{memory(merge_memory, large)} of memory for the merge.\n")
    print(table(["", f"{NODES:,} tasks, by samples", "64 tasks, by samples", f"{NODES:,} tasks, by pixels"], zip(names, *columns)))


if __name__ == "__main__":
    main()
