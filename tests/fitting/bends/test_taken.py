"""What was taken for which patch, and the user's word on it."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

import cadpanel as cp
from cadpanel.fitting.bends.asked import Blend, blends_of
from cadpanel.fitting.bends.taken import missed_blend, taken
from cadpanel.fitting.run import fit
from cadpanel.fitting.settings import FitSettings
from cadpanel.geometry.patches import ConePatch
from cadpanel.geometry.polyline import arc_length
from tests.instances import random_polygon
from tests.known_panels import alone, sampled
from tests.shapes import folded_panel, random_panel
from tests.thorough import thorough

# Millimetres.
RECOVERED = 1e-6

lengths = st.floats(0.5, 5000.0).map(lambda value: float(f"{value:g}"))
names = st.none() | st.text(min_size=1).map(str.strip).filter(bool)


@given(first=lengths, width=lengths, percent=st.booleans(), panel=names)
def test_a_blend_reads_as_it_is_written(first, width, percent, panel):
    last = float(f"{first + width:g}")
    if not first < last or (percent and last >= 100.0):
        with pytest.raises(cp.SettingsError):
            Blend(first=first, last=last, percent=percent, panel=panel)
        return
    blend = Blend(first=first, last=last, percent=percent, panel=panel)
    assert Blend.parse(str(blend)) == blend


@pytest.mark.parametrize(
    ("given_", "sentence"),
    [
        ("wide", "is a stretch across the panels like 410-540"),
        ("540-410", "must begin after side 0"),
        ("0-300", "must begin after side 0"),
        ("40-100%", "leave a flange on both sides"),
        ("-5-300", "is a stretch across"),
        (("300-400", "310-410"), "two blends are for all panels"),
        (("A=300-400", "A=310-410"), "two blends are for 'A'"),
        (7.0, "must be a word or Blend"),
        ((7.0,), "must be a word or Blend"),
    ],
)
def test_what_is_no_blend_is_refused(given_, sentence):
    with pytest.raises(cp.SettingsError, match=sentence):
        cp.fit(alone(random_panel(1)), blend=given_)


def test_blends_may_be_text_or_made_and_one_or_several():
    one = Blend(first=300.0, last=400.0)
    assert blends_of(None) == ()
    assert blends_of("300-400") == blends_of(one) == blends_of(["300-400"]) == (one,)
    assert [blend.panel for blend in blends_of(("300-400", "a=b=10-20%"))] == [None, "a=b"]


@pytest.mark.parametrize("seed", range(6))
def test_what_each_patch_of_a_known_panel_was_taken_from_is_where_its_rulings_end(seed):
    shape = random_panel(seed)
    panel = sampled(shape, shape.name)
    found = taken(panel, shape)
    for end in (0, 1):
        outline = arc_length(panel.ends[end])
        knots = [int(np.linalg.norm(panel.ends[end] - corner, axis=1).argmin()) for corner in shape.corners()[end]]
        assert found[end] == pytest.approx(outline[knots], abs=RECOVERED)


bends = st.builds(
    folded_panel,
    radius=st.floats(80.0, 400.0),
    sweep=st.floats(0.4, 1.5),
    widths=st.tuples(st.floats(100.0, 400.0), st.floats(100.0, 400.0)),
)


@settings(max_examples=5, deadline=None)
@given(shape=bends)
def test_telling_a_known_panel_where_its_bend_is_changes_nothing(shape):
    free, told = (fit(alone(shape), FitSettings(method="local", blend=how)) for how in ((), (own_blend(shape),)))
    assert np.abs(free.shapes[0].corners() - told.shapes[0].corners()).max() <= RECOVERED
    assert told.measures.overall_rms <= RECOVERED


@settings(max_examples=5, deadline=None)
@given(shape=bends)
def test_the_bend_goes_where_it_is_told_to(shape):
    own = own_blend(shape)
    grown = 0.25 * (own.last - own.first)
    blend = Blend(first=own.first - min(grown, 50.0), last=own.last + min(grown, 50.0), panel="panel 1")
    told = fit(alone(shape), FitSettings(method="local", blend=(blend,)))
    became = taken(sampled(shape, shape.name), told.shapes[0])
    # It turns over more of the panel, at a larger radius; and the measures do not hide what that costs.
    assert np.all(np.diff(became)[:, 1] > own.last - own.first)
    cone, known = told.shapes[0].patches[1], shape.patches[1]
    assert isinstance(cone, ConePatch)
    assert isinstance(known, ConePatch)
    assert cone.radius > known.radius
    assert told.measures.overall_rms > 100.0 * RECOVERED


@settings(max_examples=5, deadline=None)
@given(shape=bends, grown=st.floats(0.0, 0.15), aside=st.floats(0.3, 0.9))
def test_a_bend_that_is_not_where_it_was_told_to_be_is_told(shape, grown, aside):
    panel, own = sampled(shape, shape.name), own_blend(shape)
    width = own.last - own.first
    near = Blend(first=own.first - grown * width, last=own.last + grown * width)
    assert missed_blend(panel, shape, (near,)) is None
    assert missed_blend(panel, shape, ()) is None
    assert missed_blend(panel, shape, (replace(own, panel="another"),)) is None
    # Beside the bend, over a part of the flange before it.
    told = Blend(first=0.05 * own.first, last=aside * own.first)
    missed = missed_blend(panel, shape, (told,))
    assert missed is not None
    assert missed[0] == pytest.approx(np.array([[told.first, told.last]] * 2))
    assert missed[1] == pytest.approx(np.array([[own.first, own.last]] * 2), abs=2.0 * RECOVERED)


@thorough
def test_a_delivery_says_which_panels_bend_elsewhere_than_they_were_told_to(tmp_path):
    shape = folded_panel(radius=300.0, sweep=1.5, widths=(400.0, 400.0))
    for first, last, said in ((400.0, 850.0, 0), (700.0, 1000.0, 1)):
        result = cp.fit(alone(shape), method="local", blend=f"{first:g}-{last:g}")
        (panel,) = cp.deliver(result, tmp_path / f"{first:g}").panels
        notes = [note for note in panel.notes if note.startswith("Its bend was to be made of")]
        assert len(notes) == said


def own_blend(shape):
    """The stretch of a panel whose rulings are parallel, the same on both ends."""
    places = taken(sampled(shape, shape.name), shape)
    assert np.ptp(places, axis=0).max() <= RECOVERED
    return Blend(first=float(places[0, 1]), last=float(places[0, 2]))


@pytest.mark.parametrize(
    ("feature", "blend", "sentence"),
    [
        ("plane-cone-plane", "10-90000", "no second flange"),
        ("plane-cone-plane", "nobody=10-20", "there is no panel 'nobody'"),
        ("cone", "10-20", "no single bend between two flanges"),
        ("plane-cone-plane-cone-plane", "10-20", "no single bend between two flanges"),
        ("planar-polygon", "10-20", "no single bend between two flanges"),
    ],
)
def test_a_blend_that_does_not_suit_the_panels_is_refused(feature, blend, sentence):
    with pytest.raises(cp.SettingsError, match=sentence):
        cp.fit(alone(random_panel(1)), method="local", feature=feature, blend=blend)


def test_a_blend_and_automatic_features_contradict_each_other():
    with pytest.raises(cp.SettingsError, match="it is not known which panels have a blend"):
        cp.fit(alone(random_panel(1)), feature="auto", max_deviation=5.0, blend="10-20")


def test_polygons_are_taken_from_the_whole():
    shape = random_polygon(1, 5)
    assert not taken(sampled(shape, "five"), shape).size
