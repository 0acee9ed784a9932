"""Is what a report says of parts, blanks, masses and bends, that of its panels? All of it is worked out again."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

import numpy as np

from cadpanel.delivery.records.blanks import BendModel
from cadpanel.delivery.records.flat_parts import FlatPart
from cadpanel.delivery.records.from_fit import KG_PER_MM3
from cadpanel.delivery.records.report import PanelModel

SAME_LENGTH = 1e-6
"""Lengths in mm, and angles in degrees, that are meant to be one may differ by this; areas by as much of themselves."""
SAME_BLANK = 0.01
"""The same for the sides of a blank, which are told to this, mm."""
SAME_MASS = 1e-9
"""Relative difference of a mass from volume times density."""


def part_faults(records: Sequence[PanelModel], parts: Sequence[FlatPart], density: float) -> tuple[str, ...]:
    """One sentence for every number of a record that is not the part's, at a density in kg/m3."""
    return tuple(
        f"Panel '{record.name}': the report's {what} is not that of the panel."
        for record, part in zip(records, parts, strict=True)
        for what in _wrong(record, part, density)
    )


def _wrong(record: PanelModel, part: FlatPart, density: float) -> Iterator[str]:
    stated, found = record.blank, part.blank
    if stated is None or record.mass is None:
        yield "blank or mass"
        return
    if not abs(record.mass / (record.volume * density * KG_PER_MM3) - 1.0) <= SAME_MASS:
        yield "mass"
    sizes = np.abs([stated.width - found.width, stated.height - found.height])
    if not sizes.max() <= SAME_BLANK:
        yield "blank"
    if not abs(stated.area / found.area - 1.0) <= SAME_LENGTH:
        yield "area of its blank"
    if stated.edges.keys() != found.edges.keys() or any(
        not abs(stated.edges[edge] - length) <= SAME_LENGTH for edge, length in found.edges.items()
    ):
        yield "length of an edge"
    if (stated.stock, stated.file) != (found.stock, found.file):
        yield "sheet of the stock or name of its drawing"
    if record.bevels.keys() != part.bevels.keys() or any(
        not np.abs(np.subtract(record.bevels[edge], bevel)).max() <= SAME_LENGTH for edge, bevel in part.bevels.items()
    ):
        yield "bevel"
    if not _same_fixings(record, part):
        yield "fixing hole"
    if len(record.bends) != len(part.bends) or not all(map(_same_bend, record.bends, part.bends)):
        yield "bend"


def _same_fixings(record: PanelModel, part: FlatPart) -> bool:
    stated, found = (
        np.array([[*hole.flat, *hole.point, *hole.normal, hole.patch] for hole in holes]).reshape(-1, 9)
        for holes in (record.fixings, part.holes)
    )
    edges = [hole.edge for hole in record.fixings] == [hole.edge for hole in part.holes]
    return edges and bool(np.abs(stated - found).max(initial=0.0) <= SAME_LENGTH)


def _same_bend(one: BendModel, other: BendModel) -> bool:
    first, second = (
        np.array([*bend.radius, *bend.lengths, *bend.angles, bend.sweep, bend.half_angle, bend.patch, bend.hits])
        for bend in (one, other)
    )
    return one.direction == other.direction and bool(np.abs(first - second).max() <= SAME_LENGTH)
