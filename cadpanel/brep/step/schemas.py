"""The schemas of STEP files and the accuracy that they state."""

from __future__ import annotations

from typing import Literal, NamedTuple

Schema = Literal["AP242", "AP214"]


class Application(NamedTuple):
    """How a schema is called in a file's header, its protocol with its year, and its application."""

    name: str
    protocol: str
    application: str


SCHEMAS: dict[Schema, Application] = {
    "AP242": Application(
        "AP242_MANAGED_MODEL_BASED_3D_ENGINEERING_MIM_LF {1 0 10303 442 1 1 4 }",
        "ap242_managed_model_based_3d_engineering',2013",
        "Managed model based 3d engineering",
    ),
    "AP214": Application(
        "AUTOMOTIVE_DESIGN { 1 0 10303 214 1 1 1 1 }",
        "automotive_design',2000",
        "core data for automotive mechanical design processes",
    ),
}
UNCERTAINTY = 1e-7
"""Accuracy in mm that a file states for its geometry."""
