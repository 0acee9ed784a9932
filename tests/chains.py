"""Every shape feature that the laws are held against, random valid numbers, and problems without a reference."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from cadpanel.features.catalogue import CATALOGUE, feature
from cadpanel.features.feature import Feature
from cadpanel.features.patches import Cone, Cylinder, Plane
from cadpanel.features.walk import Points, pierce, walk
from cadpanel.fitting.problem import Problem
from cadpanel.geometry.frames import cayley
from cadpanel.terms.deviation import Deviation
from cadpanel.terms.drift import Outline
from cadpanel.terms.gap import Placement, Seams

Array = NDArray[np.float64]
IntArray = NDArray[np.intp]

# Chains that a user might compose; the package has no names for them.
COMPOSED = {
    "plane-cone-cone-plane": (Plane(), Cone(), Cone(), Plane()),
    "cone-plane-cone": (Cone(), Plane(), Cone()),
    "plane-cone": (Plane(), Cone()),
    "plane-cylinder-plane-cone-plane": (Plane(), Cylinder(), Plane(), Cone(), Plane()),
}
FEATURES: dict[str, Feature] = {
    **{name: feature(name) for name in CATALOGUE},
    **{f"{name}, tilt fixed": feature(name, tilt="fixed") for name in CATALOGUE},
    **{name: Feature(name, patches) for name, patches in COMPOSED.items()},
    "plane-cone-cone-plane, tilt fixed": Feature("plane-cone-cone-plane", COMPOSED["plane-cone-cone-plane"], "fixed"),
}
# Turned end for end these are the same chain, anchored in the same patch.
SYMMETRIC = {
    name: one
    for name, one in FEATURES.items()
    if one.patches == one.patches[::-1] and 2 * one.anchor == len(one.patches) - 1
}


def random_values(of: Feature, seed: int, panels: int = 3) -> Array:
    """(panels, N) valid numbers: a panel about 1 long, with flanges, folds and mitres like those of a real one."""
    random = np.random.default_rng(seed)
    curved = sum(patch.kind != "plane" for patch in of.patches)
    values = np.zeros((panels, len(of.numbers)))
    values[:, :2] = random.uniform(-0.05, 0.05, (panels, 2))
    values[:, 2:5] = random.uniform(-0.1, 0.1, (panels, 3))
    for i, patch in enumerate(of.patches):
        at = of.patch_slice(i).start
        if patch.kind == "plane":
            values[:, at] = random.uniform(0.1, 0.4, panels)
            values[:, at + 1] = random.uniform(-0.05, 0.05, panels)
        else:
            values[:, at] = random.uniform(0.1, 0.3, panels)
            values[:, at + 1] = random.uniform(-0.05, 0.05, panels)
            values[:, at + 2] = random.uniform(0.5, 1.5, panels) / curved
    for end in (0, 1):
        at = of.cut_slice(end).start
        values[:, at] = (end - 0.5) * random.uniform(0.9, 1.1, panels)
        values[:, at + 1] = random.uniform(-0.1, 0.1, panels)
        values[:, at + 2] = random.uniform(-0.2, 0.2, panels)
    for i, number in enumerate(of.numbers):
        if number.fixed is not None:
            values[:, i] = number.fixed
    return values


def random_unknowns(of: Feature, seed: int, panels: int = 3) -> Array:
    """(panels, free) the unknowns of `random_values`."""
    return random_values(of, seed, panels)[:, of.free]


def slopes(points: Points) -> Array:
    """The Jacobian of points that were walked with derivatives."""
    assert points.jacobian is not None
    return points.jacobian


def made_problem(of: Feature, seed: int, *, panels: int = 4, length: float = 2000.0, ring: bool = False) -> Problem:
    """A strip of panels (or a closed ring) without a reference; its samples and outlines lie near random panels.

    Some seams are reversed, as if their panels had been walked from the other side.
    """
    random = np.random.default_rng(seed)
    values = random_values(of, seed, panels)
    walked = walk(of, values, derivatives=False)
    corners = pierce(walked, walked.edges).position
    share = random.uniform(0.1, 0.9, (panels, 40))
    ruling = random.integers(0, corners.shape[2], (panels, 40))
    rows = np.arange(panels)[:, None]
    samples = (1.0 - share)[..., None] * corners[rows, 0, ruling] + share[..., None] * corners[rows, 1, ruling]
    samples += 0.02 * random.normal(size=samples.shape)
    chords = corners[:, 1] - corners[:, 0]
    along = np.stack([chords, chords], axis=1) / np.linalg.norm(chords, axis=-1)[:, None, :, None]
    origins = length * np.arange(panels)[:, None] * np.array([0.0, 1.0, 0.0]) + 50.0 * random.normal(size=(panels, 3))
    first = np.arange(panels - 1)
    pairs = np.stack([first, first + 1], axis=1)
    ends = np.tile([1, 0], (panels - 1, 1))
    if ring:
        pairs, ends = np.concatenate([pairs, [[0, panels - 1]]]), np.concatenate([ends, [[0, 1]]])
    seams = Seams(
        panels=pairs.astype(np.intp),
        ends=ends.astype(np.intp),
        reversed=np.arange(len(pairs)) % 3 == 1,
        pair=np.arange(len(pairs)),
    )
    return Problem(
        feature=of,
        place=Placement(
            origins=origins,
            centre=np.array([1000.0, -2000.0, 500.0]),
            axes=cayley(0.1 * random.normal(size=(panels, 3))),
            length=length,
        ),
        deviation=Deviation(
            np.ascontiguousarray(np.moveaxis(samples, 2, 0)), np.sqrt(random.uniform(0.5, 1.5, samples.shape[:2]))
        ),
        outline=Outline(
            corners + 0.03 * random.normal(size=corners.shape),
            along,
            np.array([0.0, 1.0, 0.0]) + 0.2 * random.normal(size=(panels, 2, 3)),
        ),
        lengths=np.ones(panels),
        seams=seams,
        pairs=pairs.astype(np.intp),
    )
