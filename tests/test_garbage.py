"""Garbage is looked for as before once a block is left, however that ends, and never where nobody wanted it."""

import gc

import pytest

from cadpanel.garbage import garbage_left, keep_what_is_loaded


@pytest.fixture(autouse=True)
def as_before():
    looked = gc.isenabled()
    yield
    (gc.enable if looked else gc.disable)()
    gc.unfreeze()
    keep_what_is_loaded.cache_clear()


@pytest.mark.parametrize("looked", [True, False])
def test_garbage_is_left_in_a_block_and_looked_for_as_before_behind_it(looked):
    (gc.enable if looked else gc.disable)()
    with garbage_left():
        assert not gc.isenabled()
        with garbage_left():
            assert not gc.isenabled()
        assert not gc.isenabled()
    assert gc.isenabled() == looked
    with pytest.raises(ZeroDivisionError), garbage_left():
        raise ZeroDivisionError
    assert gc.isenabled() == looked


def test_what_is_loaded_is_kept_once():
    assert gc.get_freeze_count() == 0
    keep_what_is_loaded()
    kept = gc.get_freeze_count()
    assert kept > 1000
    own: list[list[int]] = [[] for _ in range(1000)]
    keep_what_is_loaded()
    assert gc.get_freeze_count() <= kept
    assert len(own) == 1000
