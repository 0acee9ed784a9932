"""Panels that fit no sheet of the store are named, with the sheet that would do."""

from types import SimpleNamespace
from typing import Any

import pytest

from cadpanel.delivery.records.stock import stock_shortfall


def report(stock: Any, *sizes: tuple[float, float, str | None], only: tuple[str, ...] = ()) -> Any:
    blanks = [SimpleNamespace(width=long, height=wide, stock=sheet) for long, wide, sheet in sizes]
    panels = [SimpleNamespace(name=f"P-{i}", blank=blank) for i, blank in enumerate(blanks)]
    return SimpleNamespace(settings=SimpleNamespace(stock=stock, only=only), panels=panels)


def test_all_is_well_without_a_stock_and_where_every_panel_fits() -> None:
    assert stock_shortfall(report((), (9000.0, 9000.0, None))) is None
    assert stock_shortfall(report(((1500.0, 3000.0),), (900.0, 900.0, "1500x3000"))) is None


@pytest.mark.parametrize("count", [1, 5, 7])
def test_panels_that_fit_no_sheet_are_named_and_counted(count: int) -> None:
    said = stock_shortfall(
        report(((1500.0, 3000.0), (1000.0, 2000.0)), (900.0, 900.0, "x"), *(count * [(3100.2, 900.0, None)]))
    )
    assert said is not None
    assert said.startswith(
        f"{count} of {count + 1} blanks fit no sheet of 1500x3000 or 1000x2000 mm: 'P-1' (3100 x 900"
    )
    assert ("and 2 more" in said) == (count == 7)
    assert "a sheet of 3101x900 mm" in said


def test_panels_that_are_not_delivered_are_not_named() -> None:
    stock, sizes = ((1500.0, 3000.0),), [(3100.0, 900.0, None), (900.0, 900.0, "1500x3000"), (4100.0, 900.0, None)]
    assert stock_shortfall(report(stock, *sizes, only=("P-1",))) is None
    said = stock_shortfall(report(stock, *sizes, only=("P-0", "P-1")))
    assert said is not None
    assert said.startswith("1 of 2 blanks fit")
    assert "P-2" not in said
    assert "3100x900" in said
