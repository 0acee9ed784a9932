"""An interrupt is known by whatever was made of it, and no other error is taken for one."""

from __future__ import annotations

from itertools import pairwise

import pytest

from cadpanel.causes import causes, stopped_by


def caused(*errors: BaseException) -> BaseException:
    """The first of them, each made of the next one."""
    for error, cause in pairwise(errors):
        error.__cause__ = cause
    return errors[0]


def test_causes_begin_with_the_error_itself_and_end_with_the_first() -> None:
    chain = [ImportError(), ValueError(), OSError()]
    assert list(causes(caused(*chain))) == chain


@pytest.mark.parametrize("stop", [KeyboardInterrupt(), SystemExit(143)])
@pytest.mark.parametrize("between", [[], [ImportError("initialization failed")], [ImportError("outer"), OSError()]])
def test_what_was_made_of_an_end_is_known(stop: BaseException, between: list[BaseException]) -> None:
    assert stopped_by(caused(*between, stop)) is stop


def test_an_error_of_its_own_is_none() -> None:
    assert stopped_by(caused(ImportError("no such file"), OSError("gone"))) is None
    during = ImportError("after it")
    during.__context__ = KeyboardInterrupt()  # it came while somebody cleared up, and is to be told
    assert stopped_by(during) is None
