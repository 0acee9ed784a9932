"""Options stand in groups, in one order, and a new setting has its group at once."""

from __future__ import annotations

from inspect import signature
from typing import get_args

import pytest

from cadpanel.cli.fit import fit
from cadpanel.cli.groups import GROUPS, LIMITS, RUN, SHAPE, SHEET, group_of, rank
from cadpanel.delivery.shop_settings import ShopSettings
from cadpanel.fitting.settings import FitSettings
from cadpanel.terms.limits import catalogue


def groups_of_fit() -> list[str | None]:
    """The group of each parameter of the command, in the order of its help."""
    shown = [get_args(parameter.annotation)[1] for parameter in signature(fit).parameters.values()]
    return [getattr(option, "rich_help_panel", None) for option in shown]


def test_every_option_of_fit_has_a_group_and_groups_stand_in_their_order() -> None:
    found = groups_of_fit()
    assert found[0] is None  # the reference is no option
    assert tuple(dict.fromkeys(found[1:])) == GROUPS
    assert found == sorted(found, key=rank)


def test_every_limit_stands_among_the_limits() -> None:
    asked = [limit.name for limit in catalogue.LIMITS if limit.asked]
    assert asked
    assert {group_of(FitSettings, name) for name in asked} == {LIMITS}


@pytest.mark.parametrize(
    ("settings", "name", "group"),
    [(FitSettings, "blend", SHAPE), (FitSettings, "seed", RUN), (ShopSettings, "fixings", SHEET), (int, "real", None)],
)
def test_single_settings_stand_where_they_are_looked_for(settings: type, name: str, group: str | None) -> None:
    assert group_of(settings, name) == group
