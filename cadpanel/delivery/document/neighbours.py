"""Who meets whom, and how well, as properties: of a seam, and of a panel with all its neighbours."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from typing import NamedTuple

from cadpanel.delivery.document.objects import AnyProperty, Number, NumberKind, Words
from cadpanel.delivery.records.report import SeamModel

SEAM_GROUP = "Seam"


class Neighbour(NamedTuple):
    """What one panel meets: which, along which of its own edges, and the seam between."""

    name: str
    edge: str
    seam: SeamModel


def neighbours(seams: Sequence[SeamModel]) -> Mapping[str, list[Neighbour]]:
    """The neighbours of every panel that has some, by its name, in the order of the seams."""
    found: dict[str, list[Neighbour]] = {}
    for seam in seams:
        for own in (0, 1):
            met = Neighbour(seam.panels[1 - own], seam.edges[own], seam)
            found.setdefault(seam.panels[own], []).append(met)
    return found


def neighbour_properties(met: Sequence[Neighbour]) -> Iterator[AnyProperty]:
    """Of each neighbour its name and the seam's numbers, under a heading of its own; then the worst of them."""
    for number, (panel, edge, seam) in enumerate(met, start=1):
        prefix = f"Neighbour{number}"
        heading = f"Neighbour {number}"
        yield Words(name=prefix, group=heading, tip="the panel that is met", value=panel)
        yield Words(name=f"{prefix}Edge", group=heading, tip="along which edge of this panel", value=edge)
        yield from seam_numbers(seam, heading, prefix)
    if met:
        heading = "All neighbours"
        seams = [one.seam for one in met]
        worst: list[tuple[str, str, NumberKind, float]] = [
            (
                "LargestGap",
                "largest gap along a seam with any neighbour",
                "Length",
                max(one.max_seam_gap for one in seams),
            ),
            ("LargestStep", "largest step to any neighbour", "Length", max(one.step for one in seams)),
            ("LargestKink", "largest angle with a neighbour's skin", "Angle", max(one.max_kink for one in seams)),
        ]
        for name, tip, kind, value in worst:
            yield Number(name=name, group=heading, tip=tip, kind=kind, value=value)


def seam_properties(seam: SeamModel) -> Iterator[AnyProperty]:
    """A seam's own: the two panels and their edges, and its numbers."""
    for place, prefix in enumerate(("First", "Second")):
        yield Words(name=f"{prefix}Panel", group=SEAM_GROUP, tip="one that meets here", value=seam.panels[place])
        yield Words(name=f"{prefix}Edge", group=SEAM_GROUP, tip="along which of its edges", value=seam.edges[place])
    yield from seam_numbers(seam, SEAM_GROUP, "")
    turn = "largest angle with the drawn seam"
    yield Number(name="Turn", group=SEAM_GROUP, tip=turn, kind="Angle", value=seam.turn)


def seam_numbers(seam: SeamModel, heading: str, prefix: str) -> Iterator[AnyProperty]:
    """The numbers of a seam under a heading, every name with a prefix."""
    told: list[tuple[str, str, NumberKind, float]] = []
    if seam.clear is not None:
        told += [
            ("JointLeast", "least clear width between the sheets, as measured", "Distance", seam.clear.least),
            ("JointLargest", "largest clear width between the sheets, as measured", "Distance", seam.clear.largest),
        ]
    told += [
        ("Gap", "largest gap between the fitted skins, along the whole seam", "Length", seam.max_seam_gap),
        ("CornerGap", "largest gap between corners that meet", "Length", seam.max_corner_gap),
        ("Width", "largest part of it in the skins, square to the seam", "Length", seam.width),
        ("Step", "largest part of it from skin to skin", "Length", seam.step),
        ("Shift", "largest part of it along the seam", "Length", seam.shift),
        ("Kink", "largest angle between the two skins", "Angle", seam.max_kink),
    ]
    for name, tip, kind, value in told:
        yield Number(name=f"{prefix}{name}", group=heading, tip=tip, kind=kind, value=value)
