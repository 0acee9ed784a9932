"""Random seams of every kind, seeded: pairs of panels' end curves, good and bad, many at once. Millimetres."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from cadpanel.arrays import Array
from cadpanel.geometry.end_curves import EndCurves
from cadpanel.geometry.frames import rotate_about
from cadpanel.geometry.vectors import cross, dot, unit

_FAR = 20_000.0
_LENGTH = 1000.0


@dataclass(frozen=True, slots=True)
class Chains:
    """Numbers of s chains with the patches of `kinds`, p or c; walked from the first ruling.

    Attributes:
        kinds: the patches in their order.
        frame: (s, 3, 3) rows b, t, n of the first ruling.
        origin: (s, 3) its point.
        patches: (s, k, 3) width, turn and nothing of planes; radius, half angle and sweep of cones.
        cut: (s, 3) how far along the first ruling the cut plane crosses it, and its slopes to b and n.
    """

    kinds: str
    frame: Array
    origin: Array
    patches: Array
    cut: Array

    def curves(self) -> EndCurves:
        """The end curves."""
        b, t, n = (self.frame[:, i] for i in range(3))
        cut_point = self.origin + self.cut[:, :1] * t
        cut_normal = unit(t + self.cut[:, 1:2] * b + self.cut[:, 2:] * n)
        p, rulings = self.origin, []
        cones = np.zeros_like(self.patches)
        for i, kind in enumerate(self.kinds):
            rulings.append((p, t, n))
            first, second, third = self.patches[:, i].T
            if kind == "p":
                across = cross(t, n)
                p = p + first[:, None] * across
                t = np.cos(second)[:, None] * t + np.sin(second)[:, None] * across
                continue
            cones[:, i] = self.patches[:, i]
            axis = np.cos(second)[:, None] * t - np.sin(second)[:, None] * n
            centre = p - first[:, None] * n
            t, n = rotate_about(axis, third, t), rotate_about(axis, third, n)
            p = centre + first[:, None] * n
        rulings.append((p, t, n))
        p, t, n = (np.stack(of, axis=1) for of in zip(*rulings, strict=True))
        height = dot(cut_normal[:, None], cut_point[:, None] - p) / dot(cut_normal[:, None], t)
        return EndCurves(
            corners=p + height[..., None] * t,
            p=p,
            t=t,
            n=n,
            radius=cones[..., 0],
            half_angle=cones[..., 1],
            sweep=cones[..., 2],
            cut_point=cut_point,
            cut_normal=cut_normal,
        )


def chains(
    random: np.random.Generator, count: int, kinds: str = "pcp", *, steep: float = 0.3, whole: float = 1.8
) -> Chains:
    """Chains of building size; cut planes lean by slopes up to `steep`, cones sweep `whole` radians together."""
    patches = np.zeros((count, len(kinds), 3))
    for i, kind in enumerate(kinds):
        if kind == "p":
            patches[:, i, 0] = random.uniform(150.0, 600.0, count)
            patches[:, i, 1] = random.uniform(-0.02, 0.02, count)
        else:
            patches[:, i, 0] = random.uniform(120.0, 420.0, count)
            patches[:, i, 1] = random.uniform(-0.05, 0.05, count)
            patches[:, i, 2] = random.uniform(0.3, 1.0, count) * whole / kinds.count("c")
    frame = np.linalg.qr(random.normal(size=(count, 3, 3)))[0]
    frame *= np.linalg.det(frame)[:, None, None]
    cut = np.stack([random.uniform(-50.0, 50.0, count), *random.uniform(-steep, steep, (2, count))], axis=1)
    return Chains(kinds, frame, random.uniform(-_FAR, _FAR, (count, 3)), patches, cut)


def shaken(random: np.random.Generator, of: Chains, by: Array) -> Chains:
    """The chains with every number changed by random amounts that move points by about `by` (s,) mm."""
    count = len(by)

    def noise(*shape: int) -> Array:
        return by.reshape(-1, *[1] * len(shape)) * random.normal(size=(count, *shape))

    patches = of.patches.copy()
    for i, kind in enumerate(of.kinds):
        patches[:, i] += noise(3) * ([1.0, 1.0 / _LENGTH, 0.0] if kind == "p" else [1.0, 1e-4, 1.0 / _LENGTH])
    turned = cross(noise(1, 3) / _LENGTH, of.frame)
    frame = unit(of.frame + turned)
    frame[:, 2] = unit(frame[:, 2] - dot(frame[:, 2], frame[:, 1])[:, None] * frame[:, 1])
    frame[:, 0] = cross(frame[:, 1], frame[:, 2])
    return replace(
        of,
        frame=frame,
        origin=of.origin + noise(3),
        patches=patches,
        cut=of.cut + noise(3) * np.array([1.0, 1.0 / _LENGTH, 1.0 / _LENGTH]),
    )


def backwards(curves: EndCurves) -> EndCurves:
    """The same curves walked from the other side."""
    return EndCurves(
        corners=curves.corners[:, ::-1],
        p=curves.p[:, ::-1],
        t=-curves.t[:, ::-1],
        n=curves.n[:, ::-1],
        radius=curves.radius[:, ::-1],
        half_angle=-curves.half_angle[:, ::-1],
        sweep=curves.sweep[:, ::-1],
        cut_point=curves.cut_point,
        cut_normal=-curves.cut_normal,
    )


def shifted(curves: EndCurves, by: Array) -> EndCurves:
    """The curves moved by vectors (s, 3)."""
    return replace(
        curves, corners=curves.corners + by[:, None], p=curves.p + by[:, None], cut_point=curves.cut_point + by
    )


def log_uniform(random: np.random.Generator, low: float, high: float, count: int) -> Array:
    """(count,) numbers whose logarithms are uniform."""
    return np.exp(random.uniform(np.log(low), np.log(high), count))


Pair = tuple[EndCurves, EndCurves]


def good(random: np.random.Generator, count: int, kinds: str = "pcp") -> Pair:
    """Gaps of 0.01 to 1 mm."""
    first = chains(random, count, kinds)
    return first.curves(), shaken(random, first, log_uniform(random, 0.005, 0.5, count)).curves()


def bad(random: np.random.Generator, count: int) -> Pair:
    """Gaps of 1 to 100 mm."""
    first = chains(random, count)
    return first.curves(), shaken(random, first, log_uniform(random, 1.0, 30.0, count)).curves()


def shifts(random: np.random.Generator, count: int) -> Pair:
    """One curve of a seam is the other, moved."""
    first = chains(random, count).curves()
    away = unit(random.normal(size=(count, 3))) * log_uniform(random, 0.01, 100.0, count)[:, None]
    return first, shifted(first, away)


def tilts(random: np.random.Generator, count: int) -> Pair:
    """The cut planes lean against each other."""
    first = chains(random, count)
    lean = log_uniform(random, 1e-5, 0.3, count)[:, None] * random.normal(size=(count, 2))
    return first.curves(), replace(first, cut=first.cut + np.pad(lean, ((0, 0), (1, 0)))).curves()


def turned_about(random: np.random.Generator, count: int) -> Pair:
    """Good seams whose panels are walked from different sides."""
    first, second = good(random, count)
    return first, backwards(second)


def bulges(random: np.random.Generator, count: int) -> Pair:
    """One curve bulges where the other is hollow."""
    first = chains(random, count)
    patches = first.patches.copy()
    patches[:, 1] *= -1.0
    return first.curves(), replace(first, patches=patches).curves()


def many_patches(random: np.random.Generator, count: int) -> Pair:
    """Two cones between planes."""
    return good(random, count, "pccp")


def five_patches(random: np.random.Generator, count: int) -> Pair:
    """Three flanges and two folds."""
    return good(random, count, "pcpcp")


def unlike(random: np.random.Generator, count: int) -> Pair:
    """Chains of three and four patches that begin at one corner."""
    first, second = chains(random, count), chains(random, count, "pccp")
    second = replace(second, frame=first.frame, origin=first.origin, cut=first.cut)
    return first.curves(), second.curves()


def straight_against_curved(random: np.random.Generator, count: int) -> Pair:
    """A segment from corner to corner of a curve."""
    first = chains(random, count).curves()
    ends = first.corners[:, [0, -1]]
    along = unit(ends[:, 1] - ends[:, 0])
    flat = np.zeros((count, 1))
    second = EndCurves(
        corners=ends,
        p=ends,
        t=np.stack([along, along], axis=1),
        n=first.n[:, [0, 0]],
        radius=flat,
        half_angle=flat,
        sweep=flat,
        cut_point=ends[:, 0],
        cut_normal=along,
    )
    return first, shifted(second, random.normal(size=(count, 3)) * log_uniform(random, 1e-3, 10.0, count)[:, None])


def cylinders(random: np.random.Generator, count: int) -> Pair:
    """Half angles of exactly 0."""
    first = chains(random, count)
    by = log_uniform(random, 0.005, 30.0, count)
    second = shaken(random, first, by)
    for of in (first, second):
        of.patches[:, 1, 1] = 0.0
    return first.curves(), second.curves()


def nearly_flat(random: np.random.Generator, count: int) -> Pair:
    """Sweeps of 1e-5 to 0.05 at radii that keep the arcs' lengths."""
    first = chains(random, count)
    length = first.patches[:, 1, 0] * first.patches[:, 1, 2]
    first.patches[:, 1, 2] = log_uniform(random, 1e-5, 0.05, count)
    first.patches[:, 1, 0] = length / first.patches[:, 1, 2]
    first.patches[:, 1, 1] = 0.0
    second = replace(first, patches=first.patches.copy())
    by = log_uniform(random, 0.01, 10.0, count)
    second.patches[:, 1, 2] *= 1.0 + by / length * random.normal(size=count)
    return first.curves(), shifted(second.curves(), by[:, None] * random.normal(size=(count, 3)))


def half_turns(random: np.random.Generator, count: int) -> Pair:
    """Sweeps up to 170 degrees."""
    first = chains(random, count)
    first.patches[:, 1, 2] = np.radians(random.uniform(110.0, 170.0, count))
    return first.curves(), shaken(random, first, log_uniform(random, 0.005, 30.0, count)).curves()


def slanting_cuts(random: np.random.Generator, count: int) -> Pair:
    """Cut planes that lean by 55 to 80 degrees, nearly along the rulings."""
    first = chains(random, count, whole=1.0)
    aside = random.uniform(0.0, 2.0 * np.pi, count)
    slope = np.tan(np.radians(random.uniform(55.0, 80.0, count)))
    first.cut[:, 1], first.cut[:, 2] = slope * np.cos(aside), slope * np.sin(aside)
    first.patches[:, 1, 1] *= 0.5
    return first.curves(), shaken(random, first, log_uniform(random, 0.005, 1.0, count)).curves()


def strangers(random: np.random.Generator, count: int) -> Pair:
    """Curves that have nothing in common but a corner."""
    first, second = chains(random, count).curves(), chains(random, count).curves()
    return first, shifted(second, first.corners[:, 0] - second.corners[:, 0])


Seams = Callable[[np.random.Generator, int], Pair]

KINDS: dict[str, Seams] = {
    of.__name__: of
    for of in (
        good,
        bad,
        shifts,
        tilts,
        turned_about,
        bulges,
        many_patches,
        five_patches,
        unlike,
        straight_against_curved,
        cylinders,
        nearly_flat,
        half_turns,
        slanting_cuts,
        strangers,
    )
}
"""Kinds of seams by name."""
