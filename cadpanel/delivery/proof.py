"""The proof: both STEP files are read back and held against the records of the report."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import numpy as np

from cadpanel.brep.proof.certificate import Certificate, ExpectedPanel, ExpectedSeam, certify
from cadpanel.brep.proof.parallel import Helper
from cadpanel.delivery.names import PANELS, SKINS
from cadpanel.delivery.records.patches import PlanePatchModel
from cadpanel.delivery.records.report import CertificateModel, PanelModel, SeamModel
from cadpanel.geometry.chain_checks import SkinSide
from cadpanel.geometry.shape import Array


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
