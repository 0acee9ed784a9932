"""One task after the other, in this process."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from functools import partial

from cadpanel.jobs.engine.engine import TellOf
from cadpanel.jobs.task import Task
from cadpanel.jobs.work import Made, work


class Serial:
    """An engine that needs nothing."""

    def run(self, tasks: Sequence[Task], tell: TellOf) -> Iterator[Made]:
        """See `Engine.run`."""
        for task in tasks:
            yield work(task, task.contents, partial(tell, task.name))
