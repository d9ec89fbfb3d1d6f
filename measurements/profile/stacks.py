"""Call stacks sampled by perf: their modules and counts."""

import collections
import pathlib
import re
import subprocess
from dataclasses import dataclass

from ..shared import tools

# Modules outside frond, by the name of the file that contains the code; first match.
STRANGERS = [
    (r"libembree|libtbb", "Embree"),  # Embree builds its trees on TBB's threads
    (r"libm\.|libmvec\.", "libm"),
    (r"ld-linux|ld-musl", "dynamic linking"),
    (r"\[kernel|\[guest|\[vdso\]|\.ko$", "kernel"),
    (r"libc\.|libstdc\+\+|libgcc|libpthread", "C and C++ library"),
    (r"libOpenEXR|libIex|libIlmThread|libImath|libz\.", "OpenEXR"),
    (r"libOpenColorIO|libyaml|libexpat|libpystring", "OpenColorIO"),
]
OURS = re.compile(r"^(libfrond.*\.so.*|frond(_bench)?)$")
OTHERS = "other libraries"
NO_MODULE = "frond"  # code of frond without a known module
CUT = "cut off"
# Outermost functions of a program and of its threads.
PROGRAM = re.compile(r"^(_start|_dl_start_user)$")
THREAD = re.compile(r"^(__)?clone3?$|^start_thread$|^ret_from_fork")
BLOCK = 1024  # bytes of code without symbols that count as one function


@dataclass(frozen=True)
class Frame:
    symbol: str  # the linker's symbol; empty: unknown
    file: str  # name of the file that contains its code
    block: int = 0  # position in the file in units of BLOCK, if the symbol is unknown


def parse(text):
    """Stacks from the output of `perf script -F comm,ip,sym,dso`, outermost frame first."""
    stacks = []
    for block in text.split("\n\n"):
        frames = []
        for line in block.strip("\n").splitlines()[1:]:
            match = re.match(r"\s+([0-9a-f]+) (.*) \((.*)\)$", line)
            if not match or match[3] == "[unknown]":
                continue
            file = pathlib.PurePath(match[3]).name
            known = match[2] != "[unknown]"
            frames.append(Frame(match[2].split("@")[0], file) if known else Frame("", file, int(match[1], 16) // BLOCK))
        if frames:
            stacks.append(tuple(reversed(frames)))
    return stacks


def ways_to(stacks):
    """For each frame: the stacks of its callers and their counts."""
    ways = collections.defaultdict(collections.Counter)
    for stack in stacks:
        seen = set()
        for i, frame in enumerate(stack):
            if frame not in seen:
                ways[frame][stack[:i]] += 1
                seen.add(frame)
    return ways


def joined(stack, ways, fits=lambda frame: True):
    """The stack from its first frame that other stacks have, below the most frequent callers of this frame; None: no such frame."""
    for i, frame in enumerate(stack):
        if frame in ways and fits(frame):
            [(way, _)] = ways[frame].most_common(1)
            return way + stack[i:]
    return None


def is_whole(stack):
    return PROGRAM.match(stack[0].symbol) or THREAD.match(stack[0].symbol)


def graft(stacks):
    """Completes stacks that perf has cut off with the outer frames of complete stacks through the same function, or with one
    frame CUT. Returns the stacks, the number of stacks that were cut off, and the number of those that were not completed."""
    cut = sum(not is_whole(stack) for stack in stacks)
    for _ in range(2):  # a completed stack may complete others
        ways = ways_to(filter(is_whole, stacks))
        stacks = [stack if is_whole(stack) else joined(stack, ways) or stack for stack in stacks]
    lost = sum(not is_whole(stack) for stack in stacks)
    return [stack if is_whole(stack) else (Frame(CUT, ""), *stack) for stack in stacks], cut, lost


def join_threads(stacks):
    """Moves the stacks of threads below the call that they work for, where the main thread makes the same call."""
    ways = ways_to(stack for stack in stacks if PROGRAM.match(stack[0].symbol))
    ours = lambda frame: OURS.match(frame.file)
    return [THREAD.match(stack[0].symbol) and joined(stack, ways, ours) or stack for stack in stacks]


class Modules:
    """The module of a symbol, if the object files of exactly one module contain it. A symbol of several modules (templates,
    inline functions) belongs to its caller."""

    def __init__(self, modules_of_symbol):
        self.modules = {symbol: next(iter(modules)) for symbol, modules in modules_of_symbol.items() if len(modules) == 1}

    @classmethod
    def of_build(cls, build):
        modules = collections.defaultdict(set)
        for folder in sorted(pathlib.Path(build).glob("CMakeFiles/frond*.dir/src/*/")):
            objects = sorted(folder.rglob("*.o"))
            names = tools.run("nm", "--defined-only", "-P", "-A", *objects) if objects else ""
            for line in names.splitlines():
                symbol, kind = line.split(": ", 1)[1].split()[:2]
                if kind in "tTwWi":
                    modules[symbol].add(folder.name)
        return cls(modules)

    def of_stack(self, stack):
        """A module, or a library's name, for each frame."""
        result = []
        for frame in stack:
            stranger = next((name for pattern, name in STRANGERS if re.search(pattern, frame.file)), None)
            if frame.symbol == CUT:
                module = CUT
            elif PROGRAM.match(frame.symbol):
                module = "C and C++ library"
            elif OURS.match(frame.file):
                callers = [r for r, f in zip(result, stack) if OURS.match(f.file)]
                module = self.modules.get(frame.symbol) or (callers[-1] if callers else NO_MODULE)
            else:
                module = stranger or OTHERS
            result.append(module)
        return result


def readable(symbols):
    """Demangled names by symbol, from binutils' c++filt."""
    symbols = sorted(symbols)
    done = subprocess.run(["c++filt"], input="\n".join(symbols), capture_output=True, text=True, check=True)
    return dict(zip(symbols, map(short, done.stdout.splitlines())))


def short(name):
    """A function name without arguments, namespaces and template arguments."""
    wrapped = re.match(r"std::_Function_handler<.*?\), (.*)>::_M_invoke\(", name)
    name = wrapped[1] if wrapped else name
    name = re.sub(r"\[(clone|abi:)[^\]]*\]", "", name)
    name = re.sub(r"\{lambda\(.*?\)#\d+\}", "lambda", name).replace("(anonymous namespace)", "")
    name = name.replace("operator()", "operator{}").replace("operator<", "operator{<}").replace("operator>", "operator{>}")
    for pattern in (r"<[^<>]*>", r"\([^()]*\)"):
        while (less := re.sub(pattern, "", name)) != name:
            name = less
    name = re.sub(r"operator\{(.*?)\}", lambda m: "operator" + (m[1] or "()"), name)
    name = re.sub(r"( const| volatile|&|\.(isra|constprop|part|cold|lto_priv)\.?\d*)+(?=::|$|\s*$)", "", name.strip())
    return re.sub(r"(^|\s|::)(frond::|::)+", r"\1", name).split(" ")[-1] if "operator " not in name else name


def fold(stacks, modules):
    """Counts of stacks as tuples of (name, module). Adjacent frames of the same name become one: code without symbols has the
    name of its file, Embree's libraries have the name Embree, and all functions of the kernel have the name kernel."""
    names = readable({frame.symbol for stack in stacks for frame in stack if frame.symbol not in ("", CUT)}) | {CUT: CUT}
    ways = collections.Counter()
    for stack in stacks:
        way = []
        for frame, module in zip(stack, modules.of_stack(stack)):
            name = module if module == "kernel" else names.get(frame.symbol) or (module if module == "Embree" else frame.file)
            if not way or way[-1] != (name, module):
                way.append((name, module))
        ways[tuple(way)] += 1
    return ways


def shares(ways):
    """By module: samples in it, and samples in it or its callees."""
    itself, below = collections.Counter(), collections.Counter()
    for way, count in ways.items():
        itself[way[-1][1]] += count
        for module in {module for _, module in way}:
            below[module] += count
    return itself, below


def functions(ways):
    """Samples in each function itself, by (name, module)."""
    count = collections.Counter()
    for way, samples in ways.items():
        count[way[-1]] += samples
    return count


# Stages of a path. A stack belongs to the first stage with a function that matches; the rest of a render has no stage.
STAGES = [
    ("surface at a hit", r"^Geometry::compute_hit$|^place$"),
    ("traversal", r"^Scene::(intersect|occluded)|^rtc(Intersect|Occluded)"),
    ("film", r"^(FilmTile|Film|Splat\w*)::"),
    ("camera rays and sampler", r"Camera::|Sampler::|^block_"),
    ("lights", r"Light::|Emitter::|^Light(Selector|Tree)::"),
    ("materials", r"Bsdf::|::evaluate$"),
    ("integrator and render loop", r"Tracer::|^Integrator::|^Worker::"),
]


def stages(ways):
    """Samples by stage, in the order of STAGES, and those of no stage under None. Embree below callers that are not known counts
    as traversal."""
    count = collections.Counter()
    for way, samples in ways.items():
        names = [name for name, _ in way]
        if way[0][0] == CUT and way[-1][1] == "Embree":
            names.append("rtcIntersect1")
        count[next((stage for stage, pattern in STAGES if any(re.search(pattern, name) for name in names)), None)] += samples
    return {stage: count[stage] for stage in [*(stage for stage, _ in STAGES), None]}
