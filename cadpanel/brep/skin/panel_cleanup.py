"""What is mended in panels that a file brings ready-made: the same as in faces that are to be cut, panel by panel."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from OCP.BRepAdaptor import BRepAdaptor_Surface
from OCP.TopoDS import TopoDS_Shape

from cadpanel.brep.faces.creases import crease_of, has_breaks
from cadpanel.brep.faces.face_patch import patch_of
from cadpanel.brep.kernel.shapes import faces_of
from cadpanel.brep.skin.adjacency import WORTH_A_NOTE
from cadpanel.brep.skin.face_cleanup import find_doubles, width_of_hair
from cadpanel.reference.model import RawPanel
from cadpanel.reference.outline import Outline, bridged_gap, outline_and_gap


@dataclass(frozen=True, slots=True, kw_only=True)
class Mended:
    """Panels as they are taken, and what was found in them, in their order.

    Attributes:
        panels: none of them empty.
        hairs, doubled, creased: a sentence without its stop on each face that has no width, lies on another one of its
            panel, or has a crease inside.
        gaps: how far the faces of each panel gape, mm.
        outlines: of the panels; None for one that has none, and whoever needs it says why.
    """

    panels: tuple[RawPanel, ...]
    hairs: tuple[str, ...] = ()
    doubled: tuple[str, ...] = ()
    creased: tuple[str, ...] = ()
    gaps: tuple[float, ...] = ()
    outlines: tuple[Outline | None, ...] = ()

    def followed_by(self, other: Mended) -> Mended:
        """These panels and others, as if they had been mended together."""
        return Mended(
            panels=(*self.panels, *other.panels),
            hairs=(*self.hairs, *other.hairs),
            doubled=(*self.doubled, *other.doubled),
            creased=(*self.creased, *other.creased),
            gaps=(*self.gaps, *other.gaps),
            outlines=(*self.outlines, *other.outlines),
        )

    def notes(self, source: str, tolerance: float) -> tuple[str, ...]:
        """A note on each kind of thing that was found in the panels of a file."""
        return (
            *_first_of(self.hairs),
            *_first_of(self.doubled),
            *_gaping(self.gaps, [panel.name for panel in self.panels], source, tolerance),
            *_first_of(self.creased),
        )


def mend_panels(panels: Sequence[RawPanel], shapes: Sequence[TopoDS_Shape], source: str, tolerance: float) -> Mended:
    """Leave out faces of panels that have no width or lie on another one of their panel; look for gaps and creases.

    Args:
        panels: as sampled, with all their faces.
        shapes: theirs, in the same order.
        source: the file's name.
        tolerance: within which a face lies on another one, and gaps between faces are bridged, mm.
    """
    mended, hairs, doubled, creased = [], [], [], []
    for panel, shape in zip(panels, shapes, strict=True):
        widths = {place: width_of_hair(face) for place, face in enumerate(panel.faces)}
        narrow = {place: width for place, width in widths.items() if width is not None}
        wide = [place for place, width in widths.items() if width is None]
        faces = faces_of(shape)
        doubles = find_doubles([panel.faces[place] for place in wide], [faces[place] for place in wide], tolerance)
        creased += _creases(panel.name, shape, source)
        left_out = {*narrow, *(wide[second] for second in doubles)}
        if not wide:  # the outline says what is wrong with it
            mended.append(panel)
            continue
        kept = tuple(face for place, face in enumerate(panel.faces) if place not in left_out)
        mended.append(replace(panel, faces=kept) if left_out else panel)
        hairs += [
            f"Face {place + 1} of panel '{panel.name}' of '{source}' is only {width:.2g} mm wide and is left out"
            for place, width in narrow.items()
        ]
        doubled += [
            f"Face {wide[second] + 1} of panel '{panel.name}' of '{source}' lies on its face {wide[first] + 1} and is "
            "left out"
            for second, first in sorted(doubles.items())
        ]
    walked = [outline_and_gap(panel, source, tolerance) for panel in mended]
    return Mended(
        panels=tuple(mended),
        hairs=tuple(hairs),
        doubled=tuple(doubled),
        creased=tuple(creased),
        gaps=tuple(gap for _, gap in walked),
        outlines=tuple(outline for outline, _ in walked),
    )


def _creases(name: str, shape: TopoDS_Shape, source: str) -> list[str]:
    found = []
    for place, face in enumerate(faces_of(shape), start=1):
        crease = crease_of(patch_of(face)) if has_breaks(BRepAdaptor_Surface(face)) else 0.0
        if crease:
            found.append(
                f"Face {place} of panel '{name}' of '{source}' has a crease of {crease:.3g} degrees inside, which "
                "counts as a part of its bend"
            )
    return found


def gap_notes(panels: Sequence[RawPanel], source: str, tolerance: float) -> tuple[str, ...]:
    """One note on all panels between whose faces a gap is bridged.

    Args:
        panels: as sampled.
        source: the file's name.
        tolerance: up to which gaps are bridged, mm.
    """
    return _gaping(_gaps(panels, tolerance), [panel.name for panel in panels], source, tolerance)


def _gaps(panels: Sequence[RawPanel], tolerance: float) -> tuple[float, ...]:
    return tuple(bridged_gap(panel, tolerance) for panel in panels)


def _gaping(gaps: Sequence[float], names: Sequence[str], source: str, tolerance: float) -> tuple[str, ...]:
    gaping = [found for found in zip(gaps, names, strict=True) if found[0] > WORTH_A_NOTE]
    if not gaping:
        return ()
    gap, name = max(gaping, key=lambda found: found[0])
    where = f"panel '{name}'" if len(gaping) == 1 else f"{len(gaping)} panels"
    widest = f"by {gap:.2g} mm" if len(gaping) == 1 else f"the widest by {gap:.2g} mm in panel '{name}'"
    return (f"Faces of {where} of '{source}' gape, {widest}; that is within the tolerance of {tolerance:g} mm.",)


def _first_of(found: Sequence[str]) -> tuple[str, ...]:
    """One note on what may have been found in hundreds of panels."""
    if not found:
        return ()
    return (f"{found[0]} (the first of {len(found)} such faces)." if len(found) > 1 else f"{found[0]}.",)
