"""Relative RMSE of a picture against the sample scenes' references; shared by the charts beside it.

Errors come from two independent halves of each reference, which makes them unbiased (see tests/data/reference).
"""
import pathlib

import numpy as np
import OpenImageIO as oiio

data = pathlib.Path(__file__).resolve().parents[1] / "data"
frames = {"cornell-slide": 12, "living-room": 24}
colours = {"cornell-slide": "#c1440e", "living-room": "#1f6f8b"}


def read(path):
    image = oiio.ImageInput.open(str(path))
    return np.asarray(image.read_image(0, 3, "float"), dtype=np.float64)


def grown(mask):
    """With all eight neighbours."""
    out = mask.copy()
    for dy in (-1, 0, 1):
        for dx in (-1, 0, 1):
            out |= np.roll(np.roll(mask, dy, 0), dx, 1)
    return out


def usable(a, b):
    """Pixels that are not within one pixel of a visible lamp."""
    return ~grown((np.maximum(a, b) > 2.5).any(axis=2))


def error(picture_path, scene):
    picture = read(picture_path)
    a, b = (read(data / "reference" / f"{scene}_{frames[scene]:04}_{k}.exr") for k in (1, 2))
    keep = usable(a, b)
    mean_square = ((picture - a) * (picture - b))[keep].mean()
    return float(np.sqrt(max(mean_square, 0) / (a * b)[keep].mean()))


class Chart:
    """Both axes logarithmic; y is a share, shown in percent."""

    def __init__(self, title, x_label, x_range, y_range):
        self.x_range, self.y_range, self.names = x_range, y_range, 0
        self.parts = ['<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 760 360" font-family="sans-serif" font-size="13">',
                      '<rect width="760" height="360" fill="white"/>', f'<text x="70" y="26" font-size="15">{title}</text>',
                      f'<text x="330" y="344" text-anchor="middle">{x_label}</text>',
                      '<text x="20" y="175" text-anchor="middle" transform="rotate(-90 20 175)">relative RMSE</text>']

    def x(self, value):
        low, high = self.x_range
        return 70 + 510 * np.log(value / low) / np.log(high / low)

    def y(self, value):
        low, high = self.y_range
        return 300 - 250 * np.log(value / low) / np.log(high / low)

    def grid(self, x_values, y_values):
        for value in y_values:
            self.parts.append(f'<path d="M70 {self.y(value):.1f}H580" stroke="#ddd"/>'
                              f'<text x="62" y="{self.y(value) + 4:.1f}" text-anchor="end">{100 * value:g} %</text>')
        for value in x_values:
            self.parts.append(f'<path d="M{self.x(value):.1f} 50V300" stroke="#ddd"/>'
                              f'<text x="{self.x(value):.1f}" y="320" text-anchor="middle">{value:,g}</text>')

    def line(self, name, points, colour, dashes="none"):
        line = " ".join(f"{self.x(x):.1f},{self.y(y):.1f}" for x, y in points)
        self.parts.append(f'<polyline points="{line}" fill="none" stroke="{colour}" stroke-width="2" stroke-dasharray="{dashes}"/>')
        self.parts += [f'<circle cx="{self.x(x):.1f}" cy="{self.y(y):.1f}" r="3.5" fill="{colour}"/>' for x, y in points]
        self.names += 1
        row = 50 + 20 * self.names
        self.parts.append(f'<path d="M592 {row - 4}h22" stroke="{colour}" stroke-width="2" stroke-dasharray="{dashes}"/>'
                          f'<text x="620" y="{row}" fill="{colour}" font-size="12">{name}</text>')

    def write(self, path):
        pathlib.Path(path).write_text("\n".join(self.parts + ["</svg>"]) + "\n", encoding="utf-8")
