"""How far apart two convex shapes are, and along which normal."""
