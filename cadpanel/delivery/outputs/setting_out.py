"""setting_out.csv: where the corners of every panel lie in the model's own coordinates, for those who set them out."""

from __future__ import annotations

from cadpanel.delivery.contents import Contents
from cadpanel.delivery.outputs.tables import TableOutput

SETTING_OUT = "setting_out.csv"


class SettingOut(TableOutput):
    """Corners of both faces of every sheet."""

    name = "setting-out"
    files = (SETTING_OUT,)

    def data(self, contents: Contents) -> bytes:
        """See `TableOutput.data`."""
        from cadpanel.delivery.schedule.csv_text import csv_bytes
        from cadpanel.delivery.schedule.setting_out_rows import setting_out_rows

        return csv_bytes(setting_out_rows(contents))
