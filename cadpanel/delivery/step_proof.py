"""The STEP files of a delivery, read back and held against the numbers of its report."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from cadpanel.arrays import Array
from cadpanel.brep.proof.certificate import Certificate, certify
from cadpanel.brep.proof.clearances import Clear
from cadpanel.brep.proof.expected import ExpectedPanel, ExpectedSeam, Fitted, Sheet
from cadpanel.brep.proof.flat_checks import ExpectedFlat
from cadpanel.brep.proof.parallel import Helper
from cadpanel.delivery.contents import Contents
from cadpanel.delivery.outputs.step_files import PANELS, SKINS
from cadpanel.delivery.records.patches import PlanePatchModel
from cadpanel.delivery.records.report import CertificateModel, ClearModel, PanelModel, SeamModel
from cadpanel.delivery.records.to_shape import recorded_shape
from cadpanel.geometry.sheet_checks import sheet_depth


@dataclass(frozen=True, slots=True, kw_only=True)
class Proved:
    """What the files show.

    Attributes:
        certificate: of all of them.
        seams: as they were stated, and with the clear width of their joints, as it was measured.
    """

    certificate: CertificateModel
    seams: tuple[SeamModel, ...]


def prove_steps(folder: Path, contents: Contents, helper: Helper | None = None) -> Proved:
    """What panels.step and skins.step in a folder show; seams are seen where both panels are in the files.

    Args:
        folder: that holds the files.
        contents: what they must tell of.
        helper: a second interpreter that is running already.

    Raises:
        DeliveryError: one of the files cannot be read at all.
    """
    depth = sheet_depth(contents.sheet.thickness, contents.sheet.skin_side)
    moved = {panel.name: panel.moved for panel in contents.records}
    expected = [
        ExpectedPanel(
            name=panel.name,
            volume=panel.volume,
            kinds=tuple(patch.kind for patch in panel.patches),
            corners=np.array(panel.corners),
            far_planes=_far_planes(panel, depth),
            fitted=_fitted(panel),
            flat=ExpectedFlat(area=part.size.area, share=part.share, depth=depth, skin_pieces=part.skin_pieces),
            placed=contents.placed,
            sheet=Sheet(
                shape=recorded_shape(panel, depth),
                thickness=contents.sheet.thickness,
                skin_side=contents.sheet.skin_side,
            ),
        )
        for panel, part in zip(contents.records, contents.parts, strict=True)
    ]
    there = [place for place, seam in enumerate(contents.seams) if set(seam.panels) <= set(moved)]
    wanted = [_expected_seam(contents.seams[place], moved) for place in there]
    certificate = certify(folder / PANELS, folder / SKINS, expected, wanted, helper, contents.joint)
    found = dict(zip(there, certificate.clear, strict=True)) if certificate.clear else {}
    return Proved(certificate=_record(certificate), seams=_with_joints(contents.seams, found))


def _expected_seam(seam: SeamModel, moved: dict[str, float]) -> ExpectedSeam:
    return ExpectedSeam(
        panels=seam.panels,
        edges=seam.edges,
        gap=seam.max_seam_gap + sum(moved[name] for name in seam.panels),
        across=None if seam.plane is None else np.array(seam.plane.normal),
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


def _record(certificate: Certificate) -> CertificateModel:
    # A seam whose ends cannot be found has no gap to state; that it cannot be found is among the failures.
    measured = [gap for gap in certificate.seam_gaps if np.isfinite(gap)]
    return CertificateModel(
        solids=certificate.solids,
        skins=certificate.skins,
        valid=certificate.valid,
        face_kinds=certificate.face_kinds,
        max_tangency_error=certificate.max_tangency_error,
        volume_error=certificate.volume_error,
        flat_area_error=certificate.flat_area_error,
        flat_length_error=certificate.flat_length_error,
        names_kept=certificate.names_kept,
        max_seam_gap=max(measured, default=0.0),
        clear=_clear([one for one in certificate.clear if one is not None]),
        overlap=certificate.overlap,
        failures=certificate.failures,
    )
