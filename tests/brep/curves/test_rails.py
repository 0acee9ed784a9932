"""Curves of a file become rails, exactly, by number, name or layer."""

from dataclasses import replace

import cadquery as cq
import numpy as np
import pytest

from cadpanel.brep.curves.rails import FileCurve, FileCurves, chosen_rails, read_curves
from cadpanel.errors import LoftError
from cadpanel.lofting.rail import Rail, stretch_through


def line(number, name="", layer="", start=0.0):
    points = np.array([[start, 10.0 * number, 0.0], [start + 100.0, 10.0 * number, 0.0]])
    return FileCurve(number=number, name=name, layer=layer, stretches=(stretch_through(points),))


FOUND = FileCurves(
    source="lines.step",
    curves=(line(1, "eave", "L"), line(2, "ridge"), line(3, layer="far"), line(3, layer="far", start=100.0)),
    notes=(),
    origin=(0.0, 0.0, 0.0),
)


def test_an_arc_a_spline_and_a_polyline_are_read_as_they_are(tmp_path):
    arc = cq.Edge.makeThreePointArc(cq.Vector(100, 0, 0), cq.Vector(60, 80, 0), cq.Vector(0, 100, 0))
    spline = cq.Edge.makeSpline([cq.Vector(*point) for point in ((0, 0, 50), (50, 20, 60), (100, 0, 50))])
    cq.Compound.makeCompound([arc, spline]).exportBrep(str(tmp_path / "curves.brep"))
    found = read_curves(tmp_path / "curves.brep", None)
    rails = [Rail("rail", curve.stretches) for curve in found.curves]
    assert len(rails) == 2
    share = np.linspace(0.0, 1.0, 21)
    assert np.abs(np.linalg.norm(rails[0].at(share).point, axis=1) - 100.0).max() < 1e-9
    assert rails[1].length == pytest.approx(spline.Length(), rel=1e-5)


def test_rails_are_named_by_number_name_or_layer():
    one, other = chosen_rails(FOUND, ["eave", "layer=far"])
    assert (one.length, other.length) == pytest.approx((100.0, 200.0))
    assert chosen_rails(FOUND, ["2", "1"])[0].at(np.zeros(1)).point[0, 1] == pytest.approx(20.0)


@pytest.mark.parametrize(
    ("names", "said"),
    [
        ([], "holds 4 curves: say which two"),
        (["eave"], "name two curves, not 1"),
        (["eave", "1"], "cannot be both rails"),
        (["eave", "rigde"], "perhaps 'ridge' is meant"),
        (["eave", "layer=fra"], "perhaps 'layer=far'"),
    ],
)
def test_what_is_not_there_is_refused(names, said):
    with pytest.raises(LoftError, match=said):
        chosen_rails(FOUND, names)


def test_one_curve_alone_is_no_loft_however_it_is_named():
    for names in ([], ["1", "2"]):
        with pytest.raises(LoftError, match=r"holds one curve, .*: export the other one"):
            chosen_rails(replace(FOUND, curves=FOUND.curves[:1]), names)
