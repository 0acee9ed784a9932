"""A report's record gives the panel back that it was made of."""

from typing import Any

import numpy as np
import pytest

from cadpanel.delivery.records.from_shape import patch_models, vector
from cadpanel.delivery.records.report import PanelModel
from cadpanel.delivery.records.to_shape import recorded_shape
from cadpanel.errors import DeliveryError
from cadpanel.geometry.patches import ConePatch
from cadpanel.geometry.shape import PolygonShape
from tests.chains import FEATURES
from tests.flat_panels import panels
from tests.shapes import random_panel

CLOSE = 1e-8  # mm; of a slender cone the apex lies kilometres away


def recorded(shape: Any) -> PanelModel:
    """The part of a panel's record that tells of its shape."""
    points, normals = shape.cuts()
    return PanelModel.model_construct(
        blank=object(),
        mass=1.0,
        name=shape.name,
        feature=shape.feature,
        corners=tuple(tuple(vector(corner) for corner in row) for row in shape.corners()),
        patches=patch_models(shape),
        cuts=tuple(
            type("Cut", (), {"normal": vector(normal), "offset": float(point @ normal)})
            for point, normal in zip(points, normals, strict=True)
        ),
    )


def assert_same(one: Any, other: Any) -> None:
    assert one.corners() == pytest.approx(other.corners(), abs=CLOSE)
    assert one.offset(5.0).corners() == pytest.approx(other.offset(5.0).corners(), abs=CLOSE)
    assert len(one.patches) == len(other.patches)
    for first, second in zip(one.patches, other.patches, strict=True):
        assert first.kind == second.kind or (first.kind, second.kind) == ("cylinder", "cone")
        if isinstance(second, ConePatch):
            assert isinstance(first, ConePatch)
            assert first.half_angle == pytest.approx(second.half_angle, abs=1e-12)
            assert first.sweep == pytest.approx(second.sweep, abs=1e-12)
    assert one.offset(-1.5).area() == pytest.approx(other.offset(-1.5).area(), rel=1e-11)


@pytest.mark.parametrize("name", sorted(FEATURES))
def test_panels_of_every_feature_come_back(name):
    for shape in panels(name, 9)[:2]:
        again: Any = recorded_shape(recorded(shape))
        if isinstance(shape, PolygonShape):
            assert again.outline == pytest.approx(shape.outline)
            continue
        assert_same(again, shape)
        assert again.normals == pytest.approx(shape.rulings()[2], abs=1e-10)


@pytest.mark.parametrize("half_angle", [-0.05, -1e-5, 0.0, 1e-5, 0.05])
@pytest.mark.parametrize("concave", [False, True])
def test_cones_that_widen_either_way_and_bend_either_way_come_back(half_angle, concave):
    for chain in ("plane-cone-plane", "cone", "plane-cone-cone-plane", "cone-plane-cone"):
        shape = random_panel(3, chain=chain, half_angle=half_angle, concave=concave)
        again: Any = recorded_shape(recorded(shape))
        assert_same(again, shape)
        assert np.abs(again.normals - shape.normals).max() < 1e-10


def test_a_record_of_an_older_version_is_refused() -> None:
    record = recorded(random_panel(1))
    for update in ({"blank": None}, {"mass": None}, {"cuts": ()}, {"cuts": record.cuts[:1]}):
        with pytest.raises(DeliveryError, match="panel 'A-01' without its blank, mass or cuts"):
            recorded_shape(record.model_copy(update=update))
