"""What a gap costs: every combination of gaps, features and numbers of panels, fitted and held against each other."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import replace

from cadpanel.errors import SettingsError
from cadpanel.fitting.settings import FitSettings
from cadpanel.reference.model import Reference
from cadpanel.studies.held_points import Point, Progress, fit_points
from cadpanel.studies.knee import knee
from cadpanel.studies.prepared import Prepare, unprepared


def trade_off(
    references: Iterable[Callable[[], Reference]],
    settings: Sequence[FitSettings],
    progress: Progress | None = None,
    *,
    prepare: Prepare = unprepared,
) -> tuple[Point, ...]:
    """Fit every reference under all settings: for each reference and feature the points from tight gaps to wide ones.

    Args:
        references: each is read when its turn comes.
        settings: those that differ in nothing but the gap tolerance make a curve, in the order of their first ones.
        progress: told of every step.
        prepare: see `Prepare`.

    Raises:
        CadpanelError: a reference cannot be read.
        SettingsError: there are no settings, or some with weights.
    """
    if not settings:
        raise SettingsError("a study has at least one gap and one feature")
    if any(how.weights is not None for how in settings):
        raise SettingsError("a study is of gap tolerances, whose place weights would take: leave these out")
    found: list[Point] = []
    for read in references:
        reference = read()
        for group in _curves(settings):
            points = fit_points(reference, [prepare(one, reference) for one in group], progress)
            best = _knee(points)
            found += [replace(point, knee=place == best) for place, point in enumerate(points)]
    return tuple(found)


def most_fits(settings: Sequence[FitSettings]) -> int:
    """How many fits a study of one reference takes at most: each point alone, and from both of its neighbours."""
    return sum(3 * len(group) - 2 for group in _curves(settings))


def _curves(settings: Sequence[FitSettings]) -> list[list[FitSettings]]:
    groups: dict[str, list[FitSettings]] = {}
    for one in settings:
        groups.setdefault(one.feature_name, []).append(one)
    return list(groups.values())


def _knee(points: Sequence[Point]) -> int | None:
    """Among those points that hold what is asked."""
    held = [
        (place, point.settings.widest_gap, point.result.measures.overall_rms)
        for place, point in enumerate(points)
        if point.result is not None and point.result.tolerance_met
    ]
    found = knee([gap for _, gap, _ in held], [rms for _, _, rms in held])
    return None if found is None else held[found][0]
