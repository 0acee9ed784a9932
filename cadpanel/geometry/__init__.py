"""Rulings, planes, cones, sections and development: pure functions of NumPy arrays, in millimetres and radians.

The signed distance of a point x to the cone whose axis passes through c in the direction a, with the normal radius r at
c and the half angle g, is smooth through g = 0: with y = x - c, z = y . a and rho = |y - z a|

    d = rho cos(g) - z sin(g) - r.

A plane cuts a cone in a conic; both ends of a panel are such arcs between straight pieces. Everything here is given at
the panel, never at an apex that may lie a kilometre away: at a half angle of 1e-13 rad an apex-based formula has lost
all its digits.
"""
