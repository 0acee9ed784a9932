import numpy as np
import pytest

from cadpanel.brep.files.opennurbs import ConversionError
from cadpanel.brep.files.opennurbs_trims import SEAM, SINGULAR, trims_of
from tests.rhino_breps import Tube
from tests.rhino_files import rhino

DECODE = rhino.CommonObject.Decode
PARTS = np.array([0.0, 0.25, 1.0])


@pytest.mark.parametrize("round_v", [False, True])
def test_trims_follow_each_other_round_the_face_with_the_seam_on_both_sides(round_v):
    tube = Tube(round_v=round_v)
    ((loop,),) = trims_of(tube.brep(), DECODE).loops
    ends = np.array([trim.at(np.array([0.0, 1.0])) for trim in loop])
    np.testing.assert_allclose(ends[:, 1], np.roll(ends[:, 0], -1, axis=0), atol=1e-12)
    assert sum(trim.kind == SEAM for trim in loop) == 2
    assert {trim.against_edge for trim in loop if trim.kind == SEAM} == {False, True}
    (border,) = [trim for trim in loop if trim.edge == 0]
    around = 1.0 - PARTS if border.against_edge else PARTS
    wanted = [tube.place(part, up) for part, up in zip(around, tube.lower(around), strict=True)]
    np.testing.assert_allclose(border.at(PARTS), wanted, atol=1e-7)


def test_side_that_is_a_point_has_no_edge():
    ((loop,),) = trims_of(Tube(apex=True).brep(), DECODE).loops
    assert [trim.edge for trim in loop if trim.kind == SINGULAR] == [-1]


def test_what_is_written_another_way_is_refused():
    class Older:
        def Encode(self):  # noqa: N802 - rhino3dm's name
            return {"data": "AAAA"}

    with pytest.raises(ConversionError, match="trimming curves cannot be read"):
        trims_of(Older(), DECODE)
