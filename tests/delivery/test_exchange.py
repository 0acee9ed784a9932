"""Two folders take each other's name in one step."""

import ctypes
import errno
import os
import stat

import pytest

from cadpanel.delivery import exchange
from cadpanel.delivery.exchange import exchanged, make_lasting, put_where_nothing_is


@pytest.fixture
def two(tmp_path):
    for name in ("one", "other"):
        (tmp_path / name).mkdir()
        (tmp_path / name / "file").write_text(name)
    return tmp_path / "one", tmp_path / "other"


def test_two_folders_exchange_their_names(two):
    one, other = two
    if not exchanged(one, other):
        pytest.skip("this system, or this disk, exchanges nothing")
    assert ((one / "file").read_text(), (other / "file").read_text()) == ("other", "one")


def test_what_is_not_there_is_exchanged_with_nothing(two):
    one, other = two
    if exchange._system_rename() is None:
        pytest.skip("this system exchanges nothing")
    with pytest.raises(FileNotFoundError):
        exchanged(one, other.with_name("none"))
    assert (one / "file").read_text() == "one"


def test_what_cannot_be_exchanged_is_told(two, monkeypatch):
    def not_here(*_):
        ctypes.set_errno(errno.EINVAL)
        return -1

    monkeypatch.setattr(exchange, "_system_rename", lambda: not_here)
    assert not exchanged(*two)
    monkeypatch.setattr(exchange, "_system_rename", lambda: None)
    assert not exchanged(*two)


@pytest.mark.parametrize("system", [True, False])
def test_a_folder_goes_only_where_nothing_is(two, monkeypatch, system):
    if not system:
        monkeypatch.setattr(exchange, "_system_rename", lambda: None)
    one, other = two
    with pytest.raises(FileExistsError):
        put_where_nothing_is(one, other)
    put_where_nothing_is(one, other.with_name("third"))
    assert sorted(path.name for path in one.parent.iterdir()) == ["other", "third"]


def test_files_and_folders_are_made_lasting_and_links_are_let_alone(two, monkeypatch):
    seen: list[int] = []
    monkeypatch.setattr("cadpanel.delivery.exchange.os.fsync", seen.append)
    (two[0] / "link").symlink_to("nowhere")
    make_lasting(two[0])
    assert len(seen) == 2  # the file and its folder


def refusing(code, is_refused):
    """An fsync of a disk that refuses files, or folders."""

    def fsync(handle):
        if is_refused(os.fstat(handle).st_mode):
            raise OSError(code, os.strerror(code))

    return fsync


@pytest.mark.parametrize("code", [errno.EINVAL, errno.ENOTSUP, errno.EBADF])
def test_a_disk_that_takes_no_such_order_for_folders_is_delivered_to(two, monkeypatch, code):
    monkeypatch.setattr("cadpanel.delivery.exchange.os.fsync", refusing(code, stat.S_ISDIR))
    make_lasting(two[0])


@pytest.mark.parametrize(("code", "is_refused"), [(errno.EINVAL, stat.S_ISREG), (errno.EIO, stat.S_ISDIR)])
def test_a_file_that_is_not_written_down_and_a_broken_disk_are_told(two, monkeypatch, code, is_refused):
    monkeypatch.setattr("cadpanel.delivery.exchange.os.fsync", refusing(code, is_refused))
    with pytest.raises(OSError, match=os.strerror(code)):
        make_lasting(two[0])
