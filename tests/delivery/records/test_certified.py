"""What a certificate says of files is held against them, number by number: none that is stated goes unseen."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest

from cadpanel.delivery.records.certified import CertificateModel, ClearModel
from cadpanel.delivery.records.consistency import certificate_faults
from tests.attack.report_tampers import other

FOUND = CertificateModel(
    solids=2,
    skins=2,
    valid=True,
    face_kinds={"plane": 16, "cone": 4},
    max_tangency_error=1e-15,
    volume_error=1e-15,
    names_kept=True,
    max_seam_gap=0.5,
    clear=ClearModel(least=10.0, largest=10.5),
    overlap=0.0,
    outputs={"glb": {"panels": 2.0}},
)


def changed() -> Iterator[tuple[str, Any]]:
    content = FOUND.model_dump(mode="json")
    for key, value in content.items():
        yield key, {**content, key: {**value, "least": 9.0} if key == "clear" else other(value)}
    yield "more outputs", {**content, "outputs": {**content["outputs"], "pdf": {"pages": 3.0}}}
    yield "more numbers", {**content, "outputs": {"glb": {"panels": 2.0, "triangles": 3.0}}}


@pytest.mark.parametrize(("key", "content"), [*changed()], ids=lambda part: part if isinstance(part, str) else "")
def test_every_number_of_a_certificate_is_held_against_the_files(key: str, content: Any) -> None:
    assert set(content) == set(CertificateModel.model_fields)
    assert not list(certificate_faults(FOUND, FOUND))
    assert list(certificate_faults(CertificateModel.model_validate(content), FOUND)), key
