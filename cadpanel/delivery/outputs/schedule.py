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
        """The report's numbers must follow from its panels, and give this file again."""
        from cadpanel.delivery.schedule.proof import number_faults

        try:
            there = (folder / SCHEDULE).read_bytes()
        except OSError as error:
            raise DeliveryError(f"'{folder / SCHEDULE}' cannot be read: {error.strerror or error}.") from error
        mass_error, faults = number_faults(contents)
        if there != _bytes(contents):
            faults = (*faults, f"'{SCHEDULE}' is not what the report's numbers make.")
        return Proof(numbers={"panels": len(contents.records), "mass_error": mass_error}, failures=faults)


def _bytes(contents: Contents) -> bytes:
    from cadpanel.delivery.schedule.csv_text import csv_bytes
    from cadpanel.delivery.schedule.rows import schedule_rows

    return csv_bytes(schedule_rows(contents))
