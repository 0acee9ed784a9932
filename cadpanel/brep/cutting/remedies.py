"""Other ways to cut what could not be cut as asked, few enough to be tried before one of them is named."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass

from cadpanel.reference.settings import ReferenceSettings
from cadpanel.reference.texts import BY_FITS

SHORTER = 0.8
"""Share of a length that is tried instead."""
ROUND = 3
"""Panels round a closed surface or a point that have corners enough each."""
TRIED = 1.5
FEW = 36
"""Another grid is tried after a first one while the panels of both are within so many times those asked for, or few."""


@dataclass(frozen=True, slots=True)
class OtherWay:
    """Settings that may cut what others do not, and what to call them in a sentence."""

    settings: ReferenceSettings
    called: str


def other_ways(how: ReferenceSettings) -> tuple[OtherWay, ...]:
    """At most two other ways to cut the same faces, so that a refusal takes at most three times as long as reading.

    Where nothing is cut, or along curves that somebody drew, there are none: those are not drawn anew.
    """
    if how.way is None:
        return ()
    return tuple(OTHERS[how.way](how)) if how.way in OTHERS else ()


def _of_lengths(how: ReferenceSettings) -> Sequence[OtherWay]:
    if how.panel_length is not None:
        length = SHORTER * how.panel_length
        return _plain(how, panel_length=length), _grid(how, ROUND, 2)
    if how.divide is None or how.divide in BY_FITS:
        return (_grid(how, ROUND, 2),)
    return _plain(how, divide=int(how.divide) + 1), _grid(how, ROUND, 2)


def _of_size(how: ReferenceSettings) -> Sequence[OtherWay]:
    assert how.panel_size is not None
    u, v = how.panel_size
    return _plain(how, panel_size=(SHORTER * u, SHORTER * v)), _grid(how, ROUND, 2)


def _of_grid(how: ReferenceSettings) -> Sequence[OtherWay]:
    assert how.grid is not None
    u, v = how.grid
    finer, doubled = (max(u, ROUND - 1) + 1, max(v, ROUND - 1) + 1), (max(u, ROUND), 2 * v)
    # Reading takes as long as there are panels: no second try where a grid is large.
    panels = finer[0] * finer[1] + doubled[0] * doubled[1]
    tried = (finer, doubled) if panels <= max(FEW, TRIED * u * v) else (finer,)
    return [_grid(how, *numbers) for numbers in tried]


def _of_stations(how: ReferenceSettings) -> Sequence[OtherWay]:
    assert how.stations is not None
    return _plain(how, divide=len(how.stations) + 1), _grid(how, ROUND, 2)


def _grid(how: ReferenceSettings, u: int, v: int) -> OtherWay:
    return _plain(how, grid=(u, v))


def _plain(
    how: ReferenceSettings,
    *,
    divide: int | None = None,
    panel_length: float | None = None,
    panel_size: tuple[float, float] | None = None,
    grid: tuple[int, int] | None = None,
) -> OtherWay:
    """The same faces read the same way, and cut in this one."""
    settings = ReferenceSettings(
        seam_tolerance=how.seam_tolerance,
        unit=how.unit,
        faces=how.faces,
        junctions=how.junctions,
        divide=divide,
        panel_length=panel_length,
        panel_size=panel_size,
        grid=grid,
    )
    if divide is not None:
        return OtherWay(settings, f"dividing it into {divide}")
    if panel_length is not None:
        return OtherWay(settings, f"dividing it into panels of {panel_length:g} mm")
    if panel_size is not None:
        return OtherWay(settings, f"panels of {panel_size[0]:g}x{panel_size[1]:g} mm")
    assert grid is not None
    return OtherWay(settings, f"a grid of {grid[0]}x{grid[1]}")


OTHERS: dict[str, Callable[[ReferenceSettings], Sequence[OtherWay]]] = {
    "divide": _of_lengths,
    "panel_length": _of_lengths,
    "panel_size": _of_size,
    "grid": _of_grid,
    "stations": _of_stations,
}
"""What else is tried, by the way in which it was cut."""
