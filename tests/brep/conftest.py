"""What the tests of reading share: a place for files, and a strip of four lips."""

import pytest

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
