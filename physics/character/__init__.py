"""Characters, which the game moves by whole pixels among solids, belts and lifts."""
