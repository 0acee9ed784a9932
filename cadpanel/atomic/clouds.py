"""Samples made ready for a fit: checked, moved to their mean, scaled to size 1 and turned into their main axes.

What follows then neither depends on where the samples lie nor on the unit of length.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from cadpanel.arrays import Array, BoolArray, IntArray
from cadpanel.errors import FitError

# Samples whose distance from one line is below this share of their extent lie on it: no surface is determined.
LARGEST = 1e15
"""Coordinates beyond this lose all digits of a panel."""
_COLLINEAR = 1e-12


@dataclass(frozen=True, slots=True, kw_only=True)
class Clouds:
    """n sets of samples, each in its own main axes and unit of length.

    Attributes:
        points: (n, m, 3); the weighted mean is 0, the weighted root mean square of their length is 1.
        normals: (n, m, 3) of any length, or None.
        roots: (n, m) square roots of the weights, whose sum of squares is 1; 0 for padding.
        counts: (n,) samples with a weight.
        centres: (n, 3) the mean, mm.
        sizes: (n,) the unit of length, mm.
        axes: (n, 3, 3) columns: the main axes, by decreasing extent, right-handed.
    """

    points: Array
    normals: Array | None
    roots: Array
    counts: IntArray
    centres: Array
    sizes: Array
    axes: Array

    def at(self, which: slice | IntArray) -> Clouds:
        """Some of the sets."""
        return Clouds(
            points=self.points[which],
            normals=None if self.normals is None else self.normals[which],
            roots=self.roots[which],
            counts=self.counts[which],
            centres=self.centres[which],
            sizes=self.sizes[which],
            axes=self.axes[which],
        )


def single(
    points: ArrayLike, normals: ArrayLike | None, weights: ArrayLike | None
) -> tuple[Array, Array | None, Array]:
    """One set of samples (m, 3) as a batch of one; without weights all weigh the same.

    Raises:
        FitError: the arrays are no numbers or do not fit together.
    """
    x = _numbers("points", points)
    if x.ndim != 2:
        raise FitError(f"points must be an array of shape (m, 3), not {x.shape}")
    w = np.ones(len(x)) if weights is None else _numbers("weights", weights)
    return x[None], None if normals is None else _numbers("normals", normals)[None], w[None]


def clouds(points: ArrayLike, normals: ArrayLike | None, weights: ArrayLike | None, *, least: int, what: str) -> Clouds:
    """Check n sets of samples and make them ready.

    Args:
        points: (n, m, 3) mm.
        normals: (n, m, 3) or None.
        weights: (n, m), 0 for padding; None weighs all the same.
        least: how many samples a set needs.
        what: what is to be fitted, for the message.

    Raises:
        FitError: naming the set: too few samples, a value that is no number, all samples on one line.
    """
    x = _numbers("points", points)
    if x.ndim != 3 or x.shape[2] != 3:
        raise FitError(f"points must be an array of shape (sets, samples, 3), not {x.shape}")
    w = np.ones(x.shape[:2]) if weights is None else _numbers("weights", weights)
    outward = None if normals is None else _numbers("normals", normals)
    if w.shape != x.shape[:2]:
        raise FitError(f"weights have the shape {w.shape}, but the points want {x.shape[:2]}: one for each sample")
    if outward is not None and outward.shape != x.shape:
        raise FitError(f"normals have the shape {outward.shape}, but the points have {x.shape}: one for each sample")
    used = w > 0.0
    _refuse(~np.all(np.isfinite(w) & (w >= 0.0), axis=1), "has a weight that is negative or no number", what)
    _refuse(_any_not_finite(x, used), "has a coordinate that is no number", what)
    _refuse(np.any(used & (np.abs(x).max(axis=2) > LARGEST), axis=1), f"has a coordinate beyond {LARGEST:g}", what)
    counts = np.count_nonzero(used, axis=1)
    _refuse(counts < least, f"has too few samples: {what} needs at least {least}", what, counts)
    x = np.where(used[:, :, None], x, 0.0)
    if outward is not None:
        _refuse(_any_not_finite(outward, used), "has a normal that is no number", what)
        outward = np.where(used[:, :, None], outward, 0.0)
        _refuse(np.abs(outward).max(axis=(1, 2)) > LARGEST, f"has a normal longer than {LARGEST:g}", what)
    share = w / w.max(axis=1, keepdims=True)
    share /= share.sum(axis=1, keepdims=True)
    return _moved_to_main_axes(x, outward, share, counts, what)


def _moved_to_main_axes(x: Array, normals: Array | None, share: Array, counts: IntArray, what: str) -> Clouds:
    used = share > 0.0
    # From a sample, not from the origin, so that far away sets do not lose digits to the sum.
    first = np.take_along_axis(x, np.argmax(share, axis=1)[:, None, None], axis=1)
    offsets = np.where(used[:, :, None], x - first, 0.0)
    mean = np.einsum("nm,nmx->nx", share, offsets)
    y = np.where(used[:, :, None], offsets - mean[:, None], 0.0)
    extent = np.max(np.abs(y), axis=(1, 2))
    _refuse(~(extent > 0.0), "has all its samples at one point, which determines no surface", what)
    y /= extent[:, None, None]
    rms = np.sqrt(np.einsum("nm,nmx,nmx->n", share, y, y))
    y /= rms[:, None, None]
    moments = np.einsum("nm,nmx,nmy->nxy", share, y, y)
    _, axes = np.linalg.eigh(moments)
    axes = np.ascontiguousarray(axes[:, :, ::-1])
    axes[:, :, 2] *= np.sign(np.linalg.det(axes))[:, None]
    y = y @ axes
    aside = np.max(np.hypot(y[:, :, 1], y[:, :, 2]), axis=1)
    _refuse(aside < _COLLINEAR, "has all its samples on one line, which determines no surface", what)
    return Clouds(
        points=y,
        normals=None if normals is None else normals @ axes,
        roots=np.sqrt(share),
        counts=counts,
        centres=first[:, 0] + mean,
        sizes=extent * rms,
        axes=axes,
    )


def _numbers(name: str, values: ArrayLike) -> Array:
    try:
        return np.asarray(values, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise FitError(f"{name} must be a rectangular array of numbers") from error


def _any_not_finite(values: Array, used: BoolArray) -> BoolArray:
    bad: BoolArray = np.any(used & ~np.all(np.isfinite(values), axis=2), axis=1)
    return bad


def _refuse(bad: BoolArray, reason: str, what: str, counts: IntArray | None = None) -> None:
    """Raise for the first set that is bad; a single set needs no number."""
    if not np.any(bad):
        return
    first = int(np.argmax(bad))
    subject = "the set of samples" if len(bad) == 1 else f"set {first} of the samples"
    held = "" if counts is None else f", not {counts[first]}"
    raise FitError(f"{what} cannot be fitted: {subject} {reason}{held}")
