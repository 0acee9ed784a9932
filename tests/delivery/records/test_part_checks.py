"""What a report says of parts is worked out again from the panels, and the schedule from what it says."""

from dataclasses import replace

import pytest

from cadpanel.delivery.contents import Contents
from cadpanel.delivery.outputs.output import Delivery
from cadpanel.delivery.outputs.schedule import SCHEDULE, Schedule
from cadpanel.delivery.records.part_checks import part_faults
from cadpanel.delivery.shop_settings import ShopSettings
from cadpanel.errors import DeliveryError
from tests.flat_parts import SHEET, strip_records

SHOP = ShopSettings(stock=((2000.0, 1650.0),))
SLOTS = ("title", "sheet", "shop", "records", "seams", "parts")


def contents():
    records, seams, parts = strip_records(SHOP)
    return Contents(title="strip", sheet=SHEET, shop=SHOP, records=records, seams=seams, parts=parts)


def faults(told):
    return part_faults(told.records, told.parts, told.shop.density)


def changed(told, **update):
    return replace(told, records=(told.records[0].model_copy(update=update), *told.records[1:]))


def test_what_was_written_holds_and_any_other_byte_does_not(tmp_path):
    told = contents()
    Schedule().write(tmp_path, Delivery(panels=(), **{name: getattr(told, name) for name in SLOTS}))
    proof = Schedule().prove(tmp_path, told)
    assert proof.failures == ()
    assert proof.numbers == {"panels": 3}
    data = (tmp_path / SCHEDULE).read_bytes()
    (tmp_path / SCHEDULE).write_bytes(data.replace(b"plane-cone", b"plane-Cone", 1))
    assert Schedule().prove(tmp_path, told).failures == ("'schedule.csv' is not what the report's numbers make.",)
    (tmp_path / SCHEDULE).unlink()
    with pytest.raises(DeliveryError, match=r"schedule\.csv' cannot be read"):
        Schedule().prove(tmp_path, told)


def test_a_folder_that_is_not_there_is_told(tmp_path):
    told = contents()
    with pytest.raises(DeliveryError, match=r"schedule\.csv' cannot be written: No such file"):
        Schedule().write(tmp_path / "none", Delivery(panels=(), **{name: getattr(told, name) for name in SLOTS}))


@pytest.mark.parametrize(
    ("what", "key", "change"),
    [
        ("mass", "mass", lambda record: record.mass * (1.0 + 1e-8)),
        ("blank", "blank", lambda record: record.blank.model_copy(update={"width": record.blank.width + 0.02})),
        ("area of its blank", "blank", lambda r: r.blank.model_copy(update={"area": r.blank.area * (1.0 + 1e-5)})),
        (
            "length of an edge",
            "blank",
            lambda r: r.blank.model_copy(update={"edges": {**r.blank.edges, "end 0": r.blank.edges["end 0"] + 1e-5}}),
        ),
        (
            "sheet of the stock or name of its drawing",
            "blank",
            lambda record: record.blank.model_copy(update={"stock": "9x9"}),
        ),
        ("bend", "bends", lambda record: (record.bends[0].model_copy(update={"direction": "up"}),)),
        ("bend", "bends", lambda record: (record.bends[0].model_copy(update={"hits": 1}),)),
        ("bend", "bends", lambda _: ()),
    ],
)
def test_a_number_that_is_not_the_panels_is_told(what, key, change):
    told = contents()
    assert faults(told) == ()
    (failure,) = faults(changed(told, **{key: change(told.records[0])}))
    assert failure == f"Panel 'N 1': the report's {what} is not that of the panel."


def test_a_report_without_blanks_is_told():
    (failure,) = faults(changed(contents(), blank=None))
    assert failure == "Panel 'N 1': the report's blank or mass is not that of the panel."
