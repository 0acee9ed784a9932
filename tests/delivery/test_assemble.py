"""Deliveries of regions hang in one assembly, each where it lies in the model; what cannot hang there is refused."""

import shutil

import pytest

from cadpanel.brep.step.file import read_step_shapes
from cadpanel.delivery.assemble import assemble
from cadpanel.delivery.deliver import deliver
from cadpanel.delivery.outputs.step_files import PANELS
from cadpanel.delivery.own_files import REPORT
from cadpanel.delivery.records.report import OriginModel, read_report, write_report
from cadpanel.delivery.shop_settings import ShopSettings
from cadpanel.errors import DeliveryError
from tests.delivered import fitted_alone

FAR = (8.3e8, -2.1e8, 0.0)


@pytest.fixture(scope="module")
def regions(tmp_path_factory):
    """The same delivery as three regions: the second one far away, the third with coordinates of the model."""
    place = tmp_path_factory.mktemp("building")
    deliver(fitted_alone(), place / "one", shop=ShopSettings(outputs="step"))
    report = read_report(place / "one" / REPORT)
    for name, kept in (("two", False), ("three", True)):
        shutil.copytree(place / "one", place / name)
        far = report.model_copy(update={"origin": OriginModel(kept=kept, offset=FAR)})
        write_report(far, place / name / REPORT)
    return place


def test_regions_hang_where_they_lie_in_the_model(regions):
    assemble([regions / name for name in ("one", "two", "three")], regions / "building.step")
    found = read_step_shapes(regions / "building.step")
    alone = [name for name, _ in read_step_shapes(regions / "one" / PANELS)]
    assert [name for name, _ in found] == 3 * alone
    places = [shape.Location().Transformation().TranslationPart().Coord() for _, shape in found]
    assert places == [(0.0, 0.0, 0.0)] * 3 + [FAR] * 3 + [(0.0, 0.0, 0.0)] * 3


def test_what_cannot_hang_there_is_refused(regions, tmp_path):
    shutil.copytree(regions / "one", tmp_path / "one")
    with pytest.raises(DeliveryError, match=r"2 deliveries are called 'one', which 'b\.step' cannot tell apart"):
        assemble([regions / "one", tmp_path / "one"], tmp_path / "b.step")
    (tmp_path / "one" / PANELS).unlink()
    with pytest.raises(DeliveryError, match=r"holds no panels\.step to hang in 'b\.step'"):
        assemble([tmp_path / "one"], tmp_path / "b.step")
    report = read_report(regions / "two" / REPORT)
    other = report.model_copy(update={"settings": report.settings.model_copy(update={"step_schema": "AP214"})})
    shutil.copytree(regions / "two", tmp_path / "two")
    write_report(other, tmp_path / "two" / REPORT)
    with pytest.raises(DeliveryError, match=r"'b\.step' cannot hold AP214, AP242: choose one"):
        assemble([regions / "one", tmp_path / "two"], tmp_path / "b.step")
    with pytest.raises(DeliveryError, match="cannot hold no delivery"):
        assemble([], tmp_path / "b.step")
    assert not (tmp_path / "b.step").exists()
