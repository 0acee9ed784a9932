"""What was built from the numbers of a record is known by its boundary; what was not, is built anew."""

from cadpanel.brep.building.wanted import Sheet
from cadpanel.brep.proof.rebuilding import rebuild
from cadpanel.brep.proof.rebuilt import Rebuilt
from cadpanel.brep.proof.same_boundaries import same_boundaries
from cadpanel.delivery.built_already import built_already
from cadpanel.delivery.settings import SheetSettings
from cadpanel.delivery.sheets import build_panels
from cadpanel.delivery.shop_settings import ShopSettings
from tests.instances import random_polygon
from tests.shapes import folded_panel, moved

SHAPE = folded_panel(half_angle=0.2)
SHEET = SheetSettings()


def test_what_is_known_is_what_building_anew_makes():
    panels = build_panels([SHAPE], SHEET).panels
    known = built_already(panels, [SHAPE])[SHAPE.name]
    (anew,) = rebuild([Sheet(shape=SHAPE, thickness=SHEET.thickness, skin_side=SHEET.skin_side)])
    assert isinstance(anew, Rebuilt)
    assert same_boundaries([known.solid, known.skin], [anew.solid, anew.skin]).all()


def test_a_record_of_another_panel_is_built_anew():
    assert not built_already(build_panels([SHAPE], SHEET).panels, [moved(SHAPE, (0.0, 0.0, 1e-5))])


def test_polygons_and_sheets_with_holes_are_built_anew():
    polygon = random_polygon(7, 5)
    assert not built_already(build_panels([polygon], SHEET).panels, [polygon])
    drilled = ShopSettings(fixings=(5.0, 200.0, 20.0))
    (panel,) = build_panels([SHAPE], SHEET, shop=drilled).panels
    assert panel.fixings is not None
    assert not built_already([panel], [panel.shape])
