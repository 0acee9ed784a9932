"""The three kinds of arrays that everything here is computed with; shapes stand in the docstrings."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
"""Numbers in double precision: lengths in mm, angles in radians."""
IntArray = NDArray[np.intp]
"""Indices and counts."""
BoolArray = NDArray[np.bool_]
"""Masks."""
