"""What all tests share: examples that can be drawn again, and an order in which two workers end together."""

from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings

from tests.thorough import left_for_a_thorough_run

settings.register_profile(
    "repeatable",
    derandomize=True,
    deadline=None,
    print_blob=True,
    suppress_health_check=[HealthCheck.too_slow],
)
# Hypothesis draws the same examples on every run, so that a failure can be run again.
settings.load_profile("repeatable")

TESTS = Path(__file__).parent
FIRST = (
    "brep/files/test_fuzz.py",
    "test_examples.py",
    "test_fixtures.py",
    "test_architecture.py",
    "test_api.py",
    "cli/test_stopping.py",
    "cli/test_portability.py",
    "cli/test_fit.py",
    "cli/test_fit_refusals.py",
    "fitting/test_automatic.py",
    "fitting/test_every_feature.py",
    "terms/test_adding_a_limit.py",
    "mutation/test_mutation.py",
    "browser/test_report_page.py",
)
"""Files with tests of several seconds. Workers of pytest-xdist take tests in their order, and end together only if the
last ones are short: with the examples near the end one worker had nothing to do for the last fifth of the time."""


@pytest.hookimpl(trylast=True)
def pytest_collection_modifyitems(config: pytest.Config, items: list[pytest.Item]) -> None:
    """Run the long tests first, and leave to a thorough run what is left to it."""
    left = set(left_for_a_thorough_run(items))
    if left:
        config.hook.pytest_deselected(items=[item for item in items if item in left])
        items[:] = [item for item in items if item not in left]
    first = {TESTS / file for file in FIRST}
    items.sort(key=lambda item: item.path not in first)
