"""The schedule as a workbook: the same cells, text that stays text, and the same bytes for the same rows."""

from dataclasses import replace

import pytest
from openpyxl import load_workbook

from cadpanel.delivery.contents import Contents
from cadpanel.delivery.outputs.output import Delivery
from cadpanel.delivery.outputs.schedule_xlsx import WORKBOOK, ScheduleXlsx
from cadpanel.delivery.schedule.csv_text import Row
from cadpanel.delivery.schedule.workbook import cells_of, rows_of_workbook, workbook_bytes
from cadpanel.delivery.shop_settings import ShopSettings
from cadpanel.errors import DeliveryError
from tests.flat_parts import SHEET, strip_records

ROWS: list[Row] = [
    ["panel", "area"],
    ["=1+1", 2.5],
    ["-5", -5],
    [],
    ["D\u00e4cher \u7a97", None, "last"],
    ["bell\x07", "", ""],
]


def contents():
    records, seams, parts = strip_records()
    return Contents(title="str/ip", sheet=SHEET, shop=ShopSettings(), records=records, seams=seams, parts=parts)


def test_cells_come_back_and_nothing_is_a_formula(tmp_path):
    path = tmp_path / "a.xlsx"
    path.write_bytes(workbook_bytes(ROWS, "a [title]: with/signs and far more than thirty of them"))
    assert rows_of_workbook(path) == cells_of(ROWS)
    sheet = load_workbook(path).worksheets[0]
    assert sheet["A2"].data_type == "s"
    assert (sheet["A2"].value, sheet["A3"].value, sheet["B3"].value) == ("=1+1", "-5", -5)
    assert sheet["A6"].value == "bell_"
    assert len(sheet.title) <= 31
    assert sheet.freeze_panes == "A2"


def test_the_same_rows_give_the_same_bytes_and_the_date_is_the_environments(monkeypatch):
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "0")
    assert workbook_bytes(ROWS, "t") == workbook_bytes(ROWS, "t")
    before = workbook_bytes(ROWS, "t")
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")
    assert workbook_bytes(ROWS, "t") != before


def test_a_schedule_holds_and_a_changed_one_does_not(tmp_path):
    told = contents()
    slots = ("title", "sheet", "shop", "records", "seams", "parts")
    ScheduleXlsx().write(tmp_path, Delivery(panels=(), **{name: getattr(told, name) for name in slots}))
    assert ScheduleXlsx().prove(tmp_path, told).failures == ()
    heavier = told.records[0].model_copy(update={"mass": 99.0})
    (failure,) = ScheduleXlsx().prove(tmp_path, replace(told, records=(heavier, *told.records[1:]))).failures
    assert failure == f"'{WORKBOOK}' is not what the report's numbers make."
    for damage in (b"no workbook", (tmp_path / WORKBOOK).read_bytes()[:500]):
        (tmp_path / WORKBOOK).write_bytes(damage)
        with pytest.raises(DeliveryError, match=r"schedule\.xlsx' cannot be read: it is no workbook"):
            ScheduleXlsx().prove(tmp_path, told)
    (tmp_path / WORKBOOK).unlink()
    with pytest.raises(DeliveryError, match=r"schedule\.xlsx' cannot be read: No such file"):
        ScheduleXlsx().prove(tmp_path, told)
