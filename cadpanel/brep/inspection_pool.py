"""Reads and inspects the two files of a delivery side by side: the skins in a second interpreter, if it pays."""

from __future__ import annotations

import os
import pickle
import subprocess
import sys
from pathlib import Path

from cadpanel.brep.inspection import ShapeFacts, inspect
from cadpanel.brep.step import read_step_shapes
from cadpanel.errors import DeliveryError

WORTHWHILE_BYTES = 4_000_000
"""Size of a file from which reading takes longer than starting an interpreter with the kernel, about 2 s."""


def inspect_files(
    panels_step: str | os.PathLike[str], skins_step: str | os.PathLike[str]
) -> tuple[list[ShapeFacts], list[ShapeFacts]]:
    """Facts of every shape in either file.

    Raises:
        DeliveryError: if a file cannot be read.
    """
    skins = Path(skins_step)
    if (os.cpu_count() or 1) < 2 or not skins.is_file() or skins.stat().st_size < WORTHWHILE_BYTES:
        return inspect_file(panels_step), inspect_file(skins_step)
    # A plain second interpreter, not multiprocessing: that would run the caller's own script again to get started.
    command = [sys.executable, "-m", "cadpanel.brep.inspection_pool", os.fspath(skins_step)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL) as helper:
        try:
            panels = inspect_file(panels_step)
            output, _ = helper.communicate()
        except BaseException:
            helper.kill()
            raise
    if helper.returncode != 0:
        return panels, inspect_file(skins_step)
    facts: list[ShapeFacts] = pickle.loads(output)
    return panels, facts


def inspect_file(path: str | os.PathLike[str]) -> list[ShapeFacts]:
    """Facts of every shape in one file, in its order."""
    return [inspect(name, shape) for name, shape in read_step_shapes(path)]


if __name__ == "__main__":
    try:
        sys.stdout.buffer.write(pickle.dumps(inspect_file(sys.argv[1])))
    except DeliveryError:
        # The caller reads the file itself then, and says what is wrong with it.
        sys.exit(1)
