"""A surface cut by planes at given lengths along its middle, or along a spine of its own."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np
from scipy.spatial import cKDTree

from cadpanel.arrays import Array
from cadpanel.brep.curves.drawn_curve import CurveFile, chain
from cadpanel.brep.cutting.cut_panel import CutPanel, along_panels
from cadpanel.brep.skin.adjacency import Surface
from cadpanel.brep.skin.cut_planes import Cuts
from cadpanel.brep.skin.split_by_planes import cut_by_planes
from cadpanel.brep.skin.strip import MIDDLE_POINTS, STEP, find_strip
from cadpanel.errors import ReferenceFileError, SettingsError
from cadpanel.geometry.polyline import arc_length, interpolate
from cadpanel.geometry.vectors import norm, unit
from cadpanel.reference.assemble import LARGEST_TOLERANCE

# How far beyond the surface's farthest point from the spine a plane reaches, a ratio.
BEYOND = 1.05
# A spine whose ends are as close as this part of its length closes to a ring.
CLOSED = 1e-6


@dataclass(frozen=True, slots=True, kw_only=True)
class Spine:
    """A line along which stations are measured: (q, 3) points, mm, and the name of its file."""

    line: Array
    source: str


def spine_of(file: CurveFile) -> Spine:
    """The spine that the curves of a file make.

    Raises:
        ReferenceFileError: they do not follow each other, or until they are back at the first: a length along them
            would have no beginning.
    """
    line = chain([curve.points for curve in file.curves])
    if line is None:
        raise ReferenceFileError(
            f"'{file.source}' holds {len(file.curves)} curves that do not follow each other: a spine is one line."
        )
    if norm(line[-1] - line[0]) <= CLOSED * arc_length(line)[-1]:
        raise ReferenceFileError(
            f"The spine in '{file.source}' closes to a ring, on which no station is the first: leave a part of it out "
            "that lies off the surface, or cut the surface with a network of curves."
        )
    return Spine(line=line, source=file.source)


def cut_stations(
    surface: Surface, stations: Sequence[float], spine: Spine | None, source: str, tolerance: float
) -> tuple[CutPanel, ...]:
    """Cut a surface by planes square to its middle line or to a spine.

    Args:
        surface: what to cut.
        stations: lengths along the line, mm, rising.
        spine: along what the lengths are measured; None for the line midway between the surface's long edges.
        source: the reference's name.
        tolerance: how far panels that meet may lie apart, mm; none may be so short that its ends could be confused.

    Raises:
        ReferenceFileError: the surface cannot be cut there.
        SettingsError: a station lies beyond the line's end or the surface's, or too close to it or to the next one.
    """
    what = f"the surface of {surface.numbers} of '{source}'"
    least = tolerance / LARGEST_TOLERANCE
    if spine is None:
        strip = find_strip(surface, source, tolerance)
        _require_room(stations, (0.0, strip.length), least, what)
        cuts = strip.planes(np.array(stations) / strip.length)
    else:
        cuts, reached = _along_spine(surface, stations, spine)
        _require_room(stations, reached, least, f"{what} beside the spine in '{spine.source}'")
    return along_panels(surface.name, cut_by_planes(surface, cuts, source))


def _require_room(stations: Sequence[float], reached: tuple[float, float], least: float, what: str) -> None:
    """Refuse stations off the stretch that is cut, and such that leave a panel too short."""
    low, high = reached
    for station in stations:
        if not low + least <= station <= high - least:
            where = "too close to" if low < station < high else "beyond"
            raise SettingsError(
                f"the station at {station:.10g} mm lies {where} the end of {what}, which goes from {low:.6g} to "
                f"{high:.6g} mm: give stations from {low + least:.6g} to {high - least:.6g} mm"
            )
    for first, second in pairwise(stations):
        if second - first < least:
            raise SettingsError(
                f"the stations at {first:.10g} and {second:.10g} mm of {what} are too close to each other: leave at "
                f"least {least:g} mm between them, or give a smaller seam tolerance"
            )


def _along_spine(surface: Surface, stations: Sequence[float], spine: Spine) -> tuple[Cuts, tuple[float, float]]:
    """The planes, and from where to where on the spine there is something of the surface square to it, mm."""
    line = spine.line
    lengths = arc_length(line)
    end = float(lengths[-1])
    if stations[-1] >= end:
        raise SettingsError(
            f"the station at {stations[-1]:g} mm lies beyond the end of the spine in '{spine.source}', which is "
            f"{end:.6g} mm long: leave it out, or draw the spine on"
        )
    points = np.concatenate([array for face in surface.faces for array in (face.samples.points, *face.samples.edges)])
    fine = np.linspace(0.0, end, MIDDLE_POINTS)
    middle = interpolate([lengths], line, [fine])
    distances, nearest = cKDTree(middle).query(points)
    ways = unit(np.gradient(middle, axis=0))[nearest]
    beside = fine[nearest] + np.einsum("pd,pd->p", points - middle[nearest], ways)
    places = np.array(stations)
    step = STEP * end
    before, after = (interpolate([lengths], line, [np.clip(places + side * step, 0.0, end)]) for side in (-1.0, 1.0))
    cuts = Cuts(
        origins=interpolate([lengths], line, [places]),
        normals=unit(after - before),
        reach=np.full(len(places), BEYOND * float(np.max(distances))),
        line=middle,
        places=np.interp(fine, np.concatenate([[0.0], places, [end]]), np.arange(len(places) + 2)),
    )
    return cuts, (float(beside.min()), float(beside.max()))
