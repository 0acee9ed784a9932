"""Do the unknowns of a feature depend on each other? Told by the singular values of how the skin follows them."""

from __future__ import annotations

import numpy as np

from cadpanel.arrays import Array
from cadpanel.errors import SettingsError
from cadpanel.features.cut_planes import cut_plane_rates
from cadpanel.features.distance import patch_distance_inner, patch_outers
from cadpanel.features.numbers import POWERS
from cadpanel.features.panel_edges import ARC_SHARES
from cadpanel.features.patches import DIMENSIONS
from cadpanel.features.rulings import PanelFeature
from cadpanel.features.walk import arc_rulings, end_points, walk

# A direction of the unknowns that moves nothing has a singular value below this share of the largest.
NO_MOTION = 1e-9
# An unknown takes part in a dependency with at least this share of the largest.
TAKES_PART = 0.05
# Panels at random numbers on which a feature is tried; dependent is what is so on all of them.
TRIALS = 3
# What the dimensions of patches on such a panel are.
SPANS = {"width": (0.1, 0.3), "turn": (-0.1, 0.1), "radius": (0.2, 0.6), "half_angle": (0.02, 0.1), "sweep": (0.2, 0.5)}
# The largest of a feature's fixed lengths on such a panel.
LARGEST_FIXED = 0.3


def refuse_dependent(feature: PanelFeature) -> None:
    """Refuse a feature of which some unknowns, together, move nothing of the skin.

    Raises:
        SettingsError: naming the feature and the unknowns.
    """
    if not len(feature.free):
        raise SettingsError(f"feature '{feature.name}' leaves nothing for the fit to choose: free at least one number")
    guilty = _dependent(feature)
    if guilty:
        raise SettingsError(
            f"feature '{feature.name}' has unknowns that depend on each other, so that no fit could tell them apart: "
            f"{', '.join(guilty)}; fix one of them or leave out a patch"
        )


def _dependent(feature: PanelFeature) -> list[str]:
    """Names of the unknowns that take part in a dependency, of the worst one; empty where there is none.

    The anchor's numbers, which nobody can fix, are named only where nothing else takes part.
    """
    matrix = motions(feature, typical_values(feature))
    _, singular, directions = np.linalg.svd(matrix, full_matrices=False)
    if singular.shape[1] < len(feature.free):
        return [feature.numbers[i].name for i in feature.free]
    trial = int(np.argmax(singular[:, -1] / singular[:, 0]))
    if singular[trial, -1] > NO_MOTION * singular[trial, 0]:
        return []
    share = np.abs(directions[trial, -1])
    names = [feature.numbers[i].name for i, s in zip(feature.free, share, strict=True) if s >= TAKES_PART * share.max()]
    return [name for name in names if not name.startswith("anchor:")] or names


def motions(feature: PanelFeature, values: Array) -> Array:
    """(panels, rows, free) how what can be seen of a panel follows the unknowns.

    Seen are the surface (the distances of points that lie on its patches), the four outer corners, and the planes that
    cut the ends. A ruling between two patches is not seen by itself: two planes, or two cones with one axis and angle,
    may share it anywhere.
    """
    walked = walk(feature, values, derivatives=True)
    inside = arc_rulings(walked)
    at_rulings, at_arcs = (end_points(walked, rulings) for rulings in (walked.edges, inside))
    rulings, arcs, last = walked.edges.p.shape[1], inside.p.shape[1], len(feature.patches)
    rows, arc = [], 0
    for patch, curved in enumerate(feature.curved):
        own = [end * rulings + ruling for end in (0, 1) for ruling in (patch, patch + 1)]
        points = at_rulings.position[:, own]
        if curved:
            own = [end * arcs + arc + share for end in (0, 1) for share in range(len(ARC_SHARES))]
            points = np.concatenate([points, at_arcs.position[:, own]], axis=1)
            arc += len(ARC_SHARES)
        _, inner = patch_distance_inner(walked, np.moveaxis(points, 2, 0), patch)
        rows.append(inner @ patch_outers(walked)[:, patch])
    assert at_rulings.jacobian is not None
    rows.append(_flat(at_rulings.jacobian[:, [0, last, last + 1, -1]]))
    rows += [_flat(rates) for rates in cut_plane_rates(walked)]
    return feature.by_unknowns(np.concatenate(rows, axis=1))


def typical_values(feature: PanelFeature) -> Array:
    """(TRIALS, numbers) numbers of plausible panels about 1 long; always the same."""
    random = np.random.default_rng(0)
    values = random.uniform(-0.1, 0.1, (TRIALS, len(feature.numbers)))
    for i, patch in enumerate(feature.patches):
        least, greatest = np.array([SPANS[what] for what in DIMENSIONS[patch.kind]]).T
        values[:, feature.patch_slice(i)] = patch.numbers_for(random.uniform(least, greatest, (TRIALS, len(least))))
    for sign, (position, _, _) in zip((-1.0, 1.0), feature.cut_numbers.tolist(), strict=True):
        values[:, position] = sign * random.uniform(0.4, 0.6, TRIALS)
    return _in_scale(feature, feature.expand(values[:, feature.free]))


def _in_scale(feature: PanelFeature, values: Array) -> Array:
    """Fixed lengths are in mm, the others about 1: bring those that are fixed into the same range.

    All by one factor: two cylinders of one radius depend on each other, two of different radii do not.
    """
    powers = [POWERS[number.unit] for number in feature.numbers]
    fixed = {i: number.fixed for i, number in enumerate(feature.numbers) if powers[i] and number.fixed}
    largest = max((abs(value) ** (1.0 / powers[i]) for i, value in fixed.items()), default=1.0)
    for i, value in fixed.items():
        values[:, i] = value * (LARGEST_FIXED / largest) ** powers[i]
    return values


def _flat(derivatives: Array) -> Array:
    """(panels, rows, N) of derivatives (panels, ..., N)."""
    panels, numbers = derivatives.shape[0], derivatives.shape[-1]
    return derivatives.reshape(panels, derivatives[0, ..., 0].size, numbers)
