"""What an engine is: it works off tasks in any order, tells of their steps, and gives back what came of each."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import Protocol

from cadpanel.jobs.task import Task
from cadpanel.jobs.work import Made

TellOf = Callable[[str, str, int, int, str], None]
"""Told the region, the step, how much of it is done of how much, and a detail."""


class Engine(Protocol):
    """Where tasks are worked off."""

    def run(self, tasks: Sequence[Task], tell: TellOf) -> Iterator[Made]:
        """Give back what came of each task, as it comes."""
        ...
