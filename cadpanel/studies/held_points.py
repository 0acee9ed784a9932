"""Fits of one reference under several tolerances, each of which is at least as good as what the others tell of it.

What holds a gap holds every wider one as well, so the answer to a tighter tolerance is one to a looser; and a fit may
go on from that of the next tighter or wider gap instead of the local fits. Every point is fitted from its local fits
first, so that none can end worse for having neighbours.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from cadpanel.errors import PanelError
from cadpanel.fitting.measures.verdict import keeps_limits
from cadpanel.fitting.result import FitResult
from cadpanel.fitting.run import fit
from cadpanel.fitting.seams_asked import for_seams
from cadpanel.fitting.settings import FitSettings
from cadpanel.reference.model import Reference

# A result is better where its RMS deviation is less by more than this part: rounding must not choose between two.
BETTER = 1e-6

Progress = Callable[[FitSettings, Reference, int, float, float], None]
"""Told what is fitted, the step (0 where it begins), the largest excess over a tolerance and the RMS deviation, mm."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Point:
    """One fit of a study.

    Attributes:
        reference: what was approximated.
        settings: how; one combination of those that were asked for.
        result: what came of it; None where it was refused.
        begun: from where: "alone" (the local fits), "tighter" or "wider" (the answer to the neighbouring gap).
        refused: why there is none, in one sentence; empty where there is.
        knee: whether a wider gap than this is worth little more.
    """

    reference: Reference
    settings: FitSettings
    result: FitResult | None
    begun: str = "alone"
    refused: str = ""
    knee: bool = False


def fit_points(
    reference: Reference, settings: Sequence[FitSettings], progress: Progress | None = None
) -> tuple[Point, ...]:
    """Fit one reference under settings that differ in their gap tolerance alone; one point each, from tight to wide.

    A feature that cannot approximate a panel refuses all its points, with the sentence why.

    Args:
        reference: what is to be approximated.
        settings: in any order.
        progress: told of every step.
    """
    ordered = sorted((for_seams(one, reference.settings.seams) for one in settings), key=lambda one: one.widest_gap)
    points: list[Point] = []
    for how in ordered:
        point = _alone(reference, how, progress)
        if points:
            point = _also_from(point, points[-1], "tighter", progress)
        points.append(point)
    for place in range(len(points) - 2, -1, -1):
        points[place] = _also_from(points[place], points[place + 1], "wider", progress)
    # What came from wider gaps may better those that are wider still.
    for place in range(1, len(points)):
        points[place] = _kept(points[place], points[place - 1])
    return tuple(points)


def better(result: FitResult, other: FitResult) -> bool:
    """Whether a result of the same settings is better than another: it holds, or else exceeds less, and is closer."""
    if result.tolerance_met != other.tolerance_met:
        return result.tolerance_met
    if not result.tolerance_met:
        gaps = [max(one.measures.max_seam_gap, one.measures.max_corner_gap) for one in (result, other)]
        if abs(gaps[0] - gaps[1]) > BETTER * max(gaps):
            return gaps[0] < gaps[1]
    return result.measures.overall_rms < other.measures.overall_rms * (1.0 - BETTER)


def judged_by(result: FitResult, settings: FitSettings) -> FitResult:
    """The same panels as the answer to other tolerances; what a gap costs is not known of them."""
    parts = tuple(judged_by(part, replace(settings, blend=part.settings.blend)) for part in result.parts)
    return replace(
        result,
        settings=settings,
        baselines=result.baselines.judged_by(settings, result.measures),
        parts=parts,
        tolerance_met=keeps_limits(result.measures, settings) and all(outcome.kept for outcome in result.outcomes),
        prices={},
    )


def _alone(reference: Reference, how: FitSettings, progress: Progress | None) -> Point:
    try:
        result = fit(reference, how, _telling(reference, how, progress))
    except PanelError as error:
        return Point(reference=reference, settings=how, result=None, refused=" ".join(str(error).split()))
    return Point(reference=reference, settings=how, result=result)


def _also_from(point: Point, neighbour: Point, begun: str, progress: Progress | None) -> Point:
    """The better of a point and what comes of going on from its neighbour, where that holds what it was asked for."""
    if point.result is None or neighbour.result is None or not neighbour.result.tolerance_met:
        return point
    how = point.settings
    # Features that are chosen panel by panel may be others, and only one method goes on from an answer.
    if how.automatic or how.method != "concurrent":
        return _kept(point, neighbour)
    result = fit(point.reference, how, _telling(point.reference, how, progress), after=neighbour.result)
    return _kept(_chosen(point, result, begun), neighbour)


def _kept(point: Point, neighbour: Point) -> Point:
    """The better of a point and its neighbour's answer as it stands."""
    if point.result is None or neighbour.result is None or not neighbour.result.tolerance_met:
        return point
    begun = "tighter" if neighbour.settings.widest_gap < point.settings.widest_gap else "wider"
    return _chosen(point, judged_by(neighbour.result, point.settings), begun)


def _chosen(point: Point, result: FitResult, begun: str) -> Point:
    if point.result is not None and not better(result, point.result):
        return point
    return replace(point, result=result, begun=begun)


def _telling(
    reference: Reference, how: FitSettings, progress: Progress | None
) -> Callable[[str, int, float, float], None]:
    def tell(_method: str, step: int, excess: float, rms: float) -> None:
        if progress is not None:
            progress(how, reference, step, excess, rms)

    tell("", 0, 0.0, 0.0)
    return tell
