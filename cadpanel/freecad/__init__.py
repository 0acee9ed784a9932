"""The add-on for FreeCAD, and how it gets there."""
