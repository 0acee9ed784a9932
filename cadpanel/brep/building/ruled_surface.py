"""Ruled B-spline surfaces to the kernel and back, pole by pole."""

from __future__ import annotations

import numpy as np
from OCP.Geom import Geom_BSplineSurface

from cadpanel.brep.kernel.splines import knot_arrays, pole_grid, real_grid
from cadpanel.errors import LoftError
from cadpanel.lofting.ruled import RuledSurface

_ACROSS = np.array([0.0, 0.0, 1.0, 1.0])


def ruled_surface(surface: RuledSurface) -> Geom_BSplineSurface:
    """The kernel's surface, rational, with u along the rails and v from one to the other."""
    weights = surface.poles[..., 3]
    knots, counts = knot_arrays(surface.knots)
    across, ends = knot_arrays(_ACROSS)
    poles = pole_grid(surface.poles[..., :3] / weights[..., None])
    return Geom_BSplineSurface(poles, real_grid(weights), knots, across, counts, ends, surface.degree, 1)


def ruled_of(surface: Geom_BSplineSurface) -> RuledSurface:
    """A surface of the kernel with two rows of poles; one that has them along v is turned round.

    Raises:
        LoftError: it has more of them, or is periodic.
    """
    if surface.IsUPeriodic() or surface.IsVPeriodic():
        raise LoftError("a periodic surface is no ruled one here: cut it open")
    turned = surface
    if surface.NbVPoles() != 2 and surface.NbUPoles() == 2:
        turned = surface.Copy()
        turned.ExchangeUV()
    if turned.NbVPoles() != 2:
        raise LoftError(
            f"a ruled surface has two rows of poles, and this one has {surface.NbUPoles()} by {surface.NbVPoles()}"
        )
    rows = range(1, turned.NbUPoles() + 1)
    poles = np.array([[(*turned.Pole(row, end).Coord(), 1.0) for end in (1, 2)] for row in rows])
    weights = np.array([[turned.Weight(row, end) for end in (1, 2)] for row in rows])
    places = range(1, turned.NbUKnots() + 1)
    knots = np.repeat([turned.UKnot(place) for place in places], [turned.UMultiplicity(place) for place in places])
    return RuledSurface(int(turned.UDegree()), knots, poles * weights[..., None])
