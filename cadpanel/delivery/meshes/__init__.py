"""Panels as triangles: what viewers and building models take."""
