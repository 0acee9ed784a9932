"""Patches of a user's own: what is refused and why, and that the one in the documentation works."""

import re
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest

from cadpanel.errors import SettingsError
from cadpanel.features import patches
from cadpanel.features.feature import Feature
from cadpanel.features.numbers import Number
from cadpanel.features.patch_checks import MEMBERS, check_patch, greatest_radius
from cadpanel.features.patches import Cone, Cylinder, Dimensions, Plane
from tests.own_patches import AngleFirst, ByGirth, ByRoot, CurvedBy

OWN = [CurvedBy(), AngleFirst(), ByGirth(), ByRoot()]


def documented(name: str) -> Any:
    """The class in the documentation of patches."""
    code = re.search(r"\n\n(    @dataclass.*?)\n\nA patch", patches.__doc__ or "", re.DOTALL)
    assert code is not None
    names: dict[str, Any] = {"dataclass": dataclass, "np": np, "Number": Number, "Dimensions": Dimensions}
    exec(re.sub(r"^    ", "", code.group(1), flags=re.MULTILINE), names)
    return names[name]


class Fine(CurvedBy):
    """A patch that passes; those that are refused differ from it in one member."""


@pytest.mark.parametrize("patch", [*OWN, Fine(), Plane(), Cone(), Cylinder(), Cylinder(radius=-300.0)], ids=repr)
def test_patches_whose_members_agree_pass(patch):
    check_patch(patch)


def test_the_patch_in_the_documentation_is_one():
    of = Feature(Plane(), documented("Bent")(), Plane())
    assert of.curved == (False, True, False)
    assert len(of.free) == 17
    assert [number.name for number in of.numbers[of.patch_slice(1)]] == ["patch 1: sweep", "patch 1: curvature"]
    assert of.in_units(2000.0).bounds()[0][of.patch_slice(1).stop - 1] == pytest.approx(1.0)


TURNS: Any = "turns"


@pytest.mark.parametrize("member", sorted(MEMBERS))
def test_a_patch_that_lacks_a_member_is_refused_and_told_what_it_must_give(member):
    lacking: Any = type("Lacking", (CurvedBy,), {member: None})
    with pytest.raises(SettingsError, match=f"lacks '{member}', which must give {MEMBERS[member]}"):
        Feature(lacking())


def test_a_patch_of_the_old_kind_is_refused_and_told_what_it_lacks():
    """It carries rulings by numbers that nobody else can read: it used to come out 41.8 mm from itself."""

    @dataclass(frozen=True)
    class Carrying:
        kind = "cylinder"

        def numbers(self):
            return Number("sweep", "angle"), Number("curvature", "curvature")

        def carry(self, frames, values, way):
            raise NotImplementedError

    carrying: Any = Carrying()
    with pytest.raises(SettingsError, match="lacks 'dimensions'"):
        Feature(carrying)


def changed(**members) -> Any:
    return type("Changed", (CurvedBy,), members)()


def off(rows=0.0, rates=0.0, half_angle=0.0):
    """Dimensions that are off by a little."""

    def dimensions(self, values):
        found = CurvedBy.dimensions(self, values)
        assert found.rates is not None
        return Dimensions(found.values + rows + np.array([0.0, half_angle, 0.0]), found.rates + rates)

    return dimensions


@pytest.mark.parametrize(
    ("members", "why"),
    [
        ({"kind": "sphere"}, "is of the kind 'sphere'; its surface can be plane or cone or cylinder"),
        ({"kind": 3}, "is of the kind 3"),
        ({"__hash__": None}, "make it a frozen dataclass"),
        ({"numbers": lambda _: [Number("sweep", "angle")]}, "give no tuple of Number"),
        ({"numbers": lambda _: ("sweep", "curvature")}, "give no tuple of Number"),
        ({"numbers": lambda _: 2 * (Number("sweep", "angle"),)}, "two numbers of one name: sweep, sweep"),
        ({"numbers": lambda _: (Number("sweep", TURNS),)}, "counts 'sweep' in 'turns', not in one of: length, "),
        ({"numbers_for": lambda _, dimensions: dimensions}, "'numbers_for' that give no 2 finite numbers"),
        ({"numbers_for": lambda _, dimensions: np.log(-dimensions[:, :2])}, "give no 2 finite numbers"),
        ({"numbers_for": lambda _, dimensions: dimensions[:, :2]}, "do not give back the numbers"),
        ({"dimensions": lambda _, values: values}, "give no Dimensions with a row of radius, half_angle, sweep"),
        ({"dimensions": lambda _, values: Dimensions(values)}, "give no Dimensions with a row of"),
        (
            {"dimensions": lambda self, values: Dimensions(CurvedBy.dimensions(self, values).values)},
            r"rates are \(1, 3, 3\), not \(2, 3, 2\)",
        ),
        ({"dimensions": off(rates=1e-4)}, "rates are not how their values follow the numbers"),
        ({"dimensions": off(half_angle=1e-9)}, "is called a cylinder and has a half angle that is not 0"),
        ({"dimensions": off(rows=np.array([1e-4, 0.0, 0.0]))}, "do not give back the numbers"),
    ],
)
def test_a_patch_whose_members_are_wrong_or_disagree_is_refused_with_the_reason(members, why):
    with pytest.raises(SettingsError, match=f"^the patch .*{why}"):
        Feature(changed(**members))


def test_a_length_that_is_no_number_of_the_patch_is_refused():
    """Its dimensions would change with the unit in which the solver counts lengths."""
    liner = np.array([0.01, 0.0, 0.0])

    class Liner(AngleFirst):
        def dimensions(self, values):
            return Dimensions(AngleFirst.dimensions(self, values).values + liner, np.eye(3)[[[2, 0, 1]]])

        def numbers_for(self, dimensions):
            return AngleFirst.numbers_for(self, dimensions - liner)

    with pytest.raises(SettingsError, match="'dimensions' that change with the unit of length: a length that is no"):
        Feature(Liner())


@pytest.mark.parametrize(
    ("patch", "greatest"),
    [
        (Cone(), np.inf),
        (Cone(radius=260.0), 260.0),
        (Cone(radius=(-5.0, 3.0)), 5.0),
        (Cone(radius=(5.0, None)), np.inf),
        (Cylinder(radius=-7.0, sweep=-0.5), 7.0),
        (CurvedBy(), np.inf),
        (CurvedBy(curvature=0.25), 4.0),
        (CurvedBy(curvature=(0.25, 0.5)), 4.0),
        (CurvedBy(curvature=(0.25, None)), 4.0),
        (CurvedBy(curvature=(None, 0.25)), np.inf),
        (CurvedBy(curvature=(-0.5, 0.25)), np.inf),
        (AngleFirst(radius=8.0), 8.0),
        (ByGirth(radius=(6.0, 9.0)), 9.0),
    ],
    ids=repr,
)
def test_the_greatest_radius_that_a_patch_may_have_is_known_whatever_it_is_told_by(patch, greatest):
    assert greatest_radius(patch) == pytest.approx(greatest)


@pytest.mark.parametrize("patch", OWN, ids=repr)
def test_numbers_in_another_unit_of_length_tell_of_the_same_patch(patch):
    kinds = np.array([[0.3, 0.05, 0.4]]) if patch.kind != "plane" else np.array([[0.3, 0.05]])
    numbers = patch.numbers_for(kinds)[0]
    held = [
        Number(n.name, n.unit, float(value)).in_units(2.5) for n, value in zip(patch.numbers(), numbers, strict=True)
    ]
    told = patch.dimensions(np.array([[number.fixed for number in held]])).values[0]
    here = patch.dimensions(numbers[None]).values[0]
    assert told[0] == pytest.approx(here[0] / 2.5)
    assert told[1:] == pytest.approx(here[1:])


@pytest.mark.parametrize("scale", [1e-3, 1.0, 1e4])
@pytest.mark.parametrize(("share", "passes"), [(0.99e-6, True), (1.01e-6, False)])
def test_numbers_come_back_to_a_millionth_of_the_largest_or_of_one(scale, share, passes):
    """The largest number of the patches that are tried is a sweep of 1.1."""
    off = share * max(1.0, 1.1 * scale)

    class Coarse(AngleFirst):
        """A cone whose numbers are told in parts of its dimensions, and come back a little off."""

        def dimensions(self, values):
            found = AngleFirst.dimensions(self, values / scale)
            assert found.rates is not None
            return Dimensions(found.values, found.rates / scale)

        def numbers_for(self, dimensions):
            return scale * AngleFirst.numbers_for(self, dimensions) + np.array([off, 0.0, 0.0])

    if passes:
        check_patch(Coarse())
    else:
        with pytest.raises(SettingsError, match="do not give back the numbers"):
            check_patch(Coarse())


class Blind(AngleFirst):
    """A patch that passes, but that its dimensions forget the sign of a half angle."""

    def dimensions(self, values):
        found = AngleFirst.dimensions(self, values)
        return Dimensions(np.abs(found.values), found.rates)


def test_a_patch_that_forgets_the_sign_of_an_angle_is_refused():
    check_patch(AngleFirst())
    with pytest.raises(SettingsError, match=r"has '(numbers_for|dimensions)' that"):
        check_patch(Blind())
