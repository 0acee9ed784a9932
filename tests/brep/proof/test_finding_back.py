"""Two files through the kernel: solids find each other by where they lie, and what differs is measured."""

from __future__ import annotations

from pathlib import Path

import pytest
from OCP.BRepPrimAPI import BRepPrimAPI_MakeBox
from OCP.gp import gp_Pnt
from OCP.TopoDS import TopoDS_Shape

from cadpanel.brep.proof.finding_back import find_back
from tests.reference_shapes import write_products


def box(x: float, height: float = 3.0) -> TopoDS_Shape:
    return BRepPrimAPI_MakeBox(gp_Pnt(x, 0.0, 0.0), 400.0, 300.0, height).Shape()


def test_what_is_found_missing_and_strange_is_told_and_measured(tmp_path: Path) -> None:
    asked = []
    delivered = write_products(tmp_path / "panels.step", [("A", box(0.0)), ("B", box(1000.0)), ("C", box(2000.0))])
    other = write_products(tmp_path / "back.step", [("1", box(1000.0)), ("2", box(0.0, 3.03)), ("3", box(9000.0))])
    back = find_back(other, delivered, lambda: asked.append(1))
    assert [(one.name, one.called, one.valid) for one in back.found] == [("A", "2", True), ("B", "1", True)]
    thicker, same = back.found
    assert thicker.apart == pytest.approx(0.03, rel=1e-6)
    assert thicker.volume == pytest.approx(0.01, rel=1e-6)
    assert (same.apart, same.volume, same.area) == pytest.approx((0.0, 0.0, 0.0), abs=1e-9)
    assert (back.missing, back.strange) == (("C",), ("3",))
    assert len(asked) == 2
