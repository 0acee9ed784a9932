"""Every argument of every public function: what is none of its values is refused in one sentence, before any work."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterator
from dataclasses import fields
from functools import cache
from typing import Any

import numpy as np
import pytest

import cadpanel as cp
from cadpanel.api_keywords import MadeKeywords
from cadpanel.delivery.shop_settings import ShopSettings
from tests.delivered import fitted, strip


class Accepted(Exception):
    """An argument has passed all checks."""


STRANGE: tuple[Any, ...] = (object(), 1j, b"x", [object()], {"a": object()}, {1, 2})
"""Values of no argument."""
NO_NUMBERS: tuple[Any, ...] = (float("nan"), float("inf"), -1e9, "x", [1.0, 2.0], np.zeros((2, 2)))
POINTS = np.random.default_rng(1).normal(size=(30, 3))
RAIL = np.column_stack([np.linspace(0.0, 2000.0, 9), np.zeros(9), np.zeros(9)])


@cache
def spanned() -> cp.Loft:
    """A flat one."""
    return cp.loft(RAIL, RAIL + np.array([0.0, 0.0, 500.0]))


CALLS: dict[str, Callable[[], dict[str, Any]]] = {
    "read": lambda: {"path": "none.step"},
    "inspect": lambda: {"path": "none.step"},
    "fit": lambda: {"reference": strip()},
    "compare": lambda: {"reference": strip()},
    "deliver": lambda: {"result": fitted(), "out": "none"},
    "unroll": lambda: {"shape": fitted().shapes[0]},
    "to_cadquery": lambda: {"panels": fitted()},
    "to_build123d": lambda: {"panels": fitted()},
    "write_step": lambda: {"result": fitted(), "path": "none.step"},
    "study": lambda: {"reference": strip(), "gaps": [1.0]},
    "fewest_panels": lambda: {"path": "none.step", "max_deviation": 5.0},
    "diff": lambda: {"before": "none", "now": "none"},
    "verify": lambda: {"folder": "none"},
    "fit_plane": lambda: {"points": POINTS},
    "fit_cylinder": lambda: {"points": POINTS},
    "fit_cone": lambda: {"points": POINTS},
    "assemble": lambda: {"deliveries": ["none"], "file": "none.step"},
    "run_job": lambda: {"job": "none.toml"},
    "rails": lambda: {"path": "none.step"},
    "loft": lambda: {"a": RAIL, "b": RAIL + np.array([0.0, 0.0, 500.0])},
    "deliver_loft": lambda: {"loft": spanned(), "out": "none"},
    "build_skin": lambda: {"shape": fitted().shapes[0]},
    "build_solid": lambda: {"shape": fitted().shapes[0], "thickness": 3.0},
}
"""A call of every public function that would go well."""
KEYWORDS = {
    "read": cp.ReferenceSettings,
    "inspect": cp.ReferenceSettings,
    "fit": cp.FitSettings,
    "compare": cp.FitSettings,
    "study": cp.FitSettings,
    "fewest_panels": cp.FitSettings,
    "deliver": ShopSettings,
}
MADE = ("to_cadquery", "to_build123d", "write_step")
# Where each begins to work: what has come so far was accepted.
WORK = (
    "cadpanel.api.fit_reference",
    "cadpanel.api_job.read_job",
    "cadpanel.api_shapes.unroll_all",
    "cadpanel.brep.read.read_reference",
    "cadpanel.brep.survey.survey",
    "cadpanel.studies.table1.compare",
    "cadpanel.studies.trade_off.trade_off",
    "cadpanel.studies.fewest_panels.fewest_panels",
    "cadpanel.delivery.deliver.fill_delivery",
    "cadpanel.delivery.loft_files.write_loft_files",
    "cadpanel.lofting.loft.best_pairing",
    "cadpanel.delivery.sheets.build_panels",
)


def parameters(name: str) -> Iterator[tuple[str, Any]]:
    """Every argument with its default, keywords of settings among them."""
    for one in inspect.signature(getattr(cp, name)).parameters.values():
        if one.kind is not one.VAR_KEYWORD:
            yield one.name, one.default
    if name in KEYWORDS:
        for own in fields(KEYWORDS[name]):
            yield own.name, own.default
    if name in MADE:
        yield from ((keyword, None) for keyword in MadeKeywords.__annotations__)


def wrong(default: Any) -> tuple[Any, ...]:
    number = isinstance(default, int | float) and not isinstance(default, bool)
    return STRANGE + (NO_NUMBERS if number else ())


def test_every_public_function_is_called() -> None:
    functions = {name for name in cp.__all__ if inspect.isfunction(getattr(cp, name)) and name[0].islower()}
    assert functions == set(CALLS)


@pytest.mark.parametrize("name", CALLS)
def test_what_is_no_value_of_an_argument_is_refused_in_one_sentence(
    name: str, monkeypatch: pytest.MonkeyPatch, tmp_path: Any
) -> None:
    monkeypatch.chdir(tmp_path)
    CALLS[name]()  # what is fitted or spanned for it is, before nothing works any more

    def stop(*_: object, **__: object) -> None:
        raise Accepted

    for place in WORK:
        monkeypatch.setattr(place, stop)
    came_through = []
    for argument, default in parameters(name):
        for value in wrong(default):
            try:
                getattr(cp, name)(**{**CALLS[name](), argument: value})
                said = "was accepted"
            except cp.CadpanelError as error:
                said = "" if "\n" not in str(error) else str(error)
            except Accepted:
                said = "was accepted"
            except Exception as error:  # noqa: BLE001 - this is what is looked for
                said = f"{type(error).__name__}: {error}"
            if said:
                came_through.append(f"{argument}={value!r:.40}: {said:.90}")
    assert "\n".join(came_through) == ""
