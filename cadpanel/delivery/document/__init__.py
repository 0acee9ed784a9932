"""A FreeCAD document of a delivery, written without FreeCAD: what stands in its tree, as XML, in an archive."""
