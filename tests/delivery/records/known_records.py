"""A small but complete report and comparison, for the tests of the files that leave the house."""

from __future__ import annotations

from cadpanel.delivery.records.certified import CertificateModel, TimingModel
from cadpanel.delivery.records.comparison import ColumnModel, ComparisonModel
from cadpanel.delivery.records.patches import ConePatchModel, CylinderPatchModel, PlanePatchModel
from cadpanel.delivery.records.report import (
    BaselinesModel,
    PanelModel,
    ReferenceModel,
    ReportModel,
    SeamModel,
    SolveModel,
    SummaryModel,
)
from cadpanel.delivery.records.settings import ComparisonSettingsModel, SettingsModel

SUMMARY = SummaryModel(
    max_corner_gap=0.1,
    max_seam_gap=0.2,
    max_kink=1.5,
    rms_deviation=9.0,
    max_deviation=30.0,
    hausdorff=31.0,
    max_corner_drift=100.0,
    max_drift_along=95.0,
    max_free_edge_drift=30.0,
    drift_along_percent=4.75,
    drift_across_percent=1.5,
    local_rms_multiple=1.6,
    tolerance_met=True,
)

REFERENCE = ReferenceModel(file="lip.step", panels=2, seams=1)


def a_panel(name: str) -> PanelModel:
    return PanelModel(
        name=name,
        feature="plane-cone-plane",
        rms_deviation=9.0,
        max_deviation=30.0,
        hausdorff=31.0,
        max_corner_drift=100.0,
        max_drift_along=95.0,
        max_free_edge_drift=30.0,
        area=2.5e6,
        volume=7.5e6,
        corners=(tuple((100.0 * i, 0.0, 0.0) for i in range(4)), tuple((100.0 * i, 2000.0, 0.0) for i in range(4))),
        patches=(
            PlanePatchModel(normal=(0.0, 0.0, 1.0), point=(0.0, 0.0, 0.0)),
            ConePatchModel(
                apex=(0.0, 0.0, -9.0e3),
                axis=(0.0, 0.0, 1.0),
                half_angle=3.0,
                radius_min=400.0,
                radius_max=500.0,
                sweep=85.0,
            ),
            CylinderPatchModel(
                axis=(0.0, 1.0, 0.0), axis_point=(0.0, 0.0, 0.0), radius_min=400.0, radius_max=400.0, sweep=-5.0
            ),
        ),
        notes=("The cone is so slender that it is built as a cylinder.",),
    )


def a_report() -> ReportModel:
    return ReportModel(
        reference=REFERENCE,
        settings=SettingsModel(
            cadpanel_version="0.1.0",
            feature="plane-cone-plane",
            tilt="free",
            method="concurrent",
            gap_tolerance=1.0,
            drift_along=0.05,
            drift_across=0.02,
            weights=None,
            restarts=0,
            seed=0,
            seam_tolerance=1.0,
            thickness=3.0,
            skin_side="outer",
            step_schema="AP242",
        ),
        solve=SolveModel(iterations=100, starts=1, agreed=1),
        panels=(a_panel("Süd 1"), a_panel("Süd 2")),
        seams=(
            SeamModel(
                panels=("Süd 1", "Süd 2"),
                edges=("end 1", "end 0"),
                reversed=False,
                corner_gaps=(0.1, 0.05, 0.05, 0.1),
                max_corner_gap=0.1,
                max_seam_gap=0.2,
                max_kink=1.5,
            ),
        ),
        summary=SUMMARY,
        baselines=BaselinesModel(local=SUMMARY, two_stage=SUMMARY),
        certificate=CertificateModel(
            solids=2,
            skins=2,
            valid=True,
            face_kinds={"plane": 4, "cone": 2},
            max_tangency_error=5e-13,
            volume_error=1e-13,
            names_kept=True,
            max_seam_gap=0.2,
        ),
        timing=TimingModel(read=0.1, fit=0.2, build=0.1, write=0.1, verify=0.1),
    )


def a_comparison() -> ComparisonModel:
    return ComparisonModel(
        reference=REFERENCE,
        settings=ComparisonSettingsModel(
            cadpanel_version="0.1.0",
            tilt="free",
            gap_tolerance=1.0,
            drift_along=0.05,
            drift_across=0.02,
            weights=None,
            restarts=0,
            seed=0,
            seam_tolerance=1.0,
        ),
        seams=(("Süd 1", "Süd 2"),),
        columns=tuple(
            ColumnModel(
                feature=feature,
                method=method,
                max_corner_gap=(0.1,),
                summary=SUMMARY,
                local_rms_deviation=5.6,
                seconds=0.2,
            )
            for method in ("two_stage", "concurrent")
            for feature in ("plane-cylinder-plane", "plane-cone-plane")
        ),
    )
