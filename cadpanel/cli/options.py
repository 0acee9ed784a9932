"""Options that several commands share, and the settings that they make."""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import Annotated

import typer

from cadpanel.errors import SettingsError
from cadpanel.features.catalogue import AUTO, Tilt
from cadpanel.fitting.bends.asked import blends_of
from cadpanel.fitting.settings import FitSettings, Method, Weights
from cadpanel.reference.settings import By, ReferenceSettings, choices_of

ReferenceFile = Annotated[
    Path,
    typer.Argument(
        metavar="REFERENCE",
        help="STEP, IGES, .brep or .3dm file; each product in it is one panel's faces, unless it is to be cut.",
    ),
]


def folder_named(text: str) -> Path:
    """The folder that a name stands for; the empty one would be the folder that the command runs in.

    Raises:
        SettingsError: the name is empty.
    """
    if not text.strip():
        raise SettingsError("--out is the name of the folder to write, not ''")
    return Path(text)


Out = Annotated[
    Path,
    typer.Option("--out", metavar="DIR", parser=folder_named, help="Folder to write, whole or not at all."),
]
FeatureOption = Annotated[
    str,
    typer.Option("--feature", metavar="NAME", help="Shape of a panel, one of those that 'cadpanel features' lists."),
]
MaxDeviation = Annotated[
    float | None,
    typer.Option(
        "--max-deviation",
        metavar="MM",
        help="With --feature auto: how far a panel may lie from the reference anywhere.",
    ),
]
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
MinRadius = Annotated[float, typer.Option("--min-radius", metavar="MM", help="Tightest radius that the shop can roll.")]
BlendOption = Annotated[
    list[str] | None,
    typer.Option(
        "--blend",
        metavar="[PANEL=]FROM-TO[%]",
        help="Stretch across the panels, mm from side 0, to become the bend; may be repeated, for one panel each.",
    ),
]
Restarts = Annotated[int, typer.Option("--restarts", help="Further starts from shaken panels; the best counts.")]
Seed = Annotated[int, typer.Option("--seed", help="Of the random numbers that shake them.")]
SeamTolerance = Annotated[
    float, typer.Option("--seam-tolerance", metavar="MM", help="How far panels that meet may lie apart in the file.")
]
Unit = Annotated[
    str | None, typer.Option("--unit", metavar="UNIT", help="Of every file that has none (.brep, meshes): m, in ...")
]
Faces = Annotated[
    str | None,
    typer.Option(
        "--faces",
        metavar="CHOICE,...",
        help="Which faces are the skin: 3, 2-5, NAME, layer=NAME, color=#RRGGBB; see 'cadpanel inspect'. "
        """A name with a comma stands in double quotes: '"Roof, north",layer="Skin, east"'.""",
    ),
]
Divide = Annotated[
    int | None,
    typer.Option("--divide", metavar="N", help="Cut each strip, or ring, into so many panels of equal length."),
]
LipBand = Annotated[
    float | None,
    typer.Option("--lip", metavar="MM", help="With --divide: keep only a band of this width about the strip's lip."),
]
Grid = Annotated[
    str | None, typer.Option("--grid", metavar="UxV", help="Cut each surface into so many by so many panels.")
]
GridBy = Annotated[
    By | None,
    typer.Option("--by", help="Are the grid's parts equal in length or in parameter? In length if not given."),
]
Stations = Annotated[
    str | None, typer.Option("--stations", metavar="MM,MM,...", help="Cut by planes at these lengths along the strip.")
]
Spine = Annotated[
    Path | None, typer.Option("--spine", metavar="FILE", help="Measure the stations along the curve in this file.")
]
Network = Annotated[
    Path | None,
    typer.Option(
        "--network", metavar="FILE", help="Cut along the curves in this file; it may be the reference itself."
    ),
]
Mesh = Annotated[Path | None, typer.Option("--mesh", metavar="FILE", help="One panel a face of this OBJ or OFF mesh.")]
Junctions = Annotated[
    bool,
    typer.Option(
        "--junctions",
        help="Part sides where corners of other panels lie on them, as in a brick bond; goes with planar-polygon.",
    ),
]
Overwrite = Annotated[bool, typer.Option("--overwrite", help="Replace a delivery that stands there already.")]
Quiet = Annotated[bool, typer.Option("--quiet", help="Print nothing but what is wrong.")]

_WEIGHTS = ("gap", "deviation", "drift")


def fit_settings(
    *,
    feature: str = "plane-cone-plane",
    max_deviation: float | None = None,
    method: Method = "concurrent",
    tilt: Tilt,
    gap_tolerance: float | None,
    weights: str | None,
    drift_along: float,
    drift_across: float,
    min_radius: float,
    blend: list[str] | None,
    restarts: int,
    seed: int,
) -> FitSettings:
    """The settings that the options ask for; drifts are in percent here, and shares there.

    Raises:
        SettingsError: an option is out of its range, or contradicts another one.
    """
    if weights is not None and gap_tolerance is not None:
        raise SettingsError("--weights take the place of a tolerance: leave out either --weights or --gap-tolerance.")
    if (feature == AUTO) != (max_deviation is not None):
        raise SettingsError(f"--feature {AUTO} and --max-deviation go together: give both or neither.")
    return FitSettings(
        feature=feature,
        max_deviation=max_deviation,
        method=method,
        tilt=tilt,
        gap_tolerance=1.0 if gap_tolerance is None else gap_tolerance,
        weights=None if weights is None else parse_weights(weights),
        drift_along=_share("--drift-along", drift_along),
        drift_across=_share("--drift-across", drift_across),
        min_radius=min_radius,
        blend=blends_of(blend),
        restarts=restarts,
        seed=seed,
    )


def reference_settings(
    *,
    seam_tolerance: float,
    unit: str | None,
    faces: str | None,
    divide: int | None,
    lip: float | None,
    grid: str | None,
    by: By | None,
    stations: str | None,
    spine: Path | None,
    network: Path | None,
    mesh: Path | None,
    junctions: bool,
) -> ReferenceSettings:
    """How the options ask for the reference to be read.

    Raises:
        SettingsError: an option is out of its range, or contradicts another one.
    """
    return ReferenceSettings(
        seam_tolerance=seam_tolerance,
        unit=unit,
        faces=None if faces is None else choices_of(faces),
        divide=divide,
        lip=lip,
        grid=None if grid is None else parse_grid(grid),
        by=by,
        stations=None if stations is None else parse_stations(stations),
        spine=spine,
        network=network,
        mesh=mesh,
        junctions=junctions,
    )


def parse_grid(text: str) -> tuple[int, int]:
    """Two numbers of panels from "20x10".

    Raises:
        SettingsError: the text is not of that form.
    """
    found = re.fullmatch(r"\s*(\d{1,7})\s*[xX]\s*(\d{1,7})\s*", text)
    if found is None:
        raise SettingsError(f"--grid is two numbers of panels like 20x10, not '{text}'.")
    return int(found[1]), int(found[2])


def parse_stations(text: str) -> tuple[float, ...]:
    """Lengths from "1200,2400,3600".

    Raises:
        SettingsError: one of them is no number.
    """
    try:
        return tuple(float(word) for word in text.split(","))
    except ValueError:
        raise SettingsError(f"--stations are lengths in mm like 1200,2400,3600, not '{text}'.") from None


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
