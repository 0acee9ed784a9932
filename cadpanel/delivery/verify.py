"""The proof of a delivery: its STEP files are read back and held against its report, now or at any later time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from cadpanel.arrays import Array
from cadpanel.brep.proof.certificate import Certificate, ExpectedPanel, ExpectedSeam, certify
from cadpanel.brep.proof.parallel import Helper
from cadpanel.delivery.folder import REPORT
from cadpanel.delivery.outputs.catalogue import OUTPUTS
from cadpanel.delivery.outputs.step_files import PANELS, SKINS
from cadpanel.delivery.records.consistency import check_report
from cadpanel.delivery.records.patches import PlanePatchModel
from cadpanel.delivery.records.report import CertificateModel, PanelModel, ReportModel, SeamModel, read_report
from cadpanel.errors import DeliveryError
from cadpanel.geometry.sheet_checks import SkinSide


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
    certificate = prove(place, report.panels, report.seams, report.settings.thickness, report.settings.skin_side)
    failures = (*certificate.failures, *check_report(report, certificate))
    return Verification(report=report, certificate=certificate, failures=failures)


def prove(
    folder: Path,
    panels: Sequence[PanelModel],
    seams: Sequence[SeamModel],
    thickness: float,
    skin_side: SkinSide,
    helper: Helper | None = None,
) -> CertificateModel:
    """What reading panels.step and skins.step in a folder back shows.

    Args:
        folder: that holds the files.
        panels: as the report states them.
        seams: as the report states them.
        thickness: of the sheet, mm.
        skin_side: "outer" where the sheet lies behind the skin's normals.
        helper: a second interpreter that is running already.

    Raises:
        DeliveryError: one of the files cannot be read at all.
    """
    depth = -thickness if skin_side == "outer" else thickness
    moved = {panel.name: panel.moved for panel in panels}
    expected = [
        ExpectedPanel(
            name=panel.name,
            volume=panel.volume,
            kinds=tuple(patch.kind for patch in panel.patches),
            corners=np.array(panel.corners),
            far_planes=_far_planes(panel, depth),
        )
        for panel in panels
    ]
    gaps = [
        ExpectedSeam(panels=seam.panels, edges=seam.edges, gap=seam.max_seam_gap + sum(moved[n] for n in seam.panels))
        for seam in seams
    ]
    return _record(certify(folder / PANELS, folder / SKINS, expected, gaps, helper))


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
        failures=certificate.failures,
    )
