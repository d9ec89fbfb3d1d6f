"""Writes results/results.csv and the measured sections and charts of docs/leaf_benchmark.md from the results of record."""

import itertools
import json
import pathlib
import statistics

import pandas

from measurements.shared.tools import ROOT, table, with_section, write

from . import measures

HERE = pathlib.Path(__file__).parent
PAGE = ROOT / "docs" / "leaf_benchmark.md"
IMAGES = ["front", "back", "ambient", "glow"]
CHARTED = IMAGES[:2]
WANTED = [0.02, 0.01]  # RMS errors of the columns "CPU s"
COLORS = ("red", "green", "blue")
LAMBERTIAN = ("frond_leaf_lambert", "mitsuba_lambert", "cycles_translucent", "pbrt_diffusetransmission", "radiance_lambert", "less3d_lambert",
              "eradiate_bilambertian")


def results():
    """The results of record, `[entry]`, with the title of the entry's README: program and material."""
    found = {}
    for path in sorted((HERE / "results").glob("*.json")):
        entry = json.loads(path.read_text(encoding="utf-8"))
        title = (HERE / "entries" / path.stem / "README.md").read_text(encoding="utf-8").splitlines()[0].removeprefix("# ")
        entry["program"], entry["material"] = title.split(": ", 1)
        found[path.stem] = entry
    return found


def task_json(name):
    return json.loads((HERE / "tasks" / name / "task.json").read_text(encoding="utf-8"))


def figure(value):
    return f"{value:.4f}" if value < 0.1 else f"{value:.3f}"


def bias_text(bias):
    value, low, high = bias
    return figure(value) if low > 0.8 * value else f"≤ {figure(high)}"


def percent(bias):
    return f"{100 * bias[0]:.0f} %" if bias[1] > 0.5 * bias[0] else f"≤ {100 * bias[2]:.1f} %"


def seconds(points, bias, wanted):
    found = measures.time_to(points, bias, wanted)
    return "–" if found is None else f"{found:.2g}" if found < 9.5 else f"{found:.0f}"


def ranked(of, task, head, cells):
    """The table of a task: a row for each entry, by error; `cells` of a result. An entry that cannot do it has the reason."""
    rows = []
    for entry in of.values():
        result, name = entry["tasks"].get(task), [entry["program"], entry["material"]]
        if result and "cannot" in result:
            if task != "canopy" or result["cannot"] != "measures no BRF":
                rows.append((9, [*name, result["cannot"], *[""] * (len(head) - 1)]))
        elif result:
            rows.append((result["bias"]["all"][0], [*name, *cells(result)]))
    return table(["program", "leaf", *head], [row for _, row in sorted(rows, key=lambda pair: pair[0])])


def image_table(of, task):
    return ranked(of, task, ["bias", *COLORS, "median", "largest", "FLIP", *(f"CPU s to {w:g}" for w in WANTED)], lambda result: [
        *(bias_text(result["bias"][c]) for c in ("all", *COLORS)), *(figure(result[name]) for name in ("median", "largest", "flip")),
        *(seconds(result["points"], result["bias"]["all"][0], w) for w in WANTED)])


def canopy_table(of):
    """Bias of the BRF in per cent of the mean of each wavelength: RMS over the views, and of the mean over the views."""
    nm = [str(w) for w in task_json("canopy")["wavelengths_nm"]]

    def cells(result):
        absorbed, paths = result.get("absorbed"), result["points"][-1]["samples"] * len(task_json("canopy")["view_zenith"])
        return [percent(result["bias"]["all"]), *(f"{percent(result['bias'][w])}, {100 * result['mean'][w]:+.1f} %" for w in nm),
                ", ".join(f"{100 * absorbed[w]:+.1f}" for w in nm) if absorbed else "–",
                f"{1e6 * result['points'][-1]['cpu_s'] / paths:.1f} µs"]
    return ranked(of, "canopy", ["bias of BRF", *(f"{w} nm: bias, mean" for w in nm), f"absorbed at {', '.join(nm)} nm, %", "CPU of a path"], cells)


def leaf_table(of):
    rows = []
    for entry in of.values():
        result = entry["tasks"].get("leaf", {})
        if "errors" in result:
            failed = [f"{c['check']} {c['value']:.3f} (limit {c['limit']:.3f})" for c in result["checks"] if not c["passed"]]
            rows.append([entry["program"], entry["material"], *(figure(result["errors"][k]) for k in ("reflected", "transmitted", "R", "T")),
                         "; ".join(failed) or "passed"])
    return table(["program", "leaf", "RMS π Δf, reflected", "transmitted", "largest ΔR", "ΔT", "checks"], rows)


def bias(entry, task):
    return entry["tasks"].get(task, {}).get("bias", {}).get("all")


def cost(entry, task):
    """CPU microseconds of a path, of the image or of a view."""
    points = entry["tasks"].get(task, {}).get("points")
    if not points:
        return "–"
    about = task_json(task)
    value = 1e6 * points[-1]["cpu_s"] / points[-1]["samples"] / (about.get("width", 1) * about.get("height", len(about.get("view_zenith", [1]))))
    return f"{value:.{0 if value > 9.5 else 1}f}"


def choice(of):
    """For each program: the leaf that it has by itself, and the one with the least error, with what both cost."""
    rows, error = [], lambda e: sum(bias(e, t)[0] for t in (*CHARTED, "canopy") if bias(e, t))
    for program in dict.fromkeys(entry["program"] for entry in of.values()):
        able = [e for e in of.values() if e["program"] == program and (bias(e, "front") or bias(e, "canopy"))]
        own = [e for e in able if "frond" not in e["material"] and not e["material"].startswith(("`leaf`", "`leaf_s", "`abm`"))] or able
        usual, best = min(own, key=error), min(able, key=error)
        for e, name in ((usual, program), (best, "")) if best is not usual else ((usual, program),):
            rows.append([name, e["material"], *(bias_text(bias(e, t)) if bias(e, t) else "–" for t in IMAGES),
                         percent(bias(e, "canopy")) if bias(e, "canopy") else "–", cost(e, "front"), cost(e, "canopy")])
    return table(["renderer", "leaf", *IMAGES, "canopy, BRF", "CPU of a path, µs", "canopy"], rows)


def answer(of):
    """The first sentences: the range of the errors of Lambertian leaves, and what the best leaf of Mitsuba costs."""
    plain, best = of["mitsuba_lambert"], of["mitsuba_frond_leaf"]
    images, canopies = ([bias(of[e], t)[0] for e in LAMBERTIAN for t in tasks if bias(of[e], t)] for tasks in (IMAGES, ["canopy"]))
    more = float(cost(best, "front")) / float(cost(plain, "front"))
    return (f"**Which leaf?** A Lambertian leaf with the right R and T, the leaf that most programs have, is wrong by {min(images):.3f} to {max(images):.3f} of "
            f"white in images, RMS, and by {100 * min(canopies):.0f} % to {100 * max(canopies):.0f} % in the BRF of a canopy. Take frond's leaf where your "
            f"renderer can load it: in Mitsuba 3 its error is {bias_text(bias(best, 'front'))} in `front`, and a path costs {more:.1f} times as much as with a "
            "Lambertian leaf. The table has, for each renderer, its own leaf with the least error, and below it the best one by frond:\n")


def repeated(of):
    """The second run beside the first: `[same order, pairs]` by bias and by CPU time of those that are apart; relative differences of CPU."""
    counts, changes, runs = {"bias": [0, 0], "CPU": [0, 0]}, [], {task: [] for task in CHARTED}
    for task, entry in itertools.product(CHARTED, of.values()):
        result = entry["tasks"].get(task, {})
        if "again" in result:
            again, last = result["again"], result["again"]["points"][-1]
            cpu = next(p["cpu_s"] for p in result["points"] if p["samples"] == last["samples"]), last["cpu_s"]
            whole = last["samples"] == result["points"][-1]["samples"]  # the bias of fewer samples is another estimate
            runs[task].append((result["bias"]["all"] if whole else None, again["bias"], last["samples"], *cpu))
            changes.append(abs(cpu[1] / cpu[0] - 1))
    for a, b in itertools.chain.from_iterable(itertools.combinations(of_task, 2) for of_task in runs.values()):
        if a[0] and b[0] and (a[0][2] < b[0][1] or b[0][2] < a[0][1]):
            counts["bias"] = [counts["bias"][0] + ((a[0][0] < b[0][0]) == (a[1][0] < b[1][0])), counts["bias"][1] + 1]
        if a[2] == b[2] and max(a[3] / b[3], b[3] / a[3]) > 1 + 2 * max(changes):
            counts["CPU"] = [counts["CPU"][0] + ((a[3] < b[3]) == (a[4] < b[4])), counts["CPU"][1] + 1]
    return counts, changes


def about(of):
    every = [r for e in of.values() for r in e["tasks"].values() if "points" in r]
    dates, machines = (sorted({key(r) for r in every}) for key in (lambda r: r["date"], lambda r: r["machine"].split(";")[0]))
    versions = dict(sorted(v for e in of.values() for v in e["versions"].items()))
    shared = sorted({f"{e['program']} with {p['samples']} samples in `{t}`" for e in of.values() for t, r in e["tasks"].items()
                     for p in r.get("points", []) if p.get("core") != "reserved"})
    counts, changes = repeated(of)
    text = (f"Measured by `python -m leaf_benchmark`, which `leaf_benchmark/run` starts, on {', '.join(machines)}, {' to '.join(dict.fromkeys([dates[0], dates[-1]]))}: "
            f"{', '.join(f'{name} {number}' for name, number in versions.items())}. Each entry ran on one core that was reserved by real-time "
            "priority (`--core`); the machine's other core had other work.")
    if shared:
        text += f" Not on a reserved core: {', '.join(shared)}."
    if changes:
        text += (f" A second cold run of the charted entries with other seeds has the same order by error in {counts['bias'][0]} of {counts['bias'][1]} pairs "
                 f"whose 95 % intervals are apart; CPU times differ by {100 * statistics.median(changes):.0f} % (median; at most {100 * max(changes):.0f} %), and "
                 f"{counts['CPU'][0]} of {counts['CPU'][1]} pairs that are further apart than twice the latter have the same order.")
    return text + "\n"


def write_csv(of):
    rows = []
    for name, entry in of.items():
        for task, result in entry["tasks"].items():
            row = lambda quantity, **more: rows.append({"entry": name, "task": task, "quantity": quantity, **more})
            for point in result.get("points", []):
                row("rms", samples=point["samples"], cpu_s=point["cpu_s"], value=point["rms"])
            for color, (value, low, high) in result.get("bias", {}).items():
                row(f"bias {color}", value=value, low=low, high=high)
            for quantity in ("median", "largest", "flip", "setup_s", "cpu_s"):
                if quantity in result:
                    row(quantity, value=result[quantity])
            for check in result.get("checks", []):
                row(f"check {check['check']}", value=check["value"], high=check["limit"])
    columns = ["task", "entry", "quantity", "samples", "cpu_s", "value", "low", "high"]
    pandas.DataFrame(rows)[columns].sort_values(["task", "entry"], kind="stable").to_csv(
        HERE / "results" / "results.csv", index=False, float_format="%.4g")


def draw(of):
    from measurements.shared import charts
    drawn, panels = charts.figure(1000, 620, 1, len(CHARTED), sharey=True)
    color = dict(zip(dict.fromkeys(e["program"] for e in of.values() if bias(e, "front")), charts.COLORS[1:] + charts.COLORS[:1]))
    for panel, task in zip(panels[0], CHARTED):
        marks = {}
        for name, entry in of.items():
            points = entry["tasks"].get(task, {}).get("points")
            if points:
                mark = "os^Dvx"[marks.setdefault(entry["program"], 0) % 6]
                marks[entry["program"]] += 1
                panel.plot([p["cpu_s"] for p in points], [p["rms"] for p in points], marker=mark, color=color[entry["program"]],
                           linestyle=":" if name in LAMBERTIAN else "-", label=f"{entry['program']}: {entry['material'].replace('`', '')}", linewidth=1.4)
        panel.set(xscale="log", yscale="log", title=task, xlabel="CPU time of one image (s)")
    panels[0][0].set_ylabel("RMS error over leaf pixels (1: white)")
    charts.legend(drawn, panels[0][0], 3)
    charts.save(drawn, ROOT / "docs" / "images" / "leaf_benchmark.svg")


def sections(of):
    """The measured sections of the page."""
    images = "\n".join(f"#### `{task}`\n\n{image_table(of, task)}" for task in IMAGES)
    return {"leaf_benchmark_choice": f"{answer(of)}\n{choice(of)}\n{about(of)}",
            "leaf_benchmark": f"{images}\n#### `canopy`\n\n{canopy_table(of)}\n#### `leaf`, and checks\n\n{leaf_table(of)}"}


def page(text, of):
    for name, section in sections(of).items():
        text = with_section(text, name, section, "leaf_benchmark/run")
    return text


def write_all():
    of = results()
    write_csv(of)
    draw(of)
    write(PAGE, page(PAGE.read_text(encoding="utf-8"), of))
