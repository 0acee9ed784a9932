"""Runs of the tests on a copy of the checkout, each in a process that is forked once pytest and NumPy are loaded."""

from __future__ import annotations

import compileall
import importlib
import os
import shutil
import signal
import sys
import time
from collections.abc import Sequence
from pathlib import Path
from py_compile import PycInvalidationMode

import pytest

from tests.mutation.session import Outcome

# Loaded once, before anything is forked: what takes long to load and is not under test.
LIBRARIES = ("numpy", "scipy.interpolate", "scipy.optimize", "scipy.sparse.csgraph", "scipy.spatial", "hypothesis")
KERNEL = "OCP"
# What each process loads for itself, from the copy.
UNDER_TEST = ("cadpanel", "tests", "fixtures", "examples")
# How pytest ends: all passed; a test failed; a test file, or a conftest, could not be imported.
PASSED, FAILED = 0, (1, 2, 4)
NO_COPY = 97
LOG = "pytest.log"
PAUSE = 0.05


def copied(root: Path, to: Path) -> Path:
    """A copy of a checkout without what is hidden, compiled so that a changed file counts however soon it changes."""
    skip = shutil.ignore_patterns(".*", "__pycache__", "*.egg-info", "build", "dist")
    shutil.copytree(root, to, ignore=skip)
    compileall.compile_dir(to, quiet=1, invalidation_mode=PycInvalidationMode.CHECKED_HASH)
    return to


def preload(*, kernel: bool) -> None:
    """Load what every run needs."""
    for name in (*LIBRARIES, KERNEL) if kernel else LIBRARIES:
        importlib.import_module(name)


def run_tests(copy: Path, files: Sequence[str], plugins: Sequence[object], seconds: float) -> Outcome:
    """Run tests of a copy until the first one fails, and say whether none did.

    Args:
        copy: its root.
        files: the test files or folders, from there.
        plugins: of pytest.
        seconds: after which the run is ended.

    Raises:
        RuntimeError: pytest ran no test, or did not run the copy.
    """
    process = os.fork()
    if not process:
        status = NO_COPY
        try:
            status = _tested(copy, files, plugins)
        finally:
            os._exit(status)
    ended = time.monotonic() + seconds
    while time.monotonic() < ended:
        found, status = os.waitpid(process, os.WNOHANG)
        if found:
            return _outcome(status, copy)
        time.sleep(PAUSE)
    os.killpg(process, signal.SIGKILL)  # with whatever it started
    os.waitpid(process, 0)
    return "timeout"


def _tested(copy: Path, files: Sequence[str], plugins: Sequence[object]) -> int:
    """What a forked process does."""
    os.setsid()
    log = os.open(copy / LOG, os.O_WRONLY | os.O_CREAT | os.O_TRUNC)
    os.dup2(log, 1)
    os.dup2(log, 2)
    os.chdir(copy)
    os.environ["PYTHONPATH"] = os.environ["PYTEST_DEBUG_TEMPROOT"] = str(copy)
    for name in [name for name in sys.modules if name.partition(".")[0] in UNDER_TEST]:
        del sys.modules[name]
    sys.path[:] = [str(copy), *(path for path in sys.path if path and not Path(path, "tests", "mutation").is_dir())]
    sys.path_importer_cache.clear()
    words = ["-x", "-q", "-s", "-p", "no:cacheprovider", f"--rootdir={copy}"]
    status = int(pytest.main([*words, *files], plugins=list(plugins)))
    loaded = getattr(sys.modules.get("cadpanel"), "__file__", None)
    return status if loaded is None or Path(loaded).is_relative_to(copy) else NO_COPY


def _outcome(status: int, copy: Path) -> Outcome:
    if os.WIFSIGNALED(status):  # the kernel crashed
        return "killed"
    code = os.WEXITSTATUS(status)
    if code == PASSED:
        return "survived"
    if code in FAILED:
        return "killed"
    raise RuntimeError(
        f"The tests ended with {code} instead of an answer:\n{(copy / LOG).read_text(encoding='utf-8')[-2000:]}"
    )
