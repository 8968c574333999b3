"""Paths of the game's own files. They are in assets/ beside the packages, both in a clone and in an installation."""

from pathlib import Path

from game.startup import IN_CHECKOUT

ASSETS = Path(__file__).resolve().parent.parent / "assets"
FONTS = ASSETS / "font"
IMAGES = ASSETS / "images"
SOUNDS = ASSETS / "sounds"
MUSIC = ASSETS / "music"
LEVELS = ASSETS / "levels"
OUTLINES = ASSETS / "outlines.npz"  # outlines of the masks that scenes begin with: python -m scenes.outlines
CURE = f"rebuild it with: python -m {ASSETS.name}.build" if IN_CHECKOUT else "install hitbox again"  # of damaged assets
