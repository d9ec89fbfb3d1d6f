"""scripts/profile: samples a render with perf and writes a flame graph, a table by module and the stacks."""

import argparse
import pathlib
import shlex
import subprocess
import tempfile

import flame_graph
import stacks
import tools

FREQUENCY = 199  # samples per CPU second; divides no periodic event of a render
STACK_BYTES = 32768


def arguments():
    parser = argparse.ArgumentParser(prog="scripts/profile", description="Profile the CPU time of a render.",
                                     allow_abbrev=False)
    parser.add_argument("-o", "--output", type=pathlib.Path, default=tools.ROOT / "build" / "profile", metavar="FOLDER")
    parser.add_argument("--frequency", type=int, default=FREQUENCY, metavar="HZ", help=f"samples per CPU second; default: {FREQUENCY}")
    parser.add_argument("scene", metavar="SCENE.pbrt")
    parser.add_argument("options", nargs=argparse.REMAINDER, help="options of frond render")
    options = parser.parse_args()
    if not 1 <= options.frequency <= 10000:
        parser.error("--frequency: 1 to 10000")
    return options


def perf_refused(message):
    """Exits with perf's message and the setting that allows sampling."""
    setting = pathlib.Path("/proc/sys/kernel/perf_event_paranoid")
    level = setting.read_text(encoding="ascii").strip() if setting.exists() else "missing"
    raise SystemExit(f"{message.strip()}\nscripts/profile: perf cannot sample here (kernel.perf_event_paranoid is {level}). "
                     "As root `sysctl kernel.perf_event_paranoid=1` allows it; containers need --cap-add PERFMON, and their "
                     "filter of system calls has to let perf_event_open through.")


def record(command, data, frequency):
    """Samples by the kernel's clock of CPU time, because many virtual machines have no cycle counters."""
    perf = ["perf", "record", "--quiet", "-e", "cpu-clock", "-F", str(frequency), "--call-graph", f"dwarf,{STACK_BYTES}",
            "-o", str(data), "--", *command]
    try:
        probe = subprocess.run([*perf[:-len(command)], "true"], capture_output=True, text=True, check=False)
    except FileNotFoundError:
        raise SystemExit("scripts/profile: there is no perf; in Debian it is the package linux-perf") from None
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
    lines += ["", f"{'function':<52} {'module':<18} itself"]
    for (name, module), count in stacks.functions(ways).most_common(20):
        shown = name if len(name) <= 52 else name[:51] + "…"
        lines.append(f"{shown:<52} {module:<18} {100 * count / total:.1f} %")
    return "\n".join(line.rstrip() for line in lines) + "\n"


def main():
    options = arguments()
    folder = options.output
    folder.mkdir(parents=True, exist_ok=True)
    extra = options.options
    has_output = any(word in ("-o", "--output", "--part") or word.startswith(("--output=", "--part=")) for word in extra)
    output = [] if has_output else ["-o", str(folder / "image.exr")]
    command = [str(tools.FROND), "render", options.scene, *extra, *output]
    with tempfile.TemporaryDirectory(prefix="perf.", dir=folder) as scratch:
        data = pathlib.Path(scratch) / "perf.data"
        record(command, data, options.frequency)
        text = tools.run("perf", "script", "-i", data, "--no-demangle", "--no-inline", "-F", "comm,ip,sym,dso")
    sampled = stacks.parse(text)
    if not sampled:
        raise SystemExit("scripts/profile: the render ended before the first sample; use a larger --spp")
    whole, cut, lost = stacks.graft(sampled)
    ways = stacks.fold(stacks.join_threads(whole), stacks.Modules.of_build(tools.BUILD))
    (folder / "stacks.txt").write_text(
        "".join(f"{';'.join(name for name, _ in way)} {count}\n" for way, count in sorted(ways.items())), encoding="utf-8")
    title = shlex.join(["frond", "render", options.scene, *extra])
    seconds = len(sampled) / options.frequency
    notes = [f"{len(sampled)} samples, {options.frequency} per second: {seconds:.2f} s of CPU time, all threads",
             tools.machine(),
             f"Stacks cut off at {STACK_BYTES // 1024} kB: {cut}, of which {lost} match no complete stack"]
    (folder / "profile.svg").write_text(flame_graph.svg(ways, title, notes), encoding="utf-8")
    report = table(ways, options.frequency, [title, *notes])
    (folder / "profile.txt").write_text(report, encoding="utf-8")
    print(report)
    print(f"Written: {folder / 'profile.svg'}, {folder / 'profile.txt'}, {folder / 'stacks.txt'}")


if __name__ == "__main__":
    main()
