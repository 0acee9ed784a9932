"""Pictures without a screen: not blank, other ones by other colours and views, and refused in one sentence."""

import io
from itertools import combinations

import numpy as np
import pytest
from matplotlib.image import imread

from cadpanel.delivery.pictures import colours
from cadpanel.delivery.pictures.colours import COLOURS, rounded_up
from cadpanel.delivery.pictures.figure import png_bytes
from cadpanel.delivery.pictures.files import scene_of_page, write_picture
from cadpanel.delivery.pictures.flat import draw_flat
from cadpanel.delivery.pictures.model import draw_model, feature_colours
from cadpanel.delivery.pictures.seam import draw_seam
from cadpanel.delivery.pictures.views import VIEWS
from cadpanel.errors import DeliveryError, SettingsError
from tests.pages import NAMES, delivery, scene, write_page


def pixels(figure):
    figure.set_dpi(50)
    picture = np.asarray(imread(io.BytesIO(png_bytes(figure)), format="png"), dtype=np.float64)[..., :3]
    assert picture.std() > 0.02
    return picture


def different(one, other):
    return one.shape != other.shape or np.abs(one - other).max() > 0.2


def test_each_colour_is_another_picture_of_the_same_panels():
    found = {color: pixels(draw_model(scene(), color)) for color in COLOURS}
    assert all(different(found[one], found[other]) for one, other in combinations(COLOURS, 2))


def test_each_view_is_another_picture():
    found = {view: pixels(draw_model(scene(), "feature", view)) for view in VIEWS}
    assert all(different(found[one], found[other]) for one, other in combinations(VIEWS, 2))


@pytest.mark.filterwarnings("ignore:Glyph")
def test_a_seam_and_a_flat_pattern_are_drawn_under_names_that_look_like_formulas():
    assert different(pixels(draw_seam(scene().seams[0])), pixels(draw_seam(scene().seams[1])))
    pixels(draw_flat(delivery().parts[0].pattern))
    assert feature_colours(scene()) == {"plane-cone-plane": colours.CATEGORIES[0]}


def test_a_page_becomes_a_picture_in_a_file(tmp_path):
    page = write_page(tmp_path)
    assert [panel.name for panel in scene_of_page(page).panels] == list(NAMES)
    write_picture(page, tmp_path / "step.png", "step", "north")
    assert (tmp_path / "step.png").read_bytes().startswith(b"\x89PNG")
    with pytest.raises(DeliveryError, match=r"none/step\.png' cannot be written: No such file"):
        write_picture(page, tmp_path / "none" / "step.png", "step", "north")


@pytest.mark.parametrize(
    ("value", "end"), [(0.0, 1.0), (2.99, 3.0), (3.0, 3.0), (21.7, 25.0), (0.011, 0.015), (9.1, 10.0)]
)
def test_scales_end_at_round_numbers(value, end):
    assert rounded_up(value) == pytest.approx(end)


def test_what_cannot_be_drawn_is_refused_with_what_can(monkeypatch):
    with pytest.raises(SettingsError, match="panels cannot be coloured by 'red'; choose from deviation, gap"):
        draw_model(scene(), "red")  # type: ignore[arg-type]
    with pytest.raises(SettingsError, match="nothing can be seen from 'below'; choose from outside, north"):
        draw_model(scene(), "gap", "below")  # type: ignore[arg-type]
    monkeypatch.setattr(colours, "find_spec", lambda _: None)
    with pytest.raises(SettingsError, match=r"install it with pip install 'cadpanel\[plot\]'"):
        draw_seam(scene().seams[0])
