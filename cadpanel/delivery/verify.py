"""The proof of a delivery: its STEP files are read back and held against its report, now or at any later time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from cadpanel.arrays import Array
from cadpanel.brep.proof.certificate import Certificate, certify
from cadpanel.brep.proof.clearances import Clear
from cadpanel.brep.proof.expected import ExpectedPanel, ExpectedSeam, Fitted
from cadpanel.brep.proof.parallel import Helper
from cadpanel.delivery.folder import REPORT
from cadpanel.delivery.outputs.catalogue import OUTPUTS
from cadpanel.delivery.outputs.step_files import PANELS, SKINS
from cadpanel.delivery.records.consistency import check_report
from cadpanel.delivery.records.patches import PlanePatchModel
from cadpanel.delivery.records.report import (
    CertificateModel,
    ClearModel,
    PanelModel,
    ReportModel,
    SeamModel,
    read_report,
)
from cadpanel.delivery.records.settings import SettingsModel
from cadpanel.errors import DeliveryError
from cadpanel.geometry.sheet_checks import sheet_depth


@dataclass(frozen=True, slots=True, kw_only=True)
class Verification:
    """What a delivery folder shows.

    Attributes:
        report: its report, as it was read.
        certificate: what its STEP files show now.
        failures: one sentence for everything that does not hold, naming the panel or the seam.
    """

    report: ReportModel
    certificate: CertificateModel
    failures: tuple[str, ...]

    @property
    def holds(self) -> bool:
        """Whether the files are what the report promises."""
        return not self.failures


def verify(folder: str | Path) -> Verification:
    """Read a delivery's files and hold them against its report, and the report against itself.

    Raises:
        DeliveryError: the folder or one of its files is missing or cannot be read; one sentence says which.
    """
    place = Path(folder)
    if not place.is_dir():
        raise DeliveryError(f"'{folder}' is not a folder: name one that 'cadpanel fit' wrote.")
    for name in (REPORT, *(file for output in OUTPUTS if output.always for file in output.files)):
        if not (place / name).is_file():
            raise DeliveryError(f"'{folder}' holds no {name}, so it is no whole delivery: write it again.")
    report = read_report(place / REPORT)
    certificate = prove(place, report.panels, report.seams, report.settings).certificate
    failures = (*certificate.failures, *check_report(report, certificate))
    return Verification(report=report, certificate=certificate, failures=failures)


@dataclass(frozen=True, slots=True, kw_only=True)
class Proof:
    """What the files show.

    Attributes:
        certificate: of all of them.
        seams: as they were stated, and with the clear width of their joints, as it was measured.
    """

    certificate: CertificateModel
    seams: tuple[SeamModel, ...]


def prove(
    folder: Path,
    panels: Sequence[PanelModel],
    seams: Sequence[SeamModel],
    settings: SettingsModel,
    helper: Helper | None = None,
) -> Proof:
    """What reading panels.step and skins.step in a folder back shows.

    Args:
        folder: that holds the files.
        panels: as the report states them.
        seams: as the report states them.
        settings: with the sheet's thickness and side, and the joint.
        helper: a second interpreter that is running already.

    Raises:
        DeliveryError: one of the files cannot be read at all.
    """
    depth = sheet_depth(settings.thickness, settings.skin_side)
    moved = {panel.name: panel.moved for panel in panels}
    expected = [
        ExpectedPanel(
            name=panel.name,
            volume=panel.volume,
            kinds=tuple(patch.kind for patch in panel.patches),
            corners=np.array(panel.corners),
            far_planes=_far_planes(panel, depth),
            fitted=_fitted(panel),
        )
        for panel in panels
    ]
    wanted = [
        ExpectedSeam(
            panels=seam.panels,
            edges=seam.edges,
            gap=seam.max_seam_gap + sum(moved[name] for name in seam.panels),
            across=None if seam.plane is None else np.array(seam.plane.normal),
            clear=None if seam.clear is None else (seam.clear.least, seam.clear.largest),
        )
        for seam in seams
    ]
    certificate = certify(folder / PANELS, folder / SKINS, expected, wanted, helper, settings.joint)
    return Proof(certificate=_record(certificate), seams=_with_joints(seams, certificate))


def _with_joints(seams: Sequence[SeamModel], certificate: Certificate) -> tuple[SeamModel, ...]:
    if not certificate.clear:
        return tuple(seams)
    return tuple(
        seam if clear is None else seam.model_copy(update={"clear": _clear([clear])})
        for seam, clear in zip(seams, certificate.clear, strict=True)
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
        names_kept=certificate.names_kept,
        max_seam_gap=max(measured, default=0.0),
        clear=_clear([one for one in certificate.clear if one is not None]),
        overlap=certificate.overlap,
        failures=certificate.failures,
    )
