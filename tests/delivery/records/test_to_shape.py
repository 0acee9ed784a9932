"""A report's record gives the panel back that it was made of."""

from typing import Any

import numpy as np
import pytest

from cadpanel.delivery.records.from_shape import patch_models, rows, ruling_models, vector
from cadpanel.delivery.records.report import PanelModel
from cadpanel.delivery.records.to_shape import recorded_shape
from cadpanel.errors import DeliveryError
from cadpanel.geometry.patches import ConePatch
from cadpanel.geometry.shape import PanelShape, PolygonShape
from cadpanel.geometry.sheet_checks import check_buildable
from tests.chains import FEATURES
from tests.flat_panels import panels
from tests.joined import leaning, quadrilaterals
from tests.shapes import random_panel, walk

DEPTH = -3.0  # mm, where the sheet's other face lies
CLOSE = 1e-9  # mm


def recorded(shape: Any, depth: float = DEPTH) -> PanelModel:
    """The part of a panel's record that tells of its shape."""
    points, normals = shape.cuts()
    return PanelModel.model_construct(
        blank=object(),
        mass=1.0,
        name=shape.name,
        feature=shape.feature,
        corners=rows(shape.corners()),
        other_face=rows(shape.offset(depth).corners()),
        patches=patch_models(shape),
        rulings=ruling_models(shape),
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
        again: Any = recorded_shape(recorded(shape), DEPTH)
        if isinstance(shape, PolygonShape):
            assert again.outline == pytest.approx(shape.outline)
            assert again.offset(5.0).outline == pytest.approx(shape.offset(5.0).outline, abs=CLOSE)
            continue
        assert_same(again, shape)
        assert again.normals == pytest.approx(shape.rulings()[2], abs=1e-10)


@pytest.mark.parametrize("half_angle", [-0.05, -1e-5, 0.0, 1e-5, 0.05])
@pytest.mark.parametrize("concave", [False, True])
def test_cones_that_widen_either_way_and_bend_either_way_come_back(half_angle, concave):
    for chain in ("plane-cone-plane", "cone", "plane-cone-cone-plane", "cone-plane-cone"):
        shape = random_panel(3, chain=chain, half_angle=half_angle, concave=concave)
        again: Any = recorded_shape(recorded(shape), DEPTH)
        assert_same(again, shape)
        assert np.abs(again.normals - shape.normals).max() < 1e-10


@pytest.mark.parametrize("depth", [-3.0, 20.0])
def test_panels_whose_walls_lean_come_back(depth):
    chain = random_panel(5, chain="plane-cone-plane")
    walls = {edge: leaning(chain, edge, 8.0, lean) for edge, lean in (("side 0", 0.2), ("side 1", -0.1))}
    cut = chain.cut_back(walls, depth)
    assert np.abs(cut.side_leans).min() > 0.05
    again: Any = recorded_shape(recorded(cut, depth), depth)
    assert_same(again, cut)
    assert again.side_leans == pytest.approx(cut.side_leans, abs=1e-10)
    for polygon in quadrilaterals():
        one = polygon.cut_back({f"edge {i}": leaning(polygon, f"edge {i}", 5.0, 0.1 * i) for i in range(4)}, depth)
        other: Any = recorded_shape(recorded(one, depth), depth)
        assert other.posts == pytest.approx(one.posts, abs=1e-10)
        assert other.offset(5.0).outline == pytest.approx(one.offset(5.0).outline, abs=CLOSE)


@pytest.mark.parametrize("radius", [1e3, 1e5, 1e7])
def test_cones_that_are_all_but_flat_and_far_away_can_be_built_of_their_record(radius):
    sweep = 900.0 / radius
    patches: list[Any] = [ConePatch(radius=radius, half_angle=1e-5 * k, sweep=sweep) for k in (1, -2, 1)]
    direction, normal = (np.linalg.qr(np.random.default_rng(7).normal(size=(3, 3)))[0][:, k] for k in (0, 1))
    points, directions, normals = walk(
        patches, [(0.0, 0.0)] * 3, np.array([600_000.0, -80_000.0, 9000.0]), direction, normal
    )
    middle, ends = points.mean(axis=0), np.array([[-1500.0], [1500.0]])
    shape = PanelShape(
        name="A-01",
        feature="cone-spline",
        points=points,
        directions=directions,
        normals=normals,
        patches=tuple(patches),
        cut_points=middle + ends * direction,
        cut_normals=np.array([direction, direction]),
    )
    again: Any = recorded_shape(recorded(shape), DEPTH)
    check_buildable(again, -DEPTH)
    assert again.corners() == pytest.approx(shape.corners(), abs=CLOSE)


def test_a_record_of_an_older_version_is_refused() -> None:
    record = recorded(random_panel(1))
    for update in (
        {"blank": None},
        {"mass": None},
        {"cuts": ()},
        {"cuts": record.cuts[:1]},
        {"other_face": ()},
        {"rulings": ()},
    ):
        with pytest.raises(DeliveryError, match="panel 'A-01' without its rulings, cuts, blank, mass or other face"):
            recorded_shape(record.model_copy(update=update), DEPTH)
