"""From a fit to a delivery folder: build, write, read back, and only then put the folder in its place."""

from __future__ import annotations

import time
from collections import Counter
from pathlib import Path

from cadpanel.brep.proof.parallel import Helper, second_interpreter
from cadpanel.delivery.folder import REPORT, delivery_folder
from cadpanel.delivery.outputs.catalogue import OUTPUTS
from cadpanel.delivery.outputs.output import Delivery
from cadpanel.delivery.outputs.step_files import SKINS
from cadpanel.delivery.records.from_fit import (
    baselines_record,
    panel_records,
    reference_record,
    seam_records,
    solve_record,
)
from cadpanel.delivery.records.report import CertificateModel, ReportModel, TimingModel, write_report
from cadpanel.delivery.records.settings import settings_record
from cadpanel.delivery.records.summary import summary
from cadpanel.delivery.settings import SheetSettings
from cadpanel.delivery.sheets import Progress, build_panels, say_nothing
from cadpanel.delivery.verify import prove
from cadpanel.errors import ProofError
from cadpanel.fitting.result import FitResult


def deliver(
    result: FitResult,
    out: Path,
    sheet: SheetSettings | None = None,
    *,
    overwrite: bool = False,
    progress: Progress | None = None,
) -> ReportModel:
    """Write a delivery folder whole or not at all: panels.step, skins.step and report.json.

    Args:
        result: the fitted panels.
        out: the folder; an existing one is refused unless `overwrite` is set.
        sheet: thickness, side and schema.
        overwrite: replace an existing delivery.
        progress: told of the steps "compare", "build", "write" and "verify".

    Raises:
        PanelError: a panel cannot be built.
        DeliveryError: the folder is refused or cannot be written.
        ProofError: what was written is not what was promised; nothing is left.
    """
    with delivery_folder(out, overwrite=overwrite) as folder:
        return fill_delivery(result, folder, sheet or SheetSettings(), progress=progress)


def fill_delivery(
    result: FitResult,
    folder: Path,
    sheet: SheetSettings,
    *,
    seconds_to_read: float = 0.0,
    progress: Progress | None = None,
) -> ReportModel:
    """Build, write and verify into a folder that is there; see `deliver`.

    Args:
        result: the fitted panels.
        folder: as `delivery_folder` gives it.
        sheet: thickness, side and schema.
        seconds_to_read: how long reading the reference took, for the report.
        progress: told of the steps.
    """
    tell = progress or say_nothing
    with second_interpreter(len(result.shapes)) as helper:
        began = time.perf_counter()
        tell("compare", 0, 1)
        baselines = baselines_record(result)
        tell("compare", 1, 1)
        compared_at = time.perf_counter()
        built = build_panels(result.shapes, sheet, result.reference.seams, tell)
        panels = panel_records(result, built)
        seams = seam_records(result.reference, result.measures, built.joints)
        built_at = time.perf_counter()
        delivery = Delivery(panels=built.panels, title=Path(result.reference.source).stem, sheet=sheet)
        _write(folder, delivery, tell, helper)
        written_at = time.perf_counter()
        tell("verify", 0, 1)
        settings = settings_record(result.reference, result.settings, sheet)
        proof = prove(folder, panels, seams, settings, helper)
    verified_at = time.perf_counter()
    _demand(proof.certificate)
    report = ReportModel(
        reference=reference_record(result.reference),
        settings=settings,
        solve=solve_record(result),
        panels=panels,
        seams=proof.seams,
        features=dict(Counter(panel.feature for panel in panels)),
        summary=summary(result.measures, result.local, result.settings),
        baselines=baselines,
        certificate=proof.certificate,
        timing=TimingModel(
            read=seconds_to_read,
            fit=result.seconds + compared_at - began,
            build=built_at - compared_at,
            write=written_at - built_at,
            verify=verified_at - written_at,
        ),
    )
    write_report(report, folder / REPORT)
    tell("verify", 1, 1)
    return report


def _write(folder: Path, delivery: Delivery, tell: Progress, helper: Helper | None) -> None:
    """Every output that is always there; a helper reads the skins while the others are being written."""
    wanted = [output for output in OUTPUTS if output.always]
    for place, output in enumerate(wanted):
        tell("write", place, len(wanted))
        output.write(folder, delivery)
        if helper is not None and SKINS in output.files:
            helper.begin(folder / SKINS)
    tell("write", len(wanted), len(wanted))


def _demand(certificate: CertificateModel) -> None:
    if certificate.failures:
        raise ProofError(certificate.failures)
