"""Writes results/results.csv and the measured sections and charts of docs/leaf_benchmark.md from the results of record."""

import json
import pathlib

import pandas

from measurements.shared.tools import ROOT, table, with_section, write

from . import measures

HERE = pathlib.Path(__file__).parent
PAGE = ROOT / "docs" / "leaf_benchmark.md"
IMAGES = ["front", "back", "ambient", "glow"]
CHARTED = IMAGES[:2]
WANTED = [0.02, 0.01]  # RMS errors of the columns "CPU s"
COLORS = ("red", "green", "blue")


def results():
    """The results of record, `[entry]`, with the title of the entry's README: program and material."""
    found = {}
    for path in sorted((HERE / "results").glob("*.json")):
        entry = json.loads(path.read_text(encoding="utf-8"))
        title = (HERE / "entries" / path.stem / "README.md").read_text(encoding="utf-8").splitlines()[0].removeprefix("# ")
        entry["program"], entry["material"] = title.split(": ", 1)
        found[path.stem] = entry
    return found


def figure(value):
    return f"{value:.4f}" if value < 0.1 else f"{value:.3f}"


def bias_text(bias):
    value, low, high = bias
    return figure(value) if low > 0.8 * value else f"≤ {figure(high)}"


def seconds(points, bias, wanted):
    found = measures.time_to(points, bias, wanted)
    return "–" if found is None else f"{found:.2g}" if found < 9.5 else f"{found:.0f}"


def image_rows(of, task):
    """Rows of an image task, by program and error."""
    rows = []
    for entry in of.values():
        result = entry["tasks"].get(task)
        if result and "cannot" in result:
            rows.append((9, [entry["program"], entry["material"], result["cannot"], *[""] * (6 + len(WANTED))]))
        elif result:
            bias, points = result["bias"], result["points"]
            rows.append((bias["all"][0], [entry["program"], entry["material"], bias_text(bias["all"]), *(bias_text(bias[c]) for c in COLORS),
                         figure(result["median"]), figure(result["largest"]), figure(result["flip"]),
                         *(seconds(points, bias["all"][0], w) for w in WANTED)]))
    return [row for _, row in sorted(rows, key=lambda pair: pair[0])]


def image_table(of, task):
    head = ["program", "leaf", "bias", *COLORS, "median", "largest", "FLIP", *(f"CPU s to {w:g}" for w in WANTED)]
    return table(head, image_rows(of, task))


def percent(value):
    return f"{100 * value:+.1f} %"


def canopy_table(of):
    """Bias of the BRF in per cent of the mean of each wavelength: RMS over the views, and of the mean over the views."""
    rows, nm = [], json.loads((HERE / "tasks" / "canopy" / "task.json").read_text(encoding="utf-8"))["wavelengths_nm"]
    for entry in of.values():
        result = entry["tasks"].get("canopy")
        if result and "cannot" in result:
            rows.append((9, [entry["program"], entry["material"], result["cannot"], *[""] * (len(nm) + 1)]))
        elif result:
            bias, last = result["bias"], result["points"][-1]
            text = lambda b: f"{100 * b[0]:.0f} %" if b[1] > 0.5 * b[0] else f"≤ {100 * b[2]:.1f} %"
            rows.append((bias["all"][0], [entry["program"], entry["material"], text(bias["all"]),
                         *(f"{text(bias[str(w)])}, {percent(result['mean'][str(w)])}" for w in nm),
                         f"{1e6 * last['cpu_s'] / last['samples'] / 7:.1f} µs"]))
    return table(["program", "leaf", "bias of BRF", *(f"{w} nm: bias, mean" for w in nm), "CPU of a path"],
                 [row for _, row in sorted(rows, key=lambda pair: pair[0])])


def checks_of(entry):
    result = entry["tasks"].get("leaf", {})
    if "checks" not in result:
        return result.get("cannot", "not measured")
    failed = [f"{c['check']} {c['value']:.3f} (limit {c['limit']:.3f})" for c in result["checks"] if not c["passed"]]
    return "; ".join(failed) or "passed"


def leaf_table(of):
    rows = []
    for entry in of.values():
        errors = entry["tasks"].get("leaf", {}).get("errors")
        rows.append([entry["program"], entry["material"], *([figure(errors[k]) for k in ("reflected", "transmitted", "R", "T")] if errors
                    else [""] * 4), checks_of(entry)])
    return table(["program", "leaf", "RMS π Δf, reflected", "transmitted", "largest ΔR", "ΔT", "checks"], rows)


def choice(of):
    """For each program: the leaf that it has by itself, and the one with the least error, with what both cost."""
    rows = []
    programs = dict.fromkeys(entry["program"] for entry in of.values())
    for program in programs:
        able = [e for e in of.values() if e["program"] == program and all("bias" in e["tasks"].get(t, {}) for t in CHARTED)]
        if not able:
            continue
        error = lambda e: sum(e["tasks"][t]["bias"]["all"][0] for t in CHARTED)
        words = lambda e: [e["material"], *(bias_text(e["tasks"][t]["bias"]["all"]) for t in CHARTED), f"{cost(e):.{0 if cost(e) > 9.5 else 1}f}"]
        own = [e for e in able if "frond" not in e["material"] and not e["material"].startswith("`leaf_s")]
        usual, best = min(own or able, key=error), min(able, key=error)
        rows.append([program, *words(usual), *(words(best) if best is not usual else ["–"] * 4)])
    return table(["renderer", "its own leaf", *(f"error, {t}" for t in CHARTED), "CPU, µs", "better", *(f"error, {t}" for t in CHARTED),
                  "CPU, µs"], rows)


def cost(entry):
    """CPU microseconds of a path of `front`."""
    task = json.loads((HERE / "tasks" / "front" / "task.json").read_text(encoding="utf-8"))
    last = entry["tasks"]["front"]["points"][-1]
    return 1e6 * last["cpu_s"] / last["samples"] / task["width"] / task["height"]


def about(of):
    dates = sorted({r["date"] for e in of.values() for r in e["tasks"].values()})
    versions = dict(sorted(v for e in of.values() for v in e["versions"].items()))
    machines = sorted({r["machine"].split(";")[0] for e in of.values() for r in e["tasks"].values()})
    load = max(r.get("load", 0) for e in of.values() for r in e["tasks"].values())
    return (f"Measured by `leaf_benchmark/run` on {', '.join(machines)}, {' to '.join(dict.fromkeys([dates[0], dates[-1]]))}, maximum machine "
            f"load {load:.0f}: {', '.join(f'{name} {number}' for name, number in versions.items())}. CPU is that of a path of `front`.\n")


def write_csv(of):
    rows = []
    for name, entry in of.items():
        for task, result in entry["tasks"].items():
            for point in result.get("points", []):
                rows.append({"entry": name, "task": task, "quantity": "rms", **point, "value": point["rms"]})
            for color, (value, low, high) in result.get("bias", {}).items():
                rows.append({"entry": name, "task": task, "quantity": f"bias {color}", "value": value, "low": low, "high": high})
            for quantity in ("median", "largest", "flip", "setup_s", "cpu_s"):
                if quantity in result:
                    rows.append({"entry": name, "task": task, "quantity": quantity, "value": result[quantity]})
            for check in result.get("checks", []):
                rows.append({"entry": name, "task": task, "quantity": f"check {check['check']}", "value": check["value"], "high": check["limit"]})
    columns = ["task", "entry", "quantity", "samples", "cpu_s", "value", "low", "high"]
    pandas.DataFrame(rows)[columns].sort_values(["task", "entry"], kind="stable").to_csv(
        HERE / "results" / "results.csv", index=False, float_format="%.4g")


def draw(of):
    from measurements.shared import charts
    width, height = 1000, 620
    drawn, panels = charts.figure(width, height, 1, len(CHARTED), sharey=True)
    color = dict(zip(dict.fromkeys(e["program"] for e in of.values()), charts.COLORS[1:] + charts.COLORS[:1]))
    for panel, task in zip(panels[0], CHARTED):
        marks = {}
        for entry in of.values():
            points = entry["tasks"].get(task, {}).get("points")
            if points:
                mark = "os^Dvx"[marks.setdefault(entry["program"], 0) % 6]
                marks[entry["program"]] += 1
                panel.plot([p["cpu_s"] for p in points], [p["rms"] for p in points], marker=mark, color=color[entry["program"]],
                           label=f"{entry['program']}: {entry['material'].replace('`', '')}", linewidth=1.4)
        panel.set(xscale="log", yscale="log", title=task, xlabel="CPU time of one image (s)")
    panels[0][0].set_ylabel("RMS error over leaf pixels (1: white)")
    charts.legend(drawn, panels[0][0], 3)
    charts.save(drawn, ROOT / "docs" / "images" / "leaf_benchmark.svg")


def sections(of):
    """The measured sections of the page."""
    images = "\n".join(f"#### `{task}`\n\n{image_table(of, task)}" for task in IMAGES if any(task in e["tasks"] for e in of.values()))
    return {"leaf_benchmark_choice": f"{choice(of)}\n{about(of)}", "leaf_benchmark": f"{images}\n#### `canopy`\n\n{canopy_table(of)}\n#### `leaf`, and checks\n\n{leaf_table(of)}"}


def page(text, of):
    for name, section in sections(of).items():
        text = with_section(text, name, section, "leaf_benchmark/run")
    return text


def write_all():
    of = results()
    write_csv(of)
    draw(of)
    write(PAGE, page(PAGE.read_text(encoding="utf-8"), of))
