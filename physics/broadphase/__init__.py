"""From boxes to the pairs that may touch."""
