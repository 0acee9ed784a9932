"""Random panels of building size, seeded, for every test of geometry and B-rep."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from cadpanel.arrays import Array
from cadpanel.geometry.cone_sections import axis_frame
from cadpanel.geometry.patches import ConePatch, Patch, PlanePatch
from cadpanel.geometry.shape import PanelShape

CHAINS = {
    "plane-cone-plane": "pcp",
    "cone": "c",
    "plane": "p",
    "plane-cone": "pc",
    "plane-cone-cone-plane": "pccp",
    "cone-plane-cone": "cpc",
}


def walk(
    patches: Sequence[Patch], steps: Sequence[tuple[float, float]], point: Array, direction: Array, normal: Array
) -> tuple[Array, Array, Array]:
    """Rulings of a chain; `steps` holds (width, turn) for each plane patch in its turn."""
    points, directions, normals = [point], [direction], [normal]
    plane_steps = iter(steps)
    for patch in patches:
        point, direction, normal = points[-1], directions[-1], normals[-1]
        if isinstance(patch, ConePatch):
            frame = axis_frame(point, direction, normal, patch)
            radial = frame.radials(np.array([patch.sweep]))[0]
            cosine, sine = math.cos(patch.half_angle), math.sin(patch.half_angle)
            points.append(frame.center + frame.level_radius * radial)
            directions.append(cosine * frame.axis + sine * radial)
            normals.append(cosine * radial - sine * frame.axis)
        else:
            width, turn = next(plane_steps)
            across = np.cross(direction, normal)
            points.append(point + width * across)
            directions.append(math.cos(turn) * direction + math.sin(turn) * across)
            normals.append(normal)
    return np.array(points), np.array(directions), np.array(normals)


def random_panel(
    seed: int,
    *,
    name: str = "A-01",
    chain: str = "plane-cone-plane",
    half_angle: float | None = None,
    concave: bool = False,
    mitre: float = 0.3,
    length: float = 2000.0,
) -> PanelShape:
    """A buildable panel; the cuts tilt by at most `mitre` radians against the middle ruling's normal plane."""
    rng = np.random.default_rng(seed)
    patches: list[Patch] = []
    steps: list[tuple[float, float]] = []
    kinds = CHAINS[chain]
    for index, kind in enumerate(kinds):
        if kind == "p":
            patches.append(PlanePatch())
            steps.append((float(rng.uniform(150.0, 400.0)), float(rng.uniform(-0.02, 0.02))))
            continue
        sign = -1.0 if concave and index == kinds.rindex("c") else 1.0
        angle = float(rng.uniform(-0.03, 0.03)) if half_angle is None else half_angle
        radius = float(rng.uniform(120.0, 400.0)) + 0.75 * length * math.tan(abs(angle))
        sweep = float(rng.uniform(0.4, 1.6)) / kinds.count("c") ** 0.5
        patches.append(ConePatch(radius=sign * radius, half_angle=angle, sweep=sign * sweep))
    frame, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    direction, normal = frame[:, 0], frame[:, 1]
    origin = rng.uniform(-20000.0, 20000.0, size=3)
    points, directions, normals = walk(patches, steps, origin, direction, normal)
    middle = len(points) // 2
    center = points[middle] if len(points) % 2 else 0.5 * (points[middle] + points[middle - 1])
    along = directions[middle] if len(points) % 2 else directions[middle] + directions[middle - 1]
    along = along / np.linalg.norm(along)
    cuts = []
    for _ in range(2):
        aside = np.cross(along, rng.normal(size=3))
        tilt = rng.uniform(-mitre, mitre)
        cut = math.cos(tilt) * along + math.sin(tilt) * aside / np.linalg.norm(aside)
        cuts.append(cut / np.linalg.norm(cut))
    half = 0.5 * length * rng.uniform(0.9, 1.1)
    return PanelShape(
        name=name,
        feature=chain,
        points=points,
        directions=directions,
        normals=normals,
        patches=tuple(patches),
        cut_points=np.array([center - half * along, center + half * along]),
        cut_normals=np.array(cuts),
    )


def folded_panel(
    *,
    name: str = "A-01",
    chain: str = "pcp",
    radius: float = 200.0,
    half_angle: float = 0.0,
    sweep: float = 1.0,
    widths: Sequence[float] = (200.0, 200.0),
    turns: Sequence[float] = (0.0, 0.0),
    length: float = 1000.0,
    cut_normals: Sequence[Sequence[float]] = ((1.0, 0.0, 0.0), (1.0, 0.0, 0.0)),
) -> PanelShape:
    """A panel: first ruling along x through the origin, n = z, b = -y; cut at x = -length / 2 and length / 2."""
    patches: list[Patch] = [
        PlanePatch() if kind == "p" else ConePatch(radius=radius, half_angle=half_angle, sweep=sweep) for kind in chain
    ]
    steps = list(zip(widths, turns, strict=True))
    points, directions, normals = walk(
        patches, steps, np.zeros(3), np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, 1.0])
    )
    cuts = np.array(cut_normals, dtype=float)
    return PanelShape(
        name=name,
        feature="by hand",
        points=points,
        directions=directions,
        normals=normals,
        patches=tuple(patches),
        cut_points=np.array([[-0.5 * length, 0.0, 0.0], [0.5 * length, 0.0, 0.0]]),
        cut_normals=cuts / np.linalg.norm(cuts, axis=1, keepdims=True),
    )


def moved(shape: PanelShape, shift: Sequence[float]) -> PanelShape:
    """The same panel elsewhere."""
    offset = np.array(shift, dtype=float)
    return replace(shape, points=shape.points + offset, cut_points=shape.cut_points + offset)
