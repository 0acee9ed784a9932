"""Qt under one name, whichever binding FreeCAD has: its own alias has the widgets in QtGui."""

from __future__ import annotations

try:
    from PySide import QtCore, QtGui
except ImportError:  # packages without the alias
    from PySide2 import QtCore
    from PySide2 import QtWidgets as QtGui

__all__ = ("QtCore", "QtGui")
