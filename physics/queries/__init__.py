"""Questions without a step: rays, casts, overlaps, and two shapes alone."""
