"""The certificate holds for what was delivered and fails for anything that was changed afterwards."""

import threading
import time
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from OCP.BRepBuilderAPI import BRepBuilderAPI_NurbsConvert
from OCP.gp import gp_Trsf, gp_Vec
from OCP.STEPCAFControl import STEPCAFControl_Writer
from OCP.STEPControl import STEPControl_AsIs
from OCP.TCollection import TCollection_ExtendedString
from OCP.TDataStd import TDataStd_Name
from OCP.TDocStd import TDocStd_Document
from OCP.TopLoc import TopLoc_Location
from OCP.XCAFDoc import XCAFDoc_DocumentTool

from cadpanel.brep.isolation import client
from cadpanel.brep.proof import parallel
from cadpanel.brep.proof.expected import ExpectedSeam
from cadpanel.brep.proof.inspection import Inspector, inspect_packed
from cadpanel.brep.step.file import write_step
from cadpanel.errors import DeliveryError
from tests.certified import GAP, SEAMS, Delivery, strip
from tests.shapes import folded_panel, random_panel

pytestmark = pytest.mark.usefixtures("forked_readers")

# A second interpreter whose kernel crashes over a file of one name.
DIES = """
import os
from cadpanel.brep import server
from cadpanel.brep.proof import inspection

read = inspection.open_step


def crash(path, **how):
    if path.name == {name!r}:
        os.abort()
    return read(path, **how)


inspection.open_step = crash
server.main()
"""


@pytest.fixture
def delivery(tmp_path):
    return Delivery(tmp_path, strip())


def shifted(shape, distance):
    motion = gp_Trsf()
    motion.SetTranslation(gp_Vec(0.0, 0.0, distance))
    return shape.Moved(TopLoc_Location(motion))


def test_an_untouched_delivery_holds(delivery):
    found = delivery.certify()
    assert found.failures == ()
    assert found.holds
    assert (found.solids, found.skins) == (3, 3)
    assert found.valid
    assert found.names_kept
    assert found.face_kinds == {"plane": 24, "cone": 0, "cylinder": 6, "other": 0}
    assert found.max_tangency_error < 1e-11
    assert found.volume_error < 1e-12
    assert found.max_corner_error < 1e-9
    assert found.seam_gaps == pytest.approx([GAP, GAP], abs=1e-9)
    assert found.max_seam_gap == pytest.approx(GAP, abs=1e-9)


def test_cones_concave_panels_and_other_chains_hold(tmp_path):
    shapes = [
        random_panel(1, name="A"),
        random_panel(2, name="B", concave=True),
        random_panel(3, name="C", chain="plane-cone-cone-plane"),
        random_panel(4, name="D", chain="plane"),
        random_panel(5, name="E", half_angle=1e-7),
    ]
    found = Delivery(tmp_path, shapes).certify(seams=())
    assert found.failures == ()
    assert found.max_tangency_error < 1e-11
    assert found.volume_error < 2e-12
    assert found.max_seam_gap == 0.0


@pytest.mark.parametrize("files", [("solids",), ("skins",), ("solids", "skins")])
def test_a_panel_moved_by_a_hundredth_of_a_millimetre_fails(delivery, files):
    for file in files:
        shapes = getattr(delivery, file)
        shapes["P1"] = shifted(shapes["P1"], 0.01)
    delivery.write()
    found = delivery.certify()
    assert not found.holds
    assert any("P1" in failure and "0.01 mm" in failure for failure in found.failures)


@pytest.mark.parametrize("file", ["solids", "skins"])
def test_a_renamed_panel_fails(delivery, file):
    shapes = getattr(delivery, file)
    shapes["Q1"] = shapes.pop("P1")
    delivery.write()
    found = delivery.certify()
    assert not found.names_kept
    assert f"Panel 'P1' is missing among the {file}." in found.failures
    assert f"Panel 'Q1' is among the {file} but is not expected there." in found.failures


@pytest.mark.parametrize("file", ["solids", "skins"])
def test_a_missing_panel_fails(delivery, file):
    del getattr(delivery, file)["P2"]
    delivery.write()
    found = delivery.certify()
    assert not found.names_kept
    assert any("'P2' is missing" in failure for failure in found.failures)


def test_a_panel_delivered_twice_fails(delivery):
    solids = [(name, shape, None) for name, shape in delivery.solids.items()]
    write_step(delivery.panels_step, [*solids, solids[0]], title="panels")
    assert not delivery.certify().names_kept


def test_a_face_that_became_a_spline_fails(delivery):
    spline = BRepBuilderAPI_NurbsConvert(delivery.solids["P1"]).Shape()
    document = TDocStd_Document(TCollection_ExtendedString("XmlXCAF"))
    tool = XCAFDoc_DocumentTool.ShapeTool_s(document.Main())
    root = tool.NewShape()
    for name, shape in {**delivery.solids, "P1": spline}.items():
        label = tool.AddShape(shape, False)
        TDataStd_Name.Set_s(label, TCollection_ExtendedString(name))
        tool.AddComponent(root, label, TopLoc_Location())
    tool.UpdateAssemblies()
    writer = STEPCAFControl_Writer()
    assert writer.Transfer(document, STEPControl_AsIs)
    writer.Write(str(delivery.panels_step))
    found = delivery.certify()
    assert found.face_kinds["other"] > 0
    assert any("P1" in failure and "other" in failure for failure in found.failures)


def test_a_kink_between_two_patches_fails(tmp_path):
    # The smallest kink that counts, set into the file itself: a plane's normal turned by 1e-7 rad.
    delivery = Delivery(tmp_path, [folded_panel(name="P0", chain="pp", widths=(200.0, 200.0), turns=(0.0, 0.0))])
    assert delivery.certify(seams=()).holds
    text = delivery.skins_step.read_text()
    assert text.count("DIRECTION('',(0.0,0.0,1.0))") == 1
    position = text.rindex("=PLANE(")
    placement = text[text.index("#", position + 1) + 1 :].split(")")[0]
    line = next(row for row in text.splitlines() if row.startswith(f"#{placement}="))
    number = len(text.splitlines()) + 1000
    origin, normal, along = line.split("(''")[1].strip(",);").split(",")
    turned = line.replace(f"{normal},{along}", f"#{number},{along}")
    extra = f"{turned}\n#{number}=DIRECTION('',(0.0,1.0E-07,1.0));"
    delivery.skins_step.write_text(text.replace(line, extra))
    found = delivery.certify(seams=())
    assert origin
    assert found.max_tangency_error == pytest.approx(1e-7, rel=1e-3)
    assert any("kink of 1e-07 rad" in failure for failure in found.failures)


def test_a_wrong_volume_fails(delivery):
    delivery.expected[1] = replace(delivery.expected[1], volume=delivery.expected[1].volume * (1.0 + 2e-9))
    assert any("'P1'" in failure and "volume" in failure for failure in delivery.certify().failures)


def test_a_seam_wider_than_stated_fails(delivery):
    tighter = [replace(SEAMS[0], gap=GAP - 2e-4), SEAMS[1]]
    assert delivery.certify([replace(SEAMS[0], gap=GAP - 5e-5)]).holds
    [failure] = delivery.certify(tighter).failures
    assert failure == "Seam 'P0' to 'P1': the gap is 0.25 mm, 0.2498 mm are stated."


def test_a_seam_of_an_unknown_panel_fails(delivery):
    found = delivery.certify([ExpectedSeam(panels=("P0", "P9"), edges=("end 1", "end 0"))])
    assert not found.holds
    assert found.seam_gaps == (np.inf,)


def test_a_solid_where_a_skin_should_be_fails(delivery):
    delivery.skins["P1"] = delivery.solids["P1"]
    delivery.write()
    assert any("'P1': its skin holds 1 shells and 1 solids" in failure for failure in delivery.certify().failures)


def test_a_second_interpreter_finds_the_same(delivery, monkeypatch):
    alone = delivery.certify()
    monkeypatch.setattr(parallel, "WORTHWHILE_BYTES", 0)
    monkeypatch.setattr(parallel, "processors", lambda: 2)
    assert delivery.certify() == alone


def test_a_second_interpreter_started_ahead_finds_the_same(delivery, monkeypatch):
    alone = delivery.certify()
    monkeypatch.setattr(parallel, "processors", lambda: 2)
    with parallel.second_interpreter(parallel.WORTHWHILE_PANELS) as helper:
        assert helper is not None
        helper.begin(delivery.skins_step)
        assert delivery.certify(helper=helper) == alone


@pytest.mark.parametrize("together", [False, True])
@pytest.mark.parametrize("file", ["panels_step", "skins_step"])
def test_an_interpreter_that_dies_over_a_file_is_one_sentence(delivery, forks, monkeypatch, file, together):
    name = getattr(delivery, file).name
    client.stop_reader()
    monkeypatch.setattr(client, "interpreter", lambda _: forks(DIES.format(name=name)))
    monkeypatch.setattr(parallel, "processors", lambda: 2)
    monkeypatch.setattr(parallel, "WORTHWHILE_BYTES", 0 if together else 1 << 40)
    with pytest.raises(DeliveryError, match=rf"'{name}' makes the CAD kernel crash: it is damaged; write the delivery"):
        delivery.certify()
    client.stop_reader()
    monkeypatch.undo()
    assert delivery.certify().holds


# One that takes minutes to read any file.
SLOW = """
import time
from cadpanel.brep import server
from cadpanel.brep.proof import inspection

inspection.open_step = lambda path, **how: time.sleep(600.0)
server.main()
"""


class Told:
    """A file whose shapes are numbers, and their facts, too; notes who was asked for what."""

    def __init__(self, count, helped=None):
        self.count, self.helped, self.asked = count, helped, []

    def facts(self, places):
        self.asked += places
        return [place * place for place in places]

    def ask(self, work, argument=None):
        if work == "inspect":
            return self.facts(argument)
        if work == "close":
            self.helped.set()  # only now may the helper begin
        return argument


@pytest.mark.parametrize("count", [0, 1, 15, 16, 17, 100])
def test_the_shapes_of_a_file_are_each_inspected_once_by_one_of_two(count):
    work: Any = parallel._Work(parallel.unheard)
    own, other = Told(count, threading.Event()), Told(count)
    work._helped.set()
    work.do(own, own.count)
    work.end()
    assert own.helped.is_set()
    work.help(other)
    assert work.facts() == [place * place for place in range(count)]
    assert sorted(own.asked + other.asked) == list(range(count))
    assert len(other.asked) == min(count, parallel.AHEAD * parallel.CHUNK)


def test_a_file_is_inspected_alone_where_the_helper_never_has_time():
    work: Any = parallel._Work(parallel.unheard)
    own = Told(100, threading.Event())
    work.do(own, own.count)
    assert own.asked == list(range(100))


def test_a_file_that_was_written_again_is_read_again(delivery):
    inspector = Inspector()
    assert inspector.open(delivery.panels_step) == 3
    del delivery.solids["P1"]
    delivery.write()
    assert inspector.open(delivery.panels_step) == 2
    assert [facts.name for facts in inspector.facts(delivery.panels_step, [0, 1])] == ["P0", "P2"]


def test_shapes_that_were_packed_have_the_same_facts(delivery):
    inspector = Inspector()
    inspector.open(delivery.panels_step)
    (there,) = inspect_packed(inspector.pack(delivery.panels_step, [1]))
    (here,) = inspector.facts(delivery.panels_step, [1])
    assert (there.name, there.volume, there.face_kinds) == (here.name, here.volume, here.face_kinds)
    np.testing.assert_array_equal(there.vertices, here.vertices)


@pytest.mark.parametrize("file", ["panels_step", "skins_step"])
def test_a_file_cut_short_cannot_be_certified(delivery, file, monkeypatch):
    monkeypatch.setattr(parallel, "WORTHWHILE_BYTES", 0)
    path = getattr(delivery, file)
    path.write_text(path.read_text()[:5000])
    with pytest.raises(DeliveryError, match="cannot be read"):
        delivery.certify()


def test_files_that_are_read_ahead_give_the_same_and_are_read_again_for_who_asks_again(delivery, monkeypatch):
    alone = delivery.certify()
    monkeypatch.setattr(parallel, "processors", lambda: 2)
    with parallel.second_interpreter(parallel.WORTHWHILE_PANELS) as helper:
        assert helper is not None
        helper.open(delivery.panels_step)
        assert delivery.certify(helper=helper) == alone
        del delivery.solids["P1"]
        delivery.write()
        assert not delivery.certify(helper=helper).holds


@pytest.mark.parametrize("taken", [False, True])
@pytest.mark.parametrize("late", [0.0, 0.3])
def test_a_file_that_is_read_ahead_for_nobody_is_given_up(delivery, forks, monkeypatch, late, taken):
    client.stop_reader()
    ask = client.Interpreter.ask

    def ask_late(interpreter, request):
        time.sleep(late)  # s: it is given up before it was asked for
        return ask(interpreter, request)

    monkeypatch.setattr(client.Interpreter, "ask", ask_late)
    monkeypatch.setattr(client, "interpreter", lambda _: forks(SLOW))
    monkeypatch.setattr(parallel, "processors", lambda: 2)
    with parallel.second_interpreter(parallel.WORTHWHILE_PANELS) as helper:
        assert helper is not None
        opened = helper.open(delivery.panels_step)
        if taken:  # by one that is stopped while it waits
            assert helper.take_opened(delivery.panels_step) is opened
    with pytest.raises(DeliveryError):
        opened.result()
    client.stop_reader()
    monkeypatch.undo()
    assert delivery.certify().holds
