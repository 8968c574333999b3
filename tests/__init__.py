"""The tests. A package, so that tests/game never shadows game."""
