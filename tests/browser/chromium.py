"""Chromium without a screen, driven through its own driver."""

from __future__ import annotations

import io
import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import numpy as np
import pytest
from matplotlib.image import imread

from cadpanel.arrays import Array

PROGRAMS, DRIVERS = ("chromium", "chromium-browser", "google-chrome"), ("chromedriver",)
REQUIRED = "CADPANEL_REQUIRE_BROWSER"
"""Set to 1, a missing Chromium is a failure and not a skip."""
# WebGL is drawn by the processor, and nothing is asked of a network.
FLAGS = (
    *("--headless=new", "--no-sandbox", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"),
    *("--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update"),
    *("--disable-sync", "--hide-scrollbars", "--disable-dev-shm-usage", "--window-size=1100,700"),
)


def find_chromium() -> tuple[str, str]:
    """Chromium and its driver; skips the test, or fails it, where one is missing."""
    found = [next(filter(None, map(shutil.which, names)), None) for names in (PROGRAMS, DRIVERS)]
    if found[0] is not None and found[1] is not None:
        return found[0], found[1]
    reason = "Chromium or its driver is not installed (Debian: apt-get install chromium chromium-driver)"
    if os.environ.get(REQUIRED) == "1":
        pytest.fail(f"{reason}, and {REQUIRED}=1 asks for it")
    pytest.skip(reason)


@contextmanager
def chromium() -> Iterator[Any]:
    """A browser, ended when the block ends."""
    program, driver = find_chromium()
    from selenium.webdriver import Chrome, ChromeOptions
    from selenium.webdriver.chrome.service import Service

    options = ChromeOptions()
    options.binary_location = program
    for flag in FLAGS:
        options.add_argument(flag)
    options.set_capability("goog:loggingPrefs", {"browser": "ALL"})
    browser = Chrome(options=options, service=Service(driver))
    try:
        browser.set_script_timeout(60)
        yield browser
    finally:
        browser.quit()


def drawn(browser: Any) -> None:
    """Wait until what was asked for is on the screen."""
    browser.execute_async_script(
        "const done = arguments[0]; requestAnimationFrame(() => requestAnimationFrame(() => setTimeout(done, 0)));"
    )


def pixels(element: Any) -> Array:
    """(height, width, 3) what an element looks like, 0 to 1."""
    return np.asarray(imread(io.BytesIO(element.screenshot_as_png), format="png"), dtype=np.float64)[..., :3]
