"""The inside of a face is told alike wherever its parameters lie."""

import numpy as np
from OCP.BRepBuilderAPI import BRepBuilderAPI_MakeFace
from OCP.gp import gp_Pln

from cadpanel.brep.faces.inside_test import InsideTest


def test_the_inside_of_a_face_far_along_its_parameters_is_told_as_closely_as_near_their_origin():
    """What counts as on the border hangs on how wide the range is, and not on where it lies."""
    for far in (0.0, 1e6):
        face = BRepBuilderAPI_MakeFace(gp_Pln(), far, far + 1.0, 0.0, 1.0).Face()
        test = InsideTest(face, np.array([[far, far + 1.0], [0.0, 1.0]]))
        places = np.array([[far + 0.5, 0.5], [far + 0.5, 1e-4], [far + 0.5, 0.0], [far + 0.5, -1e-4]])
        assert test.inside(places).tolist() == [True, True, False, False]
        assert test.encloses(places).tolist() == [True, True, True, False]
