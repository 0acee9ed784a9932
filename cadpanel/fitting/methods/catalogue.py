"""Every method by the name that settings, command line and reports know it by.

A new method is a file beside these and a line here. Its name is one of `fitting.settings.Method`, from which the
command line takes its choices; type checkers and a test hold the two alike. Settings cannot ask this table themselves,
as methods are told by settings and not the other way round.
"""

from __future__ import annotations

from collections.abc import Mapping

from cadpanel.fitting.methods.annealing import Annealing
from cadpanel.fitting.methods.concurrent import Concurrent
from cadpanel.fitting.methods.local import Local
from cadpanel.fitting.methods.method import Method
from cadpanel.fitting.methods.two_stage import TwoStage
from cadpanel.fitting.settings import FitSettings
from cadpanel.fitting.settings import Method as MethodName

LOCAL, TWO_STAGE = Local(), TwoStage()
"""What every fit begins from, and what it is held against besides."""

METHODS: Mapping[MethodName, Method] = {
    "local": LOCAL,
    "two_stage": TWO_STAGE,
    "concurrent": Concurrent(),
    "annealing": Annealing(),
}


def method_for(settings: FitSettings) -> Method:
    """The method that the settings ask for, or what takes its place where they give weights."""
    method = METHODS[settings.method]
    return method if settings.weights is None else method.with_weights()
