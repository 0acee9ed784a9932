"""Many inputs over few processes: forks of one that has loaded everything; one that dies is counted and replaced.

Each fork takes one input after the other, and says what became of it; where it dies, the input that it had begun has
killed it, and the next fork goes on behind that. Needs a system on which processes can be forked.
"""

from __future__ import annotations

import json
import multiprocessing
from collections.abc import Callable, Iterator, Sequence
from multiprocessing.connection import Connection, wait
from typing import NamedTuple

DIED = "DIED"
"""What became of an input over which the process itself has died."""

Try = Callable[[str, int], str]
"""From an input's kind and seed, what became of it in a word, and in a sentence behind a colon."""


class Ended(NamedTuple):
    """What became of an input."""

    kind: str
    seed: int
    end: str


class _Worker:
    def __init__(self, share: Sequence[tuple[str, int]], attempt: Try, prepare: Callable[[], None]) -> None:
        self._share, self._attempt, self._prepare = list(share), attempt, prepare
        self.done = 0
        self.line: Connection
        self._start()

    def _start(self) -> None:
        self.line, far = multiprocessing.get_context("fork").Pipe(duplex=False)
        self._process = multiprocessing.get_context("fork").Process(target=self._work, args=(far,))
        self._process.start()
        far.close()

    def _work(self, line: Connection) -> None:
        self._prepare()
        for kind, seed in self._share[self.done :]:
            line.send_bytes(json.dumps(self._attempt(kind, seed)).encode())

    def next(self) -> Ended | None:
        """What became of the next input; None where all are done."""
        if self.done == len(self._share):
            self._process.join()
            return None
        kind, seed = self._share[self.done]
        self.done += 1
        try:
            return Ended(kind, seed, json.loads(self.line.recv_bytes()))
        except EOFError:
            self._process.join()
            self._start()
            return Ended(kind, seed, DIED)


def tried(
    inputs: Sequence[tuple[str, int]], attempt: Try, prepare: Callable[[], None], processes: int
) -> Iterator[Ended]:
    """Try inputs in some processes at once.

    Args:
        inputs: kind and seed of each.
        attempt: what is done with one.
        prepare: what each process does first.
        processes: how many.
    """
    workers = [_Worker(inputs[first::processes], attempt, prepare) for first in range(processes)]
    while workers:
        ready = wait([worker.line for worker in workers])
        for worker in [one for one in workers if one.line in ready]:
            found = worker.next()
            if found is None:
                workers.remove(worker)
            else:
                yield found
