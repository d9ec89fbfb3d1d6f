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
            "load": load("--cache", folder / "cache"), "load without cache": load("--no-cache"),
            "megabytes": frond(*one_pixel, "--resume", "--cache", folder / "cache").megabytes}


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
    """Parts by samples, the CPU time of a path, and the memory of the largest render."""
    parts, seconds, paths, megabytes = [], 0, 0, 0
    for i in range(max(PARTS)):
        parts.append(folder / f"samples_{i}.part")
        use = frond("render", scene, "--samples", f"{SAMPLES * i}:{SAMPLES * (i + 1)}", "--part", parts[-1], "-q", "--json",
                    "--cache", folder / "cache")
        report = json.loads(use.output)
        seconds += report["cpu_seconds"]
        paths += report["paths"]
        megabytes = max(megabytes, use.megabytes)
    return parts, seconds / paths, megabytes


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


def libraries():
    """Shared libraries that the program loads, and their bytes."""
    words = [line.split() for line in tools.run("ldd", tools.FROND).splitlines()]
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
    with tempfile.TemporaryDirectory(prefix="frond_many_machines.") as name:
        folder = pathlib.Path(name)
        scene = scene_of_size(folder, WIDTH, HEIGHT)
        start = start_and_load(folder, scene)
        sizes = bytes_a_pixel(folder)
        parts, path_seconds, render_memory = render_parts(folder, scene)
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
    count, bytes_on_disk = libraries()
    print(f"The program loads {count} shared libraries of {size(bytes_on_disk)}.\n")
    print(f"A path takes {path_seconds * 1e6:.2f} µs of CPU.\n")
    print(tools.table(["samples of a pixel", "part, bytes a pixel"],
                      [[tools.thousands(n), f"{b:.1f}"] for n, b in sizes.items()]))
    print(f"{WIDTH} × {HEIGHT} pixels, {SAMPLES} samples a part, {size(part_bytes)} each; the image has {size(image_bytes)}:\n")
    print(tools.table(["parts", "merged into an image, CPU s", "into a part, CPU s", "most memory, MB"],
                      [[n, f"{i:.2f}", f"{p:.2f}", f"{m:.0f}"] for n, (i, p, m) in by_parts.items()]))
    each, beside = line([(n, i) for n, (i, _, _) in by_parts.items()])
    _, beside_part = line([(n, p) for n, (_, p, _) in by_parts.items()])
    memory = max(m for _, _, m in by_parts.values())
    print(f"A further part takes {each / megapixels:.3f} CPU s a megapixel, what comes once {beside / megapixels:.2f} for an "
          f"image and {beside_part / megapixels:.2f} for a part. The same {SAMPLES} samples in {len(strips)} strips of its pixels "
          f"take {strips_cpu:.2f} CPU s.\n")

    print_calculation(start["load"], path_seconds, sizes, part_bytes / megapixels, each / megapixels, beside / megapixels,
                      beside_part / megapixels, start["megabytes"], (memory - start["megabytes"]) / megapixels,
                      (render_memory - start["megabytes"]) / megapixels)


def print_calculation(load, path, sizes, part_bytes, each, image, part, least_memory, merge_memory,
                      render_memory):
    """From figures a megapixel to those of the large picture."""
    large = LARGE_WIDTH * LARGE_HEIGHT / 1e6
    seconds = large * 1e6 * LARGE_SAMPLES * path

    def memory(of_megapixel, megapixels):
        return size((least_memory + of_megapixel * megapixels) * 1.048576e6)

    def by_samples(tasks):
        """A part has all pixels, and few samples of each."""
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
             "the same in two steps, the first of which many do at once", "memory of one task"]
    columns = [by_samples(NODES), by_samples(64), by_pixels(NODES)]
    print(f"{LARGE_WIDTH} × {LARGE_HEIGHT}, {tools.thousands(LARGE_SAMPLES)} samples: {hours(seconds)} of CPU time for paths, "
          f"{memory(merge_memory, large)} of memory for the merge.\n")
    print(tools.table(["", f"{tools.thousands(NODES)} tasks, by samples", "64 tasks, by samples",
                       f"{tools.thousands(NODES)} tasks, by pixels"], list(map(list, zip(names, *columns)))))


if __name__ == "__main__":
    main()
