"""Options that several commands share, and the settings that they make."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Annotated

import typer

from cadpanel.errors import SettingsError
from cadpanel.features.feature import Tilt
from cadpanel.fitting.settings import FitSettings, Method, Weights

ReferenceFile = Annotated[
    Path, typer.Argument(metavar="REFERENCE", help="STEP file; each product in it is one panel's faces.")
]
Out = Annotated[Path, typer.Option("--out", metavar="DIR", help="Folder to write, whole or not at all.")]
TiltOption = Annotated[
    Tilt, typer.Option("--tilt", help="May the planes that cut the ends tilt into a mitre, or stand upright?")
]
GapTolerance = Annotated[
    float | None,
    typer.Option(
        "--gap-tolerance", metavar="MM", help="Largest gap between neighbours, along whole seams; 1 if not given."
    ),
]
WeightsOption = Annotated[
    str | None,
    typer.Option(
        "--weights",
        metavar="gap=W,deviation=W,drift=W",
        help="Weigh squares against each other instead of holding a gap tolerance.",
    ),
]
DriftAlong = Annotated[
    float,
    typer.Option("--drift-along", metavar="PERCENT", help="How far corners may move along the strip, of the length."),
]
DriftAcross = Annotated[
    float,
    typer.Option("--drift-across", metavar="PERCENT", help="How far corners may move across it, which people see."),
]
Restarts = Annotated[int, typer.Option("--restarts", help="Further starts from shaken panels; the best counts.")]
Seed = Annotated[int, typer.Option("--seed", help="Of the random numbers that shake them.")]
SeamTolerance = Annotated[
    float, typer.Option("--seam-tolerance", metavar="MM", help="How far panels that meet may lie apart in the file.")
]
Overwrite = Annotated[bool, typer.Option("--overwrite", help="Replace a delivery that stands there already.")]
Quiet = Annotated[bool, typer.Option("--quiet", help="Print nothing but what is wrong.")]

_WEIGHTS = ("gap", "deviation", "drift")


def fit_settings(
    *,
    feature: str = "plane-cone-plane",
    method: Method = "concurrent",
    tilt: Tilt,
    gap_tolerance: float | None,
    weights: str | None,
    drift_along: float,
    drift_across: float,
    restarts: int,
    seed: int,
) -> FitSettings:
    """The settings that the options ask for; drifts are in percent here, and shares there.

    Raises:
        SettingsError: an option is out of its range, or contradicts another one.
    """
    if weights is not None and gap_tolerance is not None:
        raise SettingsError("--weights take the place of a tolerance: leave out either --weights or --gap-tolerance.")
    return FitSettings(
        feature=feature,
        method=method,
        tilt=tilt,
        gap_tolerance=1.0 if gap_tolerance is None else gap_tolerance,
        weights=None if weights is None else parse_weights(weights),
        drift_along=_share("--drift-along", drift_along),
        drift_across=_share("--drift-across", drift_across),
        restarts=restarts,
        seed=seed,
    )


def parse_weights(text: str) -> Weights:
    """Weights from "gap=1,deviation=1,drift=1e-4", in any order; those left out keep their defaults.

    Raises:
        SettingsError: the text is not of that form.
    """
    found: dict[str, float] = {}
    for part in text.split(","):
        name, equals, value = (piece.strip() for piece in part.partition("="))
        if not equals or name not in _WEIGHTS or name in found:
            raise SettingsError(
                f"--weights cannot use '{part.strip()}': write each of gap, deviation and drift at most once, "
                "like gap=1,deviation=1,drift=1e-4."
            )
        try:
            found[name] = float(value)
        except ValueError as error:
            raise SettingsError(f"--weights needs a number for {name}, not '{value}'.") from error
    return Weights(**found)


def _share(option: str, percent: float) -> float:
    if not (math.isfinite(percent) and 0.01 <= percent <= 50.0):
        raise SettingsError(f"{option} must be between 0.01 and 50 percent of the panel's length, not {percent:g}.")
    return percent / 100.0
