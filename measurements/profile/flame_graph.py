"""Draws call stacks as a flame graph: a self-contained SVG file without scripts."""

import collections
from html import escape

WIDTH, MARGIN, ROW, LETTER = 1200, 12, 18, 7.23  # LETTER: width of a letter of DejaVu Sans Mono at 12 pixels
LEAST = 0.8  # width in pixels of the narrowest frame that is drawn
# Colours of modules, light enough for black text.
COLORS = {
    "integrators": "#f6b26b", "scene": "#a9d08e", "materials": "#ffd966", "leaf": "#d6e39a", "render": "#9fc5e8",
    "spectra": "#d5b8ea", "core": "#e8c7a0", "Embree": "#8fd0c8", "libm": "#f2a6bd", "dynamic linking": "#f28b82",
    "image": "#b4c7f0", "openimageio": "#b4c7f0", "OpenEXR": "#c9d6f5", "OpenColorIO": "#c0b8d8", "cli": "#e0e0d0",
    "kernel": "#c4c4c4", "C and C++ library": "#dadada",
}
OTHER = "#ececec"


def clipped(text, width):
    """The text, shortened to the width."""
    fitting = int((width - 4) / LETTER)
    if len(text) <= fitting:
        return text
    return text[: fitting - 1] + "…" if fitting >= 3 else ""


def boxes(ways, scale, x=0.0, depth=0):
    """Generates (x, width, depth, frame, count), the most frequent frame at the left."""
    below = collections.defaultdict(collections.Counter)
    for way, count in ways.items():
        if way:
            below[way[0]][way[1:]] += count
    for frame, on in sorted(below.items(), key=lambda item: (-item[1].total(), item[0])):
        width = on.total() * scale
        if width >= LEAST:
            yield x, width, depth, frame, on.total()
            yield from boxes(on, scale, x, depth + 1)
        x += width


def legend(modules, top):
    """The legend of the modules in lines, and its height."""
    parts, x, y = [], MARGIN, top
    for module in modules:
        width = 18 + (len(module) + 2) * LETTER
        if x + width > WIDTH - MARGIN:
            x, y = MARGIN, y + ROW
        parts.append(f'<rect x="{x:.1f}" y="{y}" width="12" height="12" fill="{COLORS.get(module, OTHER)}" stroke="#888"/>'
                     f'<text x="{x + 17:.1f}" y="{y + 10.5}">{escape(module)}</text>')
        x += width
    return parts, y + ROW - top


def svg(ways, title, notes):
    """`ways`: counts by tuples of (name, module), outermost frame first. The program's start is at the top."""
    total = sum(ways.values())
    drawn = list(boxes(ways, (WIDTH - 2 * MARGIN) / max(total, 1)))
    count = collections.Counter({module: 0 for *_, (_, module), _ in drawn})
    for way, samples in ways.items():
        count[way[-1][1]] += samples
    head = [f'<text x="{MARGIN}" y="26" class="title">{escape(clipped(title, (WIDTH - 2 * MARGIN) * 12 / 16))}</text>']
    top = 36
    for note in notes:
        head.append(f'<text x="{MARGIN}" y="{top + 12}">{escape(clipped(note, WIDTH - 2 * MARGIN))}</text>')
        top += ROW
    entries, high = legend(sorted(count, key=lambda module: (-count[module], module)), top + 6)
    top += 6 + high + 6
    body = []
    for x, width, depth, (name, module), samples in drawn:
        y = top + depth * ROW
        share = f"{100 * samples / total:.1f} %"
        label = clipped(name, width)
        text = f'<text x="{MARGIN + x + 2:.2f}" y="{y + 13}">{escape(label)}</text>' if label else ""
        body.append(f'<g><title>{escape(name)}: {share}, {samples} samples ({escape(module)})</title>'
                    f'<rect x="{MARGIN + x:.2f}" y="{y}" width="{width:.2f}" height="{ROW - 1}" '
                    f'fill="{COLORS.get(module, OTHER)}" stroke="#fff" stroke-width="0.4"/>{text}</g>')
    height = top + ROW * (1 + max((depth for _, _, depth, _, _ in drawn), default=0)) + MARGIN
    return "\n".join([
        f'<svg xmlns="http://www.w3.org/2000/svg" width="{WIDTH}" height="{height}" viewBox="0 0 {WIDTH} {height}">',
        '<style>text { font: 12px "DejaVu Sans Mono", monospace; white-space: pre } .title { font-size: 16px }</style>',
        f'<rect width="{WIDTH}" height="{height}" fill="#fff"/>', *head, *entries, *body, "</svg>"]) + "\n"
