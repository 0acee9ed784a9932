"""What a report says that only the reference can tell, measured again on the panels of the report.

Deviation, drift and the turn of seams hang on the reference and on the panels as they were fitted. The report has the
panels, so that nothing is fitted: both are measured by the code that measures a fit.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from pathlib import Path

import numpy as np

from cadpanel.arrays import Array
from cadpanel.delivery.records.jsonfile import Record
from cadpanel.delivery.records.report import ReferenceModel, ReportModel
from cadpanel.delivery.records.to_shape import fitted_shape
from cadpanel.errors import DeliveryError, SettingsError
from cadpanel.fitting.measures.fit import Measures, measure
from cadpanel.reference.model import Reference
from cadpanel.reference.settings import ReferenceSettings
from cadpanel.terms.limits.catalogue import LIMITS

SAME = 1e-5
"""mm, degrees or percent within which a number that was measured again is the same."""
FILES = ("spine", "network", "mesh")
"""Settings that name a file beside the reference."""


def reading_again(stated: ReferenceModel, file: Path) -> ReferenceSettings:
    """How a reference was read, for a file that is said to be it; files beside it are looked for beside that one.

    Raises:
        DeliveryError: the report's settings are none.
    """
    named = {name: file.parent / str(value) if name in FILES else value for name, value in stated.reading.items()}
    try:
        return ReferenceSettings(**named)  # type: ignore[arg-type]
    except (SettingsError, TypeError) as error:
        raise DeliveryError(f"The report does not say how its reference was read ({error}): write it again.") from error


def measured_faults(report: ReportModel, reference: Reference) -> Iterator[str]:
    """One sentence for every number of a report that is not measured on its panels against a reference."""
    names = [panel.name for panel in report.panels]
    if names != [panel.name for panel in reference.panels]:
        yield f"'{reference.source}' gives other panels than the report lists, so nothing of it can be measured again."
        return
    if len(reference.seams) != len(report.seams):
        yield f"'{reference.source}' has {len(reference.seams)} seams, the report lists {len(report.seams)}."
        return
    found = measure([fitted_shape(panel) for panel in report.panels], reference)
    moved = max(panel.moved for panel in report.panels)
    of_panels = _of_panels(found)
    for index, panel in enumerate(report.panels):
        yield from _unlike(
            f"Panel '{panel.name}'", panel, {key: float(v[index]) for key, v in of_panels.items()}, moved
        )
    of_seams = _of_seams(found, reference)
    for index, seam in enumerate(report.seams):
        name = f"Seam '{seam.panels[0]}' to '{seam.panels[1]}'"
        yield from _unlike(name, seam, {key: float(values[index]) for key, values in of_seams.items()}, moved)
    worst = {limit.rows[-1].key: limit.worst(found) for limit in LIMITS} | {"rms_deviation": found.overall_rms}
    yield from _unlike("The summary", report.summary, worst, moved)


def _of_panels(found: Measures) -> Mapping[str, Array]:
    return {
        "rms_deviation": found.rms_deviation,
        "max_deviation": found.max_deviation,
        "hausdorff": found.hausdorff,
        "max_corner_drift": found.drift,
        "max_drift_along": found.drift_along,
        "max_free_edge_drift": found.drift_across,
        "outline_drift": found.outline_drift,
    }


def _of_seams(found: Measures, reference: Reference) -> Mapping[str, Array]:
    turns = [float(found.edge_turns[seam.panels, seam.edges].max()) for seam in reference.seams]
    return {
        "width": found.seam_width,
        "step": found.seam_step,
        "shift": found.seam_shift,
        "max_kink": np.degrees(found.kink),
        "turn": np.degrees(np.array(turns)),
        "unevenness": found.uneven,
    }


def _unlike(name: str, stated: Record, found: Mapping[str, float | None], moved: float) -> Iterator[str]:
    for key, number in found.items():
        told = getattr(stated, key)
        if key not in stated.model_fields_set or (told is None and number is None):
            continue  # a report from before it was told, or nothing to tell
        if told is None or number is None or not abs(told - number) <= SAME + moved:
            yield f"{name}: the report's {key} is {told}, {number} is measured on the reference."
