"""Charts as SVG, written by hand: panels with linear or logarithmic axes, lines, dots and one legend."""
import math
import pathlib

# Told apart by people who confuse red and green as well.
palette = {"full": "#777777", "baum86": "#e69f00", "chen90": "#d55e00", "tost-pueyo93": "#cc79a7", "events": "#0072b2",
           "walkthrough": "#009e73", "auto": "#000000"}
more_colours = ["#0072b2", "#e69f00", "#009e73", "#cc79a7", "#d55e00", "#56b4e9", "#777777", "#000000"]


def colour_of(name, position=0):
    return palette.get(name, more_colours[position % len(more_colours)])


def percent(value):
    return f"{100 * value:.3g} %"


def plain(value):
    return f"{value:,.12g}"


def times(value):
    return f"{value:g}×"


class Axis:
    """From values to pixels. `show` writes a tick's value."""

    def __init__(self, low, high, ticks, show=plain, logarithmic=True):
        self.low, self.high, self.ticks, self.show, self.logarithmic = low, high, ticks, show, logarithmic

    def share(self, value):
        """Where a value lies between both ends, clipped to them."""
        value = min(max(value, self.low), self.high)
        if self.logarithmic:
            return math.log(value / self.low) / math.log(self.high / self.low)
        return (value - self.low) / (self.high - self.low)


class Names(Axis):
    """Names or knob values side by side, evenly."""

    def __init__(self, names):
        super().__init__(0, 1, names, str)

    def share(self, value):
        return (self.ticks.index(value) + 0.5) / len(self.ticks)


def logarithmic(values, show=plain):
    """An axis that holds all values, with ticks at 1, (2, 5) and 10."""
    values = [v for v in values if v > 0] or [1, 10]
    low, high = min(values) / 1.15, max(values) * 1.15
    steps = (1, 3) if high / low > 30 else (1, 2, 5)
    if high / low > 3000:
        steps = (1,)
    ticks = [s * 10.0 ** e for e in range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1) for s in steps]
    return Axis(low, high, [t for t in ticks if low <= t <= high], show)


def text(x, y, words, **more):
    attributes = "".join(f' {name.replace("_", "-")}="{value}"' for name, value in more.items())
    words = str(words).replace("&", "&amp;").replace("<", "&lt;")
    return f'<text x="{x:.1f}" y="{y:.1f}"{attributes}>{words}</text>'


class Panel:
    """A frame with two axes somewhere on a chart."""

    def __init__(self, place, size, x_axis, y_axis, title="", x_label="", y_label="", y_ticks=True):
        (self.x0, self.y0), (self.wide, self.tall) = place, size
        self.x_axis, self.y_axis = x_axis, y_axis
        self.parts = [f'<rect x="{self.x0}" y="{self.y0}" width="{self.wide}" height="{self.tall}" fill="none" stroke="#bbb"/>',
                      text(self.x0 + self.wide / 2, self.y0 - 8, title, text_anchor="middle"),
                      text(self.x0 + self.wide / 2, self.y0 + self.tall + 34, x_label, text_anchor="middle", fill="#555")]
        for tick in x_axis.ticks:
            self.parts.append(text(self.x(tick), self.y0 + self.tall + 16, x_axis.show(tick), text_anchor="middle"))
            if not isinstance(x_axis, Names):
                self.parts.append(f'<path d="M{self.x(tick):.1f} {self.y0}V{self.y0 + self.tall}" stroke="#e4e4e4"/>')
        for tick in y_axis.ticks:
            self.parts.append(f'<path d="M{self.x0} {self.y(tick):.1f}H{self.x0 + self.wide}" stroke="#e4e4e4"/>')
            if y_ticks:
                self.parts.append(text(self.x0 - 6, self.y(tick) + 4, y_axis.show(tick), text_anchor="end"))
        if y_label:
            x, y = self.x0 - 54, self.y0 + self.tall / 2
            self.parts.append(text(x, y, y_label, text_anchor="middle", fill="#555", transform=f"rotate(-90 {x} {y})"))

    def x(self, value):
        return self.x0 + self.wide * self.x_axis.share(value)

    def y(self, value):
        return self.y0 + self.tall * (1 - self.y_axis.share(value))

    def rule(self, value):
        """A level that everything is compared with."""
        self.parts.append(f'<path d="M{self.x0} {self.y(value):.1f}H{self.x0 + self.wide}" stroke="#555"/>')

    def diagonal(self):
        """Where both axes have the same value."""
        low, high = max(self.x_axis.low, self.y_axis.low), min(self.x_axis.high, self.y_axis.high)
        self.parts.append(f'<path d="M{self.x(low):.1f} {self.y(low):.1f}L{self.x(high):.1f} {self.y(high):.1f}" stroke="#555"/>')

    def line(self, points, colour, dashes="none", dots=True):
        """Points in order of x; several may be given in any order."""
        path = " ".join(f"{self.x(x):.1f},{self.y(y):.1f}" for x, y in points)
        self.parts.append(f'<polyline points="{path}" fill="none" stroke="{colour}" stroke-width="2" stroke-dasharray="{dashes}"/>')
        if dots:
            self.dots(points, colour)

    def dots(self, points, colour, radius=3.2, hollow=()):
        for place, (x, y) in enumerate(points):
            fill = "white" if place in hollow else colour
            self.parts.append(f'<circle cx="{self.x(x):.1f}" cy="{self.y(y):.1f}" r="{radius}" fill="{fill}" stroke="{colour}"/>')

    def interval(self, x, low, high, colour):
        self.parts.append(f'<path d="M{self.x(x):.1f} {self.y(low):.1f}V{self.y(high):.1f}" stroke="{colour}"/>')


class Chart:
    """A page of panels. The title is the question that it answers."""

    def __init__(self, title, width, height):
        self.title, self.width, self.height, self.parts = title, width, height, []

    def add(self, panel):
        self.parts.append(panel)
        return panel

    def legend(self, x, y, entries, step=110, down=False):
        """(name, colour, dashes) beside one another or below one another."""
        for k, (name, colour, dashes) in enumerate(entries):
            left, top = (x, y + 18 * k) if down else (x + step * k, y)
            self.parts.append(f'<path d="M{left} {top - 4}h22" stroke="{colour}" stroke-width="2" stroke-dasharray="{dashes}"/>' +
                              text(left + 27, top, name, fill=colour))

    def note(self, x, y, words):
        self.parts.append(text(x, y, words, fill="#555"))

    def write(self, path):
        lines = [f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {self.width} {self.height}" font-family="sans-serif" '
                 'font-size="12">', f'<rect width="{self.width}" height="{self.height}" fill="white"/>',
                 text(20, 24, self.title, font_size=15)]
        for part in self.parts:
            lines += part.parts if isinstance(part, Panel) else [part]
        pathlib.Path(path).write_text("\n".join(lines + ["</svg>"]) + "\n", encoding="utf-8")
