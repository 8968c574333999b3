"""Fixtures of the game's tests, reused for defects of the game shell; each test has its own data folder."""

from tests.game.conftest import data_folder_of_the_test, drive

__all__ = ["data_folder_of_the_test", "drive"]
