"""Does a report agree with itself? Everything in it that follows from other numbers in it is worked out again.

What needs the reference (deviation, Hausdorff distance, drift) cannot be checked from a delivery alone; that the
summary is the worst of its panels and seams can.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from cadpanel.arrays import Array, IntArray
from cadpanel.delivery.records.certified import CertificateModel
from cadpanel.delivery.records.left_out import seams_left_out
from cadpanel.delivery.records.report import PanelModel, ReportModel, SeamModel, SummaryModel
from cadpanel.delivery.records.shape_checks import shape_faults
from cadpanel.delivery.records.to_shape import Built, fitted_shape
from cadpanel.features.catalogue import AUTO
from cadpanel.fitting.rules.book import Rules, rules_of
from cadpanel.geometry.panel import Panel
from cadpanel.geometry.shape import edge_corners
from cadpanel.geometry.sheet_checks import sheet_depth
from cadpanel.terms.limits.catalogue import LIMITS
from cadpanel.terms.limits.flange_width import FlangeWidth
from cadpanel.terms.limits.min_radius import MinRadius
from cadpanel.terms.limits.obliqueness import Obliqueness

SAME_LENGTH = 1e-6
"""Two lengths in mm, or angles in degrees, that are meant to be one number may differ by this."""
SAME_VOLUME = 1e-6
"""Volume in mm3 by which what two solids share may differ between two machines."""
SAME_LIMIT = 1e-5
"""The same of what limits measure of panels alone."""


def check_report(report: ReportModel, shapes: Sequence[Built], certificate: CertificateModel) -> tuple[str, ...]:
    """One sentence for everything in a report that does not follow from the rest of it, or from its files.

    Args:
        report: what was read.
        shapes: the panels that its list gives, as `recorded_shape` makes them.
        certificate: what the files beside it show now.
    """
    panels = {panel.name: panel for panel in report.panels}
    rules = rules_of(report.settings.rules)
    given = {} if rules is None else rules.features([panel.name for panel in report.panels])
    sheet = report.settings.sheet()
    depth = sheet_depth(sheet.thickness, sheet.skin_side)
    failures = [
        fault for panel, shape in zip(report.panels, shapes, strict=True) for fault in shape_faults(panel, shape, depth)
    ]
    origin = report.origin
    if origin.kept != (report.settings.shop().origin == "keep" or not any(origin.offset)):
        failures.append("The report's origin is called kept, or not kept, against its settings.")
    counted = Counter(panel.feature for panel in report.panels)
    if report.features != counted:
        failures.append(f"The report counts {report.features} panels by feature, its list has {dict(counted)}.")
    failures += [
        f"Panel '{panel.name}': the report calls it {panel.feature}, {asked} was asked for."
        for place, panel in enumerate(report.panels)
        for asked in [given.get(place, report.settings.feature)]
        if panel.feature != asked != AUTO
    ]
    failures += [fault for seam in report.seams for fault in _seam_faults(seam, panels)]
    failures += _joint_faults(report, rules)
    failures += seams_left_out(report)
    failures += _summary_faults(report)
    failures += certificate_faults(report.certificate, certificate)
    return tuple(failures)


def _seam_faults(seam: SeamModel, panels: dict[str, PanelModel]) -> Iterator[str]:
    name = f"Seam '{seam.panels[0]}' to '{seam.panels[1]}'"
    gaps = np.array(seam.corner_gaps)
    try:
        first, second = (
            edge_corners(_fitted(panels[panel]), edge) for panel, edge in zip(seam.panels, seam.edges, strict=True)
        )
    except ValueError as error:
        yield f"{name}: {error}."
        return
    if seam.plane is not None and seam.recut is not None:
        normal, offset = np.array(seam.plane.normal), seam.plane.offset
        farthest = max(float(np.abs(corners @ normal - offset).max()) for corners in (first, second))
        if not abs(farthest - seam.recut) <= SAME_LENGTH:
            yield (
                f"{name}: the report says that corners lie up to {seam.recut:.6g} mm from the joint's plane, they lie "
                f"{farthest:.6g} mm from it."
            )
    if len(gaps) == 2:
        first, second = first[[0, -1]], second[[0, -1]]
    if not first.shape == second.shape == (len(gaps), 3):
        yield f"{name}: the report has {len(gaps)} corner gaps for {len(first)} and {len(second)} corners."
        return
    measured = np.linalg.norm(first - (second[::-1] if seam.reversed else second), axis=-1)
    moved = sum(panels[name].moved for name in seam.panels)
    off = float(np.abs(measured - gaps).max())
    if not off <= SAME_LENGTH + moved:
        yield f"{name}: the corner gaps in the report are off by {off:.3g} mm from its panels' corners."
    if seam.max_corner_gap != gaps.max():
        yield f"{name}: the largest corner gap in the report is {seam.max_corner_gap:.6g} mm, not {gaps.max():.6g}."


def _joint_faults(report: ReportModel, rules: Rules | None) -> Iterator[str]:
    """Joints of single seams that the list of seams calls asked for, and the rules do not."""
    own = {} if rules is None else rules.joints([panel.name for panel in report.panels], _seam_panels(report))
    for place, seam in enumerate(report.seams):
        if seam.joint != own.get(place):
            yield (
                f"Seam '{seam.panels[0]}' to '{seam.panels[1]}': its own joint of {seam.joint} mm is not the one of "
                f"{own.get(place)} mm that the rules ask for."
            )


def _seam_panels(report: ReportModel) -> IntArray:
    places = {panel.name: place for place, panel in enumerate(report.panels)}
    return np.array([[places[name] for name in seam.panels] for seam in report.seams], dtype=np.intp).reshape(-1, 2)


def _fitted(panel: PanelModel) -> Array:
    """The panel's corners as the fit had them, in rows."""
    return np.array(panel.corners if panel.fitted is None else panel.fitted.corners)


@dataclass(frozen=True, slots=True)
class Alone:
    """Panels without the reference."""

    shapes: Sequence[Panel]


OF_SHAPES = (MinRadius(), FlangeWidth(), Obliqueness())
"""The limits whose measure is seen of panels alone."""


def _summary_faults(report: ReportModel) -> Iterator[str]:
    summary = report.summary
    worst: dict[str, float] = {
        key: max((of(seam) for seam in report.seams), default=0.0) for key, of in _OF_SEAMS.items()
    }
    worst |= {key: max((of(panel) for panel in report.panels), default=0.0) for key, of in _OF_PANELS.items()}
    for key, value in worst.items():
        stated = float(getattr(summary, key))
        if not abs(stated - value) <= SAME_LENGTH:
            yield f"The summary's {key} is {stated:.6g}, the worst in the list is {value:.6g}."
    shapes = [fitted_shape(panel) for panel in report.panels]
    moved = max(panel.moved for panel in report.panels)
    for limit in OF_SHAPES:
        if limit.rows[-1].key not in summary.model_fields_set:
            continue  # a report from before the limit was known
        least, of_list = getattr(summary, limit.rows[-1].key), float(limit.measure(Alone(shapes)).min())
        known = np.isfinite(of_list)
        if (least is not None) != known or (known and not abs(least - of_list) <= SAME_LIMIT + moved):
            yield f"The summary's {limit.rows[-1].key} is {least}, the panels in the list have {of_list:.6g}."
    yield from _tolerance_faults(report, summary)
    yield from _deviation_faults(report, summary)


_OF_SEAMS: dict[str, Callable[[SeamModel], float]] = {
    "max_corner_gap": lambda seam: seam.max_corner_gap,
    "max_seam_gap": lambda seam: seam.max_seam_gap,
    "max_width": lambda seam: seam.width,
    "max_step": lambda seam: seam.step,
    "max_shift": lambda seam: seam.shift,
    "max_kink": lambda seam: seam.max_kink,
    "max_unevenness": lambda seam: seam.unevenness,
}
_OF_PANELS: dict[str, Callable[[PanelModel], float]] = {
    "max_deviation": lambda panel: panel.max_deviation,
    "hausdorff": lambda panel: panel.hausdorff,
    "max_corner_drift": lambda panel: panel.max_corner_drift,
    "max_drift_along": lambda panel: panel.max_drift_along,
    "max_free_edge_drift": lambda panel: panel.max_free_edge_drift,
    "max_outline_drift": lambda panel: panel.outline_drift,
}


def _rule_faults(report: ReportModel) -> Iterator[str]:
    for rule in report.rules:
        if rule.kept != (rule.found <= rule.allowed):
            yield (
                f"The rule '{rule.rule}' is called {'kept' if rule.kept else 'not kept'}, with {rule.found:.6g} "
                f"{rule.unit} where {rule.allowed:.6g} are allowed."
            )
    if report.summary.tolerance_met and not all(rule.kept for rule in report.rules):
        yield "The report calls its tolerance met, and not all its rules are kept."


def _over_gaps(report: ReportModel) -> dict[str, tuple[float, float, float]]:
    """Of each thing that is held of gaps the largest share of what its seam may have, that, and what that is, mm."""
    rules = rules_of(report.settings.rules)
    allowed: Mapping[str, float | Array] = report.settings.gaps
    if rules is not None and report.settings.gaps:
        names = [panel.name for panel in report.panels]
        allowed = rules.gaps(report.settings.gaps, names, _seam_panels(report))
    over = {}
    for what, most in allowed.items():
        found = np.array([_GAPS[what](seam) for seam in report.seams])
        each = np.broadcast_to(most, len(found))
        worst = int((found / each).argmax()) if len(found) else -1
        over[what] = (found[worst] / each[worst], found[worst], each[worst]) if len(found) else (0.0, 0.0, 0.0)
    return over


_GAPS: dict[str, Callable[[SeamModel], float]] = {
    "gap": lambda seam: max(seam.max_corner_gap, seam.max_seam_gap),
    "width": lambda seam: seam.width,
    "step": lambda seam: seam.step,
    "shift": lambda seam: seam.shift,
}


def _tolerance_faults(report: ReportModel, summary: SummaryModel) -> Iterator[str]:
    yield from _rule_faults(report)
    if not report.settings.gaps:
        return
    gaps = _over_gaps(report)
    deviation = report.settings.max_deviation
    if summary.tolerance_met and deviation is not None and summary.max_deviation > deviation + SAME_LENGTH:
        yield f"The report calls its limits met, and a deviation in it is {summary.max_deviation:.6g} mm."
    for what, (share, found, most) in gaps.items():
        if summary.tolerance_met and share > 1.0:
            yield f"The report calls the {what} of {most:g} mm held, and one in it is {found:.6g} mm."
    limits = list(_limits(report, summary))
    beyond = [limit for limit in limits if limit.over > SAME_LENGTH]
    if summary.tolerance_met and beyond:
        yield beyond[0].sentence
    far = deviation is not None and summary.max_deviation > deviation - SAME_LENGTH
    within = all(found < most - SAME_LENGTH for share, found, most in gaps.values() if share > 0.0) and all(
        limit.over < -SAME_LENGTH for limit in limits
    )
    within &= all(rule.kept for rule in report.rules)
    if not summary.tolerance_met and not far and within:
        yield "The report calls its tolerance not met, and all its gaps and limits are kept."


@dataclass(frozen=True, slots=True)
class _Limited:
    """A limit in a report: by how much it is broken, mm or percent, and what to say if it is called kept."""

    over: float
    sentence: str


def _limits(report: ReportModel, summary: SummaryModel) -> Iterator[_Limited]:
    """The limits that the report states a worst value for; reports from before a limit was known have none."""
    for limit in LIMITS:
        found = getattr(summary, limit.rows[-1].key)
        if found is None:
            continue
        allowed, unit = limit.stated(limit.allowed(report.settings)), "%" if limit.percent else limit.unit
        yield _Limited(
            allowed - found if limit.at_least else found - allowed,
            f"The report calls its limits met, and states {found:.6g} {unit} for the {limit.what}, where "
            f"{allowed:.6g} {unit} are allowed.",
        )


def _deviation_faults(report: ReportModel, summary: SummaryModel) -> Iterator[str]:
    """The deviation of all panels is a mean of theirs, and is stated as a multiple of the local fit's."""
    each = [panel.rms_deviation for panel in report.panels]
    if not min(each) - SAME_LENGTH <= summary.rms_deviation <= max(each) + SAME_LENGTH:
        yield (
            f"The summary's rms_deviation is {summary.rms_deviation:.6g}, those in the list go from {min(each):.6g} to "
            f"{max(each):.6g}."
        )
    multiple, local = summary.local_rms_multiple, report.baselines.local.rms_deviation
    if multiple is not None and not abs(multiple * local - summary.rms_deviation) <= SAME_LENGTH:
        yield f"The summary's local_rms_multiple is {multiple:.6g}, the deviations do not make it so."


def certificate_faults(stated: CertificateModel, found: CertificateModel) -> Iterator[str]:
    """One sentence for everything that a report's certificate says otherwise than the files show now."""
    for key in ("solids", "skins", "valid", "face_kinds", "holes", "names_kept"):
        was, now = getattr(stated, key), getattr(found, key)
        if was != now:
            yield f"The certificate in the report says {key} = {was}, the files show {now}."
    if stated.failures:
        yield f"The certificate in the report lists what does not hold: {stated.failures[0]}"
    for key, limit in (
        ("max_tangency_error", 1e-9),
        ("volume_error", 1e-9),
        ("flat_area_error", 1e-9),
        ("flat_length_error", SAME_LENGTH),
        ("stated_error", 1e-9),
        ("hole_error", SAME_LENGTH),
        ("max_seam_gap", SAME_LENGTH),
    ):
        was, now = getattr(stated, key), getattr(found, key)
        if not abs(was - now) <= limit:
            yield f"The certificate in the report says {key} = {was:.6g}, the files show {now:.6g}."
    for key in ("least", "largest"):
        was, now = (None if one.clear is None else getattr(one.clear, key) for one in (stated, found))
        if (was is None) != (now is None) or (was is not None and not abs(was - now) <= SAME_LENGTH):
            yield f"The certificate in the report says clear.{key} = {was}, the files show {now}."
    shared, now = stated.overlap, found.overlap
    if shared is not None and now is not None and not abs(shared - now) <= SAME_VOLUME:
        yield f"The certificate in the report says overlap = {shared:.6g}, the files show {now:.6g}."
    was_shown, shown = (
        {f"{output}.{key}": number for output, numbers in one.outputs.items() for key, number in numbers.items()}
        for one in (stated, found)
    )
    # What is wrong with an output is told by itself: of one that is not looked at to its end there are no numbers.
    faulty = {output for output, numbers in found.outputs.items() if found.failures and not numbers}
    for key in sorted({*was_shown, *shown}):
        if key.partition(".")[0] in faulty:
            continue
        was, now = (numbers.get(key, np.nan) for numbers in (was_shown, shown))
        if not abs(was - now) <= SAME_LENGTH:
            yield f"The certificate in the report says {key} = {was:.6g}, the files show {now:.6g}."
