"""The best pairing is the best of all: as brute force finds it, whichever rail comes first."""

from itertools import pairwise

import numpy as np
import pytest

from cadpanel.lofting.pairing import EVEN, best_pairing


def every_path(m, n, start):
    """All ordered ways from a place to the last one."""
    if start == (m - 1, n - 1):
        yield [start]
        return
    for down, right in ((1, 1), (1, 0), (0, 1)):
        i, j = start[0] + down, start[1] + right
        if i < m and j < n:
            for rest in every_path(m, n, (i, j)):
                yield [start, *rest]


def cost(path, q, even, a, b, first, last):
    """Of a whole path whose steps before place `first` and behind place `last` are fans; written from the text."""
    total = 0.0
    for number, (one, two) in enumerate(pairwise(path)):
        passed = 0.5 * (a[two[0]] - a[one[0]] + b[two[1]] - b[one[1]])
        smooth = first <= number < last
        sides = [even[place] + (q[place] if smooth else 0.0) for place in (one, two)]
        total += 0.5 * sum(sides) * passed
    if first > 0:
        total += q[path[first]]
    if last < len(path) - 1:
        total += q[path[last]]
    return total


def brute_force(q, a, b):
    m, n = q.shape
    even = EVEN * np.subtract.outer(a, b) ** 2
    least = np.inf
    for path in every_path(m, n, (0, 0)):
        starts = [k for k in range(len(path)) if k == 0 or all(p[0] == 0 for p in path[: k + 1])]
        starts += [k for k in range(1, len(path)) if all(p[1] == 0 for p in path[: k + 1])]
        ends = [k for k in range(len(path)) if all(p[0] == m - 1 for p in path[k:])]
        ends += [k for k in range(len(path)) if all(p[1] == n - 1 for p in path[k:])]
        for first in set(starts):
            for last in set(ends):
                if first <= last:
                    least = min(least, cost(path, q, even, a, b, first, last))
    return least


@pytest.mark.parametrize("seed", range(6))
def test_it_costs_what_the_best_of_all_pairings_costs(seed):
    random = np.random.default_rng(seed)
    m, n = (4, 5) if seed % 2 else (5, 4)
    q = random.uniform(0.0, 1.0, (m, n)) ** 3
    a, b = (np.concatenate([[0.0], np.sort(random.uniform(size=k - 2)), [1.0]]) for k in (m, n))
    found = best_pairing(q, a, b)
    assert found.cost == pytest.approx(brute_force(q, a, b), rel=1e-12)
    swapped = best_pairing(q.T, b, a)
    assert swapped.cost == pytest.approx(found.cost, rel=1e-12)
    assert np.array_equal(swapped.path[:, ::-1], found.path)


def test_where_all_is_free_the_pairing_is_even():
    share = np.linspace(0.0, 1.0, 9)
    found = best_pairing(np.zeros((9, 9)), share, share)
    assert found.cost == 0.0
    assert np.array_equal(found.path, np.repeat(np.arange(9)[:, None], 2, axis=1))
