"""The numbers that deliveries of the three fixtures held when last looked at, for whatever must not move them.

A change of the house (a move, a protocol, another processor) keeps them to within 1e-9 mm. A change of the mathematics
moves them on purpose: then they are written anew, and the commit says by how much and why.

    python -m tests.delivered_numbers            shows the largest difference in each fixture
    python -m tests.delivered_numbers --write    keeps what this tree delivers
"""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from pathlib import Path

from cadpanel.brep.read import read_reference
from cadpanel.delivery.records.from_fit import baselines_record, panel_records, seam_records
from cadpanel.delivery.records.summary import summary
from cadpanel.delivery.settings import SheetSettings
from cadpanel.delivery.sheets import build_panels
from cadpanel.fitting.run import fit

FIXTURES = ("kai_tak_nw", "kai_tak_se_south", "kai_tak_se_east")
KEPT = Path(__file__).with_name("delivered_numbers.json")
ROOT = Path(__file__).parent.parent
CLOSE = 1e-9
"""Largest difference, in mm, degrees or parts of the value, whichever is the larger."""

Tree = dict[str, "Tree"] | list["Tree"] | float | int | str | bool | None


def delivered(fixture: str) -> Tree:
    """What report.json would say of the panels, seams and the whole of a fixture under the default settings."""
    result = fit(read_reference(ROOT / "fixtures" / f"{fixture}.step"))
    built = build_panels(result.shapes, SheetSettings(), result.reference.seams)
    seams = seam_records(result.reference, result.measures, built.joints)
    records = {
        "panels": [panel.model_dump(mode="json") for panel in panel_records(result, built)],
        "seams": [seam.model_dump(mode="json") for seam in seams],
        "summary": summary(result.measures, result.local, result.settings).model_dump(mode="json"),
        "baselines": baselines_record(result).model_dump(mode="json"),
    }
    tree: Tree = json.loads(json.dumps(records))
    return tree


def differences(one: Tree, other: Tree, place: str = "") -> Iterator[tuple[str, float]]:
    """Where a tree differs from one that was kept, and by how much: numbers by size, everything else by infinity.

    Keys may be added to a report; those that were kept may not go.
    """
    if isinstance(one, dict) and isinstance(other, dict):
        for key, value in one.items():
            if key in other:
                yield from differences(value, other[key], f"{place}/{key}")
            else:
                yield f"{place}/{key}", float("inf")
    elif isinstance(one, list) and isinstance(other, list) and len(one) == len(other):
        for index, (first, second) in enumerate(zip(one, other, strict=True)):
            yield from differences(first, second, f"{place}/{index}")
    elif isinstance(one, float | int) and isinstance(other, float | int):
        yield place, abs(one - other) / max(1.0, abs(one))
    elif one != other:
        yield place, float("inf")


def kept() -> dict[str, Tree]:
    """The numbers that were kept, fixture by fixture."""
    numbers: dict[str, Tree] = json.loads(KEPT.read_text(encoding="utf-8"))
    return numbers


def main() -> None:
    """Show the differences, or keep what this tree delivers."""
    now = {fixture: delivered(fixture) for fixture in FIXTURES}
    if "--write" in sys.argv[1:]:
        KEPT.write_text(json.dumps(now, indent=None, separators=(",", ":")) + "\n", encoding="utf-8")
        return
    for fixture, numbers in kept().items():
        place, largest = max(differences(numbers, now[fixture]), key=lambda one: one[1])
        sys.stdout.write(f"{fixture}: {largest:.3g} at {place}\n")


if __name__ == "__main__":
    main()
