"""cadpanel turns a free-form building skin into panels that a shop can make from flat sheet.

    import cadpanel as cp

    reference = cp.read("fixtures/kai_tak_nw.step")
    result = cp.fit(reference, gap_tolerance=1.0)
    report = cp.deliver(result, "build/kai_tak_nw", thickness=3.0)

Lengths are millimetres. Angles of shapes and measures are radians, those of settings, of report.json and of the command
line degrees; shares are parts of 1, where the command line speaks of percent. The names below are loaded when they are
first used: importing cadpanel loads neither the CAD kernel nor NumPy.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING

from cadpanel.errors import (
    CadpanelError,
    DeliveryError,
    FitError,
    LoftError,
    PanelError,
    ProofError,
    ReferenceFileError,
    SettingsError,
)

if TYPE_CHECKING:
    from cadpanel.api import compare, deliver, fit, inspect, read, to_build123d, to_cadquery, write_step
    from cadpanel.api_job import run_job
    from cadpanel.api_loft import deliver_loft, rails
    from cadpanel.api_result import FitResult
    from cadpanel.api_shapes import build_skin, build_solid, unroll
    from cadpanel.api_studies import fewest_panels, study
    from cadpanel.atomic.cone import fit_cone
    from cadpanel.atomic.cylinder import fit_cylinder
    from cadpanel.atomic.plane import fit_plane
    from cadpanel.atomic.result import ConeFit, CylinderFit, PlaneFit
    from cadpanel.brep.survey import Survey
    from cadpanel.delivery.assemble import assemble
    from cadpanel.delivery.diff import diff
    from cadpanel.delivery.verify import Verification, verify
    from cadpanel.features.feature import Feature
    from cadpanel.features.patches import Cone, Cylinder, Plane
    from cadpanel.fitting.bends.asked import Blend
    from cadpanel.fitting.measures.fit import Measures
    from cadpanel.fitting.settings import FitSettings, Weights
    from cadpanel.geometry.patches import ConePatch, PlanePatch
    from cadpanel.geometry.shape import PanelShape, PolygonShape
    from cadpanel.geometry.unroll import FlatPattern
    from cadpanel.lofting.loft import Loft, loft
    from cadpanel.lofting.rail import Rail
    from cadpanel.reference.model import PanelReference, Reference, Seam
    from cadpanel.reference.settings import ReferenceSettings

__all__ = [
    "Blend",
    "CadpanelError",
    "Cone",
    "ConeFit",
    "ConePatch",
    "Cylinder",
    "CylinderFit",
    "DeliveryError",
    "Feature",
    "FitError",
    "FitResult",
    "FitSettings",
    "FlatPattern",
    "Loft",
    "LoftError",
    "Measures",
    "PanelError",
    "PanelReference",
    "PanelShape",
    "Plane",
    "PlaneFit",
    "PlanePatch",
    "PolygonShape",
    "ProofError",
    "Rail",
    "Reference",
    "ReferenceFileError",
    "ReferenceSettings",
    "Seam",
    "SettingsError",
    "Survey",
    "Verification",
    "Weights",
    "assemble",
    "build_skin",
    "build_solid",
    "compare",
    "deliver",
    "deliver_loft",
    "diff",
    "fewest_panels",
    "fit",
    "fit_cone",
    "fit_cylinder",
    "fit_plane",
    "inspect",
    "loft",
    "rails",
    "read",
    "run_job",
    "study",
    "to_build123d",
    "to_cadquery",
    "unroll",
    "verify",
    "write_step",
]

if not TYPE_CHECKING:  # type checkers see the imports above, and so know what is not there
    _HOMES = {
        "api": ("compare", "deliver", "fit", "inspect", "read", "to_build123d", "to_cadquery", "write_step"),
        "api_job": ("run_job",),
        "api_loft": ("deliver_loft", "rails"),
        "api_result": ("FitResult",),
        "api_shapes": ("build_skin", "build_solid", "unroll"),
        "api_studies": ("fewest_panels", "study"),
        "brep.survey": ("Survey",),
        "delivery.assemble": ("assemble",),
        "delivery.diff": ("diff",),
        "delivery.verify": ("Verification", "verify"),
        "features.feature": ("Feature",),
        "features.patches": ("Cone", "Cylinder", "Plane"),
        "atomic.cone": ("fit_cone",),
        "atomic.cylinder": ("fit_cylinder",),
        "atomic.plane": ("fit_plane",),
        "atomic.result": ("ConeFit", "CylinderFit", "PlaneFit"),
        "fitting.bends.asked": ("Blend",),
        "fitting.measures.fit": ("Measures",),
        "fitting.settings": ("FitSettings", "Weights"),
        "geometry.patches": ("ConePatch", "PlanePatch"),
        "geometry.shape": ("PanelShape", "PolygonShape"),
        "geometry.unroll": ("FlatPattern",),
        "lofting.loft": ("Loft", "loft"),
        "lofting.rail": ("Rail",),
        "reference.model": ("PanelReference", "Reference", "Seam"),
        "reference.settings": ("ReferenceSettings",),
    }
    _HOME_OF = {name: f"cadpanel.{home}" for home, names in _HOMES.items() for name in names}

    def __getattr__(name: str) -> object:
        """Load a public name from where it is made."""
        if name not in _HOME_OF:
            raise AttributeError(f"module 'cadpanel' has no attribute '{name}'")
        thing = getattr(import_module(_HOME_OF[name]), name)
        globals()[name] = thing
        return thing

    def __dir__() -> list[str]:
        """The public names are there before they are loaded."""
        return sorted({*globals(), *__all__})
