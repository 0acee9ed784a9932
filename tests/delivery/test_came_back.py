"""A file that came back from another program: solids are found by where they lie, and what differs is told."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from OCP.TopLoc import TopLoc_Location

from cadpanel.brep.proof.returned_solids import Solids, pairs_by_place
from cadpanel.brep.step.file import read_step_shapes
from cadpanel.delivery.came_back import check_returned
from cadpanel.delivery.deliver import deliver
from cadpanel.delivery.shop_settings import ShopSettings
from cadpanel.errors import CadpanelError
from tests.attack.solid_tampers import Shape, as_splines, drilled, moved
from tests.delivered import fitted
from tests.reference_shapes import write_products


@pytest.fixture(scope="module")
def delivery(tmp_path_factory: pytest.TempPathFactory) -> Path:
    out = tmp_path_factory.mktemp("came_back") / "out"
    deliver(fitted(), out, shop=ShopSettings(outputs=("step",)))
    return out


@pytest.fixture(scope="module")
def shapes(delivery: Path) -> list[Shape]:
    return [shape.Located(TopLoc_Location()) for _, shape in read_step_shapes(delivery / "panels.step")]


def test_renamed_in_another_order_and_in_inches_all_solids_are_found(
    delivery: Path, shapes: list[Shape], tmp_path: Path
) -> None:
    file = write_products(tmp_path / "back.step", [(f"Body {k}", shapes[k]) for k in (2, 0, 1)], unit="INCH")
    found = check_returned(file, delivery)
    assert found.failures == ()
    assert [(one.name, one.called) for one in found.solids] == [(f"N {k + 1}", f"Body {k}") for k in range(3)]
    assert all(0.0 <= one.apart <= 1e-6 and abs(one.volume) <= 1e-9 for one in found.solids)


def test_what_is_missing_strange_moved_or_drilled_is_named(delivery: Path, shapes: list[Shape], tmp_path: Path) -> None:
    panels = fitted().shapes
    there = [moved(0.1)(shapes[0], panels[0]), drilled(10.0)(shapes[1], panels[1]), moved(9e4)(shapes[2], panels[2])]
    file = write_products(tmp_path / "back.step", [(f"N {k + 1}", shape) for k, shape in enumerate(there)])
    said = check_returned(file, delivery).failures
    assert said[0] == "Panel 'N 3' is missing in 'back.step'."
    assert said[1] == "'back.step' holds a solid 'N 3' that was not delivered."
    assert "Panel 'N 1' lies up to 0.15 mm off." in said
    assert any(fault.startswith("Panel 'N 2' has a volume that differs by -") for fault in said)
    assert len(said) == 6  # a hole is off the solid, too


def test_splines_in_the_place_of_cones_are_the_same_solid(delivery: Path, shapes: list[Shape], tmp_path: Path) -> None:
    there = [as_splines(shape, panel) for shape, panel in zip(shapes, fitted().shapes, strict=True)]
    file = write_products(tmp_path / "back.step", [(f"N {k + 1}", shape) for k, shape in enumerate(there)])
    assert check_returned(file, delivery).failures == ()


def test_a_delivery_that_is_none_or_was_changed_is_refused(delivery: Path, tmp_path: Path) -> None:
    with pytest.raises(CadpanelError, match="is no delivery"):
        check_returned(delivery / "panels.step", tmp_path)
    with pytest.raises(CadpanelError, match="holds no solids"):
        check_returned(delivery / "skins.step", delivery)


def test_each_solid_serves_once_and_the_nearest_comes_first() -> None:
    def solids(*places: float) -> Solids:
        ones = np.ones(len(places))
        return Solids(centroids=np.array([[x, 0.0, 0.0] for x in places]), volumes=ones, areas=1e4 * ones)

    assert pairs_by_place(solids(0.0, 1.0), solids(0.9, 0.2, 50.0)) == {1: 0, 0: 1}
    assert pairs_by_place(solids(0.0), solids(0.2, 0.1)) == {0: 1}
