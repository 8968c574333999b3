"""Pictures of the games: bots run the scenes without a window, and frames are stored as PNG files.

python -m scenes.filming pictures FOLDER                 the menu's small picture of every scene
python -m scenes.filming moments GAME FOLDER             the game's moments at the canvas' size, and captions.json
python -m scenes.filming reel SCENE 1 0 3600 60 FILE     contact sheet: seed 1, every 60th of frames 0..3600, small
python -m scenes.filming moving FILE                     README's moving picture, an animated WebP; needs Pillow

Scenes are deterministic, so seed and frame number identify a picture. The scripts of assets/ start this program because
they must not import the games.
"""

import argparse
import json
import sys
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pygame

from assets.craft import png
from game.drawing.presenter import SCREENSHOT_SCALE
from game.overlays.stack import Overlays
from game.registry import Registry
from game.run.headless import start_dummy_display
from game.run.picture import Picture
from game.run.session import Session
from game.run.sources import BotSource
from scenes import SCENES
from scenes.moments import MOMENTS, SEED, Moment, done, landing, leader

FRAME = (480, 270)  # [px] of the canvas
SIZE = (160, 90)  # [px] of a menu picture
MOST = 20000  # frames within which every moment of a game must occur


@dataclass(frozen=True)
class Shot:
    """A picture to take: the frame number or the Moment (event) of a run, and the part of the canvas to show.

    The part is 160 x 90 px times `zoom`, with its top left corner at (left, top) [canvas px].
    """

    frame: int | Moment
    left: int = 0
    top: int = 0
    zoom: int = 2
    layers: tuple = ()  # overlays that are on

    @property
    def part(self):
        """The shown part of the canvas as (left, top, width, height) [px]."""
        return self.left, self.top, SIZE[0] * self.zoom, SIZE[1] * self.zoom


# The parts shown contain no measured times, which differ from machine to machine.
SHOTS = {
    "shooter": Shot(Moment("the boss", leader("boss_a_0", 85)), 130, 20),
    "platformer": Shot(Moment("keep", done("lift with an enemy", 40)), 130, 80),
    "lander": Shot(Moment("the canyon", landing("canyon", 60.0)), 90, 40),
    "lab/gallery": Shot(38, 160, 52, 1),
    "lab/effects": Shot(410, 200, 150, 1),
    "lab/queries": Shot(101, 4, 18, 1),
    "lab/sleeping": Shot(330, 40, 118, 1),
    "lab/broadphases": Shot(60, 3, 158, 1, layers=("structure",)),
    "lab/masks": Shot(480, 0, 72),
    "lab/ladder": Shot(3, zoom=3),
    "lab/disagreement": Shot(1200, 160, 60),
    "lab/shapes": Shot(120, 24, 50, 1),
    "lab/filters": Shot(240, 66, 24),
    "lab/sensors": Shot(240, 96, 56, 1),
    "lab/stacks": Shot(240, zoom=3),
    "lab/pyramid": Shot(480, 160, 78),
    "lab/card_house": Shot(240, 60, 32, 1),
    "lab/dominoes": Shot(120, 130, 51, 1),
    "lab/tumbler": Shot(240, 142, 70),
    "lab/mask_stack": Shot(400, 0, 100, 1),
    "lab/carving": Shot(250, 160, 76),
    "lab/mask_sweep": Shot(150, 260, 106, 1),
    "lab/joints": Shot(1300, 126, 112, 1),
    "lab/cradle": Shot(80, 227, 14, 1),
    "lab/billiards": Shot(150, 62, 20),
    "lab/tunnelling": Shot(240, 196, 142, 1),
    "lab/conveyor": Shot(240, 180, 16, 1),
    "lab/one_way": Shot(240, 60, 76),
    "lab/ghost_bumps": Shot(240, 0, 20),
}


@dataclass(frozen=True)
class Clip:
    """A part of the moving picture: the bot's game from a moment on. Overlays are switched on one by one.

    parts: a tuple of (number of steps, names of the overlays that are on).
    """

    scene: str
    start: Moment
    parts: tuple[tuple[int, tuple[str, ...]], ...]


CLIPS = (
    Clip(
        "shooter",
        Moment("boss, first phase", leader("boss_a_0", 60)),
        ((54, ()), (60, ("bounds", "pairs")), (60, ("masks", "contacts"))),
    ),
    Clip(
        "platformer",
        Moment("keep", done("lift with an enemy", 1)),
        ((60, ()), (60, ("outlines", "contacts")), (60, ("bounds", "structure"))),
    ),
    Clip(
        "lander",
        Moment("the canyon", landing("canyon", 90.0)),
        ((60, ()), (66, ("outlines", "contacts")), (66, ("masks", "impulses"))),
    ),
)
EVERY = 3  # steps from picture to picture: 20 a second
SHRINK = 2  # width and height of a presented frame over those of a picture: 720 x 405 px
QUALITY = 42  # of WebP, 0..100: the file stays below 3 MB


class Film:
    """A scene played by its bot. Each picture is the frame as it is shown on a screen, an array (810,
    1440, 3) uint8.
    """

    def __init__(self, name, seed, layers=()):
        start_dummy_display()
        self.scene = Registry(SCENES).scene_class(name)(seed)
        self.session, self.overlays, self.picture = Session(self.scene, BotSource()), Overlays(layers), Picture()

    def step(self):
        """Make one step of the game."""
        self.session.step()
        self.overlays.note(self.scene)

    def run_to(self, moment):
        """Step the scene until `moment.after` steps after the moment has occurred.

        Raises ValueError, which names the moment, if it does not occur.
        """
        while not moment.when(self.scene):
            if self.scene.frame >= MOST:
                raise ValueError(
                    f"{self.scene.name}, seed {self.scene.seed}: moment {moment.caption!r} did not come within {MOST} "
                    f"frames"
                )
            self.step()
        for _ in range(moment.after):
            self.step()

    def take(self):
        """Return the current picture, an array (810, 1440, 3) uint8."""
        self.picture.draw_scene(self.scene, self.overlays)
        return pygame.surfarray.array3d(self.picture.presenter.frame.surface).transpose(1, 0, 2)


def film(name, seed, frames, layers=()):
    """Run a scene, played by its bot, and return {frame number: picture} for the wanted frames.

    seed: seed of the scene; frames: the wanted frame numbers; layers: names of the overlays that are on.
    """
    running, wanted, taken = Film(name, seed, layers), set(frames), {}
    for number in range(1, max(wanted) + 1):
        running.step()
        if number in wanted:
            taken[number] = running.take()
    return taken


def film_moments(name, seed, moments):
    """Run a scene, and return a list with a picture of each of the `moments` (see scenes/moments.py).

    The moments must occur in the given order. Raises ValueError, which names the first moment that does not occur.
    """
    running, taken = Film(name, seed), []
    for moment in moments:
        running.run_to(moment)
        taken.append(running.take())
    return taken


def reduced(pixels, part=(0, 0, *FRAME), zoom=1):
    """Return a part of a frame's picture, reduced to one pixel per `zoom` x `zoom` canvas pixels.

    part: (left, top, width, height) [canvas px]. The averages use integers, so they are equal on every machine.
    """
    left, top, width, height = (value * SCREENSHOT_SCALE for value in part)
    share = SCREENSHOT_SCALE * zoom
    return averaged(pixels[top : top + height, left : left + width], share)


def averaged(pixels, share):
    """Return a reduced picture (height, width, 3) uint8: each pixel is the mean of a square of pixels.

    share: number of pixels along a side of the square.
    """
    height, width = pixels.shape[:2]
    blocks = pixels.astype(np.int64).reshape(height // share, share, width // share, share, 3)
    return ((blocks.sum(axis=(1, 3)) + share * share // 2) // (share * share)).astype(np.uint8)


def picture_name(scene):
    """Return the file name of a scene's menu picture."""
    return f"{scene.replace('/', '_')}.png"


def menu_picture(scene):
    """Return the menu's picture of a scene, an array (90, 160, 3) uint8."""
    shot = SHOTS[scene]
    if isinstance(shot.frame, Moment):
        taken = film_moments(scene, SEED, [shot.frame])[0]
    else:
        taken = film(scene, SEED, [shot.frame], shot.layers)[shot.frame]
    return reduced(taken, shot.part, shot.zoom)


def write_pictures(folder):
    """Write the menu's pictures of all scenes into a folder."""
    for scene in SCENES:
        (folder / picture_name(scene)).write_bytes(png.encode(menu_picture(scene)))


def write_moments(game, folder):
    """Write pictures of a game's moments (events, see scenes/moments.py) into a folder as 00.png, 01.png, ...

    Also write their captions as a list into captions.json.
    """
    for number, picture in enumerate(film_moments(game, SEED, MOMENTS[game])):
        (folder / f"{number:02}.png").write_bytes(png.encode(reduced(picture)))
    captions = [moment.caption for moment in MOMENTS[game]]
    (folder / "captions.json").write_text(json.dumps(captions, indent=1) + "\n", encoding="utf-8")


def reel(name, seed, first, last, every, columns=8):
    """Return a contact sheet of a run, an array (h, w, 3) uint8: small pictures of frames, in rows of `columns`
    pictures.

    It shows every `every`-th frame from `first` to `last`. seed: seed of the scene.
    """
    taken = film(name, seed, range(max(1, first), last + 1, every))
    pictures = [reduced(taken[number], zoom=3) for number in sorted(taken)]
    while len(pictures) % columns:
        pictures.append(np.zeros_like(pictures[0]))
    rows = [np.concatenate(pictures[i : i + columns], axis=1) for i in range(0, len(pictures), columns)]
    return np.concatenate(rows)


def clip_pictures(clip):
    """Yield the pictures of a clip, every EVERY-th step, as arrays (405, 720, 3) uint8."""
    running = Film(clip.scene, SEED)
    running.run_to(clip.start)
    number = 0
    for steps, layers in clip.parts:
        running.overlays.on = set(layers)
        for _ in range(steps):
            running.step()
            if number % EVERY == 0:
                yield averaged(running.take(), SHRINK)
            number += 1


def write_moving_picture(file):
    """Write the moving picture of the README: CLIPS, one after the other, as an endless animated WebP."""
    from PIL import Image  # of the extras bench and test; nothing else here needs it

    first, *others = [Image.fromarray(each) for clip in CLIPS for each in clip_pictures(clip)]
    duration = round(1000 * EVERY / 60)  # [ms]
    first.save(file, "WEBP", save_all=True, append_images=others, duration=duration, loop=0, quality=QUALITY, method=6)


def read_arguments(arguments):
    """Return the parsed command line. Invalid arguments end the program with code 2 and the reason."""
    parser = argparse.ArgumentParser(prog=f"python -m {__package__}.filming", description="Film the games.")
    films = parser.add_subparsers(dest="what", required=True)
    films.add_parser("pictures", help="the menu's pictures").add_argument("folder", type=Path)
    moments = films.add_parser("moments", help="a game's moments")
    moments.add_argument("game", choices=MOMENTS)
    moments.add_argument("folder", type=Path)
    films.add_parser("moving", help="the README's moving picture").add_argument("file", type=Path)
    strip = films.add_parser("reel", help="small pictures of a run")
    strip.add_argument("scene", choices=SCENES)
    for number in ("seed", "first", "last", "every"):
        strip.add_argument(number, type=int)
    strip.add_argument("file", type=Path)
    options = parser.parse_args(arguments)
    if options.what == "reel" and not (0 <= options.first <= options.last and options.every >= 1):
        strip.error(
            f"the first frame must not be after the last, nor below 0, and every at least 1 "
            f"(got {options.first} {options.last} {options.every})"
        )
    if "folder" in options and not options.folder.is_dir():
        parser.error(f"{options.folder} is no folder")
    return options


def main(arguments=None):
    """Make the pictures that the command line names. Return the exit code."""
    options = read_arguments(arguments)
    if options.what == "pictures":
        write_pictures(options.folder)
    elif options.what == "moments":
        write_moments(options.game, options.folder)
    elif options.what == "moving":
        write_moving_picture(options.file)
    else:
        strip = reel(options.scene, options.seed, options.first, options.last, options.every)
        options.file.write_bytes(png.encode(strip))
    return 0


if __name__ == "__main__":
    sys.exit(main())
