"""Art, sound, fonts and levels of the game, and the scripts that make them.

Every picture, sound, tune and level file in this folder is written by `python -m assets.build` and stored in the
repository, so the game only reads files and starts at once. The scripts need NumPy; music also needs the encoder of the
extra "assets", and the menu's pictures are filmed by a program of scenes/. A script imports from its own folder and
from craft/, and nothing of the game.
"""

from pathlib import Path

FOLDER = Path(__file__).parent
