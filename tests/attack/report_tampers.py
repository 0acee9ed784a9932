"""Tampering of a report: every kind of value in it, changed once; and what only people would think of."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

Content = Any
Change = Callable[[Content], None]


def of_values(content: Content) -> dict[str, Change]:
    """By the path of its keys, one change of every kind of value in a report: another number, word or length."""
    found: dict[str, Change] = {}
    for steps, value in _places(content, ()):
        if value is not None or _named(steps) not in found:  # the last one that says something
            found[_named(steps)] = _changing(steps)
    return found


def _places(content: Content, steps: tuple[str | int, ...]) -> Iterator[tuple[tuple[str | int, ...], Content]]:
    items = content.items() if isinstance(content, dict) else enumerate(content) if isinstance(content, list) else ()
    if steps:
        yield steps, content
    for key, value in items:
        yield from _places(value, (*steps, key))


def _named(steps: tuple[str | int, ...]) -> str:
    """The path with what counts or names panels, seams, edges and files left out."""
    words = ["*" if isinstance(step, int) else re.sub(r"^(end|side|edge) \d+$", "*", step) for step in steps]
    return re.sub(r"(\.\*)+$", ".*", ".".join(words))


def _changing(steps: tuple[str | int, ...]) -> Change:
    def change(content: Content) -> None:
        holder = content
        for step in steps[:-1]:
            holder = holder[step]
        holder[steps[-1]] = other(holder[steps[-1]])

    return change


def other(value: Content) -> Content:
    """Another value of the same kind."""
    if isinstance(value, bool):
        return not value
    if isinstance(value, int):
        return value + 1
    if isinstance(value, float):
        return value * 1.01 + 0.01
    if isinstance(value, str):
        return f"{value}x"
    if isinstance(value, list):
        return value[:-1] if value else ["x"]
    if isinstance(value, dict):
        return dict(list(value.items())[1:]) if value else {"x": 1.0}
    return 1.0


def _put(*steps: str | int, value: Any) -> Change:
    def change(content: Content) -> None:
        holder = content
        for step in steps[:-1]:
            holder = holder[step]
        holder[steps[-1]] = value(holder[steps[-1]]) if callable(value) else value

    return change


def _all_normals_turned(content: Content) -> None:
    for panel in content["panels"]:
        for patch in panel["patches"]:
            for key in ("normal", "axis"):
                if key in patch:
                    patch[key] = [-part for part in patch[key]]


def _no_seams(content: Content) -> None:
    content["seams"], content["reference"]["seams"] = [], 0


def _no_last_panel(content: Content) -> None:
    gone = content["panels"].pop()["name"]
    content["seams"] = [seam for seam in content["seams"] if gone not in seam["panels"]]
    content["reference"] |= {"panels": len(content["panels"]), "seams": len(content["seams"])}


def _a_cone_called_a_cylinder(content: Content) -> None:
    cone = next(ruling for ruling in content["panels"][0]["rulings"] if ruling["half_angle"])
    cone["half_angle"] = 0.0


def _all_rulings_moved(content: Content) -> None:
    for panel in content["panels"]:
        for ruling in panel["rulings"]:
            ruling["point"][2] += 1.0


def _everything_moved(content: Content) -> None:
    """All coordinates of one panel, together, by 5 mm: a report that agrees with itself, beside the files."""
    panel = content["panels"][0]
    for row in (*panel["corners"], *panel["other_face"], *panel["fitted"]["corners"]):
        for corner in row:
            corner[2] += 5.0
    for ruling in (*panel["rulings"], *panel["fitted"]["rulings"]):
        ruling["point"][2] += 5.0


BY_HAND: dict[str, Change] = {
    "all normals turned": _all_normals_turned,
    "all seams left out": _no_seams,
    "the last panel left out": _no_last_panel,
    "a panel's normal of length 0": _put("panels", 0, "patches", 0, "normal", value=[0.0, 0.0, 0.0]),
    "thickness 4 for 3": _put("settings", "thickness", value=4.0),
    "the skin on the other side": _put("settings", "skin_side", value="inner"),
    "walls square instead of bevelled": _put("settings", "ends", value="square"),
    "moved by 1 mm": _put("panels", 0, "moved", value=1.0),
    "area times 10": _put("panels", 0, "area", value=lambda area: 10.0 * area),
    "volume by 1e-6": _put("panels", 0, "volume", value=lambda volume: volume * (1.0 + 1e-6)),
    "kinks 0": _put("seams", 0, "max_kink", value=0.0),
    "names of two panels exchanged": lambda content: _exchange(content["panels"][0], content["panels"][1], "name"),
    "an empty name": _put("panels", 0, "name", value=""),
    "rulings moved": _all_rulings_moved,
    "rulings left out": _put("panels", 0, "rulings", value=[]),
    "a panel moved in all its numbers": _everything_moved,
    "a cone called a cylinder": _a_cone_called_a_cylinder,
    "a bend of a plane": _put("panels", 0, "rulings", 0, "radius", value=500.0),
    "a joint of 12 for 10": _put("settings", "joint", value=12.0),
    "no joint": _put("settings", "joint", value=0.0),
    "another schema of STEP": _put("settings", "step_schema", value="AP214"),
    "the origin moved": _put("origin", "offset", value=[1000.0, 0.0, 0.0]),
    "the origin not kept": _put("origin", "kept", value=False),
    "outputs left out": _put("settings", "outputs", value=[]),
    "another material": _put("settings", "material", value="lead"),
    "another density": _put("settings", "density", value=11340.0),
    "the tolerance not met": _put("summary", "tolerance_met", value=False),
    "a failure in the certificate": _put("certificate", "failures", value=["x"]),
    "another schema": _put("schema", value="cadpanel.report/2"),
    "inches": _put("units", "length", value="in"),
}


def _exchange(one: Content, other_one: Content, key: str) -> None:
    one[key], other_one[key] = other_one[key], one[key]


def edited(path: Path, change: Change) -> None:
    """Change a file of JSON."""
    content = json.loads(path.read_text(encoding="utf-8"))
    change(content)
    path.write_text(json.dumps(content), encoding="utf-8")
