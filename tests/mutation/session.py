"""All tests are loaded once; for each change a process is forked that puts it in and runs the tests it may fail."""

from __future__ import annotations

import os
import signal
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Literal

import pytest

from tests.mutation.coverage import Coverage, Recorder, let_any_failure_do
from tests.mutation.in_place import loaded_functions, put_in
from tests.mutation.mutants import Mutant

Outcome = Literal["survived", "killed", "timeout"]
# A run of tests may take so many times as long as they took without a change, and this many seconds more.
PATIENCE, START_UP = 4.0, 60.0
PASSED, FAILED = 0, 1
PAUSE = 0.02


@dataclass(eq=False)
class Session:
    """A plugin of pytest that runs the tests once, notes what they call, and then tries changes.

    Attributes:
        root: of the checkout that the tests import.
        mutants: the changes, all of them inside functions.
        paths: the files in which calls are noted.
        notes: the folder for what is noted.
        processes: how many run at a time.
        timeout: seconds for one change; 0 for what its tests took.
        most: seconds of tests for one change, counted as they took without it; 0 for no limit.
        tell: is told each outcome.
    """

    root: Path
    mutants: Sequence[Mutant]
    paths: Sequence[str]
    notes: Path
    processes: int
    timeout: float
    most: float
    tell: Callable[[Mutant, Outcome], None]
    _items: dict[str, pytest.Item] = field(default_factory=dict)

    def pytest_sessionstart(self) -> None:
        let_any_failure_do()

    @pytest.hookimpl(tryfirst=True)
    def pytest_runtestloop(self, session: pytest.Session) -> bool:
        self._items = {item.nodeid: item for item in session.items}
        if not self._record(session):
            session.testsfailed = 1
            return True
        coverage = Coverage.of(self.notes)
        functions = loaded_functions(self.root, self.mutants)
        texts = {path: (self.root / path).read_text(encoding="utf-8") for path in {one.path for one in self.mutants}}

        def trial(mutant: Mutant) -> _Trial:
            tests = coverage.tests_for(mutant, self.most)
            seconds = self.timeout or PATIENCE * sum(coverage.seconds[test] for test in tests) + START_UP

            def work() -> int:
                put_in(mutant, texts[mutant.path], self.root, functions)
                return self._run(session, tests)

            return _Trial(work=work, seconds=seconds, done=lambda outcome: self.tell(mutant, outcome))

        _at_a_time(self.processes, map(trial, self.mutants))
        return True

    def _record(self, session: pytest.Session) -> bool:
        """Run all tests without a change, file by file in some processes, and note what they call."""
        by_file: dict[str, list[str]] = {}
        for test in self._items:
            by_file.setdefault(test.partition("::")[0], []).append(test)
        shares: list[list[str]] = [[] for _ in range(self.processes)]
        for tests in sorted(by_file.values(), key=len, reverse=True):
            min(shares, key=len).extend(tests)
        outcomes: list[Outcome] = []

        def recording(number: int, tests: list[str]) -> _Trial:
            def work() -> int:
                recorder = Recorder(self.root, self.paths, self.notes / f"calls-{number}.json")
                session.config.pluginmanager.register(recorder)
                status = self._run(session, tests, quiet=False)
                recorder.write()
                return status

            return _Trial(work=work, seconds=float("inf"), done=outcomes.append)

        _at_a_time(self.processes, (recording(number, tests) for number, tests in enumerate(shares) if tests))
        return all(outcome == "survived" for outcome in outcomes)

    def _run(self, session: pytest.Session, tests: Sequence[str], *, quiet: bool = True) -> int:
        """In a forked process: run tests until the first one fails."""
        own = self.notes / str(os.getpid())
        own.mkdir()
        os.environ["PYTEST_DEBUG_TEMPROOT"] = str(own)  # pytest's folders for tests lie there
        if quiet:
            nowhere = os.open(os.devnull, os.O_WRONLY)
            os.dup2(nowhere, 1)
            os.dup2(nowhere, 2)
        items = [self._items[test] for test in tests]
        for item, following in zip(items, [*items[1:], None], strict=True):
            session.config.hook.pytest_runtest_protocol(item=item, nextitem=following)
            if session.testsfailed:
                return FAILED
        return PASSED


@dataclass(eq=False)
class _Trial:
    """What a forked process does, and what becomes of its answer."""

    work: Callable[[], int]
    seconds: float
    done: Callable[[Outcome], None]
    process: int = 0
    ends: float = 0.0

    def start(self) -> None:
        self.process = os.fork()
        if not self.process:
            status = FAILED
            try:
                os.setsid()
                status = self.work()
            finally:
                os._exit(status)
        self.ends = time.monotonic() + self.seconds

    def ended(self) -> bool:
        found, status = os.waitpid(self.process, os.WNOHANG)
        if found:
            # A process that the kernel ended has noticed the change, too.
            self.done("survived" if os.WIFEXITED(status) and os.WEXITSTATUS(status) == PASSED else "killed")
        elif time.monotonic() > self.ends:
            os.killpg(self.process, signal.SIGKILL)  # with whatever it started
            os.waitpid(self.process, 0)
            self.done("timeout")
        else:
            return False
        return True


def _at_a_time(processes: int, trials: Iterator[_Trial]) -> None:
    """Run all, so many at a time."""
    running: list[_Trial] = []
    while True:
        running = [one for one in running if not one.ended()]
        while len(running) < processes and (one := next(trials, None)) is not None:
            one.start()
            running.append(one)
        if not running:
            return
        time.sleep(PAUSE)
