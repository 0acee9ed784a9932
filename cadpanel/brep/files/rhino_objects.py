"""The objects of a Rhino file that are to be seen, those in blocks included, each with where it is put.

rhino3dm's own `Transform` is not asked: it tells of success where it drops a stretch, as of a surface of revolution,
which stays round, or of an arc. What is placed is the kernel's shape: all of NURBS, whose control points move alike.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from OCP.BRepTools import BRepTools_GTrsfModification, BRepTools_Modifier
from OCP.gp import gp_GTrsf
from OCP.TopoDS import TopoDS_Shape

from cadpanel.arrays import Array
from cadpanel.brep.files.model import Label
from cadpanel.brep.files.opennurbs import ConversionError
from cadpanel.brep.kernel.shapes import children, compound_of
from cadpanel.errors import ReferenceFileError

# Blocks may hold blocks; a file in which they go deeper than this holds itself.
DEEPEST_BLOCK = 32
# A block that is pressed to less than this part of its size in one direction is flat.
FLATTENED = 1e-9
# What rhino3dm gives is untyped; each of these is one of its objects.
RhinoFile = Any
RhinoObject = Any


@dataclass(frozen=True, slots=True, kw_only=True)
class Placed:
    """An object as the file has it, and where it is put.

    Attributes:
        geometry: rhino3dm's, in the coordinates of its block.
        matrix: (4, 4) from there to the file's coordinates; None for an object in no block.
        label: what the file says of it.
        place: of the object, or of the block that holds it, among all, from 1.
    """

    geometry: RhinoObject
    matrix: Array | None
    label: Label
    place: int


def placed_objects(name: str, file: RhinoFile, left_out: Counter[str]) -> Iterator[Placed]:
    """The visible objects outside blocks and those of placed blocks, in file order.

    Args:
        name: the file's, for messages.
        file: rhino3dm's File3dm.
        left_out: takes up how many of which kind are not among them.

    Raises:
        ReferenceFileError: a block holds itself.
    """
    walk = _Walk(name, file, left_out)
    for place, thing in enumerate(file.Objects, start=1):
        if not thing.Attributes.IsInstanceDefinitionObject:
            yield from walk.below(thing, place, ())


def put(shape: TopoDS_Shape, matrix: Array) -> TopoDS_Shape:
    """A shape of NURBS where a block puts it, stretched, sheared or mirrored with it.

    Args:
        shape: in the coordinates of its block.
        matrix: (4, 4) from there.

    Raises:
        ConversionError: the matrix is no affine map, or flattens all.
    """
    sizes = np.linalg.svd(matrix[:3, :3], compute_uv=False) if np.isfinite(matrix).all() else np.zeros(3)
    if (matrix[3] != (0.0, 0.0, 0.0, 1.0)).any() or not sizes[2] > FLATTENED * sizes[0]:
        raise ConversionError("it cannot be placed as its block says, flattened or with a number that is none")
    map_ = gp_GTrsf()
    for row in range(3):
        for column in range(4):
            map_.SetValue(row + 1, column + 1, float(matrix[row, column]))
    # In a group, as the kernel reverses a mirrored face that is part of one, but not a lone one.
    group = compound_of([shape])
    modifier = BRepTools_Modifier(group)
    modifier.Perform(BRepTools_GTrsfModification(map_))
    (placed,) = children(modifier.ModifiedShape(group))
    return placed


class _Walk:
    """What is looked up again and again on the way through one file."""

    def __init__(self, name: str, file: RhinoFile, left_out: Counter[str]) -> None:
        self._name, self._file, self._left_out = name, file, left_out
        self._by_id = {str(thing.Attributes.Id): thing for thing in file.Objects}
        self._layers = {layer.Index: layer for layer in file.Layers}
        self._shown = _shown_layers(self._layers.values())

    def below(self, thing: RhinoObject, place: int, matrices: tuple[Array, ...]) -> Iterator[Placed]:
        """One object, or those of the block that it places; `matrices` are those of the blocks that hold it."""
        label, hidden = self._label(thing)
        if hidden:
            self._left_out["hidden object"] += 1
            return
        if len(matrices) > DEEPEST_BLOCK:
            raise ReferenceFileError(
                f"'{self._name}' holds a block that holds itself: explode it in Rhino and save again."
            )
        geometry = thing.Geometry
        if geometry is None:
            self._left_out["object without geometry"] += 1
            return
        if type(geometry).__name__ != "InstanceReference":
            matrix = np.linalg.multi_dot([*matrices, np.eye(4)]) if matrices else None
            yield Placed(geometry=geometry, matrix=matrix, label=label, place=place)
            return
        definition = self._file.InstanceDefinitions.FindId(geometry.ParentIdefId)
        if definition is None:
            self._left_out["block without a definition"] += 1
            return
        for member in definition.GetObjectIds():
            inner = self._by_id.get(str(member))
            if inner is not None:
                for placed in self.below(inner, place, (*matrices, _matrix(geometry.Xform))):
                    yield replace(placed, label=placed.label.over(label))

    def _label(self, thing: RhinoObject) -> tuple[Label, bool]:
        """What the file says of an object, and whether it is hidden."""
        attributes = thing.Attributes
        layer = self._layers.get(attributes.LayerIndex)
        by_object = attributes.ColorSource.name == "ColorFromObject"
        color = attributes.ObjectColor if by_object or layer is None else layer.Color
        label = Label(
            name=attributes.Name or "",
            layer="" if layer is None else layer.FullPath or layer.Name,
            color="#{:02x}{:02x}{:02x}".format(*color[:3]),
        )
        shown = layer is None or layer.Index in self._shown
        return label, not attributes.Visible or attributes.Mode.name == "Hidden" or not shown


def _shown_layers(layers: Iterable[RhinoObject]) -> set[int]:
    """The indices of layers that are switched on, as are all that they lie below."""
    by_id = {str(layer.Id): layer for layer in layers}
    shown = set()
    for layer in by_id.values():
        above, seen = layer, set()
        while above is not None and above.Visible and above.Index not in seen:
            seen.add(above.Index)
            above = by_id.get(str(above.ParentLayerId))
        if above is None or above.Visible:
            shown.add(layer.Index)
    return shown


def _matrix(transform: Any) -> Array:
    """A transform of rhino3dm as (4, 4)."""
    return np.array([[getattr(transform, f"M{row}{column}") for column in range(4)] for row in range(4)])
