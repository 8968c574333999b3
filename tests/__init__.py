"""Tests of the project. They form a package, so that the module tests.game is not imported as game."""
