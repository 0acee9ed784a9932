"""What is said of parts is written as receivers expect it: so many entities of each kind, no more, in their order."""

import io
from collections import Counter
from datetime import UTC, datetime, timedelta, timezone

import pytest

from cadpanel.brep.building.sheet import build_solid
from cadpanel.brep.step.products import Header, write_step_text
from cadpanel.brep.step.properties import ATTRIBUTES, PartData
from tests.said import SAID
from tests.shapes import random_panel


def entities(text):
    """How many instances of each simple kind a file has."""
    lines = text.partition("DATA;\n")[2].splitlines()
    return Counter(line.partition("=")[2].partition("(")[0] for line in lines if line.startswith("#"))


def written(data, schema="AP242", header=None):
    solid = build_solid(random_panel(1), 3.0)
    file = io.StringIO()
    shapes = [(f"P{i}", solid, None) for i in range(len(data))]
    write_step_text(file, shapes, "roof", schema, data=data, header=header)
    return file.getvalue()


@pytest.mark.parametrize("schema", ["AP242", "AP214"])
def test_every_property_is_so_many_entities_and_all_else_stays_as_it_was(schema):
    silent, said = entities(written([PartData(number="n")] * 2, schema)), entities(written([SAID] * 2, schema))
    texts = sum(measure == "text" for measure in ATTRIBUTES.values())
    properties = 2 * (3 + 2 + len(ATTRIBUTES))
    assert said - silent == Counter(
        {
            "PROPERTY_DEFINITION": properties,
            "PROPERTY_DEFINITION_REPRESENTATION": properties,
            "REPRESENTATION": properties,
            "MEASURE_REPRESENTATION_ITEM": 2 * (2 + 1 + len(ATTRIBUTES) - texts),
            "DESCRIPTIVE_REPRESENTATION_ITEM": 2 * (1 + texts),
            "CARTESIAN_POINT": 2,
            "GENERAL_PROPERTY": len(ATTRIBUTES),  # one for all parts
            "GENERAL_PROPERTY_ASSOCIATION": 2 * len(ATTRIBUTES),
            "DERIVED_UNIT": 3,
            "DERIVED_UNIT_ELEMENT": 4,
            "": 2,  # kilogram and metre
        }
    )
    assert not silent - said


def test_a_general_property_is_called_as_the_properties_that_it_stands_for():
    """The schema's rule WR2 of GENERAL_PROPERTY_ASSOCIATION."""
    instances = dict(line.split("=", 1) for line in written([SAID]).splitlines() if line.startswith("#"))
    pairs = [line.split("(")[1].rstrip(");").split(",")[2:] for line in instances.values() if "_ASSOCIATION(" in line]
    assert len(pairs) == len(ATTRIBUTES)
    for general, own in pairs:
        assert instances[general].split(",")[1] == instances[own].split("(")[1].split(",")[0]


def test_a_density_has_no_measure_that_the_schema_refuses_with_its_unit():
    assert "'density measure',NUMERIC_MEASURE(2660.0),#" in written([SAID])


def test_products_have_numbers_names_and_descriptions():
    assert "PRODUCT('roof/A-01','P0','plane-cone-plane, 3 mm',(" in written([SAID])


def test_the_header_tells_author_house_and_time_whatever_the_zone():
    at = datetime(2026, 11, 29, 12, 0, 0, tzinfo=timezone(timedelta(hours=2)))
    head = written([SAID], header=Header(date=at, author="Ö. Müller", organization="O'Hara"))
    assert "'2026-11-29T10:00:00+00:00',('\\X2\\00D6\\X0\\. M\\X2\\00FC\\X0\\ller'),('O''Hara')," in head
    assert "'2026-11-29T10:00:00+00:00',(''),('')," in written([SAID], header=Header(date=at.astimezone(UTC)))
