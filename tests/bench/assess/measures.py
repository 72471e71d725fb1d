"""What pictures are measured by: error beside two independent noisy halves of a reference, and flicker."""
import pathlib
import sys

import numpy as np

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1]))
from reference_error import grown, read, usable  # noqa: E402


def error_with_interval(picture, half_a, half_b, lamps=None, block=8):
    """Relative RMSE and the ends of its 95 % interval, by blocks of pixels drawn again and again: what the noise of the
    reference leaves open, and what other pixels might have shown. `lamps` is a picture of lamps alone: pixels that show one
    and their neighbours are left out, since however little of a bright lamp a pixel holds, its edge would drown all else."""
    keep = usable(half_a, half_b) if lamps is None else ~grown((lamps > 0).any(axis=2))
    square = np.where(keep[..., None], (picture - half_a) * (picture - half_b), 0).sum(axis=2)
    scale = np.where(keep[..., None], half_a * half_b, 0).sum(axis=2)
    high, wide = (n // block for n in square.shape)

    def by_block(values):
        return values[:high * block, :wide * block].reshape(high, block, wide, block).sum(axis=(1, 3)).ravel()

    squares, scales = by_block(square), by_block(scale)
    drawn = np.random.default_rng(1).integers(0, len(squares), (400, len(squares)))
    ratios = squares[drawn].sum(axis=1) / scales[drawn].sum(axis=1)
    low, high_end = np.quantile(ratios, [0.025, 0.975])
    return [float(np.sqrt(max(v, 0))) for v in (squares.sum() / scales.sum(), low, high_end)]


def picture_error(path, halves):
    """`halves`: files of both, and of the lamps alone where there is one."""
    return error_with_interval(read(path), *(read(half) for half in halves))


def apart(path, other):
    """Root mean square of what two pictures differ by, relative to their mean."""
    a, b = read(path), read(other)
    return float(np.sqrt(((a - b) ** 2).mean()) / (0.5 * (a + b)).mean())


def flicker(shown, truth):
    """As tests/support/flicker.h has it, pixel by pixel; lists of pictures."""
    errors = [s - t for s, t in zip(shown, truth)]
    second = [errors[f - 1] - 2 * errors[f] + errors[f + 1] for f in range(1, len(errors) - 1)]
    return float(np.sqrt(np.mean(np.square(second)) / 6) / np.mean(truth))


def sequence(folder):
    return [read(path) for path in sorted(pathlib.Path(folder).glob("frame_*.exr"))]
