"""schedule.csv: what to cut, bend, buy and weigh, one row a panel and one a bend, and the totals of a delivery."""

from __future__ import annotations

from cadpanel.delivery.contents import Contents
from cadpanel.delivery.outputs.tables import TableOutput

SCHEDULE = "schedule.csv"


class Schedule(TableOutput):
    """The schedule, as a spreadsheet reads it."""

    name = "schedule"
    files = (SCHEDULE,)

    def data(self, contents: Contents) -> bytes:
        """See `TableOutput.data`."""
        from cadpanel.delivery.schedule.csv_text import csv_bytes
        from cadpanel.delivery.schedule.rows import schedule_rows

        return csv_bytes(schedule_rows(contents))
