"""Panels as a binary glTF 2.0 file: one named mesh and node a panel, metres, Y up, as glTF wants it.

Coordinates of a mesh count from its panel's own corner, and the node says where that lies: single precision, which glTF
has for vertices, then keeps a thousandth of a millimetre however large the building is.
"""

from __future__ import annotations

import struct
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from pygltflib import (
    ARRAY_BUFFER,
    ELEMENT_ARRAY_BUFFER,
    FLOAT,
    GLTF2,
    UNSIGNED_INT,
    Accessor,
    Asset,
    Attributes,
    Buffer,
    BufferView,
    Material,
    Mesh,
    Node,
    PbrMetallicRoughness,
    Primitive,
    Scene,
)

from cadpanel.arrays import Array, IntArray
from cadpanel.errors import DeliveryError
from cadpanel.geometry.triangles import Triangles

Colour = tuple[float, float, float]
METRES = 1e-3
# From x right, y back, z up to x right, y up, z to the front.
_Y_UP = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])


@dataclass(frozen=True, slots=True, kw_only=True)
class MeshedPanel:
    """A panel to be written.

    Attributes:
        name: of its mesh and its node.
        mesh: its solid, mm.
        colour: sRGB, components in 0 to 1.
        said: what is told of it besides, as the node's "extras".
    """

    name: str
    mesh: Triangles
    colour: Colour
    said: Mapping[str, str | float] = field(default_factory=dict)


@dataclass(frozen=True, slots=True, kw_only=True)
class ReadMesh:
    """A mesh that was read back: its name, its points (v, 3) in mm, its triangles (t, 3), its linear colour."""

    name: str
    points: Array
    corners: IntArray
    paint: tuple[float, ...]


def glb_bytes(panels: Sequence[MeshedPanel], title: str, said: Mapping[str, object]) -> bytes:
    """A whole file.

    Args:
        panels: in their order.
        title: the name of the node that holds all others.
        said: what is told of all of it, as that node's "extras".
    """
    gltf = GLTF2(asset=Asset(version="2.0", generator="cadpanel"))
    colours = {panel.colour: None for panel in panels}
    gltf.materials = [_material(colour) for colour in colours]
    places = {colour: place for place, colour in enumerate(colours)}
    data = _Data(gltf)
    for number, panel in enumerate(panels):
        origin = panel.mesh.points[0]
        points = ((panel.mesh.points - origin) @ _Y_UP.T * METRES).astype("<f4")
        normals = (panel.mesh.normals @ _Y_UP.T).astype("<f4")
        primitive = Primitive(
            attributes=Attributes(POSITION=data.vectors(points, bounded=True), NORMAL=data.vectors(normals)),
            indices=data.indices(panel.mesh.corners.astype("<u4")),
            material=places[panel.colour],
        )
        gltf.meshes.append(Mesh(name=panel.name, primitives=[primitive]))
        at = (_Y_UP @ origin * METRES).tolist()
        gltf.nodes.append(Node(name=panel.name, mesh=number, translation=at, extras=dict(panel.said)))
    gltf.nodes.append(Node(name=title, children=list(range(len(panels))), extras=dict(said)))
    gltf.scenes, gltf.scene = [Scene(name=title, nodes=[len(panels)])], 0
    gltf.buffers = [Buffer(byteLength=len(data.bytes))]
    gltf.set_binary_blob(bytes(data.bytes))
    return b"".join(gltf.save_to_bytes())


def read_glb(path: Path) -> list[ReadMesh]:
    """The meshes in a file that `glb_bytes` made, in its order.

    Raises:
        DeliveryError: it cannot be read, or is no such file.
    """
    try:
        data = path.read_bytes()
    except OSError as error:
        raise DeliveryError(f"'{path}' cannot be read: {error.strerror or error}.") from error
    try:
        gltf = GLTF2.load_from_bytes(data)
        blob = gltf.binary_blob()
        return [_read(gltf, blob, node) for node in gltf.nodes if node.mesh is not None]
    except (struct.error, ValueError, TypeError, KeyError, IndexError, AttributeError, OSError) as error:
        raise DeliveryError(f"'{path}' cannot be read: it is no whole glTF file ({error}).") from error


class _Data:
    """The binary part of a file under construction."""

    def __init__(self, gltf: GLTF2) -> None:
        self._gltf = gltf
        self.bytes = bytearray()

    def vectors(self, rows: Array, *, bounded: bool = False) -> int:
        """Add (v, 3) numbers; the place of their accessor."""
        bounds = {"min": rows.min(axis=0).tolist(), "max": rows.max(axis=0).tolist()} if bounded else {}
        view = self._view(rows.tobytes(), ARRAY_BUFFER)
        self._gltf.accessors.append(
            Accessor(bufferView=view, componentType=FLOAT, count=len(rows), type="VEC3", **bounds)
        )
        return view

    def indices(self, corners: IntArray) -> int:
        """Add the corners of triangles; the place of their accessor."""
        view = self._view(corners.tobytes(), ELEMENT_ARRAY_BUFFER)
        self._gltf.accessors.append(
            Accessor(bufferView=view, componentType=UNSIGNED_INT, count=corners.size, type="SCALAR")
        )
        return view

    def _view(self, data: bytes, target: int) -> int:
        # All parts are of four bytes each, so that every view begins where glTF lets it.
        self._gltf.bufferViews.append(
            BufferView(buffer=0, byteOffset=len(self.bytes), byteLength=len(data), target=target)
        )
        self.bytes += data
        return len(self._gltf.bufferViews) - 1


def _read(gltf: GLTF2, blob: bytes, node: Node) -> ReadMesh:
    (primitive,) = gltf.meshes[node.mesh].primitives
    single = _numbers(gltf, blob, primitive.attributes.POSITION, "<f4").reshape(-1, 3)
    if not np.isfinite(single).all():
        raise ValueError("a coordinate is no number")
    points = single.astype(np.float64)
    corners = _numbers(gltf, blob, primitive.indices, "<u4").reshape(-1, 3).astype(np.intp)
    if corners.max(initial=-1) >= len(points):
        raise ValueError("a triangle names a corner that is not there")
    paint = gltf.materials[primitive.material].pbrMetallicRoughness.baseColorFactor
    return ReadMesh(
        name=node.name,
        points=(points + node.translation) @ _Y_UP / METRES,
        corners=corners,
        paint=tuple(float(part) for part in paint[:3]),
    )


def _numbers(gltf: GLTF2, blob: bytes, place: int, kind: str) -> Array:
    accessor = gltf.accessors[place]
    view = gltf.bufferViews[accessor.bufferView]
    count = accessor.count * (3 if accessor.type == "VEC3" else 1)
    return np.frombuffer(blob, dtype=kind, count=count, offset=view.byteOffset)


def _material(colour: Colour) -> Material:
    paint = PbrMetallicRoughness(baseColorFactor=[*linear(colour), 1.0], metallicFactor=0.1, roughnessFactor=0.6)
    return Material(pbrMetallicRoughness=paint)


def linear(colour: Colour) -> list[float]:
    """From sRGB (IEC 61966-2-1) to the linear components of glTF."""
    return [part / 12.92 if part <= 0.04045 else ((part + 0.055) / 1.055) ** 2.4 for part in colour]
