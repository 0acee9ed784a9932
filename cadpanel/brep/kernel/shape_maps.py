"""A dictionary and a set whose keys are shapes of the kernel.

The hash of a shape is no name for it: two shapes may have the same one. Here the kernel's own map tells shapes apart,
by `IsSame`: one and the same shape in one and the same place, whichever way it is turned. Both keep the order in which
keys came in, and the first of several that are the same.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Generic, TypeVar

from OCP.TopoDS import TopoDS_Shape
from OCP.TopTools import TopTools_IndexedMapOfShape

Value = TypeVar("Value")


class ShapeSet:
    """A set of shapes, in the order in which they came."""

    __slots__ = ("_keys",)

    def __init__(self, shapes: Iterable[TopoDS_Shape] = ()) -> None:
        self._keys = TopTools_IndexedMapOfShape()
        for shape in shapes:
            self._keys.Add(shape)

    def add(self, shape: TopoDS_Shape) -> None:
        """Add a shape, unless the same one is in the set already."""
        self._keys.Add(shape)

    def __contains__(self, shape: TopoDS_Shape) -> bool:
        return bool(self._keys.Contains(shape))

    def __len__(self) -> int:
        return int(self._keys.Extent())

    def __iter__(self) -> Iterator[TopoDS_Shape]:
        return (self._keys.FindKey(index) for index in range(1, len(self) + 1))


class ShapeMap(Generic[Value]):
    """A dictionary from shapes, in the order in which they came."""

    __slots__ = ("_keys", "_values")

    def __init__(self) -> None:
        self._keys = TopTools_IndexedMapOfShape()
        self._values: list[Value] = []

    def __setitem__(self, shape: TopoDS_Shape, value: Value) -> None:
        place: int = self._keys.Add(shape)
        if place > len(self._values):
            self._values.append(value)
        else:
            self._values[place - 1] = value

    def __getitem__(self, shape: TopoDS_Shape) -> Value:
        place: int = self._keys.FindIndex(shape)
        if not place:
            raise KeyError(shape)
        return self._values[place - 1]

    def get(self, shape: TopoDS_Shape, default: Value) -> Value:
        """The value of a shape, or `default` where it has none."""
        place: int = self._keys.FindIndex(shape)
        return self._values[place - 1] if place else default

    def setdefault(self, shape: TopoDS_Shape, default: Value) -> Value:
        """The value of a shape, which `default` becomes where it has none."""
        place: int = self._keys.Add(shape)
        if place > len(self._values):
            self._values.append(default)
        return self._values[place - 1]

    def __contains__(self, shape: TopoDS_Shape) -> bool:
        return bool(self._keys.Contains(shape))

    def __len__(self) -> int:
        return len(self._values)

    def __iter__(self) -> Iterator[TopoDS_Shape]:
        return (self._keys.FindKey(index) for index in range(1, len(self._values) + 1))

    def values(self) -> Iterator[Value]:
        """The values, in the order of their keys."""
        return iter(self._values)

    def items(self) -> Iterator[tuple[TopoDS_Shape, Value]]:
        """The keys with their values."""
        return zip(self, self._values, strict=True)
