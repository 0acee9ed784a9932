"""The proof of a delivery: its STEP files are read back and held against its report, now or at any later time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from cadpanel.arrays import Array
from cadpanel.brep.proof.certificate import Certificate, ExpectedPanel, ExpectedSeam, certify
from cadpanel.brep.proof.flat_checks import ExpectedFlat
from cadpanel.brep.proof.parallel import Helper
from cadpanel.delivery.chosen_panels import chosen_panels
from cadpanel.delivery.contents import Contents
from cadpanel.delivery.folder import REPORT
from cadpanel.delivery.outputs.catalogue import OUTPUTS, chosen_outputs
from cadpanel.delivery.outputs.output import Output
from cadpanel.delivery.outputs.step_files import PANELS, SKINS
from cadpanel.delivery.records.consistency import check_report
from cadpanel.delivery.records.flat_parts import flat_parts
from cadpanel.delivery.records.part_checks import part_faults
from cadpanel.delivery.records.patches import PlanePatchModel
from cadpanel.delivery.records.report import CertificateModel, PanelModel, ReportModel, read_report
from cadpanel.delivery.records.to_shape import recorded_shape
from cadpanel.delivery.settings import SheetSettings
from cadpanel.delivery.shop_settings import ShopSettings
from cadpanel.errors import DeliveryError


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
    _demand_files(place, (REPORT,))
    report = read_report(place / REPORT)
    sheet, shop = report.settings.sheet(), report.settings.shop()
    outputs = chosen_outputs(shop.outputs, OUTPUTS)
    _demand_files(place, [file for output in outputs for file in (*output.files, *output.folders)])
    certificate = prove(place, _contents(report, sheet, shop), outputs)
    failures = (*certificate.failures, *check_report(report, certificate))
    return Verification(report=report, certificate=certificate, failures=failures)


def _demand_files(place: Path, names: Sequence[str]) -> None:
    for name in names:
        if not (place / name).exists():
            raise DeliveryError(f"'{place}' holds no {name}, so it is no whole delivery: write it again.")


def _contents(report: ReportModel, sheet: SheetSettings, shop: ShopSettings) -> Contents:
    """What the files must tell of, from the report's own numbers."""
    chosen = set(chosen_panels([panel.name for panel in report.panels], shop.only))
    parts = flat_parts([recorded_shape(panel) for panel in report.panels], sheet, shop)
    own = [place for place, panel in enumerate(report.panels) if panel.name in chosen]
    return Contents(
        title=Path(report.reference.file).stem,
        sheet=sheet,
        shop=shop,
        records=tuple(report.panels[place] for place in own),
        seams=report.seams,
        parts=tuple(parts[place] for place in own),
        origin=report.origin.offset,
    )


def prove(
    folder: Path, contents: Contents, outputs: Sequence[Output], helper: Helper | None = None
) -> CertificateModel:
    """What reading the files in a folder back shows.

    Args:
        folder: that holds the files.
        contents: what they must tell of.
        outputs: those that were written.
        helper: a second interpreter that is running already.

    Raises:
        DeliveryError: one of the files cannot be read at all.
    """
    found = {output.name: output.prove(folder, contents) for output in outputs if not output.always}
    certificate = _prove_steps(folder, contents, helper)
    return certificate.model_copy(
        update={
            "outputs": {name: proof.numbers for name, proof in found.items()},
            "failures": (
                *certificate.failures,
                *part_faults(contents.records, contents.parts, contents.shop.density),
                *(fault for proof in found.values() for fault in proof.failures),
            ),
        }
    )


def _prove_steps(folder: Path, contents: Contents, helper: Helper | None) -> CertificateModel:
    """What panels.step and skins.step show."""
    panels, sheet = contents.records, contents.sheet
    depth = -sheet.thickness if sheet.skin_side == "outer" else sheet.thickness
    moved = {panel.name: panel.moved for panel in panels}
    expected = [
        ExpectedPanel(
            name=panel.name,
            volume=panel.volume,
            kinds=tuple(patch.kind for patch in panel.patches),
            corners=np.array(panel.corners),
            far_planes=_far_planes(panel, depth),
            flat=ExpectedFlat(area=part.size.area, share=part.share, depth=depth, skin_pieces=part.skin_pieces),
            placed=contents.placed,
        )
        for panel, part in zip(panels, contents.parts, strict=True)
    ]
    gaps = [
        ExpectedSeam(panels=seam.panels, edges=seam.edges, gap=seam.max_seam_gap + sum(moved[n] for n in seam.panels))
        for seam in contents.seams
        if set(seam.panels) <= set(moved)
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
        flat_area_error=certificate.flat_area_error,
        flat_length_error=certificate.flat_length_error,
        names_kept=certificate.names_kept,
        max_seam_gap=max(measured, default=0.0),
        failures=certificate.failures,
    )
