"""f in the plane of incidence: the paper's Figures 1 and 4, and the solution beside walks."""

from tools import COLORS, block, frond, rows
from validation_report import RGB


def figures(report):
    rays = report.rays(1e8)
    report.add(f"""
## Figures 1 and 4 of the paper: the BDF in the plane of incidence

Both models for soybean by the goniophotometer, {rays} rays a curve, detectors of 9° by 9°: 20 in the polar angle and 40
in azimuth, as in the paper. Above 90° light has gone through the leaf. Bars: one standard error, mostly smaller than
the lines.
""")
    for nm in RGB:
        name = f"bdf-{nm}"
        frond("goniophotometer", "abm,specimen=soybean", "--with", "leaf_simplified,specimen=soybean", "--angles",
              "30,45", "--wavelengths", nm, "--rays", rays, "-q", "--plot", report.images / f"{name}.svg")
        report.add(f"![BDF at {nm} nm](images/validation/{name}.svg)")


def in_plane(patches, reflected):
    """(angle, f, standard error) from the light's side to the other one."""
    points = []
    for p in patches:
        if p["phi_deg"] not in (0, 180) or (p["kind"] == "BRDF") != reflected:
            continue
        from_normal = min(p["theta_deg"], 180 - p["theta_deg"])
        points.append((-from_normal if p["phi_deg"] == 0 else from_normal, p["f_per_sr"], p["f_se"]))
    return sorted(points)


def plane_chart(report, leaf, side, angles, rays):
    text = frond("goniophotometer", f"leaf_solved,specimen={leaf}", "--with", f"abm,specimen={leaf}", "--integrate",
                 "--angles", ",".join(map(str, angles)), "--wavelengths", ",".join(map(str, RGB)), "--rays", rays, "-q",
                 "--csv", "-")
    readings = {}
    for p in rows(text):
        readings.setdefault((p["material"].split(",")[0], p["incidence_deg"], p["wavelength_nm"]), []).append(p)
    data, panels = "", ""
    for row, reflected in enumerate((True, False)):
        for column, angle in enumerate(angles):
            plots, residuals = [], []
            for i, nm in enumerate(RGB):
                solved = in_plane(readings["leaf_solved", angle, nm], reflected)
                walked = in_plane(readings["abm", angle, nm], reflected)
                name, color = f"p{row}{column}{i}", COLORS[(2, 3, 1)[i]]
                data += block("s" + name, [(x, f) for x, f, _ in solved])
                data += block("w" + name, [(x, f, se, (f - g) / se if se > 0 else 0)
                                           for (x, f, se), (_, g, _) in zip(walked, solved)])
                mark = f"pt {(6, 4, 8)[i]} ps 0.5 lc rgb '{color}' notitle"
                plots += [f"$s{name} with lines lw 1.5 lc rgb '{color}' notitle", f"$w{name} with points {mark}",
                          f"$w{name} using 1:(bottom($2, $3)):(0):($2 + $3 - bottom($2, $3)) with vectors nohead lw 1.5 "
                          f"lc rgb '{color}' notitle"]
                residuals.append(f"$w{name} using 1:4 with points {mark}")
            panels += plane_panel(row, column, angle, len(angles), plots, residuals)
    key = ", ".join(f"NaN with linespoints pt {(6, 4, 8)[i]} ps 0.6 lw 1.5 lc rgb '{COLORS[(2, 3, 1)[i]]}' title '{nm} nm'"
                    for i, nm in enumerate(RGB))
    report.chart(f"solved-{leaf}-{side}", f"f in the plane of incidence, {leaf}, {side} side lit", data + f"""
bottom(f, se) = f > se ? f - se : 1e-6
set multiplot
set xrange [-90:90]
set xtics -60,30,60 format ''
unset key
{panels}
set origin 0,0
set size 1,0.05
set lmargin 0
set rmargin 0
set tmargin 0
set bmargin 0
unset title
unset xlabel
unset ylabel
unset tics
unset border
unset grid
unset object
set yrange [0:1]
set key at graph 0.5,0.5 center horizontal nobox samplen 3 width 4
plot {key}
unset multiplot
""", (1500, 900))


def plane_panel(row, column, angle, columns, plots, residuals):
    """One of R or T at one angle, with its differences below."""
    margin, width, top, height, low = 0.055, 0.936 / columns, 0.955 - row * 0.425, 0.265, 0.08
    left, right = margin + column * width, margin + (column + 0.93) * width
    first = column == 0
    from_normal = min(angle, 180 - angle)
    scale = "set logscale y\nset yrange [1e-4:20]\nset ytics 10 format '10^{%L}'" if row == 0 else \
        "unset logscale y\nset yrange [0:0.07]\nset ytics 0.02 format '%g'"
    if not first:
        scale += "\nset format y ''"
    title = f"light at {angle}°" if row == 0 else ""
    label = ("BRDF (sr^{-1})", "BTDF (sr^{-1})")[row] if first else ""
    return f"""
set lmargin at screen {left}
set rmargin at screen {right}
set tmargin at screen {top}
set bmargin at screen {top - height}
set title '{title}' offset 0,-0.5
set ylabel '{label}' offset 0.5 font ',14'
{scale}
set format x ''
unset xlabel
unset object
plot {', '.join(plots)}
set tmargin at screen {top - height - 0.012}
set bmargin at screen {top - height - 0.012 - low}
unset title
unset logscale y
set yrange [-6.5:6.5]
set ytics -4,4,4 format {"'%g'" if first else "''"}
set ylabel '{"difference / s.e." if first else ""}' font ',11' offset 0.5
set object 1 rectangle from graph 0, first -1 to graph 1, first 1 fc rgb '#e8e8e8' fs solid noborder behind
set format x '%g'
set xlabel '{"angle from the normal (°), light’s side negative" if row == 1 and column == columns // 2 else ""}'
plot {', '.join(residuals)}
"""
