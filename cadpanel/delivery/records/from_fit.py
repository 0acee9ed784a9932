"""From a fit and its built panels to the report's records: millimetres stay, radians become degrees."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, fields
from pathlib import Path

import numpy as np

from cadpanel.delivery.records.flat_parts import FlatPart
from cadpanel.delivery.records.from_shape import (
    cut_model,
    cut_models,
    fitted_model,
    patch_models,
    rows,
    ruling_models,
    side_cut_models,
)
from cadpanel.delivery.records.report import (
    BaselinesModel,
    OriginModel,
    PanelModel,
    ReferenceModel,
    RuleModel,
    SeamModel,
    Setting,
    SolveModel,
)
from cadpanel.delivery.records.summary import summary
from cadpanel.delivery.sheets import FOUR_EDGES, Built, PanelSheet
from cadpanel.delivery.shop_settings import Origin
from cadpanel.fitting.bends.asked import Blend
from cadpanel.fitting.bends.taken import missed_blend, taken
from cadpanel.fitting.measures.fit import Measures
from cadpanel.fitting.result import FitResult
from cadpanel.geometry.joints import Joint
from cadpanel.reference.model import PanelReference, Reference, Seam
from cadpanel.reference.settings import ReferenceSettings
from cadpanel.terms.limits.catalogue import LIMITS

# An outline this part of the panel's length farther from the drawing's than corners and surface are is worth a note.
WORTH_A_NOTE = 0.02
KG_PER_MM3 = 1e-9
"""What a mm3 weighs at a density of 1 kg/m3."""
# What saves less RMS deviation, mm a unit, costs nothing.
_FREE = 1e-6


def reference_record(reference: Reference) -> ReferenceModel:
    """The file and what it holds."""
    return ReferenceModel(
        file=reference.source,
        panels=len(reference.panels),
        seams=len(reference.seams),
        notes=reference.notes,
        reading=_reading(reference.settings),
    )


def origin_record(reference: Reference, origin: Origin) -> OriginModel:
    """Where the fit's coordinates lie in the model's, and which of them STEP files have."""
    return OriginModel(kept=origin == "keep" or not any(reference.origin), offset=reference.origin)


def _reading(settings: ReferenceSettings) -> dict[str, Setting]:
    """The settings that differ from their defaults; files by their names."""
    usual = ReferenceSettings()
    changed = {one.name: getattr(settings, one.name) for one in fields(settings)}
    return {
        name: value.name if isinstance(value, Path) else value
        for name, value in changed.items()
        if value != getattr(usual, name)
    }


def solve_record(result: FitResult) -> SolveModel:
    """How the result was reached."""
    return SolveModel(iterations=result.iterations, starts=result.starts, agreed=result.agreed, prices=_prices(result))


def _prices(result: FitResult) -> dict[str, float]:
    """What is held costs, by its name and in the units that people ask for it in; what costs nothing is left out."""
    percent = {limit.name for limit in LIMITS if limit.percent}
    found = {name: price / 100.0 if name in percent else price for name, price in result.prices.items()}
    return {name: price for name, price in found.items() if price > _FREE}


def rule_records(result: FitResult) -> tuple[RuleModel, ...]:
    """What was measured of every rule."""
    return tuple(
        RuleModel.model_validate({**asdict(outcome), "kept": outcome.kept}, by_name=True) for outcome in result.outcomes
    )


def baselines_record(result: FitResult) -> BaselinesModel:
    """The methods that the result is held against, by the same measures and limits."""
    return BaselinesModel(
        local=summary(result.local, result.local, result.settings),
        two_stage=summary(result.two_stage, result.local, result.settings),
    )


def panel_records(result: FitResult, built: Built) -> tuple[PanelModel, ...]:
    """Every panel as it was fitted and built."""
    return tuple(
        _panel(result, index, reference, panel)
        for index, (reference, panel) in enumerate(zip(result.reference.panels, built.panels, strict=True))
    )


def with_flat_parts(
    records: Sequence[PanelModel], built: Sequence[PanelSheet], parts: Sequence[FlatPart], density: float
) -> tuple[PanelModel, ...]:
    """Records that say besides how every panel is cut, bent, and how heavy it is at a density in kg/m3."""
    return tuple(
        record.model_copy(
            update={
                "blank": part.blank,
                "mass": panel.volume * density * KG_PER_MM3,
                "bends": part.bends,
                "other_face": rows(panel.other.corners()),
                "cuts": cut_models(panel.shape),
                "side_cuts": side_cut_models(panel.shape),
                "bevels": part.bevels,
                "fixings": part.holes,
                "notes": (*record.notes, *_fixing_note(part)),
            }
        )
        for record, panel, part in zip(records, built, parts, strict=True)
    )


def _fixing_note(part: FlatPart) -> tuple[str, ...]:
    """What to say of edges along which not every hole has room."""
    if part.fixings is None or not part.fixings.found.short:
        return ()
    return (
        f"Not every fixing hole has room along {' and '.join(part.fixings.found.short)}: what would come too near to "
        "another edge, a bend's beginning or a hole is left out.",
    )


def _panel(result: FitResult, index: int, reference: PanelReference, built: PanelSheet) -> PanelModel:
    measures = result.measures
    return PanelModel(
        name=built.shape.name,
        feature=built.shape.feature,
        rms_deviation=float(measures.rms_deviation[index]),
        max_deviation=float(measures.max_deviation[index]),
        hausdorff=float(measures.hausdorff[index]),
        max_corner_drift=float(measures.drift[index]),
        max_drift_along=float(measures.drift_along[index]),
        max_free_edge_drift=float(measures.drift_across[index]),
        outline_drift=float(measures.outline_drift[index]),
        area=built.area,
        volume=built.volume,
        surface=built.check.area,
        centroid=built.check.centroid,
        skin_centroid=built.skin_check.centroid,
        corners=rows(built.shape.corners()),
        fitted=fitted_model(built.fitted),
        patches=patch_models(built.shape),
        rulings=ruling_models(built.shape),
        taken=tuple(map(tuple, taken(reference, built.fitted).tolist())),
        returns=built.returns,
        tray=built.tray,
        moved=built.moved,
        notes=(*built.notes, *_outline_note(measures, index), *_blend_note(reference, built, result.settings.blend)),
    )


def _blend_note(reference: PanelReference, built: PanelSheet, blends: Sequence[Blend]) -> tuple[str, ...]:
    """What to say of a panel whose bend is not where it was told to be."""
    missed = missed_blend(reference, built.fitted, blends)
    if missed is None:
        return ()
    # The same on both ends is said once.
    asked, became = (
        " and ".join(dict.fromkeys(f"{first:.0f}-{last:.0f}" for first, last in places.tolist())) for places in missed
    )
    return (
        f"Its bend was to be made of {asked} mm along its ends, and reaches over {became} mm: the drawing there does "
        "not bend like that.",
    )


def _outline_note(measures: Measures, index: int) -> tuple[str, ...]:
    """What to say of a panel whose outline leaves the drawing's though its corners and its surface do not."""
    beyond = float(measures.hausdorff[index])
    if beyond - measures.max_deviation[index] - measures.drift[index] <= WORTH_A_NOTE * measures.lengths[index]:
        return ()
    return (
        f"Between its corners its outline is up to {beyond:.0f} mm away from the drawing's, as its free edges are "
        "straight and its ends lie in planes.",
    )


def seam_records(
    reference: Reference, measures: Measures, joints: Sequence[Joint], prices: Sequence[float] = ()
) -> tuple[SeamModel, ...]:
    """Every seam; the panel that comes first in the file is named first, as its walk orders the corners.

    Args:
        reference: with the seams.
        measures: of their gaps and kinks.
        joints: of each, as `Built` has them.
        prices: what each of them costs, see `FitResult.seam_prices`; empty where that is not known.
    """
    return tuple(
        _seam(reference, seam, measures, index, joints[index], prices[index] if prices else None)
        for index, seam in enumerate(reference.seams)
    )


def seam_names(reference: Reference) -> tuple[tuple[str, str], ...]:
    """The two panels of every seam, the one that comes first in the file first."""
    return tuple(_names(reference, seam) for seam in reference.seams)


def _names(reference: Reference, seam: Seam) -> tuple[str, str]:
    first, second = sorted(seam.panels)
    return reference.panels[first].name, reference.panels[second].name


def _seam(
    reference: Reference, seam: Seam, measures: Measures, index: int, joint: Joint, price: float | None
) -> SeamModel:
    order = np.argsort(seam.panels, kind="stable")
    first, second = (_edge(reference.panels[seam.panels[i]], seam.edges[i]) for i in order)
    gaps = measures.corner_gaps[index]
    return SeamModel(
        panels=_names(reference, seam),
        edges=(first, second),
        reversed=seam.reversed,
        corner_gaps=tuple(gaps.tolist()),
        max_corner_gap=float(gaps.max()),
        max_seam_gap=float(measures.seam_gap[index]),
        width=float(measures.seam_width[index]),
        step=float(measures.seam_step[index]),
        shift=float(measures.seam_shift[index]),
        turn=float(np.degrees(measures.edge_turns[seam.panels, seam.edges].max())),
        unevenness=float(measures.uneven[index]),
        max_kink=float(np.degrees(measures.kink[index])),
        price=price,
        plane=cut_model(joint.plane.point, (1.0 if order[0] == 0 else -1.0) * joint.plane.normal),
        joint=joint.own,
        recut=joint.recut,
    )


def _edge(panel: PanelReference, edge: int) -> str:
    """The edge as features call it: ends and sides of four-sided panels, numbers of others."""
    return FOUR_EDGES[edge] if panel.four_sided else f"edge {edge}"
