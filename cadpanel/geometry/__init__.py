"""Rulings, planes, cones, sections and development: pure NumPy functions in millimetres and radians."""
