"""How many parts of a step are done, where several threads work them off."""

from __future__ import annotations

import threading

from cadpanel.delivery.sheets import Progress


class PartsDone:
    """Told whenever some parts are done, it tells how many of how many are."""

    def __init__(self, tell: Progress, step: str, of: int) -> None:
        """Tell of a step with `of` parts; more than those are not told."""
        self._tell, self._step, self._of = tell, step, of
        self._done = 0
        self._lock = threading.Lock()

    def __call__(self, parts: int) -> None:
        """So many more are done."""
        with self._lock:
            self._done = min(self._done + parts, self._of)
            self._tell(self._step, self._done, self._of)
