"""Random panels of every feature, seeded: valid instances of a chain, and polygons."""

from __future__ import annotations

import numpy as np

from cadpanel.arrays import Array
from cadpanel.features.catalogue import CATALOGUE, feature
from cadpanel.features.cut_planes import cut_planes
from cadpanel.features.feature import Feature
from cadpanel.features.rulings import Walk
from cadpanel.geometry.frames import cayley
from cadpanel.geometry.patches import ConePatch, Patch, PlanePatch
from cadpanel.geometry.shape import PanelShape, PolygonShape

# Every feature that has a name; of the cone splines two.
NAMES = [*CATALOGUE, "cone-spline-4", "cone-spline-6"]
# Those with cones whose half angle is free.
TAPERED = [name for name in NAMES if any(patch.kind == "cone" for patch in feature(name).patches)]


def random_shapes(
    of: Feature, seed: int, count: int, *, length: float = 2000.0, half_angle: float | None = None
) -> list[PanelShape]:
    """Buildable panels of a feature, about `length` mm long, anywhere within 5 m of the origin.

    Args:
        of: the feature.
        seed: of the random numbers.
        count: how many.
        length: mm.
        half_angle: radians, of every cone; None for any.
    """
    random = np.random.default_rng(seed)
    values = _random_values(of, random, count, half_angle)
    walked = of.walk(values, derivatives=False)
    origins = random.uniform(-5000.0, 5000.0, (count, 3))
    turn = np.swapaxes(cayley(random.uniform(-1.0, 1.0, (count, 3))), 1, 2)
    points = length * walked.edges.p @ turn + origins[:, None]
    directions, normals = walked.edges.t @ turn, walked.edges.n @ turn
    m, s = cut_planes(walked)
    size = np.linalg.norm(m, axis=-1, keepdims=True)
    cut_points = length * (s[..., None] * m / size**2) @ turn + origins[:, None]
    cut_normals = (m / size) @ turn
    return [
        PanelShape(
            name=f"panel {i + 1}",
            feature=of.name,
            points=points[i],
            directions=directions[i],
            normals=normals[i],
            patches=_patches(walked, i, length),
            cut_points=cut_points[i],
            cut_normals=cut_normals[i],
        )
        for i in range(count)
    ]


def _patches(walked: Walk, panel: int, length: float) -> tuple[Patch, ...]:
    patches: list[Patch] = []
    for i, patch in enumerate(walked.feature.patches):
        if patch.kind == "plane":
            patches.append(PlanePatch())
        else:
            radius, half_angle, sweep = walked.dimensions[i].values[panel].tolist()
            patches.append(ConePatch(radius=length * radius, half_angle=half_angle, sweep=sweep, kind=patch.kind))
    return tuple(patches)


def _random_values(of: Feature, random: np.random.Generator, count: int, half_angle: float | None) -> Array:
    """(count, numbers) lengths in panel lengths; what the feature fixes or ties has its value."""
    values = np.zeros((count, len(of.numbers)))
    values[:, :2] = random.uniform(-0.05, 0.05, (count, 2))
    values[:, 2:5] = random.uniform(-0.1, 0.1, (count, 3))
    for i, curved in enumerate(of.curved):
        dimensions = np.zeros((count, 3 if curved else 2))
        dimensions[:, 0] = random.uniform(0.1, 0.3 if curved else 0.4, count)
        dimensions[:, 1] = random.uniform(-0.05, 0.05, count)
        if curved:
            dimensions[:, 2] = random.uniform(0.5, 1.5, count) / sum(of.curved)
            if half_angle is not None:
                # Neighbours of one half angle must differ in their radii, or none could tell where they part.
                dimensions[:, 0] = random.uniform(*((0.1, 0.18), (0.22, 0.3))[i % 2], count)
                dimensions[:, 1] = half_angle
        values[:, of.patch_slice(i)] = of.patches[i].numbers_for(dimensions)
    for end in (0, 1):
        at = of.cut_slice(end).start
        values[:, at] = (end - 0.5) * random.uniform(0.9, 1.1, count)
        values[:, at + 1] = random.uniform(-0.1, 0.1, count)
        values[:, at + 2] = random.uniform(-0.2, 0.2, count)
    return of.expand(values[:, of.free])


def random_polygon(seed: int, corners: int, *, size: float = 1000.0) -> PolygonShape:
    """A convex polygon with corners about `size` mm from its middle, anywhere within 5 m of the origin."""
    random = np.random.default_rng(seed)
    turn = 2.0 * np.pi * (np.arange(corners) + random.uniform(-0.2, 0.2, corners)) / corners
    reach = size * random.uniform(0.9, 1.1, corners)
    axes, _ = np.linalg.qr(random.normal(size=(3, 3)))
    b, t = axes[0], axes[1]
    outline = random.uniform(-5000.0, 5000.0, 3) + np.outer(reach * np.cos(turn), b) + np.outer(reach * np.sin(turn), t)
    return PolygonShape(name=f"polygon {corners}", feature="planar-polygon", outline=outline, normal=np.cross(b, t))
