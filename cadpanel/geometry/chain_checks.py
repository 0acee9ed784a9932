"""Can a shop fold this panel, and can a solid be built of it? Refuses with the panel's name and one clear reason.

The same conditions are held on the skin and on the other face of the sheet; between the two everything they compare is
linear in the depth, so what holds on both holds inside. Millimetres and radians.
"""

from __future__ import annotations

import math

import numpy as np

from cadpanel.arrays import Array
from cadpanel.errors import PanelError
from cadpanel.geometry.cone_sections import AxisFrame, ConeCut, axis_frame, cut_cone, lifted, radius_range
from cadpanel.geometry.limits import LARGEST_COORDINATE, SMALLEST_LENGTH
from cadpanel.geometry.panel import Chain
from cadpanel.geometry.patches import ConePatch
from cadpanel.geometry.plane_sides import end_spans, side_curves
from cadpanel.geometry.self_crossing import crosses_itself

SMALLEST_RADIUS = 0.1
"""Distance from the axis, mm, below which a skin counts as having reached the apex."""
LARGEST_RADIUS = 1e8
"""Largest normal radius, mm; a flatter patch is a plane to within rounding."""
SMALLEST_CUT_COSINE = math.sin(math.radians(10.0))
"""Least cosine between a ruling and a cut plane's normal."""
LARGEST_ECCENTRICITY = 0.9
"""Eccentricity of a section seen along its axis, beyond which it is too near a parabola."""
LARGEST_HALF_ANGLE = math.radians(80.0)
FRAME_TOLERANCE = 1e-10
"""How far a ruling's t and n may be from an orthonormal pair, and a patch from handing them on exactly."""
POINT_TOLERANCE = 1e-8
"""How far from the next ruling, in mm, a patch may end."""

_ENDS = ("start", "far end")
# Places along a side that stands in a plane at which that must be found.
_SHARES = np.linspace(0.0, 1.0, 9)


def check_chain(shape: Chain) -> None:
    """Refuse a chain whose skin cannot be built exactly.

    Raises:
        PanelError: with one reason: not finite, rulings that disagree with the patches, a ruling parallel to a cut
            plane, an apex inside, a section that is no ellipse, cut planes that cross inside, a fold inside out.
    """
    _check_numbers(shape)
    check_walk(shape)
    _check_face(shape, "")


def check_chain_sheet(shape: Chain, away: Chain, thickness: float) -> None:
    """Refuse a sheet of `thickness` mm between a chain that passes `check_chain` and its other face `away`.

    Raises:
        PanelError: for the reasons of `check_chain` on the other face, or a sheet that is thicker than its inner radius
            allows.
    """
    _check_thickness(shape, away, thickness)
    _check_face(away, f" on the other face of the {thickness:g} mm sheet")


def _check_numbers(shape: Chain) -> None:
    arrays = (shape.points, shape.directions, shape.normals, shape.cut_points, shape.cut_normals)
    numbers = [number for patch in shape.patches if isinstance(patch, ConePatch) for number in _numbers(patch)]
    if not (all(np.isfinite(array).all() for array in arrays) and np.isfinite(numbers).all()):
        raise PanelError(shape.name, "some of its numbers are not finite; fit it again from another start.")
    count = len(shape.patches)
    if count < 1 or any(array.shape != (count + 1, 3) for array in arrays[:3]):
        raise PanelError(shape.name, f"{count} patches need {count + 1} rulings, got points {shape.points.shape}.")
    units = np.concatenate([shape.directions, shape.normals, shape.cut_normals])
    square = np.einsum("rx,rx->r", shape.directions, shape.normals)
    if max(np.abs(np.linalg.norm(units, axis=1) - 1.0).max(), np.abs(square).max()) > FRAME_TOLERANCE:
        raise PanelError(shape.name, "its ruling frames or cut normals are not orthonormal; normalise them first.")


def _numbers(patch: ConePatch) -> tuple[float, float, float]:
    return patch.radius, patch.half_angle, patch.sweep


def check_walk(shape: Chain) -> None:
    """Each patch must carry its ruling to the next one, turning the way the walk goes.

    Raises:
        PanelError: one does not.
    """
    for index, patch in enumerate(shape.patches):
        if isinstance(patch, ConePatch):
            _check_cone_numbers(shape.name, index, patch)
        point, direction, normal = carried_ruling(shape, index)
        gap = point - shape.points[index + 1]
        aside = gap - (gap @ shape.directions[index + 1]) * shape.directions[index + 1]
        if isinstance(patch, ConePatch):
            turned = max(
                float(np.linalg.norm(direction - shape.directions[index + 1])),
                float(np.linalg.norm(normal - shape.normals[index + 1])),
            )
            off = float(np.linalg.norm(aside))
        else:
            turned = float(np.linalg.norm(normal - shape.normals[index + 1]))
            off = abs(float(gap @ normal))
        if turned > FRAME_TOLERANCE or off > POINT_TOLERANCE:
            raise PanelError(
                shape.name,
                f"patch {index + 1} ends {off:.3g} mm and {turned:.3g} rad away from the next ruling; "
                "walk the rulings through the patches again.",
            )


def _check_cone_numbers(name: str, index: int, patch: ConePatch) -> None:
    if patch.radius == 0.0 or abs(patch.radius) > LARGEST_RADIUS:
        raise PanelError(
            name,
            f"the normal radius of patch {index + 1} is {patch.radius:.6g} mm; it must lie between 0 and "
            f"{LARGEST_RADIUS:g} mm: use a plane there.",
        )
    if abs(patch.half_angle) > LARGEST_HALF_ANGLE:
        raise PanelError(
            name,
            f"the half angle of patch {index + 1} is {math.degrees(patch.half_angle):.4g} degrees, beyond "
            f"{math.degrees(LARGEST_HALF_ANGLE):.4g}; fit it with a narrower cone.",
        )
    if patch.sweep * patch.radius <= 0.0:
        raise PanelError(
            name,
            f"the fold of patch {index + 1} turns inside out: its sweep is {math.degrees(patch.sweep):.4g} degrees at "
            f"a radius of {patch.radius:.6g} mm, and the two must have the same sign.",
        )
    if abs(patch.sweep) >= math.pi:
        raise PanelError(
            name,
            f"the fold of patch {index + 1} turns by {math.degrees(patch.sweep):.4g} degrees; less than 180 can be "
            "built: split the reference into two panels.",
        )


def carried_ruling(shape: Chain, index: int) -> tuple[Array, Array, Array]:
    """Point, direction and normal to which patch `index` carries its first ruling (a plane: that ruling itself)."""
    point, direction, normal = shape.points[index], shape.directions[index], shape.normals[index]
    patch = shape.patches[index]
    if not isinstance(patch, ConePatch):
        return point, direction, normal
    frame = axis_frame(point, direction, normal, patch)
    radial = frame.radials(np.array([patch.sweep]))[0]
    cosine, sine = math.cos(patch.half_angle), math.sin(patch.half_angle)
    turned = frame.center + frame.level_radius * radial
    return turned, cosine * frame.axis + sine * radial, cosine * radial - sine * frame.axis


def _check_thickness(shape: Chain, away: Chain, thickness: float) -> None:
    """The two faces of the sheet must lie on the same side of every axis, with room for the inner one."""
    for index, (near, far) in enumerate(zip(shape.patches, away.patches, strict=True)):
        if not (isinstance(near, ConePatch) and isinstance(far, ConePatch)):
            continue
        room = min(_radii(shape, index, near)) * math.cos(near.half_angle)
        beyond_axis = far.radius * near.radius <= 0.0
        inside = abs(far.radius) < abs(near.radius)
        if beyond_axis or (inside and min(_radii(away, index, far)) < SMALLEST_RADIUS):
            raise PanelError(
                shape.name,
                f"the sheet of {thickness:g} mm is thicker than the radius of patch {index + 1} allows, "
                f"{room:.4g} mm at its tightest; use a thinner sheet, the other skin side or a larger radius.",
            )


def _radii(shape: Chain, index: int, patch: ConePatch) -> list[float]:
    """Smallest distance from the axis at either end, with the sign that the patch should have: negative beyond 0."""
    frame = axis_frame(shape.points[index], shape.directions[index], shape.normals[index], patch)
    sign = math.copysign(1.0, patch.radius)
    cut_frame = lifted(frame, shape.lift)
    cuts = [cut_cone(cut_frame, *plane) for plane in zip(shape.cut_points, shape.cut_normals, strict=True)]
    return [min(sign * radius for radius in _own_radii(frame, cut_frame, cut)) for cut in cuts]


def _own_radii(frame: AxisFrame, cut_frame: AxisFrame, cut: ConeCut) -> list[float]:
    """Smallest and largest radius of a patch along an end, where the plane may cut a parallel one."""
    inside = cut_frame.level_radius - frame.level_radius
    return [radius - inside for radius in radius_range(cut, frame.sweep)]


def _check_face(shape: Chain, where: str) -> None:
    """Everything that depends on the trimmed face: cuts, apex, lengths and widths."""
    _check_rulings(shape, where)
    _check_sides(shape, where)
    corners = shape.corners()
    if np.abs(corners).max() > LARGEST_COORDINATE:
        raise PanelError(
            shape.name,
            f"a corner lies {np.abs(corners).max():.4g} mm from the origin, beyond {LARGEST_COORDINATE:g} mm; "
            "move the model to a local origin.",
        )
    lengths = np.einsum("rx,rx->r", corners[1] - corners[0], shape.directions)
    if lengths.min() < SMALLEST_LENGTH:
        at = f"at ruling {int(lengths.argmin()) + 1}"
        raise PanelError(shape.name, _crossing_cuts(float(lengths.min()), at, where))
    for index, patch in enumerate(shape.patches):
        if isinstance(patch, ConePatch):
            _check_cone(shape, index, patch, where)
        else:
            _check_flange(shape, index, corners, where)
    turn = sum(abs(patch.sweep) for patch in shape.patches if isinstance(patch, ConePatch))
    # A planar curve that turns by less than half a turn cannot meet itself; half of that leaves room for oblique cuts.
    if turn > 0.5 * math.pi and crosses_itself(shape):
        raise PanelError(
            shape.name,
            f"the fold runs into itself{where} after turning by {math.degrees(turn):.4g} degrees; shorten the flanges "
            "or split the panel.",
        )


def _crossing_cuts(length: float, at: str, where: str) -> str:
    return (
        f"the cut planes cross inside the panel{where}: only {length:.4g} mm are left between them {at}; "
        "divide it into fewer panels, or choose another feature."
    )


def _check_rulings(shape: Chain, where: str) -> None:
    cosines = np.einsum("rx,ex->er", shape.directions, shape.cut_normals)
    if cosines.min() < SMALLEST_CUT_COSINE:
        end, ruling = np.unravel_index(int(cosines.argmin()), cosines.shape)
        angle = math.degrees(math.asin(max(float(cosines[end, ruling]), -1.0)))
        raise PanelError(
            shape.name,
            f"ruling {int(ruling) + 1} runs at {angle:.4g} degrees to the cut plane at the {_ENDS[end]}{where}, nearly "
            f"parallel; {math.degrees(math.asin(SMALLEST_CUT_COSINE)):.4g} are needed: divide the panel "
            "further, or choose another feature.",
        )


def _check_sides(shape: Chain, where: str) -> None:
    """The planes in which sides stand must leave something of the patches between them, at both ends."""
    if shape.side_planes == (None, None):
        return
    spans, sides = end_spans(shape), [curve for curve in side_curves(shape) if curve is not None]
    round_ones = [index for index, patch in enumerate(shape.patches) if isinstance(patch, ConePatch)]
    ways = [np.sign(patch.sweep) for patch in shape.patches if isinstance(patch, ConePatch)]
    left = (spans[:, round_ones, 1] - spans[:, round_ones, 0]) * np.array(ways)
    heights = np.concatenate([curve.heights[0] + np.diff(curve.heights) * _SHARES for curve in sides])
    angles = np.concatenate([curve.angles(heights) for curve in sides])
    if left.min() <= 0.0 or not np.isfinite(angles).all():
        raise PanelError(
            shape.name,
            f"nothing is left of it between the walls at its sides{where}: ask for a narrower joint, or divide the "
            "reference into fewer panels.",
        )


def _check_cone(shape: Chain, index: int, patch: ConePatch, where: str) -> None:
    own = axis_frame(shape.points[index], shape.directions[index], shape.normals[index], patch)
    frame = lifted(own, shape.lift)
    cuts = []
    for end in range(2):
        # A cut that leans back over the axis cannot be an ellipse; cut_cone would have nothing to divide by.
        if float(frame.axis @ shape.cut_normals[end]) <= 0.0:
            raise PanelError(shape.name, _no_ellipse(index, end, math.inf, where))
        cuts.append(cut_cone(frame, shape.cut_points[end], shape.cut_normals[end]))
        if abs(cuts[end].eccentricity) > LARGEST_ECCENTRICITY:
            raise PanelError(shape.name, _no_ellipse(index, end, abs(cuts[end].eccentricity), where))
        sign = math.copysign(1.0, patch.radius)
        smallest = min(sign * radius for radius in _own_radii(own, frame, cuts[end]))
        if smallest < SMALLEST_RADIUS:
            raise PanelError(
                shape.name,
                f"the apex of patch {index + 1} falls inside the panel{where}: the radius comes down to {smallest:.4g} "
                f"mm at the {_ENDS[end]}, {SMALLEST_RADIUS:g} are needed; fit it with a narrower cone or a cylinder.",
            )
        if smallest * abs(patch.sweep) < SMALLEST_LENGTH:
            raise PanelError(
                shape.name,
                f"patch {index + 1} is only {smallest * abs(patch.sweep):.3g} mm wide at the {_ENDS[end]}{where}, "
                f"{SMALLEST_LENGTH:g} are needed; leave it out of the chain.",
            )
    _check_cuts_apart(shape.name, index, frame, cuts, where)


def _no_ellipse(index: int, end: int, eccentricity: float, where: str) -> str:
    return (
        f"the cut at the {_ENDS[end]} is too oblique to patch {index + 1}{where}: its section is no ellipse "
        f"(eccentricity {eccentricity:.4g}, at most {LARGEST_ECCENTRICITY:g} can be built): divide the panel further, "
        "or choose another feature."
    )


def _check_flange(shape: Chain, index: int, corners: Array, where: str) -> None:
    """Both corners of ruling i + 1 must lie on the +b side of ruling i, and those of ruling i on the -b side."""
    across = corners[:, index + 1] - corners[:, index]
    binormals = shape.binormals()[index : index + 2]
    widths = across @ binormals.T
    if widths.min() < SMALLEST_LENGTH:
        end = int(widths.min(axis=1).argmin())
        raise PanelError(
            shape.name,
            f"the flange of patch {index + 1} turns inside out{where}: it is {float(widths.min()):.4g} mm wide at the "
            f"{_ENDS[end]}, {SMALLEST_LENGTH:g} are needed; anchor its corners more strongly or widen it.",
        )


def _check_cuts_apart(name: str, index: int, frame: AxisFrame, cuts: list[ConeCut], where: str) -> None:
    """End 1 must lie beyond end 0 along every generatrix of the patch.

    The length left, reach_1 / rate_1 - reach_0 / rate_0 - SMALLEST_LENGTH, times the positive rates is a trigonometric
    polynomial of degree 2 in the sweep angle; its least value lies at an end or where its derivative, a quartic in
    exp(i phi), vanishes.
    """
    reach, rate = [], []
    for cut in cuts:
        lean = 0.5 * cut.tilt * np.array([np.exp(1j * cut.phase), 0.0, np.exp(-1j * cut.phase)])
        reach.append(np.array([0.0, cut.offset, 0.0]) - frame.level_radius * lean)
        rate.append(np.array([0.0, math.cos(frame.half_angle) * cut.rise, 0.0]) + math.sin(frame.half_angle) * lean)
    rates = np.convolve(rate[0], rate[1])
    spare = np.convolve(reach[1], rate[0]) - np.convolve(reach[0], rate[1]) - SMALLEST_LENGTH * rates
    orders = np.arange(-2, 3)
    scale = float(np.abs(spare).max())
    derivative = np.where(np.abs(orders * spare) > 1e-14 * scale, orders * spare, 0.0)
    angles = np.concatenate([np.array([0.0, frame.sweep]), np.angle(np.roots(derivative[::-1]))])
    inside = angles[(angles * np.sign(frame.sweep) >= 0.0) & (np.abs(angles) <= abs(frame.sweep))]
    waves = np.exp(1j * np.outer(inside, orders))
    values = (waves @ spare).real
    worst = int(values.argmin())
    if values[worst] < 0.0:
        length = SMALLEST_LENGTH + float(values[worst] / (waves[worst] @ rates).real)
        raise PanelError(name, _crossing_cuts(length, f"on patch {index + 1}", where))
