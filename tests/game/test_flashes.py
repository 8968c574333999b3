"""Flashes of the whole picture: at most three a second in any game, and none if the player has switched them off.

A flash is defined as in WCAG 2.1: a pair of opposing changes of a tenth or more of the full relative luminance. The
darker state is below 0.8, and the change covers a quarter of the picture or more.
"""

import numpy as np
import pygame
import pytest

from game.drawing.canvas import Canvas
from game.drawing.flash import MOST, SPAN, Flash
from game.files.accessibility import Accessibility
from game.input.inputs import InputState
from game.overlays.stack import Overlays
from game.registry import Registry
from game.run.picture import Picture
from game.run.sources import BotSource
from game.screens.parts.wipe import Wipe
from scenes import SCENES
from tests.game.reading import luminance

BLOCK = 15  # [canvas px] the picture is looked at in squares of this size
STEP = 0.1  # of full luminance, and
DARK = 0.8  # its darker side: what counts as a change
AREA = 0.25  # of the picture


def squares(surface):
    """Return the luminance of each square block of a canvas.

    It is computed from the mean colour of a block, which is ten times as fast as from all its pixels.
    """
    width, height = surface.get_size()
    return luminance(pygame.surfarray.array3d(pygame.transform.smoothscale(surface, (width // BLOCK, height // BLOCK))))


class FlashMeter:
    """Counter of the general flashes in a sequence of pictures. Each square stores its last
    turning point of luminance.
    """

    def __init__(self):
        self.low = self.high = self.way = None
        self.turns = []  # picture numbers at which a quarter of the picture turned at once
        self.now = 0

    def see(self, light):
        """Process the luminances of the next picture's squares."""
        if self.way is None:
            self.low, self.high, self.way = light.copy(), light.copy(), np.zeros(light.shape, int)
        self.low, self.high = np.minimum(self.low, light), np.maximum(self.high, light)
        up = (light - self.low >= STEP) & (self.low < DARK) & (self.way <= 0)
        down = (self.high - light >= STEP) & (light < DARK) & (self.way >= 0)
        for turned, way in ((up, 1), (down, -1)):
            self.low[turned], self.high[turned], self.way[turned] = light[turned], light[turned], way
            if turned.mean() >= AREA:
                self.turns.append((self.now, way))
        self.now += 1

    def most_in_a_second(self):
        """Return the greatest number of flashes (pairs of opposing changes) within 60 successive pictures."""
        changes = [number for i, (number, way) in enumerate(self.turns) if i == 0 or way != self.turns[i - 1][1]]
        return max((sum(1 for each in changes if first <= each < first + 60) // 2 for first in changes), default=0)


def meter_of(pictures):
    meter = FlashMeter()
    for picture in pictures:
        meter.see(picture)
    return meter


def test_the_meter_counts():
    dark, bright = np.full((32, 18), 0.2), np.full((32, 18), 0.6)
    blinking = [bright if n // 6 % 2 else dark for n in range(120)]
    assert meter_of(blinking).most_in_a_second() == 5
    assert meter_of([dark] * 60 + [bright] * 60).most_in_a_second() == 0
    corner = [dark.copy() for _ in range(60)]
    for n in range(0, 60, 4):
        corner[n][:8, :8] = 0.9
    assert meter_of(corner).most_in_a_second() == 0, "a small part of the picture is no general flash"
    slow = [np.full((32, 18), 0.3 + 0.25 * np.sin(n / 8)) for n in range(240)]
    assert 1 <= meter_of(slow).most_in_a_second() <= 2, "a change need not be sudden"


def test_flashes_are_limited_whoever_asks():
    flash, begun = Flash(), []
    canvas = Canvas()
    meter = FlashMeter()
    for step in range(600):
        if flash.start(1.0):
            begun.append(step)
        flash.step()
        canvas.begin((60, 60, 70))
        flash.draw(canvas.surface)
        meter.see(squares(canvas.surface))
    assert all(sum(1 for each in begun if first <= each < first + SPAN) <= MOST for first in begun)
    assert meter.most_in_a_second() <= 3


def lights_of(name, steps, accessibility, seed=1):
    """Return the FlashMeter after all pictures of a bot's run."""
    scene = Registry(SCENES).scene_class(name)(seed=seed)
    scene.set_accessibility(accessibility)
    source, inputs, picture, overlays = BotSource(), InputState(), Picture(pygame.Surface((480, 270))), Overlays(())
    meter = FlashMeter()
    for _ in range(steps):
        inputs.set(source.next(scene))
        scene.step(inputs)
        picture.draw_scene(scene, overlays)
        meter.see(squares(picture.canvas.surface))
    return meter


@pytest.mark.parametrize("flashing", [True, False])
@pytest.mark.parametrize("name", ["shooter", "platformer", "lander"])
def test_games_stay_within_three_flashes_a_second(name, flashing):
    meter = lights_of(name, 600, Accessibility(flashing=flashing))
    assert meter.most_in_a_second() <= (3 if flashing else 0), meter.turns


@pytest.mark.nightly
@pytest.mark.parametrize(
    "name, steps, flashing",
    [
        ("shooter", 15000, True),
        ("platformer", 2400, True),
        ("lander", 5600, True),
        ("shooter", 4000, False),
        ("platformer", 2400, False),
        ("lander", 5600, False),
    ],
)
def test_whole_games_stay_within_three_flashes_a_second(name, steps, flashing):
    meter = lights_of(name, steps, Accessibility(flashing=flashing))
    assert meter.most_in_a_second() <= (3 if flashing else 0), meter.turns


@pytest.mark.nightly
@pytest.mark.parametrize("name", [name for name in SCENES if "/" in name])
def test_labs_stay_within_three_flashes_a_second(name):
    assert lights_of(name, 600, Accessibility()).most_in_a_second() <= 3


def test_reduced_flashing_leaves_out_the_flash(monkeypatch):
    scene = Registry(SCENES).scene_class("lab/masks")(seed=1)
    for flashing, lit in ((True, True), (False, False)):
        scene.set_accessibility(Accessibility(flashing=flashing))
        picture = Picture(pygame.Surface((480, 270)))
        scene.flash.light = 0.0
        picture.draw_scene(scene, Overlays(()))
        before = squares(picture.canvas.surface).mean()
        scene.flash.light, scene.flash.color = 1.0, (255, 255, 255)
        picture.draw_scene(scene, Overlays(()))
        assert (squares(picture.canvas.surface).mean() > before + 0.01) == lit


@pytest.mark.parametrize("fades", [False, True])
def test_going_from_screen_to_screen_is_no_flash(fades):
    bright, dark = pygame.Surface((480, 270)), pygame.Surface((480, 270))
    bright.fill((240, 240, 240))
    wipe, meter = Wipe(), FlashMeter()
    for number in range(120):
        shown = (bright if number // 60 else dark).copy()
        if number == 60:
            wipe.begin(dark, 60 / 60)
        wipe.draw(shown, number / 60, fades)
        meter.see(squares(shown))
    assert meter.most_in_a_second() == 0 and wipe.old is None
    assert len({way for _, way in meter.turns}) <= 1, "it only grows brighter"
