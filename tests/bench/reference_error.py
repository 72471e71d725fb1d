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
