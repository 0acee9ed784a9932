"""Cones along the strip through a panel's tangent planes, where the bend of its feature is an even number of cones.

The strip comes from one linear system (`lofting.tangent_planes`), the cones from its rulings without any further one
(`lofting.cone_strip`). `python -m tests.benchmarks.features starts` holds fits that begin there against others.
"""

from __future__ import annotations

import numpy as np

from cadpanel.arrays import Array
from cadpanel.errors import LoftError, PanelError
from cadpanel.features.feature import Feature
from cadpanel.fitting.samples import SampleArrays
from cadpanel.fitting.start.axes import turning_axes
from cadpanel.fitting.start.frames import Given
from cadpanel.fitting.start.segmentation import curved_runs
from cadpanel.lofting.cone_strip import Cones, cones_through
from cadpanel.lofting.tangent_planes import PlaneCurve, Sampled, plane_curve
from cadpanel.reference.model import PanelReference, Reference

# What the whole outline counts, as a part of the panel's area.
_OUTLINE = 0.01


def bends_in_cones(feature: Feature) -> bool:
    """Whether a chain has one bend, and that is an even number of cones, none of which is held to be a cylinder."""
    runs = curved_runs(feature.curved)
    if len(runs) != 1 or (runs[0][1] - runs[0][0]) % 2:
        return False
    return all(patch.kind == "cone" for patch in feature.patches[slice(*runs[0])])


def cone_strips(feature: Feature, given: Given, axis: Array) -> list[Cones | None]:
    """Cones for every panel; none where its normals do not turn one way, or where the user says what is to bend.

    Args:
        feature: of all the panels.
        given: n of them.
        axis: (n, 3) the directions about which their normals turn.
    """
    asked = np.flatnonzero(~np.isnan(given.stretches).any(axis=(1, 2))).tolist()
    found: list[Cones | None] = []
    for i, panel in enumerate(given.panels):
        try:
            found.append(None if i in asked else cones_of(feature, panel, _sampled(panel, axis[i])))
        except LoftError:
            found.append(None)  # Not every panel is a strip; it begins from what was rolled between its ends.
    return found


def strips_of(reference: Reference) -> list[tuple[Sampled, PlaneCurve]]:
    """The developable strip through the tangent planes of every panel, with the samples that it is led through.

    Raises:
        PanelError: a panel is no strip that turns one way.
    """
    samples = SampleArrays.of(reference)
    found = []
    for panel, axis in zip(reference.panels, turning_axes(reference.panels, samples), strict=True):
        try:
            sampled = _sampled(panel, axis)
            curve = plane_curve(sampled)
        except LoftError as error:
            raise PanelError(panel.name, str(error)) from error
        if not curve.bend:
            raise PanelError(
                panel.name, "its normals turn to and fro, or rulings through its tangent planes meet in it"
            )
        found.append((sampled, curve))
    return found


def _sampled(panel: PanelReference, axis: Array) -> Sampled:
    """A panel's samples and, with little weight, its outline, as its first and its last plane are at its sides."""
    outline = np.concatenate(panel.edges)
    beside = np.full(len(outline), _OUTLINE * panel.weights.sum() / len(outline))
    return Sampled.of(
        np.concatenate([panel.points, outline]),
        np.concatenate([panel.normals, *panel.edge_normals]),
        np.concatenate([panel.weights, beside]),
        axis,
    )


def cones_of(feature: Feature, panel: PanelReference, sampled: Sampled) -> Cones:
    """A panel's cones from flange to flange, or from side to side where the feature has no flanges.

    Raises:
        LoftError: the panel is no strip that turns one way, or has flat sides while the feature has no flanges.
    """
    ((first, stop),) = curved_runs(feature.curved)
    flanged = stop - first < len(feature.patches)
    if not flanged and sampled.turning() != sampled.whole_turning:
        raise LoftError("the strip has flat sides, which no cone of a strip follows")
    curve = plane_curve(sampled)
    low, high = curve.turning if curve.bend >= 0 else curve.turning[::-1]
    if not flanged:
        low, high = (float(curve.feet(side)[0].mean()) for side in panel.sides)
    return cones_through(curve, (low, high), stop - first, feature.anchor - first)
