"""What the tests of reading share: a place for files, a strip of four lips, and readers that are there at once."""

import pytest

from cadpanel.brep.isolation import client
from tests.forking import SERVER, forking
from tests.reference_shapes import kernel_lip, strip, write_products


@pytest.fixture(scope="session")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("read")


@pytest.fixture(scope="session")
def lips():
    return [(f"lip {index}", kernel_lip(lip)) for index, lip in enumerate(strip(4))]


@pytest.fixture(scope="session")
def strip_file(folder, lips):
    return write_products(folder / "strip.step", lips)


@pytest.fixture(scope="session")
def forks():
    """The command that starts an interpreter with the kernel loaded, of the text that it is to run."""
    with forking() as command:
        yield command


@pytest.fixture(scope="module")
def forked_readers(forks):
    """The reader is forked whenever it is started: for tests that crash or stop it."""
    client.stop_reader()
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(client, "interpreter", lambda _: forks(SERVER))
        yield
        client.stop_reader()
