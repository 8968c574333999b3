"""Art, sound, fonts and levels of the game, and the scripts that make them.

Every picture, sound and level file in this folder is written by `python -m assets.build` and kept in the
repository, so the game itself reads files only and starts at once. The scripts need NumPy and nothing else, but for
filming.py, which plays the game to take the menu's pictures.
"""

from pathlib import Path

FOLDER = Path(__file__).parent
