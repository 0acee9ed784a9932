"""A strip cut into a number of panels of equal length along it: the paper's way."""

from __future__ import annotations

import numpy as np

from cadpanel.brep.connect import Surface
from cadpanel.brep.lanes import Lanes, find_lanes
from cadpanel.brep.lips import band, lips_of, section_of
from cadpanel.brep.planes import cut_by_planes
from cadpanel.brep.strip import find_strip
from cadpanel.brep.subdivide.panel import CutPanel, along_panels
from cadpanel.errors import ReferenceFileError


def cut_lengths(surface: Surface, count: int, lip: float | None, source: str) -> tuple[CutPanel, ...]:
    """Cut a strip where the mean length of its two long edges has equal parts.

    Faces side by side that share their parameter along the strip are cut along parameter lines, without any boolean;
    all others by planes through the two long edges, square to the strip.

    Args:
        surface: what to cut.
        count: number of panels.
        lip: width of the band about the strip's lip that the panels cover, mm; None for all of the strip.
        source: the reference's name.

    Raises:
        ReferenceFileError: the surface is no strip, has no lip where one is asked for, or cannot be cut.
    """
    lanes = find_lanes(surface)
    parts = np.linspace(0.0, 1.0, count + 1)
    if lanes is not None:
        if not lanes.outer:
            raise ReferenceFileError(
                f"The surface of {surface.numbers} of '{source}' is closed round its length, and a panel cannot go "
                "round: cut it both ways, with a grid."
            )
        if lip is not None:
            lanes = _about_the_lip(lanes, surface, lip, source)
        parts[1:-1] = lanes.at_lengths(parts[1:-1])
        return along_panels(surface.name, lanes.cut(parts))
    if lip is not None:
        raise ReferenceFileError(
            f"The faces of the surface of {surface.numbers} of '{source}' share no parameter along the strip, so that "
            "no band about its lip can be cut out of them: trim them where they were modelled."
        )
    strip = find_strip(surface, source)
    if count == 1:
        return along_panels(surface.name, [[face.patch.face for face in surface.faces]])
    return along_panels(surface.name, cut_by_planes(surface, strip.planes(parts[1:-1]), source))


def _about_the_lip(lanes: Lanes, surface: Surface, width: float, source: str) -> Lanes:
    """The band of a width about the lip that turns most."""
    section = section_of(lanes)
    lips = () if section is None else lips_of(section.length, section.turn)
    if section is None or not lips:
        raise ReferenceFileError(
            f"The surface of {surface.numbers} of '{source}' has no lip, a stretch across it that turns fast: "
            "divide all of it."
        )
    middle = max(lips, key=lambda lip: lip.turn).middle
    if width >= section.length[-1]:
        raise ReferenceFileError(
            f"The surface of {surface.numbers} of '{source}' is {section.length[-1]:.6g} mm wide, no more than "
            f"the band of {width:g} mm about its lip: divide all of it."
        )
    return band(lanes, section, middle - 0.5 * width, middle + 0.5 * width)
