"""Distance of convex hulls: GJK, EPA and witness points."""
