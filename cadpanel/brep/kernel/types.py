"""The kernel's shape types under the names by which other layers may speak of them; they never look inside."""

from __future__ import annotations

from OCP.TopoDS import TopoDS_Shape, TopoDS_Shell, TopoDS_Solid

Shape = TopoDS_Shape
Shell = TopoDS_Shell
Solid = TopoDS_Solid
