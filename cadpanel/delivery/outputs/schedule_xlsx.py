"""schedule.xlsx: the schedule as a workbook, for those who want no text file; it needs openpyxl."""

from __future__ import annotations

from pathlib import Path

from cadpanel.delivery.contents import Contents, Proof
from cadpanel.delivery.outputs.output import Delivery, Output
from cadpanel.errors import DeliveryError

WORKBOOK = "schedule.xlsx"


class ScheduleXlsx(Output):
    """The same rows as schedule.csv."""

    name = "xlsx"
    files = (WORKBOOK,)
    unasked = False
    needs = ("openpyxl",)

    def write(self, folder: Path, delivery: Delivery) -> None:
        """See `Output.write`."""
        from cadpanel.delivery.schedule.rows import schedule_rows
        from cadpanel.delivery.schedule.workbook import workbook_bytes

        try:
            (folder / WORKBOOK).write_bytes(workbook_bytes(schedule_rows(delivery), delivery.title))
        except OSError as error:
            raise DeliveryError(f"'{folder / WORKBOOK}' cannot be written: {error.strerror or error}.") from error

    def prove(self, folder: Path, contents: Contents) -> Proof:
        """Its cells must be those that the report's numbers make."""
        from cadpanel.delivery.schedule.rows import schedule_rows
        from cadpanel.delivery.schedule.workbook import cells_of, rows_of_workbook

        same = rows_of_workbook(folder / WORKBOOK) == cells_of(schedule_rows(contents))
        failures = () if same else (f"'{WORKBOOK}' is not what the report's numbers make.",)
        return Proof(numbers={"panels": len(contents.records)}, failures=failures)
