"""What a fit is asked for: a reference, options as on the command line, rules of single panels, and a folder."""

from __future__ import annotations

import fnmatch
import json
import shlex
from pathlib import Path
from typing import Any, Sequence

from .documents import DeliveryMissing, panels_of

# Settings of a report that are options of the same name and take one value, and those that take percent of a share.
_PLAIN = (
    *("tilt", "gap_tolerance", "joint_tolerance", "step", "shift", "min_radius", "restarts", "seed", "seam_tolerance"),
    *("seam_turn", "max_kink", "feature", "max_deviation", "method", "thickness", "joint", "skin_side", "origin"),
    *("k_factor", "chord", "roll_pitch", "dxf_entities", "dxf_name_length", "density", "facet_height"),
)
_PERCENT = ("drift_along", "drift_across", "evenness")
_DIGITS = 12
# Pairs that are told as 4x6; other lists have commas.
_SIZES = ("grid", "panel_size")


def options_of(report: dict[str, Any]) -> list[str]:
    """The options of `cadpanel fit` that a delivery was made with, as far as they are not left to themselves.

    Raises:
        DeliveryMissing: its feature was made by a program, which no option can say.
    """
    settings = report["settings"]
    if settings.get("composition"):
        raise DeliveryMissing("The feature of this delivery was made by a program: fit it there again.")
    values = {name: settings[name] for name in _PLAIN if settings.get(name) is not None}
    values.update(report["reference"].get("reading", {}))
    for name in _PERCENT:
        if settings.get(name) is not None:
            values[name] = round(100.0 * settings[name], _DIGITS)
    found = [word for name, value in values.items() for word in _option(name, value)]
    weights = settings.get("weights")
    if weights:
        found += ["--weights", ",".join(f"{name}={value!r}" for name, value in weights.items())]
    found += _lists(settings)
    return found


def _lists(settings: dict[str, Any]) -> list[str]:
    """The options that are lists."""
    found: list[str] = []
    for name in ("outputs", "only", "blend"):
        if settings.get(name):
            found += [f"--{name}", ",".join(f'"{one}"' if "," in one else one for one in settings[name])]
    if settings.get("stock"):
        found += ["--stock", ",".join(f"{wide:g}x{high:g}" for wide, high in settings["stock"])]
    if settings.get("dxf_layers"):
        found += ["--dxf-layers", ",".join(f"{role}={name}" for role, name in settings["dxf_layers"])]
    if settings.get("dxf_contour_only"):
        found.append("--dxf-contour-only")
    if settings.get("step_schema"):
        found += ["--schema", settings["step_schema"]]
    return found


def _option(name: str, value: Any) -> list[str]:
    flag = f"--{name.replace('_', '-')}"
    if isinstance(value, bool):
        return [flag] if value else []
    if isinstance(value, (list, tuple)):
        value = ("x" if name in _SIZES else ",").join(str(one) for one in value)
    return [flag, str(value)]


def wanted_features(document: Any) -> dict[str, str]:
    """The panels whose feature was changed in FreeCAD, by their names, with the one that is wanted."""
    return {one.PanelName: one.WantedFeature for one in panels_of(document) if one.WantedFeature != one.Feature}


def rules_of(document: Any, report: dict[str, Any]) -> dict[str, list[dict[str, Any]]]:
    """The rules that a delivery was made with, and the features that were changed in FreeCAD since."""
    settings = report["settings"]
    rules = dict(settings.get("rules") or {})
    names = [panel.PanelName for panel in panels_of(document)]
    features: dict[str, str] = {}
    for table in rules.pop("feature", []):
        patterns = [table["panels"]] if isinstance(table["panels"], str) else table["panels"]
        own = [name for name in names if any(fnmatch.fnmatchcase(name, pattern) for pattern in patterns)]
        features.update(dict.fromkeys(own, table["feature"]))
    features.update(wanted_features(document))
    tables = [
        {"panels": [name], "feature": feature} for name, feature in features.items() if feature != settings["feature"]
    ]
    return {**rules, "feature": tables} if tables else rules


def write_rules(path: str, rules: dict[str, list[dict[str, Any]]]) -> None:
    """Write a file of rules, as `cadpanel fit --rules` reads it: texts, numbers and lists of JSON are those of TOML."""
    tables = [
        "\n".join((f"[[{name}]]", *(f"{key} = {json.dumps(value)}" for key, value in table.items()), ""))
        for name, several in rules.items()
        for table in several
    ]
    Path(path).write_text("\n".join(tables), encoding="utf-8")


def write_faces(path: str, selection: Sequence[tuple[Any, Sequence[str]]]) -> int:
    """Write chosen faces, or all faces of chosen objects, as a .brep file in millimetres; how many there are.

    Raises:
        DeliveryMissing: none is chosen.
    """
    import Part

    faces: list[Any] = []
    for thing, names in selection:
        if not hasattr(thing, "Shape"):
            continue
        own = [thing.Shape.getElement(name) for name in names if name.startswith("Face")]
        placed = thing.getGlobalPlacement().multiply(thing.Placement.inverse())
        for face in own or thing.Shape.Faces:
            copy = face.copy()
            copy.Placement = placed.multiply(copy.Placement)
            faces.append(copy)
    if not faces:
        raise DeliveryMissing("Nothing with faces is chosen: choose faces or objects in the document, or name a file.")
    Part.Compound(faces).exportBrep(path)
    return len(faces)


def reference_near(folder: str, name: str) -> str | None:
    """The reference of a delivery where it is near its folder: in it, or in one of the three above it."""
    place = Path(folder).resolve()
    paths = [beside / name for beside in (place, *list(place.parents)[:3])]
    return next((str(path) for path in paths if path.is_file()), None)


def arguments_of(reference: str, out: str, options: str, rules: str | None = None) -> list[str]:
    """The words after `cadpanel` for a fit, every step told."""
    found = ["fit", reference, "--out", out, "--tell-steps", *shlex.split(options)]
    return [*found, "--rules", rules] if rules is not None else found


def quoted(options: Sequence[str]) -> str:
    """Options as one line that `shlex.split` takes apart again."""
    return " ".join(shlex.quote(option) for option in options)
