"""`python -m scenes.outlines [--check]`: fit the outlines of the masks that the scenes begin with, and store them.

They are stored beside the art (assets/outlines.npz), so that a start without compiled kernels does not fit them again.
Every scene is built with each of its tiers. Bots play the games for some seconds, which adds later masks. The sprites
of all sheets are added, too.

--check compares the file with newly fitted outlines. Exit 1: it differs.
"""

import sys
import tempfile
from pathlib import Path

from game.drawing.sprites import load_atlas
from game.places import OUTLINES
from game.registry import Registry
from game.run.headless import start_dummy_display
from game.run.session import Session
from game.run.sources import BotSource
from physics.outline import kept
from physics.shapes.outline import outline_of
from scenes import SCENES

FRAMES = {"shooter": 3600, "platformer": 600, "lander": 600}  # steps of 1/60 s
SHEETS = ("planes", "hero", "things", "lab", "lander")


def fit_all() -> dict[bytes, kept.Parts]:
    """Return the outlines of all masks that scenes begin with, by their keys, all newly fitted."""
    start_dummy_display()
    kept.forget()
    kept.recorded = {}
    try:
        for scene_class in Registry(SCENES).all_classes():
            for tier in scene_class.tiers or (None,):
                session = Session(scene_class(0, tier=tier), BotSource())
                for _ in range(FRAMES.get(scene_class.name, 2)):
                    session.step()
        for atlas in map(load_atlas, SHEETS):
            for name in atlas.images:
                outline_of(atlas.mask(name))
        return dict(kept.recorded)
    finally:
        kept.recorded = None
        kept.use(OUTLINES)


def main(arguments: list[str]) -> int:
    """Write the file, or compare it. Return the exit code."""
    found = fit_all()
    if arguments == ["--check"]:
        with tempfile.TemporaryDirectory() as folder:
            anew = Path(folder) / OUTLINES.name
            kept.write(anew, found)
            same = OUTLINES.exists() and anew.read_bytes() == OUTLINES.read_bytes()
        print(f"{OUTLINES.name}: {'as it is fitted' if same else 'differs; run python -m ' + str(__spec__.name)}")
        return 0 if same else 1
    kept.write(OUTLINES, found)
    print(f"{OUTLINES.name}: {len(found)} outlines, {OUTLINES.stat().st_size} bytes")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
