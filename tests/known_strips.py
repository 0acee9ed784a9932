"""Developable strips through the tangent planes of surfaces that are known."""

from __future__ import annotations

from collections.abc import Callable
from functools import cache, partial
from typing import Any

from cadpanel.lofting.tangent_planes import PlaneCurve, Sampled, plane_curve
from tests.known_rails import cone_samples, torse_samples

KNOWN: dict[str, Callable[[], Any]] = {
    "torse": torse_samples,
    "cone": cone_samples,
    "cylinder": partial(cone_samples, slope=0.0),
}


@cache
def strip(name: str, spans: int = 8) -> PlaneCurve:
    """The strip through one of them."""
    points, normals, weights, along = KNOWN[name]()
    return plane_curve(Sampled.of(points, normals, weights, along), spans=spans)
