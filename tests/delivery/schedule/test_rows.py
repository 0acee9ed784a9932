"""The rows of a schedule: every panel, every bend, and totals that add up."""

import csv
import io
from dataclasses import replace

import pytest

from cadpanel.delivery.contents import Contents
from cadpanel.delivery.schedule.csv_text import csv_bytes
from cadpanel.delivery.schedule.rows import BEND_HEADINGS, PANEL_HEADINGS, schedule_rows, strip_of
from cadpanel.delivery.shop_settings import ShopSettings
from tests.flat_parts import SHEET, strip_records

SHOP = ShopSettings(stock=((2000.0, 1500.0), (2000.0, 1650.0)), density=7850.0)


def contents(shop=SHOP):
    records, seams, parts = strip_records(shop)
    return Contents(title="strip", sheet=SHEET, shop=shop, records=records, seams=seams, parts=parts)


def tables(told):
    """The rows under their headings, and those of the totals."""
    rows = list(csv.reader(io.StringIO(csv_bytes(schedule_rows(told)).decode("utf-8-sig"))))
    gap = rows.index([])
    return [dict(zip(rows[0], row, strict=False)) for row in rows[1:gap]], rows[gap + 1 :]


def test_every_panel_has_its_numbers():
    told = contents()
    rows, _ = tables(told)
    assert list(rows[0]) == [*PANEL_HEADINGS, *BEND_HEADINGS]
    for row, record in zip(rows, told.records, strict=True):
        assert record.blank is not None
        assert record.mass is not None
        assert (row["row"], row["panel"], row["feature"]) == ("panel", record.name, record.feature)
        assert float(row["blank length mm"]) == pytest.approx(record.blank.width, abs=0.005)
        assert float(row["area m2"]) == pytest.approx(record.blank.area / 1e6, abs=1e-6)
        assert float(row["mass kg"]) == pytest.approx(record.volume * 7850.0e-9, abs=1e-3)
        assert float(row["mass kg"]) == pytest.approx(record.mass, abs=1e-3)
        own = [seam for seam in told.seams if record.name in seam.panels]
        worst = max(max(seam.max_seam_gap, seam.max_corner_gap) for seam in own)
        assert float(row["largest gap mm"]) == pytest.approx(worst, abs=1e-3)
        (bend,) = record.bends
        assert float(row["inner radius least mm"]) == pytest.approx(bend.radius[0], abs=0.005)
        assert int(row["press hits"]) == bend.hits
        assert float(row["end 1 bevel largest deg"]) == pytest.approx(record.bevels["end 1"][1], abs=0.005)


def test_a_second_bend_has_a_row_of_its_own():
    told = contents()
    bend = told.records[0].bends[0]
    doubled = told.records[0].model_copy(update={"bends": (bend, bend.model_copy(update={"hits": 77}))})
    rows, _ = tables(replace(told, records=(doubled, *told.records[1:])))
    assert [(row["row"], row["panel"], row["bend"]) for row in rows[:3]] == [
        ("panel", doubled.name, "1"),
        ("bend", doubled.name, "2"),
        ("panel", told.records[1].name, "1"),
    ]
    assert rows[1]["press hits"] == "77"
    assert rows[1]["blank length mm"] == ""


def test_totals_add_up():
    told = contents()
    _, totals = tables(told)
    numbers = [row for row in totals if len(row) in (5, 6) and row[2].isdecimal()]
    rows = {(row[0], row[1]): [float(number) for number in row[2:]] for row in numbers}
    count, area, mass, holes = rows[("all panels", "")]
    assert holes == 0
    assert count == len(told.records)
    assert mass == pytest.approx(sum(record.mass or 0.0 for record in told.records), abs=1e-3)
    for what in ("feature", "thickness mm", "stock"):
        own = [row for (kind, _), row in rows.items() if kind == what]
        assert sum(row[0] for row in own) == count
        assert sum(row[1] for row in own) == pytest.approx(area, abs=1e-5)
    radii = [row for (kind, value), row in rows.items() if kind == "" and value]
    assert sum(row[0] for row in radii) == sum(len(record.bends) for record in told.records)
    assert sum(row[2] for row in radii) == sum(bend.hits for record in told.records for bend in record.bends)
    assert {value for kind, value in rows if kind == "stock"} <= {"none", "2000x1500", "2000x1650"}


def test_a_panel_without_neighbours_has_no_gap():
    told = contents()
    rows, _ = tables(replace(told, seams=()))
    assert {row["largest gap mm"] for row in rows} == {""}


@pytest.mark.parametrize(("name", "strip"), [("NW-01", "NW"), ("S1-R02-C05", "S1-R02"), ("wall", ""), ("N 1", "")])
def test_a_strip_is_what_stands_before_the_number(name, strip):
    assert strip_of(name) == strip


def test_what_was_not_asked_for_and_what_is_not_bent_has_no_totals():
    told = contents(ShopSettings())
    flat = replace(told, records=tuple(record.model_copy(update={"bends": ()}) for record in told.records))
    kinds = [{row[0] for row in tables(one)[1] if row} for one in (told, flat)]
    assert kinds[0] - kinds[1] == {"bends by inner radius", ""}
    assert kinds[1] == {"totals of", "all panels", "feature", "thickness mm"}
