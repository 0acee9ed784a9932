"""Adding up what many groups say of few blocks."""

from __future__ import annotations

import numpy as np

from cadpanel.arrays import Array, IntArray


def scatter_add(target: Array, index: IntArray, values: Array) -> None:
    """target[index] += values, adding up where an index repeats; `index` is (groups,), `values` (groups, ...)."""
    if np.all(index[1:] > index[:-1]):
        target[index] += values
        return
    # Here, not above: terms use this, settings ask limits for their ranges, and neither help nor a refusal should wait
    # for SciPy.
    from scipy.sparse import csr_array

    groups = len(index)
    gather = csr_array((np.ones(groups), (index, np.arange(groups))), shape=(len(target), groups))
    summed: Array = np.asarray(gather @ values.reshape(groups, -1))
    target += summed.reshape(target.shape)
