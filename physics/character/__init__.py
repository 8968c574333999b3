"""Characters, which move by whole pixels among solids, belts and lifts."""
