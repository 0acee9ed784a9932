"""building.step: one STEP assembly on top of the deliveries of a job, which stay the files that they are."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from cadpanel.delivery.hung import Hung
from cadpanel.delivery.outputs.step_files import PANELS
from cadpanel.errors import DeliveryError

BUILDING = "building.step"
_LEAST = 2
"""Deliveries from which there is something to put together."""


def put_together(out: Path, regions: Mapping[str, Hung]) -> tuple[bool, str | None]:
    """Write the assembly, or remove an earlier one that tells of regions as they were.

    Args:
        out: the folder of the job.
        regions: by the names of those that are delivered, how they hang; the ones without STEP files are left out.

    Returns:
        Whether it was written, and in a sentence why not; nothing is said where there are no two files for it.
    """
    from cadpanel.delivery.assemble import assemble_told  # it loads the kernel, for which a refused job should not wait

    told = {(out / name).absolute(): hung for name, hung in regions.items() if (out / name / PANELS).is_file()}
    said = None
    if len(told) >= _LEAST:
        try:
            assemble_told(told, (out / BUILDING).absolute())
        except DeliveryError as error:
            said = str(error)
        else:
            return True, None
    (out / BUILDING).unlink(missing_ok=True)
    return False, said
