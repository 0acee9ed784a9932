"""Limits that every panel keeps, whatever its feature. Millimetres."""

THINNEST_SHEET, THICKEST_SHEET = 0.01, 10_000.0
"""Of a thinner sheet the volume cannot be proved to nine digits, and in the end its two faces become one."""
SMALLEST_LENGTH = 0.1
"""Shortest edge: along a generatrix, across a flange, along an arc."""
LARGEST_COORDINATE = 1e7
"""Farthest corner from the origin; beyond it the CAD kernel's own checks at 1e-7 mm lose their digits."""
WIDEST_JOINT = 1000.0
"""Widest joint between two sheets; no facade has one of a metre."""
LEAST_DISTANCE, LEAST_PITCH = 1.2, 2.2
"""Of holes for bolts from an edge and from each other, middle to middle, in diameters: EN 1993-1-8, table 3.3."""
