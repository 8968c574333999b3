"""The shell's faults are driven as its other tests are, each with a data folder of its own."""

from tests.game.conftest import data_folder_of_the_test, drive

__all__ = ["data_folder_of_the_test", "drive"]
