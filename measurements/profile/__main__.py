"""Profile of a render: flame graph, table by module and stage, call stacks (docs/performance.md)

measurements/run profile [-o FOLDER] [--frequency HZ] SCENE.pbrt [options of frond render]

Samples the CPU time of the render with perf and writes profile.svg, profile.txt and stacks.txt into FOLDER (build/profile by
default).
  --docs   writes the table of stages of docs/performance.md instead
"""

import argparse
import json
import os
import pathlib
import shlex
import subprocess
import tempfile

from ..race import scenes
from ..shared import tools
from . import flame_graph
from . import stacks

FREQUENCY = 199  # samples per CPU second; divides no periodic event of a render
STACK_BYTES = 32768


def arguments():
    parser = argparse.ArgumentParser(prog="measurements/run profile", description="Profile the CPU time of a render.",
                                     allow_abbrev=False)
    parser.add_argument("-o", "--output", type=pathlib.Path, default=tools.ROOT / "build" / "profile", metavar="FOLDER")
    parser.add_argument("--frequency", type=int, default=FREQUENCY, metavar="HZ", help=f"samples per CPU second; default: {FREQUENCY}")
    parser.add_argument("--docs", action="store_true", help="write the table of stages of docs/performance.md and nothing else")
    parser.add_argument("scene", nargs="?", metavar="SCENE.pbrt")
    parser.add_argument("options", nargs=argparse.REMAINDER, help="options of frond render")
    options = parser.parse_args()
    if not 1 <= options.frequency <= 10000:
        parser.error("--frequency: 1 to 10000")
    if options.docs == bool(options.scene):
        parser.error("either a scene or --docs")
    return options


def perf_refused(message):
    """Exits with perf's message and the setting that allows sampling."""
    setting = pathlib.Path("/proc/sys/kernel/perf_event_paranoid")
    level = setting.read_text(encoding="ascii").strip() if setting.exists() else "missing"
    raise SystemExit(f"{message.strip()}\nmeasurements/run profile: perf cannot sample here (kernel.perf_event_paranoid is {level}). "
                     "As root `sysctl kernel.perf_event_paranoid=1` allows it; containers need --cap-add PERFMON, and their "
                     "filter of system calls has to let perf_event_open through.")


def record(command, data, frequency):
    """Samples by the kernel's clock of CPU time, because many virtual machines have no cycle counters."""
    perf = ["perf", "record", "--quiet", "-e", "cpu-clock", "-F", str(frequency), "--call-graph", f"dwarf,{STACK_BYTES}",
            "-o", str(data), "--", *command]
    try:
        probe = subprocess.run([*perf[:-len(command)], "true"], capture_output=True, text=True, check=False)
    except FileNotFoundError:
        raise SystemExit("measurements/run profile: there is no perf; in Debian it is the package linux-perf") from None
    if probe.returncode != 0:
        perf_refused(probe.stderr)
    done = subprocess.run(perf, check=False)
    if done.returncode != 0:
        raise SystemExit(done.returncode)


def table(ways, frequency, notes):
    total = sum(ways.values())
    itself, below = stacks.shares(ways)

    def row(count, deep):
        share = count / total
        error = 196 * (share * (1 - share) / total) ** 0.5
        return f"{100 * share:6.1f} % ±{error:4.1f}  {count / frequency:8.2f} s  {100 * deep / total:6.1f} %"

    lines = [*notes, "", f"{'module':<20} {'itself':>15}  {'CPU time':>10}  {'with what it calls':>8}"]
    for module in sorted(below, key=lambda r: (-itself[r], -below[r], r)):
        lines.append(f"{module:<20} {row(itself[module], below[module])}")
    lines += ["", f"{'stage of a path':<28} CPU time"]
    for stage, count in stacks.stages(ways).items():
        lines.append(f"{stage or 'not on a path':<28} {100 * count / total:.1f} %")
    lines += ["", f"{'function':<52} {'module':<18} itself"]
    for (name, module), count in stacks.functions(ways).most_common(20):
        shown = name if len(name) <= 52 else name[:51] + "…"
        lines.append(f"{shown:<52} {module:<18} {100 * count / total:.1f} %")
    return "\n".join(line.rstrip() for line in lines) + "\n"


def profile(command, folder, frequency):
    """Stacks of a command as stacks.fold has them, their number, and how many were cut off and lost."""
    with tempfile.TemporaryDirectory(prefix="perf.", dir=folder) as scratch:
        data = pathlib.Path(scratch) / "perf.data"
        record(command, data, frequency)
        text = tools.run("perf", "script", "-i", data, "--no-demangle", "--no-inline", "-F", "comm,ip,sym,dso")
    sampled = stacks.parse(text)
    if not sampled:
        raise SystemExit("measurements/run profile: the render ended before the first sample; use a larger --spp")
    whole, cut, lost = stacks.graft(sampled)
    return stacks.fold(stacks.join_threads(whole), stacks.Modules.of_build(tools.BUILD)), len(sampled), cut, lost


# Scenes of measurements/run race in the table of stages: (name, leaves, samples per pixel).
STAGED = [("front", "opaque", 256), ("soybean-back", "leaf", 512), ("canopy", "leaf", 16)]


def scattered(result, times):
    """Share of the paths of a render that scatter at least so often."""
    return 1 - sum(sum(result[f"paths_{end}_by_depth"][:times]) for end in ("escaped", "absorbed")) / result["paths"]


def stages_of_scenes(frequency):
    """Writes the table of stages of docs/performance.md."""
    columns = []
    with tempfile.TemporaryDirectory(prefix="frond_stages.", dir=os.environ.get("TMPDIR")) as temporary:
        folder = pathlib.Path(temporary)
        for name, leaves, samples in STAGED:
            scene = folder / f"{name}.pbrt"
            scenes.write_pbrt(scenes.SCENES[name](folder), scene, leaves, True, 256, tables=True)
            command = [str(tools.FROND), "render", str(scene), "--spp", str(samples), "--threads", "1", "--wavelengths", "smpte",
                       "-o", str(folder / "image.exr")]
            result = json.loads(tools.run(*command, "--json", "-"))
            ways, *_ = profile([*command, "-q"], folder, frequency)
            count = stacks.stages(ways)
            del count[None]
            columns.append((result, count))
    rows = [[stage, *(f"{100 * count[stage] / sum(count.values()):.0f} %" for _, count in columns)] for stage, _ in stacks.STAGES]
    rows.append(["CPU time per path", *(f"{result['cpu_us_per_path']:.2f} µs" for result, _ in columns)])
    rows.append(["rays per path", *(f"{result['rays_per_path']:.1f}" for result, _ in columns)])
    rows.append(["hits in a bundle of 16: first, second, third, fourth",
                 *(", ".join(f"{16 * scattered(result, depth):.1f}" for depth in range(1, 5)) for result, _ in columns)])
    head = ["stage", *(f"{name}, {'opaque' if leaves == 'opaque' else 'transmitting'} leaves" for name, leaves, _ in STAGED)]
    tools.write_section(tools.ROOT / "docs" / "performance.md", "stages", f"""
Share of the CPU time of paths in scenes of `measurements/run race` (256 × 256 pixels, box filter, `--wavelengths smpte`, one thread;
{tools.machine()}):

{tools.table(head, rows)}
""", "profile --docs")


def main():
    options = arguments()
    if options.docs:
        return stages_of_scenes(options.frequency)
    folder = options.output
    folder.mkdir(parents=True, exist_ok=True)
    extra = options.options
    has_output = any(word in ("-o", "--output", "--part") or word.startswith(("--output=", "--part=")) for word in extra)
    output = [] if has_output else ["-o", str(folder / "image.exr")]
    ways, sampled, cut, lost = profile([str(tools.FROND), "render", options.scene, *extra, *output], folder, options.frequency)
    (folder / "stacks.txt").write_text(
        "".join(f"{';'.join(name for name, _ in way)} {count}\n" for way, count in sorted(ways.items())), encoding="utf-8")
    title = shlex.join(["frond", "render", options.scene, *extra])
    notes = [f"{sampled} samples, {options.frequency} per second: {sampled / options.frequency:.2f} s of CPU time, all threads",
             tools.machine(),
             f"Stacks cut off at {STACK_BYTES // 1024} kB: {cut}, of which {lost} match no complete stack"]
    (folder / "profile.svg").write_text(flame_graph.svg(ways, title, notes), encoding="utf-8")
    report = table(ways, options.frequency, [title, *notes])
    (folder / "profile.txt").write_text(report, encoding="utf-8")
    print(report)
    print(f"Written: {folder / 'profile.svg'}, {folder / 'profile.txt'}, {folder / 'stacks.txt'}")


if __name__ == "__main__":
    main()
