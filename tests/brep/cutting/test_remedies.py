"""What is said where a cut fails: what is known, and what would help only where it has been seen to."""

import pytest

from cadpanel.brep.cutting import by_length, lip_band, ways
from cadpanel.brep.cutting.remedies import other_ways
from cadpanel.brep.kernel.shapes import compound_of
from cadpanel.brep.read import read_reference
from cadpanel.brep.splitting.splitter import UncutError
from cadpanel.errors import NoStripError, OverlapError, PanelError, ReferenceFileError
from cadpanel.reference.settings import ReferenceSettings
from tests.cuts import model_of, panels_of
from tests.knife_edges import aerofoil_faces
from tests.model_files import strip_faces, write_shape


def test_panel_that_reaches_round_a_knife_edge_is_called_so(tmp_path):
    path = write_shape(tmp_path / "wing.brep", compound_of(aerofoil_faces((0.0, 5000.0))))
    with pytest.raises(PanelError, match=r"in 'wing.brep', two of its corners lie on each other: its sides meet in"):
        read_reference(path, ReferenceSettings(unit="mm", divide=5))


@pytest.mark.parametrize(
    ("works", "end"), [((7,), r"\); into 7 panels it can be cut\.$"), ((5,), r"\); into 5 pan"), ((), r"\)\.$")]
)
def test_another_number_of_panels_is_named_only_where_it_can_be_cut(monkeypatch, works, end):
    cut = by_length.cut_lengths

    def stubborn(surface, how, source, tolerance):
        if how.count not in works:
            raise UncutError("The CAD kernel cannot split face 1 of 'roof.step' (it gives up).")
        return cut(surface, how, source, tolerance)

    monkeypatch.setattr(ways, "cut_lengths", stubborn)
    with pytest.raises(ReferenceFileError, match=end):
        panels_of(model_of(*strip_faces()), divide=6)


@pytest.mark.parametrize(
    ("works", "end"), [((270.0,), "; a band of 270 mm can be cut"), ((), "it, nor are bands of nearly that width")]
)
def test_another_width_of_a_band_is_named_only_where_it_can_be_cut(monkeypatch, works, end):
    cut = lip_band._band

    def stubborn(surface, width, source, tolerance):
        if width not in works:
            raise lip_band._UncutError("The kernel does not cut it")
        return cut(surface, width, source, tolerance)

    monkeypatch.setattr(lip_band, "_band", stubborn)
    with pytest.raises(ReferenceFileError, match=end):
        panels_of(model_of(*strip_faces()), divide=6, lip=300.0)


def test_what_can_be_divided_without_a_band_is_said_to(monkeypatch):
    def edgeless(*_arguments):
        raise NoStripError("The surface is no strip that could be divided along its length.")

    monkeypatch.setattr(by_length, "lip_band", edgeless)
    with pytest.raises(ReferenceFileError, match="all of it can be divided: leave the band out"):
        panels_of(model_of(*strip_faces()), divide=6, lip=300.0)


def test_panels_that_were_cut_here_are_not_to_be_deleted():
    error = OverlapError("A", "roof.step", "a part of it covers panel 'B'", "trim or delete one of the two")
    assert str(error).endswith("trim or delete one of the two.")
    said = str(error.of_a_cut())
    assert "delete" not in said
    assert said.endswith("both were cut from its skin, which comes so close to itself there.")


def test_what_was_tried_in_vain_is_said_and_no_more(tmp_path, monkeypatch):
    tried = []

    def read(_path, how):
        tried.append(how)
        raise NoStripError("The surface is none")

    monkeypatch.setattr("cadpanel.brep.read._read", read)
    with pytest.raises(NoStripError, match=r"is none: dividing it into 5 and a grid of 3x2 do not help\.$"):
        read_reference(tmp_path / "roof.step", ReferenceSettings(divide=4, lip=300.0, unit="m"))
    assert [(how.divide, how.grid, how.lip, how.unit) for how in tried[1:]] == [
        (5, None, None, "m"),
        (None, (3, 2), None, "m"),
    ]


@pytest.mark.parametrize(
    "how",
    [
        {"divide": 4},
        {"divide": "auto"},
        {"panel_length": 900.0},
        {"panel_size": (900.0, 500.0)},
        {"grid": (1, 1)},
        {"stations": (500.0,)},
    ],
)
def test_at_most_two_other_ways_are_tried_and_neither_is_the_one_asked_for(how):
    settings = ReferenceSettings(unit="mm", **how)
    others = other_ways(settings)
    assert 1 <= len(others) <= 2
    assert all(
        other.settings not in (settings, *(one.settings for one in others if one is not other)) for other in others
    )


@pytest.mark.parametrize("how", [{}, {"network": "lines.step"}, {"mesh": "mesh.obj"}])
def test_nobody_draws_other_curves(how):
    assert other_ways(ReferenceSettings(unit="mm", **how)) == ()


def test_a_large_grid_is_not_refused_at_the_price_of_several():
    asked = ReferenceSettings(unit="mm", grid=(8, 8))
    tried = [other.settings.grid for other in other_ways(asked) if other.settings.grid]
    assert tried
    assert sum(u * v for u, v in tried) <= 1.5 * 64
    assert len(other_ways(ReferenceSettings(unit="mm", grid=(1, 2)))) == 2
