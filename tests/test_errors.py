"""Errors travel between processes whole: what they say, and what they know."""

import inspect
import pickle

import pytest

from cadpanel import errors
from cadpanel.errors import CadpanelError, NoStripError, OutlineError, OverlapError, PanelError, ProofError

KINDS = [kind for _, kind in inspect.getmembers(errors, inspect.isclass) if issubclass(kind, CadpanelError)]
FAULT = ("N-01", "x.step", "it is none", "leave it out")
GIVEN: dict[type[CadpanelError], tuple[object, ...]] = {
    NoStripError: ("it is none", "leave it out"),
    OutlineError: FAULT,
    OverlapError: FAULT,
    PanelError: FAULT[:2],
    ProofError: (("Panel 'a' is missing.", "Panel 'b' has a kink."),),
}


@pytest.mark.parametrize("kind", KINDS, ids=lambda kind: kind.__name__)
def test_an_error_that_was_pickled_says_and_knows_the_same(kind: type[CadpanelError]) -> None:
    told = kind(*GIVEN.get(kind, ("Nothing is there.",)))
    again = pickle.loads(pickle.dumps(told))
    assert type(again) is kind
    assert str(again) == str(told)
    assert vars(again) == vars(told)
