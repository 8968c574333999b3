"""Pictures of the game itself: its scenes are run by their bots without a window, and frames are kept.

    python -m assets.filming shooter 1 0 3600 60 reel.png    frames 0, 60, ... of a run, small, to choose moments from

Two things are made of them: the small picture that the menu shows of every scene (a product of assets/build.py), and
the moments of docs/moments.png (assets/contact_sheet.py). A scene is deterministic, so a frame's number names it.
This is the only file of assets/ that imports the game.
"""

import sys
from dataclasses import dataclass

import numpy as np
import pygame

from assets import png
from assets.moments import FRAME, SEED, Moment, done, leader
from game.drawing.presenter import SCREENSHOT_SCALE
from game.overlays.stack import Overlays
from game.registry import Registry
from game.run.headless import start_dummy_display
from game.run.picture import Picture
from game.run.session import Session
from game.run.sources import BotSource
from scenes import SCENES

SIZE = (160, 90)  # [px] of a menu picture
MOST = 20000  # frames within which every moment of a game comes


@dataclass(frozen=True)
class Shot:
    """A picture to be taken: the frame or moment of a run, and the part of the canvas seen, 160 x 90 px times `zoom`."""

    frame: int | Moment
    left: int = 0
    top: int = 0
    zoom: int = 2
    layers: tuple = ()  # overlays that are on

    @property
    def part(self):
        """left, top, width, height of what is seen, in canvas px."""
        return self.left, self.top, SIZE[0] * self.zoom, SIZE[1] * self.zoom


# Parts are chosen so that no measured time (of some microseconds, on the machine that films) is ever in the picture.
SHOTS = {
    "shooter": Shot(Moment("the boss", leader("boss_a_0", 85)), 130, 20),
    "platformer": Shot(Moment("keep", done("lift with an enemy", 40)), 130, 80),
    "lab/broadphases": Shot(60, 3, 158, 1, layers=("structure",)),
    "lab/masks": Shot(480, 0, 72),
    "lab/shapes": Shot(120, 24, 50, 1),
    "lab/filters": Shot(240, 66, 24),
    "lab/sensors": Shot(240, 96, 56, 1),
    "lab/stacks": Shot(240, zoom=3),
    "lab/pyramid": Shot(480, 160, 78),
    "lab/card_house": Shot(240, 60, 32, 1),
    "lab/dominoes": Shot(120, 130, 51, 1),
    "lab/tumbler": Shot(240, 142, 70),
    "lab/cradle": Shot(80, 227, 14, 1),
    "lab/billiards": Shot(150, 62, 20),
    "lab/tunnelling": Shot(240, 196, 142, 1),
    "lab/conveyor": Shot(240, 180, 16, 1),
    "lab/one_way": Shot(240, 60, 76),
    "lab/ghost_bumps": Shot(240, 0, 20),
}


class Film:
    """A scene that its bot plays, and pictures of it: the presented frame, (810, 1440, 3) uint8."""

    def __init__(self, name, seed, layers=()):
        start_dummy_display()
        self.scene = Registry(SCENES).scene_class(name)(seed)
        self.session, self.overlays, self.picture = Session(self.scene, BotSource()), Overlays(layers), Picture()

    def step(self):
        """One step of the game."""
        self.session.step()
        self.overlays.times.note(self.scene)

    def take(self):
        """The picture now."""
        self.picture.draw_scene(self.scene, self.overlays)
        return pygame.surfarray.array3d(self.picture.presenter.frame.surface).transpose(1, 0, 2)


def film(name, seed, frames, layers=()):
    """Run a scene; return {frame number: picture} for those asked for."""
    running, wanted, taken = Film(name, seed, layers), set(frames), {}
    for number in range(1, max(wanted) + 1):
        running.step()
        if number in wanted:
            taken[number] = running.take()
    return taken


def film_moments(name, seed, moments):
    """Run a scene; return a picture of each moment, looked for in their order.

    Raises ValueError naming the first one that does not come.
    """
    running, taken = Film(name, seed), []
    for moment in moments:
        while not moment.when(running.scene):
            if running.scene.frame >= MOST:
                raise ValueError(f"{name}, seed {seed}: moment {moment.caption!r} did not come within {MOST} frames")
            running.step()
        for _ in range(moment.after):
            running.step()
        taken.append(running.take())
    return taken


def reduced(pixels, part=(0, 0, *FRAME), zoom=1):
    """The part (left, top, width, height in canvas px) of a presented picture, `zoom` canvas pixels to one.

    Averages are of whole numbers, so that they are the same on every machine.
    """
    left, top, width, height = (value * SCREENSHOT_SCALE for value in part)
    share = SCREENSHOT_SCALE * zoom
    seen = pixels[top : top + height, left : left + width].astype(np.int64)
    blocks = seen.reshape(height // share, share, width // share, share, 3)
    return ((blocks.sum(axis=(1, 3)) + share * share // 2) // (share * share)).astype(np.uint8)


def picture_name(scene):
    """The file of a scene's menu picture, relative to assets/."""
    return f"images/pictures/{scene.replace('/', '_')}.png"


def picture_files():
    """Return {relative path: bytes} of the menu's pictures, one per scene, 160 x 90."""
    files = {}
    for scene in SCENES:
        shot = SHOTS[scene]
        if isinstance(shot.frame, Moment):
            taken = film_moments(scene, SEED, [shot.frame])[0]
        else:
            taken = film(scene, SEED, [shot.frame], shot.layers)[shot.frame]
        files[picture_name(scene)] = png.encode(reduced(taken, shot.part, shot.zoom))
    return files


def reel(name, seed, first, last, every, columns=8):
    """Small pictures of a run side by side, row by row, to choose from."""
    taken = film(name, seed, range(max(1, first), last + 1, every))
    pictures = [reduced(taken[number], zoom=3) for number in sorted(taken)]
    while len(pictures) % columns:
        pictures.append(np.zeros_like(pictures[0]))
    rows = [np.concatenate(pictures[i : i + columns], axis=1) for i in range(0, len(pictures), columns)]
    return np.concatenate(rows)


def main(arguments=None):
    """Write a reel. Returns the exit code."""
    words = sys.argv[1:] if arguments is None else arguments
    if len(words) != 6 or words[0] not in SCENES or not all(word.isdigit() for word in words[1:5]):
        sys.stderr.write(f"python -m assets.filming SCENE SEED FIRST LAST EVERY FILE; scenes: {', '.join(SCENES)}\n")
        return 2
    name, target = words[0], words[5]
    seed, first, last, every = (int(word) for word in words[1:5])
    if first > last or every < 1:
        sys.stderr.write(f"FIRST must not be after LAST, and EVERY at least 1 (got {first} {last} {every})\n")
        return 2
    picture = png.encode(reel(name, seed, first, last, every))
    with open(target, "wb") as file:
        file.write(picture)
    sys.stdout.write(f"{target}\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
