"""Where the game's own files are: assets/ beside the packages, in a clone and when installed."""

from pathlib import Path

ASSETS = Path(__file__).resolve().parent.parent / "assets"
FONTS = ASSETS / "font"
IMAGES = ASSETS / "images"
SOUNDS = ASSETS / "sounds"
MUSIC = ASSETS / "music"
LEVELS = ASSETS / "levels"
