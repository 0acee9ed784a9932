"""How closely what is made keeps to what was given, once for all of brep."""

from __future__ import annotations

# How closely a cut follows what was drawn, mm.
CLOSE = 1e-3
