"""A third kind of panel is a class and an entry in each place that knows more than geometry: nothing else changes."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import cadpanel as cp
from cadpanel.brep.building.polygon_sheet import polygon_sheet, polygon_skin
from cadpanel.brep.building.sheet import sheet_faces, skin_faces
from cadpanel.delivery.records.from_shape import patch_models
from cadpanel.errors import PanelError
from cadpanel.features.polygon import Polygon
from cadpanel.fitting.start.begin import frames_and_numbers
from cadpanel.geometry.panel import Panel
from cadpanel.geometry.sheet_checks import check_buildable, other_face
from cadpanel.geometry.unroll import unroll_polygons, unroller
from cadpanel.geometry.volume import sheet_volume
from tests.known_panels import alone
from tests.third_kind import Regular, RegularShape, regular, start_regular

RECOVERED = 1e-9
CORNERS = 5
KNOWN = [regular(seed, CORNERS) for seed in range(3)]


def shape() -> RegularShape:
    known = KNOWN[0]
    return RegularShape(known.name, known.feature, known.outline, known.normal)


@pytest.fixture(scope="module")
def entries() -> None:
    """The entries of the third kind; nothing else in the tests is of it."""
    frames_and_numbers.register(Regular, start_regular)
    skin_faces.register(RegularShape, lambda panel: polygon_skin(panel.as_polygon()))
    sheet_faces.register(RegularShape, lambda near, far: polygon_sheet(near.as_polygon(), far.as_polygon()))
    patch_models.register(RegularShape, lambda panel: patch_models(panel.as_polygon()))
    unroller.register(RegularShape, lambda _: lambda shapes: unroll_polygons([one.as_polygon() for one in shapes]))


def test_where_a_kind_has_no_entry_the_place_says_so() -> None:
    class Unknown:
        def __getattr__(self, name: str) -> Any:
            return getattr(shape(), name)

    panel: Any = Unknown()
    for ask in (
        lambda: skin_faces(panel),
        lambda: sheet_faces(panel, panel),
        lambda: patch_models(panel),
        lambda: frames_and_numbers(panel, panel),
        lambda: unroller(panel),
    ):
        with pytest.raises(TypeError, match="register one for its class"):
            ask()


def test_geometry_takes_it_as_it_is() -> None:
    panel: Panel = shape()
    check_buildable(panel, 3.0)
    assert sheet_volume(panel, 3.0) == pytest.approx(3.0 * panel.area(), rel=1e-12)
    assert other_face(panel, 3.0, "outer").corners() - panel.corners() == pytest.approx(
        np.broadcast_to(-3.0 * shape().normal, (1, CORNERS, 3)), abs=1e-9
    )
    assert panel.straightened().shape is panel


@pytest.mark.usefixtures("entries")
def test_it_is_fitted_delivered_and_proved(tmp_path: Path) -> None:
    result = cp.fit(alone(*KNOWN), feature=Regular(CORNERS))
    for found, known in zip(result.shapes, KNOWN, strict=True):
        assert isinstance(found, RegularShape)
        assert found.outline == pytest.approx(known.outline, abs=RECOVERED)
    report = cp.deliver(result, tmp_path / "out")
    assert cp.verify(tmp_path / "out").holds
    assert [panel.feature for panel in report.panels] == 3 * ["regular"]
    assert report.panels[0].area == pytest.approx(KNOWN[0].area(), rel=1e-9)


def test_a_panel_with_other_corners_than_its_feature_is_refused() -> None:
    with pytest.raises(PanelError, match=r"panel 1.*it has 5 corners in 'known', and its feature 'planar-polygon' 6"):
        cp.fit(alone(*KNOWN), feature=Polygon(6))
    assert cp.fit(alone(*KNOWN), feature=Polygon(5)).measures.max_deviation.max() <= RECOVERED
