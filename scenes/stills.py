"""Stills: the pictures of docs/pictures. They show scenes as they are played, with their measurements.

python -m scenes.stills docs/pictures            all of them; needs a minute for each that shows measured times
python -m scenes.stills docs/pictures masks      the named ones

A bot plays each scene up to its moment. Then the scene is paused until everything that the screen shows is measured.
"""

import argparse
import re
import sys
from dataclasses import dataclass
from pathlib import Path
from time import perf_counter, sleep

from game.audio.sound import Sounds
from game.input.devices import DeviceSource
from game.registry import Registry
from game.run.headless import start_dummy_display
from game.run.picture import Picture, save_png
from game.run.sources import BotSource
from game.screens.play import Play
from scenes import SCENES
from scenes.filming import MOST
from scenes.moments import SEED, Moment, done, landing, leader

PATIENCE = 240.0  # [s] within which everything is measured
TURN = 0.02  # [s] between two pictures while it is measured
MEASURING, DASH = "measuring", "-"  # words in a text, or the text, in place of a number that is not known yet
SETTINGS = re.compile(r"(\d+) of (\d+) settings measured")


@dataclass(frozen=True)
class Still:
    """A picture to take: the scene, the frame number or the Moment (event) of its run, and the overlays that are on.

    costs: whether to show the plot of accuracy and cost (key M); measured: whether to wait for all measurements.
    """

    scene: str
    when: int | Moment
    layers: tuple[str, ...] = ()
    costs: bool = False
    measured: bool = False


BOSS = Moment("boss, first phase", leader("boss_a_0", 85))
KEEP = Moment("keep", done("lift with an enemy", 40))
STILLS = {
    "shooter": Still("shooter", BOSS),
    "shooter_overlays": Still("shooter", BOSS, ("bounds", "pairs", "masks", "contacts")),
    "platformer": Still("platformer", 845),
    "platformer_overlays": Still("platformer", KEEP, ("bounds", "structure", "contacts", "impulses", "times")),
    "lander": Still("lander", Moment("the canyon", landing("canyon", 60.0))),
    "costs": Still("lab/pyramid", 240, costs=True, measured=True),
    "masks": Still("lab/masks", 120, ("masks", "contacts"), measured=True),
    "broadphases": Still("lab/broadphases", 120, ("structure", "pairs"), measured=True),
}


def played(still: Still) -> Play:
    """Return the Play screen of a still, on which the bot has played the scene up to the still's moment."""
    start_dummy_display()
    scene = Registry(SCENES).scene_class(still.scene)(SEED)
    play = Play(scene, DeviceSource(), Sounds(silent=True), bot=True, overlays=still.layers)
    play.session.source = BotSource()
    play.helped_since = -MOST  # without the line of keys
    after = still.when if isinstance(still.when, int) else None
    while scene.frame < MOST:
        if after is None and isinstance(still.when, Moment) and still.when.when(scene):
            after = scene.frame + still.when.after
        if after is not None and scene.frame >= after:
            return play
        play.step()
    raise ValueError(f"{still.scene}: the moment did not come within {MOST} frames")


def take(still: Still, file: Path) -> None:
    """Take a still, and write it as a PNG file. Raises TimeoutError if the measurements take too long."""
    play, started = played(still), perf_counter()
    if still.costs:
        play.toggle_costs()
    picture = Picture()
    frame = play.draw(picture)
    while still.measured and any(missing(text) for _, text in frame.boxes):
        if perf_counter() - started > PATIENCE:
            raise TimeoutError(f"{file.stem}: the measurements were not done within {PATIENCE:.0f} s")
        sleep(TURN)
        play.now = perf_counter() - started
        frame = play.draw(picture)
    play.close()
    save_png(frame.surface, file)


def missing(text: str) -> bool:
    """Return whether a text replaces a number that is not measured yet, or says that some settings are not measured."""
    counted = SETTINGS.search(text)
    return text == DASH or MEASURING in text or (counted is not None and counted[1] != counted[2])


def main(arguments: list[str] | None = None) -> int:
    """Take the stills that the command line names. Return the exit code."""
    parser = argparse.ArgumentParser(prog=f"python -m {__package__}.stills", description="Take pictures of screens.")
    parser.add_argument("folder", type=Path)
    parser.add_argument("names", nargs="*", metavar="NAME", help=f"of {', '.join(STILLS)}; all without a name")
    options = parser.parse_args(arguments)
    if not options.folder.is_dir():
        parser.error(f"{options.folder} is no folder")
    unknown = [name for name in options.names if name not in STILLS]
    if unknown:
        parser.error(f"there is no still {unknown[0]!r}; choose of {', '.join(STILLS)}")
    for name in options.names or STILLS:
        take(STILLS[name], options.folder / f"{name}.png")
    return 0


if __name__ == "__main__":
    sys.exit(main())
