"""From sampled faces to the reference: oriented panels and the seams between them."""

from __future__ import annotations

from collections.abc import Sequence
from numbers import Real

import numpy as np

from cadpanel.errors import PanelError, ReferenceFileError, SettingsError
from cadpanel.geometry.vectors import norm
from cadpanel.reference.alignment import align, find_seams, orient
from cadpanel.reference.ends_and_outside import first_ends, outer_faces
from cadpanel.reference.junctions import part_sides
from cadpanel.reference.model import RawPanel, Reference
from cadpanel.reference.near_misses import unmet_notes
from cadpanel.reference.oriented_panel import Sheet, sheet
from cadpanel.reference.outline import Outline, find_outline
from cadpanel.reference.overlaps import refuse_overlaps
from cadpanel.reference.seam_finding import after_flipping, find_contacts, refuse_duplicates

# Ends of panels that meet may lie this far apart in the file, mm.
SEAM_TOLERANCE = 1.0
# The largest tolerance, against the distance of any two neighbouring corners of a panel.
LARGEST_TOLERANCE = 0.4
# Corners as close as this are one, mm: no seam tolerance could be small enough to tell them apart.
SAME_CORNER = 1e-3


def assemble(
    raw_panels: Sequence[RawPanel],
    source: str,
    seam_tolerance: float = SEAM_TOLERANCE,
    junctions: bool = False,
    found: Sequence[Outline] | None = None,
) -> Reference:
    """Return the reference that a file's panels make.

    The result does not depend on the order of panels, faces and edges, nor on the side of the faces' normals: panels
    keep the file's order, everything else is found by geometry.

    Args:
        raw_panels: the panels as sampled, each with a name of its own.
        source: the file's name, kept and used in messages.
        seam_tolerance: how far panels that meet, and faces of one panel, may lie apart, mm.
        junctions: part the sides of panels where corners of others lie on them?
        found: the panels' outlines, where they were found with this tolerance already.

    Raises:
        ReferenceFileError: there are no panels.
        PanelError: one of the panels is none, lies on another one, or meets more than one at the same edge.
        SettingsError: the tolerance is no positive length.
    """
    if not _is_length(seam_tolerance):
        raise SettingsError(f"The seam tolerance must be a positive length in mm, not {seam_tolerance!r}.")
    if not raw_panels:
        raise ReferenceFileError(f"'{source}' holds no faces: export the faces of the skin, one product a panel.")
    outlines = found or [find_outline(raw, source, seam_tolerance) for raw in raw_panels]
    if junctions:
        outlines = part_sides(outlines, seam_tolerance)
    sheets = [sheet(raw, outline) for raw, outline in zip(raw_panels, outlines, strict=True)]
    _check_tolerance(sheets, source, seam_tolerance)
    refuse_duplicates(sheets, source, seam_tolerance)
    contacts = find_contacts(sheets, source, seam_tolerance)
    refuse_overlaps(sheets, source, seam_tolerance)
    notes = unmet_notes(sheets, contacts, source, seam_tolerance, junctions)
    flipped = outer_faces(sheets, contacts)
    sheets = [one.other_face() if flip else one for one, flip in zip(sheets, flipped, strict=True)]
    contacts = after_flipping(contacts, sheets, flipped)
    first = first_ends(sheets, contacts)
    panels = [orient(one, end) for one, end in zip(sheets, first, strict=True)]
    aligned, seams = align(panels, find_seams(panels, sheets, first, contacts), seam_tolerance)
    return Reference(source=source, panels=aligned, seams=seams, seam_tolerance=seam_tolerance, notes=notes)


def _is_length(value: object) -> bool:
    return isinstance(value, Real) and 0.0 < float(value) < np.inf


def _check_tolerance(sheets: Sequence[Sheet], source: str, seam_tolerance: float) -> None:
    """Refuse a tolerance within which two corners of a panel could be taken for each other."""
    shortest = [min(float(norm(side.points[-1] - side.points[0])) for side in one.sides) for one in sheets]
    panel = int(np.argmin(shortest))
    if shortest[panel] < SAME_CORNER:
        raise PanelError(
            sheets[panel].name,
            f"in '{source}', two of its corners lie on each other: its sides meet in a knife edge there, and no panel "
            "reaches round one.",
        )
    if seam_tolerance > LARGEST_TOLERANCE * shortest[panel]:
        raise SettingsError(
            f"The seam tolerance of {seam_tolerance:g} mm is too large for panel '{sheets[panel].name}', two corners "
            f"of which are {shortest[panel]:.4g} mm apart: at most {LARGEST_TOLERANCE * shortest[panel]:.4g} mm."
        )
