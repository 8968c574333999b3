"""Art, sound, fonts and levels of the game, and the scripts that make them.

`python -m assets.build` writes every picture, sound, tune and level file in this folder. The files are stored in the
repository, so the game only reads files and starts at once. The scripts need NumPy; music also needs the encoder of the
extra "assets", and a program of scenes/ takes the menu's pictures. A script imports from its own folder and from
craft/, and nothing of the game.
"""

from pathlib import Path

FOLDER = Path(__file__).parent
