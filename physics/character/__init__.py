"""Characters of platform games, which the game moves in whole pixels among solids, conveyors and moving platforms."""
