"""A few of the mutants that keep the form of their file: each is read rightly, or refused in one sentence."""

import pytest

from tests.brep.files.mutants import MUTANTS, ending, originals, read
from tests.thorough import cases

SEEDS = {"strip.step": range(cases(4, 20)), "tube.3dm": range(cases(3, 10))}


@pytest.mark.parametrize("name", MUTANTS)
def test_mutant_is_read_rightly_or_refused_in_one_sentence(tmp_path, name):
    data = originals(tmp_path)[name]
    path = tmp_path / name
    _, whole = read(path)
    ends = []
    for seed in SEEDS[name]:
        text, same = MUTANTS[name](data, seed)
        path.write_bytes(text)
        ends.append(ending(*read(path), whole if same else None))
    assert "WRONG" not in ends
    assert "read" in ends
    assert len(ends) == len(SEEDS[name])
