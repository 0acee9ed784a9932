"""Repeat the certificate of a delivery from its files alone."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from cadpanel.delivery.names import PANELS, REPORT, SKINS
from cadpanel.delivery.proof import prove
from cadpanel.delivery.records.consistency import check_report
from cadpanel.delivery.records.report import CertificateModel, ReportModel, read_report
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
    for name in (REPORT, PANELS, SKINS):
        if not (place / name).is_file():
            raise DeliveryError(f"'{folder}' holds no {name}, so it is no whole delivery: write it again.")
    report = read_report(place / REPORT)
    certificate = prove(place, report.panels, report.seams, report.settings.thickness, report.settings.skin_side)
    failures = (*certificate.failures, *check_report(report, certificate))
    return Verification(report=report, certificate=certificate, failures=failures)
