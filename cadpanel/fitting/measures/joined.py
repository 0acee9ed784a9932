"""The measures of several components as those of all: put together, and not measured again.

Sums over more panels are added in another order, and may end in another last digit.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields

import numpy as np

from cadpanel.arrays import Array, IntArray
from cadpanel.fitting.measures.fit import Measures
from cadpanel.reference.model import Reference

_OF_SEAMS = ("seam_gap", "seam_width", "seam_step", "seam_shift", "kink", "uneven")
_OF_ALL = ("corner_gaps", "overall_rms", "seam_panels", "shapes")


def joined(parts: Sequence[Measures], places: Sequence[IntArray], reference: Reference) -> Measures:
    """The measures of a reference from those of its components.

    Args:
        parts: of each component.
        places: of its panels; its seams are in the order of the reference's.
        reference: what all of them approximate.
    """
    panels = np.argsort(np.concatenate(places), kind="stable")
    own = np.empty(len(panels), dtype=np.intp)
    for number, one in enumerate(places):
        own[one] = number
    of_seam = np.array([own[seam.panels[0]] for seam in reference.seams], dtype=np.intp)
    seams = np.argsort(np.argsort(of_seam, kind="stable"), kind="stable")
    areas = np.array([sum(float(reference.panels[i].weights.sum()) for i in one.tolist()) for one in places])
    squares = np.array([part.overall_rms for part in parts]) ** 2
    corner_gaps = [gaps for part in parts for gaps in part.corner_gaps]
    shapes = [shape for part in parts for shape in part.shapes]
    arrays = {
        one.name: _stacked([getattr(part, one.name) for part in parts])[seams if one.name in _OF_SEAMS else panels]
        for one in fields(Measures)
        if one.name not in _OF_ALL
    }
    return Measures(
        corner_gaps=tuple(corner_gaps[i] for i in seams.tolist()),
        overall_rms=float(np.sqrt((areas * squares).sum() / areas.sum())),
        seam_panels=np.array([seam.panels for seam in reference.seams], dtype=np.intp).reshape(-1, 2),
        shapes=tuple(shapes[i] for i in panels.tolist()),
        **arrays,
    )


def _stacked(arrays: Sequence[Array]) -> Array:
    """One below the other; with zeros where one has fewer columns, as of panels with fewer edges."""
    if arrays[0].ndim == 1:
        return np.concatenate(arrays)
    most = max(array.shape[1] for array in arrays)
    return np.concatenate([np.pad(array, ((0, 0), (0, most - array.shape[1]))) for array in arrays])
