from __future__ import annotations

from dataclasses import fields, replace

import numpy as np

from cadpanel.fitting.measures.fit import Measures, measure
from cadpanel.fitting.measures.joined import joined
from cadpanel.reference.model import Reference
from tests.delivered import fitted, strip


def test_put_together_they_are_what_is_measured_of_all() -> None:
    """The strip, and its panels once more in another order between those of the first."""
    result, drawn = fitted(), strip()
    places = [np.array([1, 3, 4]), np.array([0, 2, 5])]
    whole: Reference = replace(
        drawn,
        panels=tuple(drawn.panels[i] for i in (0, 0, 1, 1, 2, 2)),
        seams=tuple(
            replace(seam, panels=(int(one[seam.panels[0]]), int(one[seam.panels[1]])))
            for seam in drawn.seams
            for one in places
        ),
    )
    found = joined([result.measures, result.measures], places, whole)
    told = measure([result.shapes[i] for i in (0, 0, 1, 1, 2, 2)], whole)
    for one in fields(Measures):
        if one.name not in ("shapes", "corner_gaps"):
            np.testing.assert_allclose(getattr(found, one.name), getattr(told, one.name), rtol=1e-9, atol=1e-12)
    for own, other in zip(found.corner_gaps, told.corner_gaps, strict=True):
        np.testing.assert_allclose(own, other, rtol=1e-9, atol=1e-12)
    assert [shape.name for shape in found.shapes] == [shape.name for shape in told.shapes]
