"""Errors and flicker of pictures beside independent pairs of true ones, which make both estimates unbiased."""
import pathlib
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from reference_error import data, grown, read  # noqa: E402

LAMP_RADIANCE = 2.5
REFERENCE_FRAMES = {"cornell-slide": (0, 12, 36), "living-room": (0, 24, 72)}
# By what share of the mean true pictures may differ, all frames together, where a pixel is constantly or nearly constantly lit.
CONSTANT, NEARLY_CONSTANT = 1e-3, 1e-2


def beside_lamps(*pictures):
    """Pixels at most one away from a lamp in sight: box filters differ there."""
    return grown(np.max([p.max(axis=2) for p in pictures], axis=0) > LAMP_RADIANCE)


def reference(scene, frame):
    return [read(data / "reference" / f"{scene}_{frame:04}_{k}.exr") for k in (1, 2)]


def error(picture, scene, frame):
    """Relative RMSE beside the reference, and the ratio of means."""
    a, b = reference(scene, frame)
    keep = ~beside_lamps(a, b)
    square = ((picture - a) * (picture - b))[keep].mean()
    mean = 0.5 * (a + b)[keep].mean()
    return float(np.sqrt(max(square, 0) / (a * b)[keep].mean())), float(picture[keep].mean() / mean)


def block_means(pictures, block):
    frames, high, wide, channels = pictures.shape
    cut = pictures[:, :high // block * block, :wide // block * block]
    return cut.reshape(frames, high // block, block, wide // block, block, channels).mean(axis=(2, 4))


def second_differences(pictures):
    return pictures[:-2] - 2 * pictures[1:-1] + pictures[2:]


def flicker(shown, true_pair, block, keep=None):
    """As tests/support/flicker.h says, but unbiased: beside each of two independent true sequences, multiplied. `keep`: pixels."""
    one, other = (second_differences(block_means(shown - truth, block)) for truth in true_pair)
    product = one * other if keep is None else (one * other)[:, keep]
    mean = 0.5 * (true_pair[0] + true_pair[1]).mean()
    return float(np.sqrt(max(product.mean(), 0) / 6) / mean)


def lit_within(true_pair, low, high):
    """Pixels away from lamps whose light changes by at least `low` and less than `high`, shares of the mean."""
    truth = 0.5 * (true_pair[0] + true_pair[1])
    lamps = np.any([beside_lamps(t) for t in truth], axis=0)
    change = (truth.max(axis=0) - truth.min(axis=0)).max(axis=2)
    return (change >= low * truth.mean()) & (change < high * truth.mean()) & ~lamps


def flicker_of_constant(shown, mean):
    """Of pictures whose light does not change at all, which need no true ones."""
    return float(np.sqrt((second_differences(shown) ** 2).mean() / 6) / mean)
