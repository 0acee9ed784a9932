"""schedule.csv: what to cut, bend, buy and weigh, one row a panel and one a bend, and the totals of a delivery."""

from __future__ import annotations

from pathlib import Path

from cadpanel.delivery.contents import Contents, Proof
from cadpanel.delivery.outputs.output import Delivery, Output
from cadpanel.errors import DeliveryError

SCHEDULE = "schedule.csv"


class Schedule(Output):
    """The schedule, as a spreadsheet reads it."""

    name = "schedule"
    files = (SCHEDULE,)

    def write(self, folder: Path, delivery: Delivery) -> None:
        """See `Output.write`."""
        try:
            (folder / SCHEDULE).write_bytes(_bytes(delivery))
        except OSError as error:
            raise DeliveryError(f"'{folder / SCHEDULE}' cannot be written: {error.strerror or error}.") from error

    def prove(self, folder: Path, contents: Contents) -> Proof:
        """The report's numbers, which are proved by themselves, must give this file again."""
        try:
            there = (folder / SCHEDULE).read_bytes()
        except OSError as error:
            raise DeliveryError(f"'{folder / SCHEDULE}' cannot be read: {error.strerror or error}.") from error
        same = there == _bytes(contents)
        failures = () if same else (f"'{SCHEDULE}' is not what the report's numbers make.",)
        return Proof(numbers={"panels": len(contents.records)}, failures=failures)


def _bytes(contents: Contents) -> bytes:
    from cadpanel.delivery.schedule.csv_text import csv_bytes
    from cadpanel.delivery.schedule.rows import schedule_rows

    return csv_bytes(schedule_rows(contents))
