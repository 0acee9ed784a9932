"""A large STEP file whose products are the panels, read, sampled and mended by two processes, half of it each.

What comes back is what one process finds, digit for digit: panels are sampled in the same groups, and whatever needs
all of them, names and the origin, is found from what both have read. Where anything is out of the ordinary nothing
comes back, and one process reads the file as a whole and says so.
"""

from __future__ import annotations

import tempfile
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import cast

from cadpanel.brep.cutting.raw_panels import PANELS_AT_ONCE, RawReference, all_of, mended_products
from cadpanel.brep.files.catalogue import format_of
from cadpanel.brep.files.loading import Extent, extent_of, moved_back, origin_note, origin_within, placed_together
from cadpanel.brep.files.model import NamedShape
from cadpanel.brep.files.names import call_panels
from cadpanel.brep.files.step import STEP, read_plain_products
from cadpanel.brep.files.step_parts import StepPart, cut_in_two
from cadpanel.brep.files.text_check import check_step_text, contents
from cadpanel.brep.isolation.beside import POSSIBLE, Channel, beside
from cadpanel.brep.isolation.processors import processors
from cadpanel.brep.isolation.requests import SECONDS_TO_WORK
from cadpanel.brep.isolation.time_limit import limit_time
from cadpanel.brep.skin.panel_cleanup import Mended
from cadpanel.reference.settings import ReferenceSettings

WORTHWHILE_BYTES = 8_000_000
"""Size of a file from which reading takes a second or more."""
Place = tuple[float, float, float]
AT_HOME: Place = (0.0, 0.0, 0.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class _Said:
    """What one process tells the other one of its products.

    Attributes:
        called: the names of each and of its use.
        unit: of the file.
        extent: the box around them.
    """

    called: tuple[tuple[str, str], ...]
    unit: str
    extent: Extent | None


@dataclass(frozen=True, slots=True, kw_only=True)
class _Told:
    """What the other one is told for that: the names of its panels, and the origin that they are to have."""

    names: tuple[str, ...]
    origin: Place | None


def products_by_two(path: Path, how: ReferenceSettings, go_on: Callable[[], None]) -> RawReference | None:
    """Read a reference whose products are the panels, if two processes can read it, and it is large enough to pay.

    Args:
        path: the file.
        how: the settings.
        go_on: called once both halves are read; what is found wrong after that leaves the file to one process, too.

    Returns:
        None where it is read as a whole; that says, too, what is wrong with a file that is refused.
    """
    if how.way is not None or how.faces is not None or how.millimetres is not None or not _is_worthwhile(path):
        return None
    try:
        return _read_by_two(path, how, go_on)
    except Exception:  # noqa: BLE001 - whatever it is, one process meets it again, or does without what was missing
        return None


def _is_worthwhile(path: Path) -> bool:
    try:
        return POSSIBLE and processors() > 1 and path.stat().st_size >= WORTHWHILE_BYTES
    except OSError:
        return False


def _read_by_two(path: Path, how: ReferenceSettings, go_on: Callable[[], None]) -> RawReference | None:
    if format_of(path) is not STEP:
        return None
    text = contents(path)
    cut = cut_in_two(text, PANELS_AT_ONCE)
    if cut is None:
        return None

    def other_half(channel: Channel) -> None:
        found = _Half.read(cut.other, path.name)
        if found is not None:
            channel.say(found.said)
            limit_time(SECONDS_TO_WORK)
            channel.say(found.done(cast(_Told, channel.hear()), how))

    with beside(other_half) as channel:
        del text
        own = _Half.read(cut.one, path.name)
        if own is None:
            return None
        other = cast(_Said, channel.hear())
        if other.unit != own.said.unit:
            return None
        go_on()
        names = call_panels([*own.said.called, *other.called])
        origin = origin_within([own.said.extent, other.extent], path.name)
        count = len(own.said.called)
        channel.say(_Told(names=tuple(names[count:]), origin=origin))
        first = own.done(_Told(names=tuple(names[:count]), origin=origin), how)
        mended = first.followed_by(cast(Mended, channel.hear()))
    outlines = all_of(mended.outlines)
    if outlines is None:
        return None
    moved = () if origin is None else (origin_note(path.name, origin),)
    return RawReference(
        panels=mended.panels,
        notes=(*moved, *mended.notes(path.name, how.seam_tolerance)),
        origin=origin or AT_HOME,
        outlines=outlines,
    )


@dataclass(frozen=True, slots=True, kw_only=True)
class _Half:
    """Some products of a file, placed, and what the other process must know of them."""

    source: str
    shapes: tuple[NamedShape, ...]
    said: _Said

    @classmethod
    def read(cls, part: StepPart, source: str) -> _Half | None:
        """Read a part of a file of that name; None where it holds other things than so many products.

        Raises:
            CadpanelError: it is damaged.
        """
        check_step_text(Path(source), b"".join(part.pieces))
        with _as_file(part.pieces) as path:
            read = read_plain_products(path, part.products)
        if read is None:
            return None
        parts, unit = read
        shapes = placed_together([one.shape for one in parts], source)
        return cls(
            source=source,
            shapes=tuple(NamedShape(one.product, shape) for one, shape in zip(parts, shapes, strict=True)),
            said=_Said(
                called=tuple((one.product, one.instance) for one in parts), unit=unit, extent=extent_of(shapes, source)
            ),
        )

    def done(self, told: _Told, how: ReferenceSettings) -> Mended:
        """Its panels, sampled and mended, under their names and near their origin.

        Raises:
            CadpanelError: one of them is none.
        """
        named = tuple(replace(one, name=name) for one, name in zip(self.shapes, told.names, strict=True))
        shapes = named if told.origin is None else moved_back(named, told.origin)
        return mended_products(shapes, self.source, how.seam_tolerance)


@contextmanager
def _as_file(pieces: Sequence[bytes]) -> Iterator[Path]:
    """A file without a name, of which nothing is left, however this process ends."""
    with tempfile.TemporaryFile() as file:  # not in memory: not every Python has files there
        file.writelines(pieces)
        file.flush()
        yield Path(f"/proc/self/fd/{file.fileno()}")
