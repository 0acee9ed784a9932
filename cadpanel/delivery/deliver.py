"""From a fit to a delivery folder: build, write, read back, and only then put the folder in its place."""

from __future__ import annotations

import time
from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from cadpanel.brep.proof.parallel import Helper, second_interpreter
from cadpanel.delivery.built_already import built_already
from cadpanel.delivery.chosen_panels import chosen_panels
from cadpanel.delivery.folder import delivery_folder
from cadpanel.delivery.outputs.catalogue import OUTPUTS, chosen_outputs
from cadpanel.delivery.outputs.output import Delivery, Output
from cadpanel.delivery.outputs.step_files import PANELS, SKINS
from cadpanel.delivery.own_files import REPORT
from cadpanel.delivery.records.certified import CertificateModel, TimingModel
from cadpanel.delivery.records.flat_parts import flat_parts
from cadpanel.delivery.records.from_fit import (
    baselines_record,
    origin_record,
    panel_records,
    reference_record,
    rule_records,
    seam_records,
    solve_record,
    with_flat_parts,
)
from cadpanel.delivery.records.report import ReportModel, write_report
from cadpanel.delivery.records.settings import settings_record
from cadpanel.delivery.records.summary import summary
from cadpanel.delivery.records.to_shape import recorded_shape
from cadpanel.delivery.settings import SheetSettings
from cadpanel.delivery.sheets import Progress, build_panels, say_nothing
from cadpanel.delivery.shop_settings import ShopSettings
from cadpanel.delivery.verify import prove, prove_more
from cadpanel.errors import ProofError
from cadpanel.fitting.result import FitResult
from cadpanel.geometry.sheet_checks import sheet_depth


def deliver(
    result: FitResult,
    out: Path,
    sheet: SheetSettings | None = None,
    shop: ShopSettings | None = None,
    *,
    overwrite: bool = False,
    progress: Progress | None = None,
) -> ReportModel:
    """Write a delivery folder whole or not at all: panels.step, skins.step, report.json, and what else is asked for.

    Args:
        result: the fitted panels.
        out: the folder; an existing one is refused unless `overwrite` is set.
        sheet: thickness, side and schema.
        shop: outputs and panels that are asked for, and how they are made.
        overwrite: replace an existing delivery.
        progress: told of the steps "compare", "build", "write" and "verify".

    Raises:
        SettingsError: there is no output or panel of a name that is asked for.
        PanelError: a panel cannot be built.
        DeliveryError: the folder is refused or cannot be written.
        ProofError: what was written is not what was promised; nothing is left.
    """
    with delivery_folder(out, overwrite=overwrite) as folder:
        return fill_delivery(result, folder, sheet or SheetSettings(), shop or ShopSettings(), progress=progress)


def fill_delivery(
    result: FitResult,
    folder: Path,
    sheet: SheetSettings,
    shop: ShopSettings,
    *,
    seconds_to_read: float = 0.0,
    progress: Progress | None = None,
) -> ReportModel:
    """Build, write and verify into a folder that is there; see `deliver`.

    Args:
        result: the fitted panels.
        folder: as `delivery_folder` gives it.
        sheet: thickness, side and schema.
        shop: outputs and panels that are asked for, and how they are made.
        seconds_to_read: how long reading the reference took, for the report.
        progress: told of the steps.
    """
    tell = progress or say_nothing
    outputs = chosen_outputs(shop.outputs, OUTPUTS)
    chosen = set(chosen_panels([shape.name for shape in result.shapes], shop.only))
    with second_interpreter(len(chosen)) as helper:
        began = time.perf_counter()
        tell("compare", 0, 1)
        baselines = baselines_record(result)
        tell("compare", 1, 1)
        compared_at = time.perf_counter()
        built = build_panels(result.shapes, sheet, result.reference.seams, tell, result.own_joints(), shop)
        parts = flat_parts([panel.shape for panel in built.panels], sheet, shop)
        panels = with_flat_parts(panel_records(result, built), built.panels, parts, shop.density)
        seams = seam_records(result.reference, result.measures, built.joints, result.seam_prices)
        told = summary(result.measures, result.local, result.settings, result.outcomes)
        built_at = time.perf_counter()
        own = [place for place, panel in enumerate(panels) if panel.name in chosen]
        depth = sheet_depth(sheet.thickness, sheet.skin_side)
        delivery = Delivery(
            panels=tuple(built.panels[place] for place in own),
            title=Path(result.reference.source).stem,
            sheet=sheet,
            shop=shop,
            records=tuple(panels[place] for place in own),
            seams=seams,
            shapes=tuple(recorded_shape(panels[place], depth, square=sheet.ends == "square") for place in own),
            parts=tuple(parts[place] for place in own),
            joint=sheet.joint,
            origin=result.reference.origin,
            summary=told,
            result=result,
        )
        first, last = _in_turn(outputs)
        _write(folder, delivery, first, _part(tell, 0, len(outputs)), helper)
        written_at = time.perf_counter()
        tell("verify", 0, 1)
        proved = prove(folder, delivery, first, helper, built_already(delivery.panels, delivery.shapes), tell)
        if not proved.certificate.failures:
            delivery = replace(delivery, seams=proved.seams)
            _write(folder, delivery, last, _part(tell, len(first), len(outputs)), helper)
            proved = prove_more(proved, folder, delivery, last)
    verified_at = time.perf_counter()
    _demand(proved.certificate)
    report = ReportModel(
        reference=reference_record(result.reference),
        origin=origin_record(result.reference, shop.origin),
        settings=settings_record(result.reference, result.settings, sheet, shop),
        solve=solve_record(result),
        panels=panels,
        seams=proved.seams,
        features=dict(Counter(panel.feature for panel in panels)),
        rules=rule_records(result),
        summary=told,
        baselines=baselines,
        certificate=proved.certificate,
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


def _in_turn(outputs: Sequence[Output]) -> tuple[list[Output], list[Output]]:
    """Those that are written first, and those that tell of what is measured on the first ones."""
    return [one for one in outputs if not one.tells_joints], [one for one in outputs if one.tells_joints]


def _write(folder: Path, delivery: Delivery, outputs: Sequence[Output], tell: Progress, helper: Helper | None) -> None:
    """Every output that is asked for; panels and skins are read while the others are being written."""
    for place, output in enumerate(outputs):
        tell("write", place, len(outputs))
        output.write(folder, delivery)
        if helper is not None and SKINS in output.files:
            helper.begin(folder / SKINS)
        if helper is not None and PANELS in output.files:
            helper.open(folder / PANELS)
    tell("write", len(outputs), len(outputs))


def _part(tell: Progress, before: int, of: int) -> Progress:
    """Progress of a part of what is done, of which so much is done before."""
    return lambda step, done, _: tell(step, before + done, of)


def _demand(certificate: CertificateModel) -> None:
    if certificate.failures:
        raise ProofError(certificate.failures)
