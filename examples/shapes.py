"""The surfaces that these pages cut and fit, drawn with cadquery: a canopy, a column, a roof, two rails.

python examples/shapes.py [FOLDER]

One STEP file each is written into the folder (`build`, if none is named). All are made up for these pages.
"""

import sys
from pathlib import Path

import cadquery as cq
import numpy as np


def face(points: np.ndarray) -> cq.Face:
    """A smooth face through points (m, n, 3)."""
    return cq.Face.makeSplineApprox([[cq.Vector(*p) for p in row] for row in points.tolist()], tol=0.05, maxDeg=5)


def canopy() -> cq.Compound:
    """A strip of 60 m: two flanges about a blend, which twists to one side and back while its spine is an arc."""
    along, across = np.linspace(0.0, 1.0, 121), np.linspace(0.0, 1.0, 41)
    # The section's direction turns by 80 degrees in its middle third.
    turn = np.radians(80.0) * np.clip(3.0 * across - 1.0, 0.0, 1.0)
    middle = 0.5 * (turn[1:] + turn[:-1])
    step = 2800.0 / (len(across) - 1)
    section = np.zeros((len(across), 2))
    section[1:] = np.cumsum(step * np.stack([np.cos(middle), -np.sin(middle)], axis=1), axis=0)
    section -= section[len(across) // 2]
    points = []
    for share in along.tolist():
        plan, twist = 60_000.0 * share / 90_000.0, np.radians(12.0 * np.sin(np.pi * share))
        place = np.array([90_000.0 * np.sin(plan), 90_000.0 * (1.0 - np.cos(plan)), 3_000.0 * np.sin(np.pi * share)])
        side, up = np.array([-np.sin(plan), np.cos(plan), 0.0]), np.array([0.0, 0.0, 1.0])
        x, y = np.cos(twist) * side + np.sin(twist) * up, np.cos(twist) * up - np.sin(twist) * side
        points.append(place + section[:, :1] * x + section[:, 1:] * y)
    return cq.Compound.makeCompound([face(np.array(points))])


def column() -> cq.Compound:
    """Four quarters of a column of 8 m that is oval and flares towards its head."""
    quarters = []
    for quarter in range(4):
        angle = 0.5 * np.pi * (quarter + np.linspace(0.0, 1.0, 25))
        height = np.linspace(0.0, 8000.0, 41)[:, None]
        wider = 1.0 + 0.8 * (height / 8000.0) ** 2
        x, y = 1200.0 * wider * np.cos(angle), 800.0 * wider * np.sin(angle)
        quarters.append(face(np.stack([x, y, np.broadcast_to(height, x.shape)], axis=2)))
    return cq.Compound.makeCompound(quarters)


def roof() -> cq.Compound:
    """A roof of 12 m by 9 m, arched both ways, and over it the lines of its network, closer at the eaves."""
    x = np.linspace(0.0, 12_000.0, 25)[:, None] * np.ones((1, 19))
    y = np.linspace(0.0, 9_000.0, 19)[None, :] * np.ones((25, 1))

    def over(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        return np.stack([x, y, 2_000.0 - ((x - 6_000.0) / 200.0) ** 2 - ((y - 4_500.0) / 150.0) ** 2], axis=-1)

    lines = []
    for share in (0.12, 0.3, 0.5, 0.7, 0.88):
        lines += [over(0.0 * x[:, 0] + 12_000.0 * share, np.linspace(0.0, 9_000.0, 25))]
        lines += [over(np.linspace(0.0, 12_000.0, 25), 0.0 * x[:, 0] + 9_000.0 * share)]
    edges = [cq.Edge.makeSpline([cq.Vector(*point) for point in line.tolist()]) for line in lines]
    return cq.Compound.makeCompound([face(over(x, y)), *edges])


def rails() -> cq.Compound:
    """Two curves of 6 m: an eave, level and round, and a ridge over it that rises; no cone goes through both."""
    share = np.linspace(0.0, 1.0, 41)
    turn = 1.6 * share
    eave = np.stack([4_000.0 * np.cos(turn), 4_000.0 * np.sin(turn), 0.0 * turn], axis=-1)
    ridge = np.stack([2_600.0 * np.cos(turn), 2_900.0 * np.sin(turn), 1_500.0 + 500.0 * share**2], axis=-1)
    edges = [cq.Edge.makeSpline([cq.Vector(*point) for point in line.tolist()]) for line in (eave, ridge)]
    return cq.Compound.makeCompound(edges)


SHAPES = {"canopy": canopy, "column": column, "roof": roof, "rails": rails}

if __name__ == "__main__":
    folder = Path(sys.argv[1] if len(sys.argv) > 1 else "build")
    folder.mkdir(parents=True, exist_ok=True)
    for name, shape in SHAPES.items():
        shape().exportStep(str(folder / f"{name}.step"))
        print(f"Written: {folder / name}.step")
