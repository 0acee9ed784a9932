"""The parts of a gap by their names."""

PARTS = ("width", "step", "shift")
"""In the skins and square to the seam; along the skins' normal; along the seam. In the order of a seam's directions."""
