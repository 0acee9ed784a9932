"""The records of a panel's patches: planes, cones by apex and axis, cylinders. Millimetres and degrees."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, model_validator

from cadpanel.delivery.records.jsonfile import Direction, NonNegative, Record, Vector


class PlanePatchModel(Record):
    """A flat patch: its outward unit normal and a point on it, mm."""

    kind: Literal["plane"] = "plane"
    normal: Direction
    point: Vector


class ConePatchModel(Record):
    """A conical patch.

    Attributes:
        apex: mm.
        axis: unit vector, from the apex towards the patch.
        half_angle: degrees.
        radius_min: smallest distance of the trimmed patch from its axis, mm.
        radius_max: largest distance, mm.
        sweep: angle by which the walk across the panel turns about the axis, right-handed, degrees.
    """

    kind: Literal["cone"] = "cone"
    apex: Vector
    axis: Direction
    half_angle: Annotated[float, Field(gt=0.0, lt=90.0)]
    radius_min: NonNegative
    radius_max: NonNegative
    sweep: Annotated[float, Field(ge=-360.0, le=360.0)]


class CylinderPatchModel(Record):
    """A cylindrical patch.

    Attributes:
        axis: unit vector.
        axis_point: a point on the axis, mm.
        radius_min: the radius, mm.
        radius_max: the radius again, so that readers need not tell cones from cylinders.
        sweep: angle by which the walk across the panel turns about the axis, right-handed, degrees.
    """

    kind: Literal["cylinder"] = "cylinder"
    axis: Direction
    axis_point: Vector
    radius_min: NonNegative
    radius_max: NonNegative
    sweep: Annotated[float, Field(ge=-360.0, le=360.0)]


class RulingModel(Record):
    """A straight line of a panel's skin, and the patch that begins at it: by these numbers the panel is built anew.

    Attributes:
        point: on the line, mm.
        direction: unit vector along it, from end 0 to end 1.
        normal: unit normal of the skin there, outwards.
        radius: of a round patch, mm along the normal from the point to its axis; positive where it is convex outwards;
            None of a flat one, and at the last ruling, as are the next two.
        half_angle: degrees, positive where it widens along the direction.
        sweep: by which it turns about its axis to the next ruling, degrees, of the radius' sign.
    """

    point: Vector
    direction: Direction
    normal: Direction
    radius: float | None = None
    half_angle: float | None = None
    sweep: float | None = None

    @model_validator(mode="after")
    def _check_that_a_bend_is_whole(self) -> RulingModel:
        if len({number is None for number in (self.radius, self.half_angle, self.sweep)}) > 1:
            raise ValueError("a bend has a radius, a half angle and a sweep")
        return self


PatchModel = Annotated[PlanePatchModel | ConePatchModel | CylinderPatchModel, Field(discriminator="kind")]
