"""Garbage is looked for as before once a block is left, however that ends, and never where nobody wanted it."""

import gc
from threading import Event

import pytest

from cadpanel import garbage
from cadpanel.garbage import garbage_left, keep_what_is_loaded, own_process


@pytest.fixture(autouse=True)
def as_before(monkeypatch):
    monkeypatch.setattr(garbage, "_OWN", Event())
    looked = gc.isenabled()
    yield
    (gc.enable if looked else gc.disable)()
    gc.unfreeze()
    garbage._freeze.cache_clear()


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


def test_what_is_loaded_is_kept_once_and_in_a_process_of_our_own_alone():
    keep_what_is_loaded()
    assert gc.get_freeze_count() == 0
    own_process()
    keep_what_is_loaded()
    kept = gc.get_freeze_count()
    assert kept > 1000
    own: list[list[int]] = [[] for _ in range(1000)]
    keep_what_is_loaded()
    assert gc.get_freeze_count() <= kept
    assert len(own) == 1000
