"""Shape features: what a panel can be, as chains of rulings or polygons, and the catalogue of those with a name.

A chain is walked across the panel from ruling to ruling. A ruling is a frame: a point p and the right-handed axes
b = t x n (across), t (along the ruling) and n (the outward normal). Each patch carries one ruling to the next, and the
tangent plane goes with it, so that neighbouring patches meet without a kink by construction:

- a plane moves p by a width along b and turns t in the plane by an angle (2 numbers);
- a cone turns the whole frame by its sweep about the axis through c = p - r n in the direction
  a = cos(g) t - sin(g) n (3 numbers: the normal radius r at p, the half angle g, the sweep). g = 0 is exactly the
  cylinder, and nothing blows up there;
- a cylinder is the cone with g held at 0 (2 numbers).

The apex is never an unknown: it runs off to infinity exactly where real panels lie, and is derived for reports. The
walk begins in the middle patch, which keeps the unknowns well scaled. Plane-cone-plane has 8 independent shape numbers
so; the paper's 9 carry one spare, since shifting along the axis equals changing the apex distance.

Each end is cut by one plane, so it is line - conic - line, planar and without a kink. Where that plane may tilt (a
mitre) a panel has 18 independent numbers instead of the paper's 16, and that decides whether neighbours can meet: two
flat flanges share only the line in which their planes cross.

numbers -> patches -> panel_edges -> rulings (what a walk gives, and the protocol PanelFeature) -> cut_planes, walk,
distance -> independence (no unknown may depend on others) -> feature, polygon -> catalogue, layout.
"""
