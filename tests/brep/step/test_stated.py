"""The kernel's reader hands on what files say of parts: every number, every attribute, and the material."""

from dataclasses import replace

import pytest
from OCP.TDF import TDF_LabelSequence
from OCP.XCAFDoc import XCAFDoc_DocumentTool, XCAFDoc_Material

from cadpanel.brep.building.sheet import build_skin, build_solid
from cadpanel.brep.files.step_reader import read_document
from cadpanel.brep.step.file import open_step, write_step
from cadpanel.brep.step.properties import Stated
from tests.said import ALL_ATTRIBUTES, SAID
from tests.shapes import random_panel

FAR = (8.3e8, -2.1e8, 1000.0)


@pytest.mark.parametrize("placed", [(0.0, 0.0, 0.0), FAR])
def test_all_that_is_said_of_a_solid_or_a_skin_comes_back(tmp_path, placed):
    panel = random_panel(1)
    bare = replace(SAID, validation=None, material=None, attributes={"mass": 1.0})
    shapes = [("süß", build_solid(panel, 3.0), None), ("skin", build_skin(panel), None), ("q", build_skin(panel), None)]
    write_step(tmp_path / "a.step", shapes, title="t", placed=placed, data=[SAID, SAID, bare])
    stated = open_step(tmp_path / "a.step", properties=True).stated()
    whole = Stated(area=1.5, volume=2.5, centroid=(1.0, 2.0, 3.0), attributes=ALL_ATTRIBUTES)
    assert stated == {"süß": whole, "skin": whole, "q": Stated(attributes={"mass": 1.0})}
    assert not any(one != Stated() for one in open_step(tmp_path / "a.step").stated().values())


def test_the_material_is_not_lost_among_attributes(tmp_path):
    write_step(tmp_path / "a.step", [("p", build_solid(random_panel(1), 3.0), None)], title="t", data=[SAID])
    step = read_document(tmp_path / "a.step", labels=True)
    labels = TDF_LabelSequence()
    XCAFDoc_DocumentTool.MaterialTool_s(step.document.Main()).GetMaterialLabels(labels)
    assert labels.Length() == 1
    material = XCAFDoc_Material()
    assert labels.Value(1).FindAttribute(XCAFDoc_Material.GetID_s(), material)
    assert material.GetName().ToCString() == "AlMg3"
    assert material.GetDensity() == pytest.approx(2660.0e-6)  # the kernel tells it in g/mm3
