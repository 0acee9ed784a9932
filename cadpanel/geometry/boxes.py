"""Which of many boxes meet."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from cadpanel.arrays import Array


def meeting(least: Array, greatest: Array, touch: float) -> Iterator[tuple[int, int]]:
    """Pairs (i, j), i < j, of boxes that share more than a layer of thickness `touch`, each once.

    Swept along x, in the order in which they begin.

    Args:
        least: (n, 3) least coordinates.
        greatest: (n, 3) greatest coordinates.
        touch: how far two may reach into each other without meeting.
    """
    order = np.argsort(least[:, 0], kind="stable")
    starts = least[order, 0]
    for place, i in enumerate(order.tolist()):
        last = int(np.searchsorted(starts, greatest[i, 0] - touch))
        others = order[place + 1 : last]
        meets = (least[others, 1:] < greatest[i, 1:] - touch) & (greatest[others, 1:] > least[i, 1:] + touch)
        yield from ((min(i, j), max(i, j)) for j in others[meets.all(axis=1)].tolist())
