"""Small charts of ratios with their intervals, for the rows of a table."""

import math

WIDTH, HEIGHT = 300, 26
CENTER, REACH = WIDTH / 2, WIDTH / 2 - 34
REACHES = (1.05, 1.1, 1.2, 1.5, 2, 4, 10, 100)  # possible ends of the axis, in both directions
COLORS = {"slower": "#b34700", "faster": "#0067a5", "": "#5c6166"}


class Axis:
    """Logarithmic, 1 in the middle, wide enough for all of the ratios."""

    def __init__(self, ratios):
        farthest = max(max(r, 1 / r) for r in ratios)
        self.end = next((reach for reach in REACHES if reach >= farthest), REACHES[-1])

    def x(self, ratio):
        return CENTER + REACH * max(-1.05, min(1.05, math.log(ratio) / math.log(self.end)))

    def ticks(self):
        return [1 / self.end, 1 / math.sqrt(self.end), 1, math.sqrt(self.end), self.end]

    def labels(self):
        words = "".join(f'<text x="{self.x(t):.0f}" y="18" text-anchor="middle">{tick(t)}</text>' for t in self.ticks())
        return f'<svg width="{WIDTH}" height="{HEIGHT}" role="img" aria-label="B over A">{words}</svg>'

    def bar(self, low, ratio, high, mark):
        color = COLORS[mark]
        grid = "".join(f'<path d="M{self.x(t):.1f} 0V{HEIGHT}" stroke="{"#9aa0a6" if t == 1 else "#e4e6e8"}"/>'
                       for t in self.ticks())
        ends = (self.x(low if low > 0 else 1e-300), self.x(min(high, 1e300)))
        line = f'<path d="M{ends[0]:.1f} {HEIGHT / 2}H{ends[1]:.1f}" stroke="{color}" stroke-width="2"/>'
        dot = f'<circle cx="{self.x(ratio):.1f}" cy="{HEIGHT / 2}" r="4" fill="{color}"/>'
        return f'<svg width="{WIDTH}" height="{HEIGHT}" aria-hidden="true">{grid}{line}{dot}</svg>'


def tick(ratio):
    if ratio == 1:
        return "1"
    return f"{100 * (ratio - 1):+.0f} %".replace("-", "−") if 0.5 < ratio < 2 else f"×{ratio:.2g}"
