"""Corners for setting out: the model's own coordinates, with all digits, wherever the model lies."""

import csv
import io
from dataclasses import replace

import numpy as np
import pytest

from cadpanel.delivery.contents import Contents
from cadpanel.delivery.outputs.output import Delivery
from cadpanel.delivery.outputs.setting_out import SETTING_OUT, SettingOut
from cadpanel.delivery.schedule.csv_text import csv_bytes
from cadpanel.delivery.schedule.setting_out_rows import HEADINGS, setting_out_rows
from cadpanel.delivery.shop_settings import ShopSettings
from tests.flat_parts import SHEET, strip_records


def contents():
    records, seams, parts = strip_records()
    return Contents(title="strip", sheet=SHEET, shop=ShopSettings(), records=records, seams=seams, parts=parts)


def read(told):
    head, *rows = csv.reader(io.StringIO(csv_bytes(setting_out_rows(told)).decode("utf-8-sig")))
    assert tuple(head) == HEADINGS
    return rows


def test_every_corner_of_every_panel_is_told_by_its_end_and_side():
    told = contents()
    rows = read(told)
    corners = np.concatenate([np.reshape(record.corners, (-1, 3)) for record in told.records])
    assert np.array([row[2:] for row in rows], dtype=float) == pytest.approx(corners, abs=0.5001e-4)
    assert [row[1] for row in rows[:8]] == [
        *("end 0, side 0", "end 0, ruling 1", "end 0, ruling 2", "end 0, side 1"),
        *("end 1, side 0", "end 1, ruling 1", "end 1, ruling 2", "end 1, side 1"),
    ]
    assert {row[0] for row in rows} == {record.name for record in told.records}


def test_map_coordinates_lose_no_digit():
    record = contents().records[0]
    row = ((123.45678, -0.00001, 0.00005),)
    told = replace(contents(), records=(record.model_copy(update={"corners": (row,)}),), origin=(2.6e12, -1.2e9, 0.0))
    assert read(told) == [["N 1", "corner 0", "2600000000123.4568", "-1200000000.0000", "0.0001"]]
    told = replace(told, origin=(0.0, 0.0, 0.0))
    assert read(told)[0][3] == "0.0000"


def test_what_was_written_holds_and_another_origin_does_not(tmp_path):
    told = contents()
    slots = ("title", "sheet", "shop", "records", "seams", "parts")
    SettingOut().write(tmp_path, Delivery(panels=(), **{name: getattr(told, name) for name in slots}))
    assert SettingOut().prove(tmp_path, told).failures == ()
    (failure,) = SettingOut().prove(tmp_path, replace(told, origin=(1000.0, 0.0, 0.0))).failures
    assert failure == f"'{SETTING_OUT}' is not what the report's numbers make."
