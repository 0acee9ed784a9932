"""Every shape feature that the laws are held against, random valid numbers, and problems without a reference."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from cadpanel.arrays import Array, BoolArray, IntArray
from cadpanel.features.catalogue import CATALOGUE, feature
from cadpanel.features.edge_pieces import edge_pieces
from cadpanel.features.feature import Feature
from cadpanel.features.layout import Layout
from cadpanel.features.patches import Cone, Cylinder, Plane
from cadpanel.features.polygon import Polygon
from cadpanel.features.rulings import PanelFeature, Points
from cadpanel.features.walk import arc_rulings
from cadpanel.fitting.problem import Problem
from cadpanel.geometry.frames import cayley
from cadpanel.geometry.vectors import dot
from cadpanel.reference.across_seams import AcrossSeams, across_edges
from cadpanel.terms.deviation import Deviation
from cadpanel.terms.outline import Limited, Outline, Pieces
from cadpanel.terms.placement import Placement
from cadpanel.terms.seams import batches
from cadpanel.terms.state import State
from tests.own_patches import AngleFirst, ByGirth, ByRoot, CurvedBy

# Chains that a user might compose; the package has no names for them.
COMPOSED: dict[str, Feature] = {
    "cone-plane-cone": Feature(Cone(), Plane(), Cone()),
    "plane-cone": Feature(Plane(), Cone()),
    "plane-cylinder-plane-cone-plane": Feature(Plane(), Cylinder(), Plane(), Cone(), Plane()),
    "plane-cone-plane, cut parallel": Feature(Plane(), Cone(), Plane(), cuts="parallel"),
    "cone-plane, cut square": Feature(Cone(), Plane(), cuts="square"),
    "roof edge": Feature(Plane(width=0.3, turn=0.0), Cone(radius=0.2, half_angle=(-0.04, 0.04)), Plane(), name="roof"),
}
# Chains of patches that a user might write.
OWN: dict[str, Feature] = {
    "own cylinder": Feature(CurvedBy()),
    "own fold": Feature(Plane(), CurvedBy(), Plane()),
    "own cone": Feature(AngleFirst(), cuts="parallel"),
    "own flanges": Feature(ByRoot(), AngleFirst(), ByRoot()),
    "own double fold": Feature(ByRoot(), ByGirth(), Plane(), CurvedBy(), ByRoot()),
    "own rectangle": Feature(ByRoot(turn=0.0), cuts="square"),
    "own roof edge": Feature(ByRoot(root=0.5), ByGirth(half_angle=(-0.04, 0.04)), CurvedBy(curvature=4.0), Plane()),
}
CHAINS: dict[str, Feature] = {
    **{name: feature(name) for name in CATALOGUE},
    **{f"{name}, tilt fixed": feature(name, tilt="fixed") for name, one in CATALOGUE.items() if one.cuts == "mitre"},
    "cone-spline-4": feature("cone-spline-4"),
    **COMPOSED,
    **OWN,
}
POLYGONS: dict[str, Polygon] = {f"polygon of {corners}": Polygon(corners) for corners in (3, 5, 6)}
FEATURES: dict[str, PanelFeature] = {**CHAINS, **POLYGONS}
# Turned end for end these are the same chain, anchored in the same patch.
SYMMETRIC = {
    name: one
    for name, one in CHAINS.items()
    if one.patches == one.patches[::-1] and 2 * one.anchor == len(one.patches) - 1
}
_SAMPLES = 40


def random_values(of: PanelFeature, seed: int, panels: int = 3) -> Array:
    """(panels, N) valid numbers: a panel about 1 long, with flanges, folds and mitres like those of a real one."""
    random = np.random.default_rng(seed)
    values = np.zeros((panels, len(of.numbers)))
    if isinstance(of, Polygon):
        _random_polygon(of, random, values)
        return values
    curved = max(1, sum(of.curved))
    values[:, :2] = random.uniform(-0.05, 0.05, (panels, 2))
    values[:, 2:5] = random.uniform(-0.1, 0.1, (panels, 3))
    for i, patch in enumerate(of.patches):
        if patch.kind == "plane":
            dimensions = [random.uniform(0.1, 0.4, panels), random.uniform(-0.05, 0.05, panels)]
        else:
            dimensions = [
                random.uniform(0.1, 0.3, panels),
                random.uniform(-0.03, 0.03, panels),
                random.uniform(0.5, 1.5, panels) / curved,
            ]
        values[:, of.patch_slice(i)] = patch.numbers_for(np.stack(dimensions, axis=1))
    for end, (at, _, _) in enumerate(of.cut_numbers.tolist()):
        values[:, at] = (end - 0.5) * random.uniform(0.9, 1.1, panels)
        values[:, at + 1] = random.uniform(-0.1, 0.1, panels)
        values[:, at + 2] = random.uniform(-0.2, 0.2, panels)
    return of.expand(values[:, of.free])


def _random_polygon(of: Polygon, random: np.random.Generator, values: Array) -> None:
    """Corners from b to t (counterclockwise about n) near a circle of radius 0.5; changed in place."""
    panels = len(values)
    values[:, 0] = random.uniform(-0.05, 0.05, panels)
    values[:, 1:3] = random.uniform(-0.1, 0.1, (panels, 2))
    angle = 2.0 * np.pi * (np.arange(of.corner_count) + random.uniform(-0.2, 0.2, (panels, of.corner_count)))
    angle /= of.corner_count
    within = 0.5 * np.stack([np.cos(angle), np.sin(angle)], axis=-1)
    values[:, 3:] = (within + random.uniform(-0.05, 0.05, within.shape)).reshape(panels, -1)


def random_unknowns(of: PanelFeature, seed: int, panels: int = 3) -> Array:
    """(panels, free) the unknowns of `random_values`."""
    return random_values(of, seed, panels)[:, of.free]


def mixed_unknowns(layout: Layout, seed: int) -> Array:
    """(panels, size) random unknowns of panels of several features."""
    unknowns = np.zeros((layout.panels, layout.size))
    for group in layout.groups:
        own = random_unknowns(group.feature, seed, len(group.panels))
        unknowns[group.panels, : own.shape[1]] = own
    return unknowns


def slopes(points: Points) -> Array:
    """The Jacobian of points that were walked with derivatives."""
    assert points.jacobian is not None
    return points.jacobian


def made_problem(
    of: PanelFeature, seed: int, *, panels: int = 4, length: float = 2000.0, ring: bool = False
) -> Problem:
    """A strip of panels of one feature (or a closed ring), walked from end to end or round from edge to edge."""
    first = np.arange(panels - 1)
    pairs, edges = np.stack([first, first + 1], axis=1), np.tile([1, 0], (panels - 1, 1))
    if ring:
        pairs, edges = np.concatenate([pairs, [[0, panels - 1]]]), np.concatenate([edges, [[0, 1]]])
    return problem_of([of] * panels, seed, pairs, edges, length=length)


def problem_of(
    features: Sequence[PanelFeature], seed: int, pairs: ArrayLike, edges: ArrayLike, *, length: float = 2000.0
) -> Problem:
    """Panels without a reference; their samples and outlines lie near random panels.

    Every third seam is reversed, as if its panels had been walked from other sides.

    Args:
        features: one a panel, lengths counted in units of `length`.
        seed: of everything that is random.
        pairs: (seams, 2) which panels meet, the lower first.
        edges: (seams, 2) along which edge of each.
        length: mm that the solver counts as 1.
    """
    random = np.random.default_rng(seed)
    layout, panels = Layout.of(features), len(features)
    corners = State(layout, layout.walk(mixed_unknowns(layout, seed), derivatives=False)).corners.position
    samples = np.empty((panels, _SAMPLES, 3))
    for panel, one in enumerate(layout.feature_of):
        samples[panel] = _random_samples(one, corners[panel, : one.corner_count], random)
    met, along = (np.asarray(which, dtype=np.intp).reshape(-1, 2) for which in (pairs, edges))
    coupled, pair = np.unique(met, axis=0, return_inverse=True)
    backwards = np.arange(len(met)) % 3 == 1
    return Problem(
        names=tuple(f"panel {i}" for i in range(panels)),
        layout=layout,
        place=Placement(
            origins=length * np.arange(panels)[:, None] * np.array([0.0, 1.0, 0.0])
            + 50.0 * random.normal(size=(panels, 3)),
            centre=np.array([1000.0, -2000.0, 500.0]),
            axes=cayley(0.1 * random.normal(size=(panels, 3))),
            length=length,
        ),
        deviation=Deviation(
            np.ascontiguousarray(np.moveaxis(samples, 2, 0)), np.sqrt(random.uniform(0.5, 1.5, samples.shape[:2]))
        ),
        outline=outline_near(layout, corners, random),
        lengths=np.ones(panels),
        areas=np.ones(panels),
        seams=batches(layout, met, along, backwards, pair.reshape(-1)),
        pairs=coupled,
        bounds=(np.full((panels, layout.size), -np.inf), np.full((panels, layout.size), np.inf)),
        across=across_near(layout, met, along, backwards, random),
    )


def across_near(
    layout: Layout, met: IntArray, along: IntArray, backwards: BoolArray, random: np.random.Generator
) -> AcrossSeams:
    """The seams between chains, on a drawing with one normal a seam."""
    sided = np.array([isinstance(one, Feature) for one in layout.feature_of])
    index = np.flatnonzero(sided[met].all(axis=1))
    normals = random.normal(size=(len(index), 1, 3)) + np.array([0.0, 0.0, 3.0])
    normals = np.repeat(normals / np.linalg.norm(normals, axis=-1, keepdims=True), 2, axis=1)
    return across_edges(index, met[index], along[index], backwards[index], normals)


def _random_samples(of: PanelFeature, corners: Array, random: np.random.Generator) -> Array:
    """Points near the rulings of a chain, near the diagonals and edges of a polygon."""
    share = random.uniform(0.1, 0.9, (_SAMPLES, 1))
    rulings = len(corners) // 2
    one = random.integers(0, len(corners) if isinstance(of, Polygon) else rulings, _SAMPLES)
    other = random.integers(0, len(corners), _SAMPLES) if isinstance(of, Polygon) else one + rulings
    points: Array = (1.0 - share) * corners[one] + share * corners[other] + 0.02 * random.normal(size=(_SAMPLES, 3))
    return points


def outline_near(layout: Layout, corners: Array, random: np.random.Generator, shake: float = 0.03) -> Outline:
    """An outline whose corners lie near those given (panels, corners, 3), its ends on planes near y = constant."""
    panels = len(corners)
    outer = max(4 if isinstance(one, Feature) else one.corner_count for one in layout.feature_of)
    inner = max(one.corner_count if isinstance(one, Feature) else 0 for one in layout.feature_of)
    along = np.zeros((panels, inner, 1, 3))
    held, across = np.zeros((panels, outer), dtype=np.intp), np.zeros((panels, outer, 3, 3))
    for i, one in enumerate(layout.feature_of):
        count = one.corner_count
        if isinstance(one, Polygon):
            held[i, :count], across[i, :count] = np.arange(count), np.eye(3)
            continue
        rulings = count // 2
        chords = corners[i, rulings:count] - corners[i, :rulings]
        way = np.tile(chords / np.linalg.norm(chords, axis=-1, keepdims=True), (2, 1))
        normals = np.array([0.0, 1.0, 0.0]) + 0.2 * random.normal(size=(2, 3))
        gauge = np.repeat(normals, rulings, axis=0)
        gauge = gauge / dot(gauge, way)[:, None]
        corner = np.array([0, rulings - 1, rulings, count - 1])
        gauge[corner] = way[corner]
        along[i, :count, 0] = gauge
        held[i, :4], across[i, :4] = corner, np.eye(3) - way[corner][:, :, None] * way[corner][:, None]
    near = corners + shake * random.normal(size=corners.shape)
    for i, one in enumerate(layout.feature_of):
        near[i, one.corner_count :] = 0.0
    return Outline(
        corners=near,
        along=Limited(corners=np.tile(np.arange(inner), (panels, 1)), part=along),
        across=Limited(corners=held, part=across),
        sided=np.array([isinstance(one, Feature) for one in layout.feature_of]),
        pieces=pieces_near(layout, random),
    )


def pieces_near(layout: Layout, random: np.random.Generator) -> Pieces:
    """All pieces of all edges, of drawn edges in planes with random normals; some of them count as longer."""
    own = [edge_pieces(one.edges) for one in layout.feature_of]
    most = max(len(pieces.edge) for pieces in own)
    points, planes = np.zeros((len(own), most, 2), dtype=np.intp), np.zeros((len(own), most, 3))
    for i, pieces in enumerate(own):
        count = len(pieces.edge)
        points[i, :count], planes[i, :count] = pieces.points, random.normal(size=(count, 3))
    sizes = np.linalg.norm(planes, axis=-1, keepdims=True)
    lengths = np.where(sizes[..., 0] > 0.0, random.uniform(0.1, 20.0, sizes.shape[:2]), 0.0)
    return Pieces(points=points, planes=planes / np.where(sizes > 0.0, sizes, 1.0), lengths=lengths)


def rulings_of(walked):
    return {"anchor": walked.anchor, "edges": walked.edges, "carriers": walked.carriers, "arcs": arc_rulings(walked)}
