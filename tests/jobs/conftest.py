"""One run of a job of three regions, two of which are the same, for all tests of what comes out of it."""

from __future__ import annotations

import signal
from collections.abc import Iterator
from pathlib import Path

import pytest

from tests.jobs.jobs import job, made, reference

REGIONS = "A = {}\nB = {thickness = 2}\nC = {divide = 2}"


@pytest.fixture(scope="session")
def strip(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of the strip's file."""
    return reference(tmp_path_factory.mktemp("strip")).parent


@pytest.fixture(scope="session")
def done(strip: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of the run, for reading only; beside it the results."""
    from cadpanel.jobs.results import Results

    place = tmp_path_factory.mktemp("done")
    path = job(strip, REGIONS)
    with Results(place / "cache") as results:
        assert made(path, place / "out", results).code in (0, 1)
    return place / "out"


@pytest.fixture
def heeding() -> Iterator[None]:
    """Ctrl-C is heeded as in a terminal, and afterwards as it was before."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)
