"""What stands around the geometry of a STEP file is that which was asked for, and anything else is told."""

import pytest

from cadpanel.brep.building.sheet import build_solid
from cadpanel.brep.step.file import write_step
from cadpanel.brep.step.frame_checks import Part, frame_faults
from cadpanel.brep.step.properties import Material, PartData
from cadpanel.brep.step.schemas import SCHEMAS
from tests.shapes import folded_panel

TITLE = "Größe d'or panels"
PARTS = [Part("Größe/A", "A"), Part("Größe/B'2", "B'2", "plane, 3 mm")]
MATERIALS = [Material(name="AlMg3", density=2660.0)]


@pytest.fixture(scope="module")
def text(tmp_path_factory):
    path = tmp_path_factory.mktemp("frame") / "panels.step"
    solids = [(name, build_solid(folded_panel(name=name), 3.0), (0.5, 0.5, 0.5)) for _, name, _ in PARTS]
    data = [
        PartData(number=part.number, description=part.description, material=material)
        for part, material in zip(PARTS, (None, *MATERIALS), strict=True)
    ]
    write_step(path, solids, title=TITLE, data=data)
    return path.read_text(encoding="ascii")


def faults(tmp_path, text, parts=None, schema="AP242"):
    path = tmp_path / "panels.step"
    path.write_text(text, encoding="ascii")
    return list(frame_faults(path, TITLE, PARTS if parts is None else parts, schema, materials=MATERIALS))


def test_what_was_written_holds(tmp_path, text):
    assert faults(tmp_path, text) == []


@pytest.mark.parametrize("schema", SCHEMAS)
def test_every_schema_is_told_by_its_name(tmp_path, schema):
    path = tmp_path / "panels.step"
    write_step(path, [("A", build_solid(folded_panel(name="A"), 3.0), None)], title="T", schema=schema)
    for other in SCHEMAS:
        assert (list(frame_faults(path, "T", [Part("A", "A")], other)) == []) is (other == schema)


@pytest.mark.parametrize(
    ("old", "new", "says"),
    [
        ("LENGTH_MEASURE(1.E-07)", "LENGTH_MEASURE(10.)", "does not say once that its accuracy is 1e-07 mm"),
        ("AP242_MANAGED", "AP214_MANAGED", "does not say once that its schema is AP242"),
        ("'A','A',", "'A','Z',", "holds no product 'A'"),
        (",'A','',#", ",'Z','',#", "are not the panels, each once"),
        (
            "=PRODUCT('Gr",
            "=PRODUCT('','A','',$);#9=PRODUCT('Gr",
            "with the part number '' that says ''",
        ),
        ("3 mm'", "9 mm'", "that says 'plane, 9 mm', which is not expected"),
        ("(''),(''),", "('Somebody'),(''),", "does not say once that it is from '' of ''"),
        ("(0.,0.,1.)", "(0.,0.001,1.)", "does not begin with the origin"),
        (",.T.);\n", ",.F.);\n", "has edges that run against their curves"),
        ("NUMERIC_MEASURE(2660.", "NUMERIC_MEASURE(2669.", "does not say of every panel what it is made of"),
        ("('AlMg3','AlMg3')", "('Steel','Steel')", "does not say of every panel what it is made of"),
    ],
)
def test_what_was_changed_is_told(tmp_path, text, old, new, says):
    if old == "'A','A',":
        old, new = "/A','A',", "/A','Z',"
    assert old in text
    assert any(says in fault for fault in faults(tmp_path, text.replace(old, new, 1)))


def test_a_part_that_hangs_twice_or_elsewhere_is_told(tmp_path, text):
    lines = [line for line in text.splitlines() if "=NEXT_ASSEMBLY_USAGE_OCCURRENCE(" in line]
    parts = [line.rsplit(",", 2)[1] for line in lines]
    twice = text.replace(lines[1], lines[1].replace(f",{parts[1]},$", f",{parts[0]},$"))
    assert "A part hangs twice" in "".join(faults(tmp_path, twice))


def test_a_panel_that_is_missing_and_one_too_many_are_told(tmp_path, text):
    assert "which is not expected there" in "".join(faults(tmp_path, text, PARTS[:1]))
    assert "holds no product 'C'" in "".join(faults(tmp_path, text, [*PARTS, Part("Größe/C", "C")]))
    assert "schema is AP214" in "".join(faults(tmp_path, text, schema="AP214"))
