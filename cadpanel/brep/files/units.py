"""Units of length, and shapes in millimetres."""

from __future__ import annotations

from cadpanel.errors import ReferenceFileError


def no_unit(name: str, kind: str) -> str:
    """What the report says of a file in a format without units where the user gives none."""
    return f"'{name}' has no unit, as no {kind} has; it is read as millimetres."


def unit_missing(name: str) -> str:
    """What the report says of a file that leaves its unit out, though its format has one, where the user gives none."""
    return f"'{name}' does not say its unit; it is read as millimetres: give the unit if that is wrong."


def unit_taken(millimetres: float | None) -> str:
    """What stands for the unit of a file that says none: how many mm the user gives, None for millimetres."""
    return "none, read as millimetres" if millimetres is None else f"none, read as {millimetres:g} mm"


def refuse_given(name: str, unit: str) -> ReferenceFileError:
    """What the user hears who gives a unit for a file that has its own."""
    return ReferenceFileError(
        f"'{name}' says itself that its unit is the {unit}: leave the unit out, or correct it in the export."
    )
