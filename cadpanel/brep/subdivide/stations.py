"""A surface cut by planes at given lengths along its middle, or along a spine of its own."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from cadpanel.brep.connect import Surface
from cadpanel.brep.curves import CurveFile, chain
from cadpanel.brep.planes import cut_by_planes
from cadpanel.brep.strip import MIDDLE_POINTS, STEP, Cuts, find_strip
from cadpanel.brep.subdivide.panel import CutPanel, along_panels
from cadpanel.errors import ReferenceFileError, SettingsError
from cadpanel.reference.polyline import arc_length, interpolate, unit

Array = NDArray[np.float64]

# How far beyond the surface's farthest point from the spine a plane reaches, a ratio.
BEYOND = 1.05


@dataclass(frozen=True, slots=True, kw_only=True)
class Spine:
    """A line along which stations are measured: (q, 3) points, mm, and the name of its file."""

    line: Array
    source: str


def spine_of(file: CurveFile) -> Spine:
    """The spine that the curves of a file make.

    Raises:
        ReferenceFileError: they do not follow each other.
    """
    line = chain([curve.points for curve in file.curves])
    if line is None:
        raise ReferenceFileError(
            f"'{file.source}' holds {len(file.curves)} curves that do not follow each other: a spine is one line."
        )
    return Spine(line=line, source=file.source)


def cut_stations(surface: Surface, stations: Sequence[float], spine: Spine | None, source: str) -> tuple[CutPanel, ...]:
    """Cut a surface by planes square to its middle line or to a spine.

    Args:
        surface: what to cut.
        stations: lengths along the line, mm, rising.
        spine: along what the lengths are measured; None for the line midway between the surface's long edges.
        source: the reference's name.

    Raises:
        ReferenceFileError: the surface cannot be cut there.
        SettingsError: a station lies beyond the line's end.
    """
    if spine is None:
        strip = find_strip(surface, source)
        _require_on_line(stations, strip.length, f"the strip of {surface.numbers}")
        cuts = strip.planes(np.array(stations) / strip.length)
    else:
        cuts = _along_spine(surface, stations, spine)
    return along_panels(surface.name, cut_by_planes(surface, cuts, source))


def _require_on_line(stations: Sequence[float], length: float, what: str) -> None:
    if stations[-1] >= length:
        raise SettingsError(
            f"the station at {stations[-1]:g} mm lies beyond the end of {what}, which is {length:.6g} mm long"
        )


def _along_spine(surface: Surface, stations: Sequence[float], spine: Spine) -> Cuts:
    line = spine.line
    lengths = arc_length(line)
    _require_on_line(stations, float(lengths[-1]), f"the spine in '{spine.source}'")
    points = np.concatenate([array for face in surface.faces for array in (face.samples.points, *face.samples.edges)])
    fine = np.linspace(0.0, lengths[-1], MIDDLE_POINTS)
    middle = interpolate([lengths], line, [fine])
    far = max(float(np.linalg.norm(point - middle, axis=1).min()) for point in points)
    places = np.array(stations)
    step = STEP * lengths[-1]
    before, after = (
        interpolate([lengths], line, [np.clip(places + side * step, 0.0, lengths[-1])]) for side in (-1.0, 1.0)
    )
    return Cuts(
        origins=interpolate([lengths], line, [places]),
        normals=unit(after - before),
        reach=np.full(len(places), BEYOND * far),
        line=middle,
        places=np.interp(fine, np.concatenate([[0.0], places, [lengths[-1]]]), np.arange(len(places) + 2)),
    )
