"""The date of files is that of the environment, and the present where it says none."""

from datetime import UTC, datetime

import pytest

from cadpanel.delivery.source_date import source_date
from cadpanel.errors import SettingsError


def test_the_environment_says_the_date(monkeypatch):
    monkeypatch.delenv("SOURCE_DATE_EPOCH", raising=False)
    before = datetime.now(UTC).replace(microsecond=0)
    assert before <= source_date() <= datetime.now(UTC)
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "1700000000")
    assert source_date() == datetime(2023, 11, 14, 22, 13, 20, tzinfo=UTC)


@pytest.mark.parametrize("said", ["yesterday", "", "1e99", "99999999999999999999"])
def test_a_date_that_is_none_is_refused(monkeypatch, said):
    monkeypatch.setenv("SOURCE_DATE_EPOCH", said)
    with pytest.raises(SettingsError, match="SOURCE_DATE_EPOCH must be a number of seconds"):
        source_date()
