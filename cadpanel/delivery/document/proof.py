"""A document read back: its numbers are those of the report, and its shapes the panels of the STEP files.

The report's numbers, which are held against the STEP files by the certificate, give the text of the document again byte
for byte. Shapes are held against the same volumes, areas and corners as those in the STEP files, as closely, and the
triangles that come with solids against these (`brep.proof.shown`).
"""

from __future__ import annotations

import math
import zlib
from collections.abc import Iterator, Mapping
from pathlib import Path
from zipfile import BadZipFile, ZipFile

import numpy as np

from cadpanel.arrays import Array
from cadpanel.brep.building.drawn import rim_places
from cadpanel.brep.proof.certificate import POSITION_LIMIT, VOLUME_LIMIT
from cadpanel.brep.proof.kept_facts import KeptFacts
from cadpanel.brep.proof.parallel import inspect_archive
from cadpanel.delivery.contents import Contents, Proof
from cadpanel.delivery.document.archive import DOCUMENT_XML, GUI_XML, xml_files
from cadpanel.delivery.document.shapes import laid_out
from cadpanel.delivery.document.tree import drawn_seams, flat_file, panel_file, seam_file, skin_file
from cadpanel.delivery.records.report import PanelModel, SeamModel
from cadpanel.delivery.records.to_shape import sheet_corners, tray_of
from cadpanel.errors import DeliveryError
from cadpanel.geometry.sheet_checks import sheet_depth

# Of a flat pattern's area, where arcs in its contour come as close as the chord allows: rounding.
_AREA_SHARE = 1e-9
# How far points are apart of which there are none: numbers of a report are finite.
_NOWHERE = float(np.finfo(np.float64).max)


def prove_document(path: Path, contents: Contents) -> Proof:
    """Hold a document against what it should tell.

    Raises:
        DeliveryError: it is missing, damaged, or a shape in it cannot be read.
    """
    failures = [f"'{path.name}': {what}" for what in _text_faults(path, contents)]
    facts = inspect_archive(path)
    depth = sheet_depth(contents.sheet.thickness, contents.sheet.skin_side)
    volumes, corners = 0.0, 0.0
    for place, (panel, part) in enumerate(zip(contents.records, contents.parts, strict=True)):
        files = (panel_file(place), skin_file(place), flat_file(place))
        if not set(files) <= facts.keys():
            failures.append(f"'{path.name}': panel '{panel.name}' has lost its solid, its skin or its flat pattern.")
            continue
        solid, skin, flat = (facts[file] for file in files)
        volumes = max(volumes, abs(solid.volume / panel.volume - 1.0), abs(skin.area / panel.area - 1.0))
        near, far = sheet_corners(panel, depth)
        # A solid may have vertices elsewhere, too, round whatever is drilled into it; its volume tells of that.
        off = _off(np.concatenate([near, far]), solid.vertices), _apart(skin.vertices, near)
        corners = max(corners, *off)
        failures += [f"'{path.name}': panel '{panel.name}': {what}" for what in _panel_faults(panel, solid, skin, off)]
        reach = contents.shop.chord * sum(part.size.edges.values()) + _AREA_SHARE * part.size.area
        area = part.size.area - 0.25 * math.pi * float(np.sum(part.circles[:, 2] ** 2))
        if flat.faces != 1 or flat.triangles or abs(flat.area - area) > reach:
            failures.append(f"'{path.name}': panel '{panel.name}': its flat pattern is not that of the report.")
    failures += [f"'{path.name}': {what}" for what in _hole_faults(contents, facts)]
    failures += [f"'{path.name}': {what}" for what in _seam_faults(contents, facts)]
    numbers = {
        "panels": len(contents.records),
        "volume_error": volumes,
        "corner_error": min(corners, np.finfo(float).max),
    }
    return Proof(numbers=numbers, failures=tuple(failures))


def _text_faults(path: Path, contents: Contents) -> Iterator[str]:
    try:
        with ZipFile(path) as archive:
            names = archive.namelist()
            texts = [archive.read(name) if name in names else b"" for name in (DOCUMENT_XML, GUI_XML)]
    except OSError as error:
        raise DeliveryError(f"'{path}' cannot be read: {error.strerror or error}.") from error
    except (BadZipFile, zlib.error) as error:
        raise DeliveryError(f"'{path}' cannot be read: it is damaged ({error}); write the delivery again.") from error
    document, looks = xml_files(contents)
    if texts[0] != document:
        yield "its numbers are not those of the report."
    if texts[1] != looks:
        yield "its colours are not those that the report's numbers make."
    if names[:1] != [DOCUMENT_XML] or names[-1:] != [GUI_XML]:
        yield "its shapes do not stand between numbers and looks, where FreeCAD finds them."


def _panel_faults(panel: PanelModel, solid: KeptFacts, skin: KeptFacts, off: tuple[float, float]) -> Iterator[str]:
    if solid.solids != 1:
        yield f"it is {solid.solids} solids instead of one."
    volume = abs(solid.volume / panel.volume - 1.0)
    if volume > VOLUME_LIMIT:
        yield f"the volume of its solid is off by {volume:.2g} of itself."
    area = abs(skin.area / panel.area - 1.0)
    if area > VOLUME_LIMIT:
        yield f"the area of its skin is off by {area:.2g} of itself."
    if not solid.triangles:
        yield "its solid has no triangles, by which FreeCAD shows it."
    if solid.triangles_fault:
        yield f"triangles of its solid {solid.triangles_fault}."
    if skin.triangles:
        yield "its skin has triangles, which belong to solids."
    for what, apart in zip(("solid", "skin"), off, strict=True):
        if apart > POSITION_LIMIT:
            yield f"a corner of its {what} is {apart:.3g} mm away from where it is expected."


def _hole_faults(contents: Contents, facts: Mapping[str, KeptFacts]) -> Iterator[str]:
    """The holes are less of a flat pattern than its arcs may miss of its area, so that each must be found."""
    if not any(len(part.circles) for part in contents.parts):
        return
    for place, (panel, (contour, lines, holes)) in enumerate(zip(contents.records, laid_out(contents), strict=True)):
        flat = facts.get(flat_file(place))
        plane = np.concatenate([contour[:, :2], lines.reshape(-1, 2)])
        wanted = np.concatenate([np.pad(plane, ((0, 0), (0, 1))), rim_places(holes)])
        if flat is not None and _apart(flat.vertices, wanted) > POSITION_LIMIT:
            yield f"panel '{panel.name}': the holes in its flat pattern are not those of the report."


def _seam_faults(contents: Contents, facts: Mapping[str, KeptFacts]) -> Iterator[str]:
    panels = {panel.name: panel for panel in contents.records}
    depth = sheet_depth(contents.sheet.thickness, contents.sheet.skin_side)
    for place, seam in enumerate(drawn_seams(contents)):
        of = f"the seam of '{seam.panels[0]}' and '{seam.panels[1]}'"
        kept = facts.get(seam_file(place))
        try:
            rows = list(_rows(seam, panels, depth))
        except ValueError as error:
            yield f"{of} is not where the report says it: {error}."
            continue
        if kept is None or kept.edges != sum(len(row) - 1 for row in rows):
            yield f"{of} is not drawn from corner to corner."
        elif kept.triangles or _apart(kept.vertices, np.concatenate(rows)) > POSITION_LIMIT:
            yield f"{of} is not drawn where the two panels end."


def _rows(seam: SeamModel, panels: Mapping[str, PanelModel], depth: float) -> Iterator[Array]:
    for name, edge in zip(seam.panels, seam.edges, strict=True):
        if name in panels:
            tray = tray_of(panels[name], depth)
            yield edge_row(panels[name], edge) if tray is None else tray.edge(edge).corners


def edge_row(panel: PanelModel, edge: str) -> Array:
    """(m, 3) the corners of a panel's record along one of its edges, mm.

    Raises:
        ValueError: the panel has no such edge.
    """
    word, number = edge.split()
    corners, place = np.array(panel.corners), int(number)
    four_sided = len(corners) == 2
    if (word == "edge") == four_sided or place >= (2 if four_sided else corners.shape[1]):
        raise ValueError(f"panel '{panel.name}' has no {edge}")
    if word == "end":
        return np.asarray(corners[place])
    if word == "side":
        return np.asarray(corners[:, -place])
    return np.asarray(corners[0, [place, (place + 1) % corners.shape[1]]])


def _apart(found: Array, wanted: Array) -> float:
    """How far two sets of points (n, 3) and (m, 3) are apart at most, mm: each point from the other set's nearest."""
    return max(_off(found, wanted), _off(wanted, found))


def _off(points: Array, others: Array) -> float:
    """How far a point of some (n, 3) is from the nearest of others (m, 3), at most, mm."""
    if not len(points) or not len(others):
        return _NOWHERE
    return float(np.linalg.norm(points[:, None] - others, axis=-1).min(axis=1).max())
