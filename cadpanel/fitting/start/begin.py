"""Where the fit of every panel of a reference begins, whatever their features."""

from __future__ import annotations

from dataclasses import dataclass
from functools import singledispatch

import numpy as np

from cadpanel.arrays import Array
from cadpanel.features.feature import Feature
from cadpanel.features.layout import Layout
from cadpanel.features.polygon import Polygon
from cadpanel.features.rulings import PanelFeature
from cadpanel.fitting.samples import SampleArrays
from cadpanel.fitting.start.chains import start_chains
from cadpanel.fitting.start.frames import Frames, Given
from cadpanel.fitting.start.polygons import start_polygons
from cadpanel.fitting.start.segmentation import ambiguous
from cadpanel.reference.model import Reference
from cadpanel.solver.one_thread import on_one_thread


@dataclass(frozen=True, slots=True)
class Start:
    """Where the fit begins.

    Attributes:
        origins: (panels, 3) a point on the middle of each panel, mm.
        axes: (panels, 3, 3) columns b, t, n: across the panel, along it, outwards.
        unknowns: arrays (panels, size) in the layout's rows, lengths in units of `length`: the best start and, where a
            feature has curved patches side by side, another one, as it is easy to cut them in the wrong place.
        length: mm, the mean length of a panel.
    """

    origins: Array
    axes: Array
    unknowns: tuple[Array, ...]
    length: float


@on_one_thread
def start(
    reference: Reference, layout: Layout, samples: SampleArrays, length: float, stretches: Array | None = None
) -> Start:
    """First values for all panels.

    Args:
        reference: what is to be approximated.
        layout: the panels' features, in units of `length`.
        samples: those of the reference.
        length: mm.
        stretches: (panels, 2, 2) where on both ends the curved patches are to begin and end, mm from side 0; nan, or
            None, where the normals are to tell.

    Raises:
        PanelError: a panel has no fold, or not the four corners, that its feature asks for.
    """
    origins, axes = np.zeros((layout.panels, 3)), np.zeros((layout.panels, 3, 3))
    held = np.full((layout.panels, 2, 2), np.nan) if stretches is None else stretches
    starts = [np.zeros((layout.panels, layout.size))]
    if any(ambiguous(group.feature.curved) for group in layout.groups):
        starts.append(starts[0].copy())
    for group in layout.groups:
        given = Given(
            panels=[reference.panels[i] for i in group.panels],
            source=reference.source,
            samples=samples.take(group.panels),
            length=length,
            stretches=held[group.panels],
            ways=len(starts),
        )
        found = frames_and_numbers(group.feature, given)
        origins[group.panels], axes[group.panels] = found.origins, found.axes
        for way, unknowns in enumerate(starts):
            values = found.values[min(way, len(found.values) - 1)]
            unknowns[group.panels, : len(group.feature.free)] = values[:, group.feature.free]
    return Start(origins, axes, tuple(starts), length)


@singledispatch
def frames_and_numbers(feature: PanelFeature, _given: Given) -> Frames:
    """Frames of panels of one feature, and first values of its numbers; one entry for each kind of feature.

    Raises:
        PanelError: a panel is not what its feature is made for.
        TypeError: nobody has said how features of this kind begin.
    """
    raise TypeError(f"no start is known for a feature like {feature!r}: register one for its class")


frames_and_numbers.register(Feature, start_chains)
frames_and_numbers.register(Polygon, start_polygons)
