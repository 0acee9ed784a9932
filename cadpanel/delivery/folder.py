"""A folder that is written whole or not at all.

Everything goes into a hidden folder beside the target, so on the same disk, the manifest last; then the two exchange
their names in one step, so that there is a whole delivery before, during and after. Whatever goes wrong before that
leaves the target as it was, and nothing else behind; what a killed run leaves is cleared by the next one.
"""

from __future__ import annotations

import errno
import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from cadpanel.delivery.exchange import exchanged, make_lasting, put_where_nothing_is
from cadpanel.delivery.manifest import write_manifest
from cadpanel.delivery.own_files import MARKS_OF_A_DELIVERY, changed_since, is_ours, strangers
from cadpanel.delivery.work_folders import aside_of, clear_left_behind, keep_from_clearing, work_folder
from cadpanel.errors import CadpanelError, DeliveryError

_DISK_FAULTS = frozenset({errno.ENOSPC, errno.EDQUOT, errno.EROFS, errno.EIO, errno.EFBIG})


@contextmanager
def delivery_folder(target: Path, *, overwrite: bool = False) -> Iterator[Path]:
    """Give a folder to write into; put it in the target's place when the block ends well, else remove it.

    Args:
        target: where the delivery shall stand; missing parents are made (and removed again on failure).
        overwrite: replace an existing delivery. A folder that is not one, or that holds anything beside it, is never
            replaced unless it is empty.

    Yields:
        The folder to write into; it is not the target, so do not keep its path.

    Raises:
        DeliveryError: the target is refused, or cannot be written; one sentence says why.
    """
    place = Path(os.path.realpath(target))  # a link to a folder keeps pointing at it
    refuse_if_taken(place, target, overwrite=overwrite)
    made = _make_parents(place, target)
    clear_left_behind(place.parent)
    work = work_folder(place)
    try:
        _make_folder(work, target)
        yield work
        write_manifest(work)
        make_lasting(work)
        refuse_if_taken(place, target, overwrite=overwrite)  # a fit takes minutes: someone may have come first
        replaced = _put_in_place(work, place, target)
    except BaseException as error:  # an interrupt must clean up as well
        shutil.rmtree(work, ignore_errors=True)
        _remove_empty(made)
        # A writer may have told its own story about the hidden folder; the reader knows only the target.
        cause = error.__cause__ if isinstance(error, DeliveryError) else error
        if isinstance(cause, OSError) and not isinstance(cause, CadpanelError) and _is_about(cause, work):
            raise DeliveryError(_sentence(target, cause)) from cause
        raise
    if replaced is not None:
        _delete(replaced, target)


def refuse_if_taken(place: Path, target: Path, *, overwrite: bool) -> None:
    """Refuse a target that holds something which was not asked to be replaced, or which is not ours to replace."""
    try:
        place.lstat()
        if not place.is_dir():
            raise DeliveryError(f"'{target}' is a file: name a folder to write the delivery to.")
        if not overwrite:
            raise DeliveryError(f"'{target}' exists already: name another folder, or replace it with --overwrite.")
        if not is_ours(place):
            raise DeliveryError(
                f"'{target}' holds files but no {' or '.join(MARKS_OF_A_DELIVERY)} of cadpanel, so it is not a "
                "delivery and is not overwritten: name another folder."
            )
        strange = strangers(place)
        if strange:
            raise DeliveryError(
                f"'{target}' also holds '{min(strange)}', which cadpanel did not write and --overwrite would "
                "delete: move it elsewhere, or name another folder."
            )
        changed = changed_since(place)
        if changed:
            raise DeliveryError(
                f"'{changed[0]}' in '{target}' was changed since cadpanel wrote it, and --overwrite would delete that: "
                "move it elsewhere, or name another folder."
            )
    except DeliveryError:
        raise
    except (FileNotFoundError, NotADirectoryError):
        return  # nothing there; whether it can be made is for _make_parents to say
    except OSError as error:
        raise DeliveryError(_sentence(target, error)) from error


def _make_parents(place: Path, target: Path) -> list[Path]:
    """Make the folders above the target; return those that were not there, deepest first."""
    missing = []
    folder = place.parent
    while not os.path.lexists(folder):
        missing.append(folder)
        folder = folder.parent
    if not folder.is_dir():
        raise DeliveryError(f"'{target}' cannot be written: '{folder}' is a file, not a folder.")
    try:
        for parent in reversed(missing):
            parent.mkdir(exist_ok=True)
    except OSError as error:
        _remove_empty(missing)
        raise DeliveryError(_sentence(target, error)) from error
    return missing


def _make_folder(work: Path, target: Path) -> None:
    try:
        work.mkdir()
    except OSError as error:
        raise DeliveryError(_sentence(target, error)) from error


def _put_in_place(work: Path, place: Path, target: Path) -> Path | None:
    """Let the finished folder take its place; an old delivery is never out of it for longer than the system needs.

    Returns:
        Where the old delivery stands now, to be deleted; None if there was none.
    """
    try:
        if not os.path.lexists(place):
            put_where_nothing_is(work, place)
            return None
        keep_from_clearing(place)
        if exchanged(work, place):
            return work
    except FileExistsError as error:
        raise DeliveryError(
            f"'{target}' exists already: name another folder, or replace it with --overwrite."
        ) from error
    except OSError as error:
        raise DeliveryError(_sentence(target, error)) from error
    return _stand_aside(work, place, target)


def _stand_aside(work: Path, place: Path, target: Path) -> Path:
    """Two renames where the system exchanges nothing; the old delivery returns on any error."""
    aside = aside_of(work, place)
    _rename(place, aside, target)
    try:
        _rename(work, place, target)
    except BaseException:
        if not place.exists():
            aside.rename(place)
        raise
    return aside


def _delete(aside: Path, target: Path) -> None:
    try:
        shutil.rmtree(aside)
    except FileNotFoundError:
        return  # another machine clears it as left behind
    except OSError as error:
        raise DeliveryError(
            f"'{target}' is written, but what stood there before could not be deleted from '{aside}': {error.strerror}."
        ) from error


def _rename(source: Path, destination: Path, target: Path) -> None:
    try:
        source.rename(destination)
    except OSError as error:
        raise DeliveryError(_sentence(target, error)) from error


def _remove_empty(folders: list[Path]) -> None:
    """Remove the folders, deepest first, as far as they are there and empty."""
    for folder in folders:
        with suppress(OSError):  # never made, or someone else's by now
            folder.rmdir()


def _is_about(error: OSError, work: Path) -> bool:
    """Whether the disk or the folder is at fault, and not some other file that the block read."""
    names = [str(name) for name in (error.filename, error.filename2) if name is not None]
    return error.errno in _DISK_FAULTS or any(Path(name).is_relative_to(work) for name in names)


def _sentence(target: Path, error: OSError) -> str:
    reasons = {
        errno.ENOSPC: "the disk is full",
        errno.EDQUOT: "the disk quota is used up",
        errno.EROFS: "the disk is read-only",
        errno.EACCES: "writing there is not permitted",
        errno.EPERM: "writing there is not permitted",
        errno.ENAMETOOLONG: "the name is too long",
    }
    reason = reasons.get(error.errno or 0, error.strerror or str(error))
    return f"'{target}' cannot be written: {reason}; nothing was written."
