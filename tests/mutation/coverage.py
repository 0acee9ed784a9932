"""Which tests call which functions, told by a plugin of pytest; and a plugin that keeps to chosen tests."""

from __future__ import annotations

import json
import sys
from collections.abc import Collection, Generator, Mapping
from dataclasses import dataclass, field
from itertools import accumulate
from pathlib import Path
from types import CodeType, FrameType

import pytest
from hypothesis import Phase, settings

from tests.mutation.mutants import Mutant

Calls = dict[str, list[int]]  # by file, the first lines of the functions that were called


@dataclass(eq=False)
class Recorder:
    """Notes for each test which functions of some files it calls, and how long it takes, in seconds.

    What fixtures call that several tests share is noted for the first of them alone.
    """

    root: Path
    paths: Collection[str]
    out: Path
    calls: dict[str, Calls] = field(default_factory=dict)
    seconds: dict[str, float] = field(default_factory=dict)
    _codes: set[CodeType] = field(default_factory=set)

    @pytest.hookimpl(hookwrapper=True)
    def pytest_runtest_protocol(self, item: pytest.Item) -> Generator[None]:
        self._codes = set()
        before = sys.gettrace()
        sys.settrace(self._called)
        try:
            yield
        finally:
            sys.settrace(before)
        names = {str((self.root / path).resolve()): path for path in self.paths}
        found: Calls = {}
        for code in self._codes:
            if code.co_filename in names:
                found.setdefault(names[code.co_filename], []).append(code.co_firstlineno)
        self.calls[item.nodeid] = found

    def _called(self, frame: FrameType, _event: str, _argument: object) -> None:
        self._codes.add(frame.f_code)

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        self.seconds[report.nodeid] = self.seconds.get(report.nodeid, 0.0) + report.duration

    def write(self) -> None:
        """Leave what was noted for `Coverage.of`."""
        self.out.write_text(json.dumps({"calls": self.calls, "seconds": self.seconds}), encoding="utf-8")


def let_any_failure_do() -> None:
    """A failure is enough: the smallest one would be looked for for minutes."""
    settings.register_profile("found", phases=(Phase.explicit, Phase.generate))
    settings.load_profile("found")


@dataclass(eq=False)
class Chosen:
    """Runs some of the tests alone, those first that take least: most changes fail one of these."""

    seconds: Mapping[str, float]

    def pytest_sessionstart(self) -> None:
        let_any_failure_do()

    @pytest.hookimpl(trylast=True)
    def pytest_collection_modifyitems(self, items: list[pytest.Item]) -> None:
        chosen = [item for item in items if item.nodeid in self.seconds]
        items[:] = sorted(chosen, key=lambda item: self.seconds[item.nodeid])


@dataclass(frozen=True)
class Coverage:
    """What the recorder found."""

    calls: Mapping[str, Calls]
    seconds: Mapping[str, float]

    @classmethod
    def of(cls, folder: Path) -> Coverage:
        """What all recorders left in a folder."""
        calls: dict[str, Calls] = {}
        seconds: dict[str, float] = {}
        for path in folder.glob("calls-*.json"):
            noted = json.loads(path.read_text(encoding="utf-8"))
            calls |= noted["calls"]
            seconds |= noted["seconds"]
        return cls(calls=calls, seconds=seconds)

    def tests_for(self, mutant: Mutant, most: float = 0.0) -> list[str]:
        """The tests that may fail for a change, those first that call the changed function and take least.

        Args:
            mutant: the change.
            most: seconds that they may take together; 0 for no limit.
        """
        first = self.tests_of(mutant.path, mutant.function)
        more = self.tests_of(mutant.path, (0, 0))
        found = [*self._quickest(first), *self._quickest((more | self.beside(more | first)) - first)]
        taken = accumulate(self.seconds.get(test, 0.0) for test in found)
        return [test for test, so_far in zip(found, taken, strict=True) if not most or so_far <= most]

    def _quickest(self, tests: Collection[str]) -> list[str]:
        return sorted(tests, key=lambda test: (self.seconds.get(test, 0.0), test))

    def tests_of(self, path: str, function: tuple[int, int]) -> set[str]:
        """The tests that call what stands between two lines; for (0, 0) those that call anything in the file."""
        first, last = function if any(function) else (1, sys.maxsize)
        return {
            test
            for test, found in self.calls.items()
            if any(first <= line <= last for line in found.get(path, ()) if line > 1 or not any(function))
        }

    def beside(self, tests: Collection[str]) -> set[str]:
        """All tests that stand in the same files: one of them may hold what a fixture made for another."""
        files = set(map(_file_of, tests))
        return {test for test in self.calls if _file_of(test) in files}

    def files_of(self, tests: Collection[str]) -> list[str]:
        """The files in which tests stand."""
        return sorted(set(map(_file_of, tests)))


def _file_of(test: str) -> str:
    return test.partition("::")[0]
