"""The two XML files of a document: whatever names hold, they are read as XML and tell it again."""

from __future__ import annotations

import xml.etree.ElementTree as ElementTree
from dataclasses import replace
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cadpanel.delivery.document import xml
from cadpanel.delivery.document.objects import (
    AnyProperty,
    Body,
    Choice,
    Group,
    Lines,
    Look,
    Number,
    Place,
    Property,
    Sheet,
    Words,
    Yes,
)
from cadpanel.delivery.document.xml import document_xml, gui_xml, quoted
from cadpanel.delivery.schedule.csv_text import Row

PANELS = Group(name="Panels", label="Panels")
BODY = Body(name="Panel1", label="N", parent="Panels", file="panel1.bin", look=Look(faces=(1.0, 0.5, 0.0)))


@settings(max_examples=50)
@given(st.text())
def test_every_text_is_told_again_but_for_what_xml_cannot_hold(text: str) -> None:
    found = ElementTree.fromstring(f"<A b={quoted(text)}/>".encode("utf-8", errors="strict")).get("b")
    assert found is not None
    assert len(found) == len(text)
    assert all(a == b or (b == "_" and not a.isprintable()) for a, b in zip(text, found, strict=True))


def test_groups_name_what_stands_in_them_and_come_before_it() -> None:
    root = ElementTree.fromstring(document_xml("a <&> b", [PANELS, BODY]))
    assert [link.get("value") for link in root.iter("Link")] == ["Panel1"]
    assert [one.get("Name") for one in root.iter("Dep")] == ["Panel1"]
    assert [(one.get("type"), one.get("name")) for one in root.findall("Objects/Object")] == [
        ("App::DocumentObjectGroup", "Panels"),
        ("Part::Feature", "Panel1"),
    ]
    assert root.find("Properties/Property/String").get("value") == "a <&> b"  # type: ignore[union-attr]
    assert [part.get("file") for part in root.iter("Part")] == ["panel1.bin"]


def test_properties_are_told_with_their_types_values_and_whether_they_may_be_changed() -> None:
    heading = {"group": "g", "tip": "t"}
    told: list[AnyProperty] = [
        Number(name="A", kind="Length", value=0.1, **heading),
        Words(name="B", value='"N"', **heading),
        Lines(name="C", value=("x", "y"), **heading),
        Yes(name="D", value=True, **heading),
        Place(name="E", value=(1.0, 2.0, 3.0), **heading),
        Choice(name="F", options=("cone", "plane"), value="plane", **heading),
    ]
    root = ElementTree.fromstring(document_xml("", [replace(BODY, parent=None, properties=told)]))
    own = {one.get("name"): one for one in root.iter("Property") if one.get("group") == "g"}
    assert {name: (one.get("type"), one.get("ro")) for name, one in own.items()} == {
        "A": ("App::PropertyLength", "1"),
        "B": ("App::PropertyString", "1"),
        "C": ("App::PropertyStringList", "1"),
        "D": ("App::PropertyBool", "1"),
        "E": ("App::PropertyVector", "1"),
        "F": ("App::PropertyEnumeration", "0"),
    }
    values = {name: [dict(leaf.attrib) for leaf in one.iter() if leaf is not one] for name, one in own.items()}
    assert values["A"] == [{"value": "0.1"}]
    assert values["B"] == [{"value": '"N"'}]
    assert values["C"][1:] == [{"value": "x"}, {"value": "y"}]
    assert values["D"] == [{"value": "true"}]
    assert values["E"] == [{"valueX": "1.0", "valueY": "2.0", "valueZ": "3.0"}]
    assert values["F"][0] == {"value": "1", "CustomEnum": "true"}
    assert values["F"][2:] == [{"value": "cone"}, {"value": "plane"}]


def test_a_property_of_an_unknown_kind_is_refused() -> None:
    unknown: Any = [Property(name="A", group="g", tip="t")]
    strange = replace(BODY, parent=None, properties=unknown)
    with pytest.raises(TypeError, match="nobody has said how a property like"):
        document_xml("", [strange])


def test_cells_keep_texts_as_texts_and_numbers_as_numbers() -> None:
    rows: list[Row] = [["panel", None, ""], ["=A1", 1.5, 2], [*[None] * 26, "27th", "28th"]]
    root = ElementTree.fromstring(document_xml("", [Sheet(name="S", label="S", cells=rows)]))
    cells = {one.get("address"): one.get("content") for one in root.iter("Cell")}
    assert cells == {"A1": "'panel", "A2": "'=A1", "B2": "1.5", "C2": "2", "AA3": "'27th", "AB3": "'28th"}
    assert [one.get("address") for one in root.iter("Cell") if one.get("style") == "bold"] == ["A1"]


def test_looks_are_told_in_the_order_of_the_objects() -> None:
    hidden = replace(BODY, name="Skin1", look=Look(visible=False, lines=(0.0, 0.0, 1.0), line_width=3.0))
    root = ElementTree.fromstring(gui_xml([PANELS, BODY, hidden], "Camera {\n}\n"))
    looks = {one.get("name"): one for one in root.iter("ViewProvider")}
    assert list(looks) == ["Panels", "Panel1", "Skin1"]
    assert [one.get("expanded") for one in looks.values()] == ["1", "0", "0"]
    colors = {one.get("name"): leaf.get("value") for one in looks["Panel1"].iter("Property") for leaf in one}
    assert colors["ShapeColor"] == str(0xFF800000)
    assert colors["Visibility"] == "true"
    shown = {one.get("name"): leaf.get("value") for one in looks["Skin1"].iter("Property") for leaf in one}
    assert (shown["Visibility"], shown["LineColor"], shown["LineWidth"]) == ("false", str(0x0000FF00), "3.0")
    assert root.find("Camera").get("settings") == "Camera {\n}\n"  # type: ignore[union-attr]
    assert xml.HEAD.encode() in gui_xml([], "")
