"""`cadpanel loft` from a file with two curves to files that are read back; what is warped is told by the exit code."""

from pathlib import Path

import cadquery as cq
import ezdxf
import numpy as np
import pytest

import cadpanel as cp
from cadpanel.brep.building.loft_skin import build_loft
from cadpanel.brep.proof.archive import kept_areas
from cadpanel.brep.proof.loft_facts import loft_facts
from cadpanel.delivery import loft_files
from cadpanel.delivery.pictures.loft import draw_loft
from cadpanel.delivery.records.loft import read_loft
from cadpanel.errors import LoftError, ProofError
from tests.known_rails import CONE, CYLINDER, TWISTED, curve, rails
from tests.thorough import thorough


@pytest.fixture(scope="module")
def file(tmp_path_factory):
    """Two ellipses over each other, which no common cone has."""
    share = np.linspace(0.0, 1.5, 31)
    low = np.stack([900.0 * np.cos(share), 700.0 * np.sin(share), 0.0 * share], axis=-1)
    high = np.stack([500.0 * np.cos(share), 550.0 * np.sin(share), 600.0 + 100.0 * share], axis=-1)
    edges = [cq.Edge.makeSpline([cq.Vector(*point) for point in line.tolist()]) for line in (low, high)]
    path = tmp_path_factory.mktemp("rails") / "rails.brep"
    cq.Compound.makeCompound(edges).exportBrep(str(path))
    return path


def test_a_loft_is_written_and_read_back(run, file, tmp_path):
    answer = run("loft", file, "1", "2", "--unit", "mm", "--out", tmp_path / "loft", "--quiet")
    assert (answer.code, answer.out) == (0, "")
    assert {path.name for path in (tmp_path / "loft").iterdir()} == {
        *("loft.step", "loft.dxf", "loft.FCStd", "loft.json", "loft.png", "manifest.json")
    }
    record = read_loft(tmp_path / "loft" / "loft.json")
    assert record.exact
    assert record.max_warp < 1e-3
    facts = loft_facts(tmp_path / "loft" / "loft.step")
    assert (facts.valid, facts.faces) == (True, record.proof.faces)
    assert facts.area == pytest.approx(record.flat.area, rel=1e-6)
    kept = kept_areas(tmp_path / "loft" / "loft.FCStd")
    assert kept["Surface.bin"] == pytest.approx(record.flat.area, rel=1e-6)
    assert kept["FlatPattern.bin"] == pytest.approx(record.proof.drawn_area, rel=1e-6)
    drawing = ezdxf.filemanagement.readfile(tmp_path / "loft" / "loft.dxf")
    assert not drawing.audit().errors
    assert {entity.dxf.layer for entity in drawing.modelspace()} == {"CUT", "ROLL"}
    # What stands there is ours, so it may be replaced; and a rail that there is not leaves it alone.
    assert run("loft", file, "1", "3", "--out", tmp_path / "loft", "--overwrite").code == 2
    assert read_loft(tmp_path / "loft" / "loft.json") == record


@thorough
def test_a_cone_and_a_cylinder_are_delivered_as_such(tmp_path):
    level = [curve(CONE[0], 0.0, 1.5), curve(CONE[1], 0.0, 1.5)]
    assert cp.deliver_loft(cp.loft(*level), tmp_path / "cone").proof.faces == ("cone",)
    # A fan at its beginning, and the cylinder behind it.
    fanned = cp.loft(*rails(CYLINDER, second=(0.2, 1.5)))
    assert cp.deliver_loft(fanned, tmp_path / "cylinder").proof.faces == ("ruled", "cylinder")


def test_a_loft_with_too_much_warp_is_written_and_says_so(tmp_path):
    surface = cp.loft(*rails(TWISTED))
    record = cp.deliver_loft(surface, tmp_path / "twisted", max_warp=1.0)
    assert not record.tolerance_met
    assert not record.exact
    worst = max(record.pieces, key=lambda piece: piece.max_warp)
    assert record.max_warp >= worst.max_warp > 1.0
    assert len(draw_loft(surface).axes) == 3


def test_what_is_read_back_otherwise_is_not_delivered(tmp_path, monkeypatch):
    surface, other = (cp.loft(*rails(known)) for known in (CYLINDER, CONE))
    monkeypatch.setattr(loft_files, "build_loft", lambda _: build_loft(other))
    with pytest.raises(ProofError, match="holds cone, expected cylinder"):
        cp.deliver_loft(surface, tmp_path / "wrong")
    assert not Path(tmp_path / "wrong").exists()


def test_the_program_s_rails_are_those_of_the_file(file):
    one, other = cp.rails(file, unit="mm")
    assert one.length > other.length > 500.0


@thorough
def test_rails_that_no_surface_fits_are_delivered_all_the_same_with_their_warp(tmp_path, monkeypatch):
    random = np.random.default_rng(8)
    along = np.linspace(0.0, 1000.0, 6)[:, None]
    low, high = (np.concatenate([along, random.normal(0.0, 60.0, (6, 2)) + up], axis=1) for up in (0.0, 500.0))
    surface = cp.loft(low, high)
    record = cp.deliver_loft(surface, tmp_path / "wild")
    assert record.max_warp > 5.0
    assert record.proof.area == pytest.approx(record.flat.area, rel=1e-4)
    # As if it were warped by more than a right angle, and its flat pattern lay upon itself.
    monkeypatch.setattr(loft_files, "_TURNED_OVER", 0.0)
    monkeypatch.setattr(loft_files, "arc_contour_area", lambda _: 0.5 * record.flat.area)
    with pytest.raises(LoftError, match=r"turns over .* at \(.*\) mm it is warped by \d+ degrees; draw rails"):
        cp.deliver_loft(surface, tmp_path / "folded")
    assert not (tmp_path / "folded").exists()
