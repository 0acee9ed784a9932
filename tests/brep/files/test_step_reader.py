"""One reader for all who read STEP files: panels, labelled parts and the proof see the same products in one order."""

import pytest

from cadpanel.brep.building.sheet import build_solid
from cadpanel.brep.files.loading import load_model
from cadpanel.brep.files.step import read_products
from cadpanel.brep.files.step_reader import StepFault, read_document
from cadpanel.brep.files.xcaf import parts_of
from cadpanel.brep.kernel.shapes import faces_of
from cadpanel.brep.splitting.splitter import area_of
from cadpanel.brep.step.file import read_step_shapes, write_step
from tests.named_products import nested
from tests.shapes import random_panel


def areas(shapes):
    """Of each shape its faces' areas."""
    return [[area_of(face) for face in faces_of(shape)] for shape in shapes]


def test_panels_parts_and_the_proof_see_the_same_shapes(tmp_path):
    path = nested(tmp_path / "nested.step")
    products, model, proven = read_products(path).shapes, load_model(path), read_step_shapes(path, heal=True)
    assert model.panel_names() == tuple(product.name for product in products)
    assert {name for name, _ in proven} == {part.product for part in model.parts}
    expected = areas(product.shape for product in products)
    assert len(expected) == 6
    for other in ([part.shape for part in model.parts], [shape for _, shape in proven]):
        assert [pytest.approx(row, rel=1e-9) for row in areas(other)] == expected


def test_the_proof_keeps_names_that_a_program_might_have_made_up(tmp_path):
    names = ["Face 1", "NAUO2", " a "]
    write_step(tmp_path / "a.step", [(name, build_solid(random_panel(1), 3.0), None) for name in names], title="t")
    assert [name for name, _ in read_step_shapes(tmp_path / "a.step")] == names
    assert [product.name for product in read_products(tmp_path / "a.step").shapes][2] == "a"


def test_colours_are_left_out_where_labels_do_not_matter(tmp_path):
    path = tmp_path / "colored.step"
    write_step(path, [("p", build_solid(random_panel(1), 3.0), (1.0, 0.0, 0.0))], title="t")
    found = [parts_of(read_document(path, labels=labels).document)[0].label.color for labels in (True, False)]
    assert found == ["#ff0000", ""]


def test_a_file_that_breaks_off_is_a_fault(tmp_path):
    (tmp_path / "a.step").write_text("ISO-10303-21;\nHEADER;\n")
    with pytest.raises(StepFault):
        read_document(tmp_path / "a.step", labels=False)
