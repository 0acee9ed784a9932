"""The STEP files of a delivery, read back and held against the numbers of its report."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from cadpanel.arrays import Array
from cadpanel.brep.building.wanted import Sheet
from cadpanel.brep.proof.certificate import Certificate, certify
from cadpanel.brep.proof.clearances import Clear
from cadpanel.brep.proof.expected import ExpectedPanel, ExpectedSeam, Fitted
from cadpanel.brep.proof.flat_checks import ExpectedFlat
from cadpanel.brep.proof.hole_checks import ExpectedHoles
from cadpanel.brep.proof.parallel import Helper, Told, unheard
from cadpanel.brep.proof.rebuilt import Rebuilt
from cadpanel.brep.step.frame_checks import Part, frame_faults
from cadpanel.delivery.contents import Contents
from cadpanel.delivery.outputs.step_files import PANELS, SKINS
from cadpanel.delivery.part_data import skin_data, solid_data
from cadpanel.delivery.records.certified import CertificateModel, ClearModel
from cadpanel.delivery.records.flat_parts import FlatPart
from cadpanel.delivery.records.patches import PlanePatchModel
from cadpanel.delivery.records.report import PanelModel, SeamModel
from cadpanel.delivery.records.to_shape import unfolded_rulings
from cadpanel.geometry.panel import Panel
from cadpanel.geometry.sheet_checks import sheet_depth
from cadpanel.geometry.trays import TrayShape
from cadpanel.geometry.volume import beyond_quadratic


@dataclass(frozen=True, slots=True, kw_only=True)
class Proved:
    """What the files show.

    Attributes:
        certificate: of all of them.
        seams: as they were stated, and with the clear width of their joints, as it was measured.
    """

    certificate: CertificateModel
    seams: tuple[SeamModel, ...]


def prove_steps(
    folder: Path,
    contents: Contents,
    helper: Helper | None = None,
    built: Mapping[str, Rebuilt] | None = None,
    told: Told = unheard,
) -> Proved:
    """What panels.step and skins.step in a folder show; seams are seen where both panels are in the files.

    Args:
        folder: that holds the files.
        contents: what they must tell of.
        helper: a second interpreter that is running already.
        built: by name, what bounds panels that were built from the same numbers already; others are built anew.
        told: how many solids, skins and sheets more were inspected or built.

    Raises:
        DeliveryError: one of the files cannot be read at all.
    """
    depth = sheet_depth(contents.sheet.thickness, contents.sheet.skin_side)
    moved = {panel.name: panel.moved for panel in contents.records}
    trays = [shape if isinstance(shape, TrayShape) else None for shape in contents.shapes]
    expected = [
        ExpectedPanel(
            name=panel.name,
            volume=panel.volume,
            kinds=tuple(patch.kind for patch in (panel.patches if tray is None else tray.patches)),
            corners=np.array(panel.corners),
            far_planes=_far_planes(panel, depth),
            fitted=_fitted(panel),
            flat=_expected_flat(shape, part, depth, tray),
            said=said,
            said_of_skin=said_of_skin,
            placed=contents.placed,
            square=contents.sheet.ends == "square",
            holes=_expected_holes(part, depth),
            folded=_folded(panel),
            tray=tray,
            sheet=_sheet(shape, part, contents),
        )
        for panel, shape, part, said, said_of_skin, tray in zip(
            contents.records,
            contents.shapes,
            contents.parts,
            solid_data(contents),
            skin_data(contents),
            trays,
            strict=True,
        )
    ]
    there = [place for place, seam in enumerate(contents.seams) if set(seam.panels) <= set(moved)]
    wanted = [_expected_seam(contents.seams[place], moved) for place in there]
    files = folder / PANELS, folder / SKINS
    certificate = certify(*files, expected, wanted, helper, contents.joint, built or {}, told)
    found = dict(zip(there, certificate.clear, strict=True)) if certificate.clear else {}
    record = _record(certificate)
    record = record.model_copy(update={"failures": (*record.failures, *_frame_faults(folder, contents))})
    return Proved(certificate=record, seams=_with_joints(contents.seams, found))


def _sheet(shape: Panel, part: FlatPart, contents: Contents) -> Sheet:
    return Sheet(
        shape=shape,
        thickness=contents.sheet.thickness,
        skin_side=contents.sheet.skin_side,
        holes=() if part.fixings is None else part.fixings.holes,
    )


def _frame_faults(folder: Path, contents: Contents) -> Iterator[str]:
    """What both files say around their geometry, and are not to say."""
    for file, what, data in ((PANELS, "panels", solid_data(contents)), (SKINS, "skins", skin_data(contents))):
        parts = [
            Part(panel.name, panel.name) if said is None else Part(said.number, panel.name, said.description)
            for panel, said in zip(contents.records, data, strict=True)
        ]
        title, who = f"{contents.title} {what}", (contents.shop.author, contents.shop.organization)
        materials = [said.material for said in data if said is not None and said.material is not None]
        yield from frame_faults(folder / file, title, parts, contents.sheet.schema, who, materials)


def _expected_flat(shape: Panel, part: FlatPart, depth: float, tray: TrayShape | None) -> ExpectedFlat:
    holes = 0.0 if part.fixings is None else part.fixings.area
    area, pieces = part.size.area - holes, part.skin_pieces
    beyond = beyond_quadratic(shape, depth, part.share)
    return ExpectedFlat(area=area, share=part.share, depth=depth, skin_pieces=pieces, tray=tray, beyond=beyond)


def _expected_holes(part: FlatPart, depth: float) -> ExpectedHoles | None:
    if part.fixings is None:
        return None
    fixings = part.fixings
    return ExpectedHoles(
        pattern=fixings.pattern,
        places=fixings.places,
        patches=tuple(hole.patch for hole in fixings.found.holes),
        middles=fixings.middles,
        diameter=fixings.rule.diameter,
        distance=fixings.rule.distance,
        depth=depth,
        skin_area=fixings.skin_area,
    )


def _folded(panel: PanelModel) -> tuple[int, int]:
    """How many patches lie beyond the fit's at side 0 and at side 1."""
    first, last = unfolded_rulings(panel)
    return first, len(panel.corners[0]) - last


def _expected_seam(seam: SeamModel, moved: dict[str, float]) -> ExpectedSeam:
    return ExpectedSeam(
        panels=seam.panels,
        edges=seam.edges,
        gap=seam.max_seam_gap + sum(moved[name] for name in seam.panels),
        across=None if seam.plane is None else np.array(seam.plane.normal),
        joint=seam.joint,
        clear=None if seam.clear is None else (seam.clear.least, seam.clear.largest),
    )


def _with_joints(seams: Sequence[SeamModel], found: dict[int, Clear | None]) -> tuple[SeamModel, ...]:
    """The seams with the width that was measured, at the places where there is one."""
    return tuple(
        seam if (clear := found.get(place)) is None else seam.model_copy(update={"clear": _clear([clear])})
        for place, seam in enumerate(seams)
    )


def _clear(found: Sequence[Clear]) -> ClearModel | None:
    if not found:
        return None
    return ClearModel(least=min(one.least for one in found), largest=max(one.largest for one in found))


def _fitted(panel: PanelModel) -> Fitted | None:
    if panel.fitted is None:
        return None
    cuts = [(np.array(cut.normal) * cut.offset, cut.normal) for cut in panel.fitted.cuts]
    return Fitted(corners=np.array(panel.fitted.corners), cuts=np.array(cuts).reshape(-1, 2, 3))


def _far_planes(panel: PanelModel, depth: float) -> Array:
    planes = [(patch.point, patch.normal) for patch in panel.patches if isinstance(patch, PlanePatchModel)]
    found = np.array(planes).reshape(-1, 2, 3)
    found[:, 0] += depth * found[:, 1]
    return found


def _measured(error: float) -> float:
    """What was measured; 0 where nothing could be, and that is among the failures."""
    return error if np.isfinite(error) else 0.0


def _record(certificate: Certificate) -> CertificateModel:
    # A seam whose ends cannot be found has no gap to state; that it cannot be found is among the failures.
    measured = [gap for gap in certificate.seam_gaps if np.isfinite(gap)]
    return CertificateModel(
        solids=certificate.solids,
        skins=certificate.skins,
        valid=certificate.valid,
        face_kinds=certificate.face_kinds,
        max_tangency_error=_measured(certificate.max_tangency_error),
        volume_error=_measured(certificate.volume_error),
        flat_area_error=_measured(certificate.flat_area_error),
        flat_length_error=_measured(certificate.flat_length_error),
        stated_error=_measured(certificate.stated_error),
        holes=certificate.holes,
        hole_error=_measured(certificate.hole_error),
        names_kept=certificate.names_kept,
        max_seam_gap=max(measured, default=0.0),
        clear=_clear([one for one in certificate.clear if one is not None]),
        overlap=certificate.overlap,
        failures=certificate.failures,
    )
