"""Line plots and box plots as SVG text, with the standard library alone. Colours are classes of the page's style."""
import html
import math

WIDTH, HEIGHT = 330, 190
LEFT, RIGHT, TOP, BOTTOM = 44, 8, 20, 28


def ticks(low, high, count=4):
    """Round numbers from low to high."""
    span = high - low
    if span <= 0:
        return [low]
    step = 10 ** math.floor(math.log10(span / count))
    for factor in (1, 2, 5, 10):
        if span / (step * factor) <= count:
            step *= factor
            break
    first = math.ceil(low / step - 1e-9)
    return [i * step for i in range(first, math.floor(high / step + 1e-9) + 1)]


def powers(low, high):
    return [10.0 ** e for e in range(math.ceil(math.log10(low) - 1e-9), math.floor(math.log10(high) + 1e-9) + 1)]


class Axis:
    """Maps values to pixels; with `log`, powers of ten at equal distances."""

    def __init__(self, values, begin, end, log=False, pad=0.05):
        values = [v for v in values if v is not None and (v > 0 or not log)]
        low, high = (min(values), max(values)) if values else (0.1 if log else 0.0, 1.0)
        self.log, self.begin, self.end = log, begin, end
        if log:
            low, high = math.log10(low), math.log10(high)
        room = pad * (high - low) if high > low else (0.5 if log else pad * abs(high) or 1)
        self.low, self.high = low - room, high + room

    def at(self, value):
        v = math.log10(value) if self.log else value
        return self.begin + (v - self.low) / (self.high - self.low) * (self.end - self.begin)

    def ticks(self):
        if not self.log:
            return ticks(self.low, self.high)
        marks = powers(10 ** self.low, 10 ** self.high)
        return marks if len(marks) > 1 else [10 ** t for t in ticks(self.low, self.high, 3)]


def label(value):
    return f"{value:.3g}"


def frame(title, unit, x_title, x_axis, y_axis, x_ticks=True):
    parts = [f'<text x="{LEFT}" y="13" class="title">{html.escape(title)}</text>']
    if unit:
        parts.append(f'<text x="{WIDTH - RIGHT}" y="13" class="tick" text-anchor="end">{html.escape(unit)}</text>')
    for v in y_axis.ticks():
        y = y_axis.at(v)
        parts.append(f'<path class="grid" d="M{LEFT} {y:.1f}H{WIDTH - RIGHT}"/>'
                     f'<text class="tick" x="{LEFT - 4}" y="{y + 3:.1f}" text-anchor="end">{label(v)}</text>')
    if x_ticks:
        for v in x_axis.ticks():
            parts.append(f'<text class="tick" x="{x_axis.at(v):.1f}" y="{HEIGHT - 15}" text-anchor="middle">{label(v)}</text>')
    parts.append(f'<text class="tick" x="{(LEFT + WIDTH - RIGHT) / 2}" y="{HEIGHT - 3}" text-anchor="middle">{html.escape(x_title)}</text>')
    return parts


def svg(parts, width=WIDTH, height=HEIGHT):
    return (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" class="plot" role="img">'
            + "".join(parts) + "</svg>")


def lines(title, unit, x_title, curves, log_x=False, log_y=False):
    """`curves`: (class of the colour, name, [(x, y)])."""
    xs = [x for _, _, points in curves for x, _ in points]
    ys = [y for _, _, points in curves for _, y in points]
    x_axis = Axis(xs, LEFT, WIDTH - RIGHT, log_x, 0.02)
    y_axis = Axis(ys, HEIGHT - BOTTOM, TOP, log_y)
    parts = frame(title, unit, x_title, x_axis, y_axis, not log_x)
    if log_x:
        for x in sorted(set(xs)):
            parts.append(f'<text class="tick" x="{x_axis.at(x):.1f}" y="{HEIGHT - 15}" text-anchor="middle">{label(x)}</text>')
    for colour, name, points in curves:
        path = " ".join(f"{x_axis.at(x):.1f},{y_axis.at(y):.1f}" for x, y in points)
        parts.append(f'<polyline class="line {colour}" points="{path}"><title>{html.escape(name)}</title></polyline>')
    return svg(parts)


def quantile(values, q):
    values = sorted(values)
    place = q * (len(values) - 1)
    low = math.floor(place)
    high = min(low + 1, len(values) - 1)
    return values[low] + (place - low) * (values[high] - values[low])


def boxes(title, unit, groups, log=False):
    """Quartiles, median and extremes. `groups`: (class of the colour, name, [values])."""
    groups = [g for g in groups if g[2]]
    x_axis = Axis([0, max(len(groups), 1)], LEFT, WIDTH - RIGHT, pad=0)
    y_axis = Axis([v for _, _, values in groups for v in values], HEIGHT - BOTTOM, TOP, log)
    parts = frame(title, unit, "", x_axis, y_axis, False)
    for i, (colour, name, values) in enumerate(groups):
        middle = x_axis.at(i + 0.5)
        half = 0.3 * (WIDTH - LEFT - RIGHT) / len(groups)
        low, q1, median, q3, high = (y_axis.at(quantile(values, q)) for q in (0, 0.25, 0.5, 0.75, 1))
        parts.append(
            f'<g class="box {colour}"><title>{html.escape(name)}: median {label(quantile(values, 0.5))}</title>'
            f'<path d="M{middle:.1f} {low:.1f}V{q1:.1f}M{middle:.1f} {q3:.1f}V{high:.1f}"/>'
            f'<rect x="{middle - half:.1f}" y="{q3:.1f}" width="{2 * half:.1f}" height="{max(q1 - q3, 0.5):.1f}"/>'
            f'<path class="median" d="M{middle - half:.1f} {median:.1f}h{2 * half:.1f}"/></g>'
            f'<text class="tick" x="{middle:.1f}" y="{HEIGHT - 15 + 10 * (i % 2)}" text-anchor="middle">{html.escape(name)}</text>')
    return svg(parts)
