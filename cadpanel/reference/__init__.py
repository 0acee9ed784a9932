"""What is to be approximated: sampled faces, outlines and neighbours, as arrays only, mm.

Raw panels (points, normals, weights and edges of faces) -> outline -> oriented_panel (which edges are ends, which side
is out) -> seam_finding (who meets whom, on which edge) -> model.Reference. Neither the order of the faces nor the side
of their normals matters. What cannot be approximated, or was drawn askew, is told with the panel's name.
"""
