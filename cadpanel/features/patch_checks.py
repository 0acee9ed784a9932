"""Does a patch give what the package asks of it, and do its members agree? Asked when a feature is made of it."""

from __future__ import annotations

import itertools
import math
from typing import Any, get_args

import numpy as np

from cadpanel.arrays import Array
from cadpanel.errors import SettingsError
from cadpanel.features.numbers import POWERS, Number
from cadpanel.features.patches import DIMENSIONS, Dimensions, Kind, Patch

MEMBERS = {
    "numbers": "the patch's own numbers, as a tuple of Number",
    "dimensions": "the Dimensions, width and turn or radius, half angle and sweep, of patches with given numbers",
    "numbers_for": "the numbers of patches with given dimensions, from which a fit can start",
}
"""What a patch has besides its kind, and what each member gives."""

# Dimensions of two plausible patches of panels that are about 1 long.
_PLANES = np.array([[0.2, 0.03], [0.35, -0.05]])
_CONES = np.array([[0.3, 0.05, 0.4], [0.5, -0.02, 1.1]])
# Central differences with this step agree with derivatives to the tolerance; so do numbers told there and back.
_STEP, _AGREES = 1e-6, 1e-6
# Another unit of length, in which the dimensions must come out as in the first.
_OTHER_UNIT = 2.0


def check_patch(patch: Any) -> None:
    """Refuse what is no patch, and a patch whose own members are missing or disagree.

    Raises:
        SettingsError: with one sentence that names the member and what it must give.
    """
    if isinstance(patch, type) or not hasattr(patch, "kind"):
        raise SettingsError(f"a feature is made of patches like Plane(), Cone() or Cylinder(), not of {patch!r}")
    if patch.kind not in get_args(Kind):
        raise _refused(patch, f"is of the kind {patch.kind!r}; its surface can be {' or '.join(get_args(Kind))}")
    for member, gives in MEMBERS.items():
        if not callable(getattr(patch, member, None)):
            raise _refused(patch, f"lacks '{member}', which must give {gives}")
    try:
        hash(patch)
    except TypeError as error:
        raise _refused(patch, "cannot be a key of a dictionary: make it a frozen dataclass") from error
    _check_numbers(patch)
    with np.errstate(all="ignore"):
        _check_dimensions(patch)


def _refused(patch: object, why: str) -> SettingsError:
    return SettingsError(f"the patch {patch!r} {why}")


def _check_numbers(patch: Patch) -> None:
    numbers: Any = patch.numbers()
    if not (isinstance(numbers, tuple) and all(isinstance(number, Number) for number in numbers)):
        raise _refused(patch, f"has 'numbers' that give no tuple of Number but {numbers!r}")
    names = [number.name for number in numbers]
    if len(set(names)) < len(names):
        raise _refused(patch, f"has two numbers of one name: {', '.join(names)}")
    for number in numbers:
        if number.unit not in POWERS:
            raise _refused(patch, f"counts '{number.name}' in {number.unit!r}, not in one of: {', '.join(POWERS)}")


def _check_dimensions(patch: Patch) -> None:
    """Try `dimensions` and `numbers_for` on plausible patches."""
    wanted = _PLANES if patch.kind == "plane" else _CONES
    count, size = len(patch.numbers()), len(DIMENSIONS[patch.kind])
    values: Any = patch.numbers_for(wanted.copy())
    if np.shape(values) != (len(wanted), count) or not np.isfinite(values).all():
        raise _refused(patch, f"has 'numbers_for' that give no {count} finite numbers for each of {wanted.tolist()}")
    found: Any = patch.dimensions(np.array(values))
    if not isinstance(found, Dimensions) or np.shape(found.values) != wanted.shape:
        names = ", ".join(DIMENSIONS[patch.kind])
        raise _refused(patch, f"has 'dimensions' that give no Dimensions with a row of {names} for each patch")
    rates = found.by_numbers()
    if np.shape(rates)[1:] != (size, count) or len(rates) not in (1, len(wanted)):
        raise _refused(patch, f"has 'dimensions' whose rates are {np.shape(rates)}, not {(len(wanted), size, count)}")
    if patch.kind == "cylinder" and patch.dimensions(_held(patch, np.array(values))).values[:, 1].any():
        raise _refused(patch, "is called a cylinder and has a half angle that is not 0")
    if not _agree(patch.numbers_for(found.values), values):
        raise _refused(patch, "has 'numbers_for' that do not give back the numbers whose 'dimensions' they are given")
    if not _agree(np.broadcast_to(rates, (len(wanted), size, count)), _differences(patch, np.array(values))):
        raise _refused(patch, "has 'dimensions' whose rates are not how their values follow the numbers")
    if not _agree(patch.dimensions(_in_other_unit(patch, np.array(values))).values, _scaled(patch, found.values)):
        raise _refused(
            patch,
            "has 'dimensions' that change with the unit of length: a length that is no number of the patch must become "
            "one, which may be held",
        )


def _held(patch: Patch, values: Array) -> Array:
    """The values with what the author holds in its place."""
    fixed = [number.fixed for number in patch.numbers()]
    return np.array([[own if at is None else at for own, at in zip(row, fixed, strict=True)] for row in values])


def _agree(one: Array, other: Array) -> bool:
    return bool(np.abs(np.asarray(one) - other).max(initial=0.0) <= _AGREES * max(1.0, np.abs(other).max(initial=0.0)))


def _differences(patch: Patch, values: Array) -> Array:
    """(n, d, numbers) central differences of the dimensions."""
    steps = _STEP * np.eye(values.shape[1])
    columns = [
        (patch.dimensions(values + step).values - patch.dimensions(values - step).values) / (2.0 * _STEP)
        for step in steps
    ]
    return np.stack(columns, axis=-1) if columns else np.zeros((len(values), len(DIMENSIONS[patch.kind]), 0))


def _in_other_unit(patch: Patch, values: Array) -> Array:
    return values / _OTHER_UNIT ** np.array([POWERS[number.unit] for number in patch.numbers()])


def _scaled(patch: Patch, dimensions: Array) -> Array:
    """Dimensions in the other unit: width and radius, which come first, are lengths."""
    units = np.ones(len(DIMENSIONS[patch.kind]))
    units[0] = _OTHER_UNIT
    scaled: Array = dimensions / units
    return scaled


def greatest_radius(patch: Patch) -> float:
    """The greatest radius, whatever its sign, that the author of a curved patch lets it have; often infinite.

    What its numbers are held at or between is tried at the ends, and at 0 where that lies between: there a radius that
    is told by its curvature has its pole.
    """
    rates = patch.dimensions(patch.numbers_for(_CONES.copy())).by_numbers()[0, 0]
    ends = []
    for number, rate in zip(patch.numbers(), rates, strict=True):
        if rate == 0.0:
            ends.append([1.0])
        elif number.fixed is not None:
            ends.append([number.fixed])
        else:
            ends.append([number.lower, number.upper, *([0.0] if number.lower < 0.0 < number.upper else [])])
    with np.errstate(all="ignore"):
        radii = np.abs(patch.dimensions(np.array(list(itertools.product(*ends)))).values[:, 0])
    return float(np.where(np.isnan(radii), math.inf, radii).max())
