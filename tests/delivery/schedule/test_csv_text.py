"""Rows become a file that spreadsheets read, and in which nothing runs."""

import csv
import io

import pytest

from cadpanel.delivery.schedule.csv_text import Row, csv_bytes


def read(data):
    return list(csv.reader(io.StringIO(data.decode("utf-8-sig"))))


def test_rows_come_back_as_they_were():
    rows: list[Row] = [
        ["panel", 'a "quoted", name', "D\u00e4cher \u7a97"],
        ["", 1, -2.5],
        [],
        [None, "two\nlines", 1e-9],
    ]
    assert read(csv_bytes(rows)) == [
        ["panel", 'a "quoted", name', "D\u00e4cher \u7a97"],
        ["", "1", "-2.5"],
        [],
        ["", "two\nlines", "1e-09"],
    ]


@pytest.mark.parametrize("sign", ["=", "+", "-", "@", "\t", "\r"])
def test_text_that_a_spreadsheet_would_run_is_text(sign):
    ((cell, number),) = read(csv_bytes([[f"{sign}1+1", -1.0]]))
    assert cell.startswith("'" + sign.strip())
    assert number == "-1.0"


def test_it_says_that_it_is_utf_8_and_ends_lines_as_the_format_does():
    assert csv_bytes([["a"], ["b"]]) == b"\xef\xbb\xbfa\r\nb\r\n"
