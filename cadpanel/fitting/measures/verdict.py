"""Whether what was measured keeps within what was asked."""

from __future__ import annotations

from collections.abc import Iterator

from cadpanel.arrays import BoolArray
from cadpanel.fitting.measures.fit import Measures
from cadpanel.fitting.settings import FitSettings
from cadpanel.terms.limits.catalogue import LIMITS
from cadpanel.terms.limits.limit import Limit
from cadpanel.terms.limits.obliqueness import Obliqueness


def keeps_limits(measures: Measures, settings: FitSettings) -> bool:
    """Whether every gap, deviation and limit is kept; with weights only a deviation has one to miss.

    What cannot be built keeps nothing.
    """
    if too_oblique(measures).any():
        return False
    if settings.max_deviation is not None and measures.max_deviation.max() > settings.max_deviation:
        return False
    if settings.weights is not None:
        return True
    gaps, asked = measures.gaps, settings.gaps_of([shape.name for shape in measures.shapes], measures.seam_panels)
    return bool(
        all((gaps[what] <= allowed).all() for what, allowed in asked.items())
        and all(limit.kept(measures, allowed).all() for limit, allowed in limits_of(settings))
    )


def too_oblique(measures: Measures) -> BoolArray:
    """(panels,) which cannot be built as an end is cut too obliquely, whatever was asked for."""
    limit = Obliqueness()
    return ~limit.kept(measures, limit.default)


def limits_of(settings: FitSettings) -> Iterator[tuple[Limit, float]]:
    """Every limit with what the settings allow."""
    allowed = settings.allowed
    for limit in LIMITS:
        yield limit, allowed[limit.name]
