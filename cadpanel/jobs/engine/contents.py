"""What the files of tasks hold, for workers: where they lie, or their bytes, as long as a task needs them."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from cadpanel.jobs.task import Content, Task

if TYPE_CHECKING:
    from distributed import Client, Future


class Contents:
    """Files that lie here are told, or sent once to workers elsewhere."""

    def __init__(self, client: Client, tasks: Sequence[Task], *, here: bool) -> None:
        """Say who needs them, and whether workers read them here."""
        self._client, self._here = client, here
        self._needed = Counter(sha256 for task in tasks for sha256 in _sums(task))
        self._sent: dict[str, Future] = {}

    def of(self, task: Task) -> list[Content | Future]:
        """Those of a task.

        Raises:
            SettingsError: one cannot be read, or has changed since.
        """
        if self._here:
            return [replace(content, path=content.path.absolute()) for content in task.contents]
        return [self._sent_of(content) for content in task.contents]

    def _sent_of(self, content: Content) -> Future:
        sha256 = content.sha256
        if sha256 not in self._sent:
            self._sent[sha256] = self._client.submit(_bytes, content.read(), key=f"bytes-{sha256}", pure=True)
        return self._sent[sha256]

    def done(self, task: Task) -> None:
        """Let go of what no other task needs."""
        for sha256 in _sums(task):
            self._needed[sha256] -= 1
            if not self._needed[sha256]:
                self._sent.pop(sha256, None)


def _sums(task: Task) -> set[str]:
    return {content.sha256 for content in task.contents}


def _bytes(data: bytes) -> bytes:
    return data
