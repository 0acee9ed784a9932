"""The records of a delivery's proof, and of the time that its steps took."""

from __future__ import annotations

from pydantic import Field

from cadpanel.delivery.records.jsonfile import NonNegative, NonNegativeCount, Record


class ClearModel(Record):
    """The clear width of joints between sheets, mm."""

    least: float
    largest: float


class CertificateModel(Record):
    """What reading panels.step and skins.step back showed.

    Attributes:
        solids: how many were found in panels.step.
        skins: how many open shells were found in skins.step.
        valid: whether all of them pass the kernel's exact check and are closed.
        face_kinds: how many faces of each kind the panels' main faces are.
        max_tangency_error: largest angle between two patches across their common ruling, RADIANS.
        volume_error: largest relative difference between a solid's volume and the formula's.
        flat_area_error: largest relative difference between a flat pattern's area and that of the surface in the solid
            that it unrolls.
        flat_length_error: largest difference between an edge of a skin and the same edge unrolled, mm.
        stated_error: largest relative difference of a volume or area that the STEP files state from the kernel's.
        holes: how many holes were found in panels.step.
        hole_error: how far, at most, a place of a hole's rim lies off the circle that is drawn on the flat pattern, mm.
        names_kept: whether every panel was found again under its name.
        max_seam_gap: mm, measured on the faces that were read, carried on to where the fit has cut them.
        clear: the least and the largest clear width of all joints, mm; None without seams.
        overlap: the largest volume that two solids share, mm^3; 0 where a plane parts every two. None in reports from
            before joints were proved.
        outputs: what the files of other outputs showed, by the output's name.
        failures: what does not hold, one sentence each; empty where everything does.
    """

    solids: NonNegativeCount
    skins: NonNegativeCount
    valid: bool
    face_kinds: dict[str, NonNegativeCount]
    max_tangency_error: NonNegative
    volume_error: NonNegative
    flat_area_error: NonNegative = 0.0
    flat_length_error: NonNegative = 0.0
    stated_error: NonNegative = 0.0
    holes: NonNegativeCount = 0
    hole_error: NonNegative = 0.0
    names_kept: bool
    max_seam_gap: NonNegative
    clear: ClearModel | None = None
    overlap: NonNegative | None = None
    outputs: dict[str, dict[str, NonNegative]] = Field(default_factory=dict)
    failures: tuple[str, ...] = ()


class TimingModel(Record):
    """Wall-clock seconds of each step.

    `read` is 0 where the reference was read before, in another program; `fit` counts the baselines, too.
    """

    read: NonNegative
    fit: NonNegative
    build: NonNegative
    write: NonNegative
    verify: NonNegative
