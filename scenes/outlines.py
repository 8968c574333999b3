"""`python -m scenes.outlines [--check]`: fit polygon outlines to the pixel masks of the scenes, and store them.

The outlines are stored in assets/outlines.npz, so that a start without compiled kernels does not fit them again. Every
scene is built at each of its collision tiers. Bots play the games for some seconds, to include the masks that appear
during play. The sprites of all sheets are included, too.

--check compares the stored file with newly fitted outlines. Exit code 1: the file differs.
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
    """Fit the outlines of all masks of the scenes and sheets again. Return {mask key: outline parts}."""
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
    """Write the outline file or, with --check, compare it with new outlines. Return the exit code."""
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
