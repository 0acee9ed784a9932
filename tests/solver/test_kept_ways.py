"""The interior point goes the ways that were kept, see `tests.solver.kept_ways`."""

import copy
import json

from tests.solver.kept_ways import KEPT, farthest, ways


def test_every_step_is_the_one_that_was_kept_on_any_processor():
    assert farthest(ways(), json.loads(KEPT.read_text(encoding="utf-8"))) <= 1e-7


def test_a_step_that_is_another_or_is_missing_is_seen():
    kept = json.loads(KEPT.read_text(encoding="utf-8"))
    other = copy.deepcopy(kept)
    other["a chain"][3][1] *= 1.0 + 1e-5
    assert farthest(other, kept) > 1e-7
    other["a chain"].pop()
    assert farthest(other, kept) == float("inf")
