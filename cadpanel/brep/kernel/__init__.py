"""What everything else in brep takes from the kernel: its messages, types, points, shapes, splines and tolerances."""
