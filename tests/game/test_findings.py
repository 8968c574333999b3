"""Every lab ends with a finding: first what is still to be measured, then the result of this run, readable at every
size.
"""

import re
from itertools import count

import pygame
import pytest

import physics
from game.input.devices import DeviceSource
from game.measure.measured_runs import RunFigures
from game.measure.tiers import measure_at, poses_around
from game.measure.timing import RUNS, Cost
from game.measurement_requests import RunRequest, SpriteRequest
from game.run.picture import Picture
from game.run.session import Session
from game.run.sources import BotSource
from game.screens.parts.lab_card import LabCard
from game.screens.play import Play
from scenes import SCENES
from tests.game.test_lab_card import SIZES, Silent, words
from tests.lockstep import make_scene

LABS = [name for name in SCENES if name.startswith("lab/")]
NOT_YET = "not yet: "
# The bot's frames after which it has found something, and after which that is something else.
PLAYED = {
    "lab/disagreement": (215, 290), "lab/effects": (125, 305), "lab/stacks": (130, 150), "lab/card_house": (70, 100),
    "lab/dominoes": (300, 300), "lab/tumbler": (185, 250), "lab/sleeping": (245, 330), "lab/cradle": (130, 430),
    "lab/conveyor": (300, 530), "lab/one_way": (230, 290), "lab/gallery": (3, 9), "lab/billiards": (60, 300),
    "lab/carving": (60, 200), "lab/joints": (90, 480), "lab/filters": (60, 110),
    "lab/mask_stack": (110, 140),
}  # fmt: skip
USUAL = (60, 90)
COUNTED_AT_ONCE = {"lab/ladder"}  # when the sprite is taken
# What these measure comes out alike after any time: of these it is shown that other figures make another finding.
OF_FIGURES = {"lab/masks", "lab/pyramid", "lab/broadphases"}
OTHERWISE = {"lab/dominoes": "spacing", "lab/mask_stack": "high"}  # and of these, that another slider does
LOOKED_AT_TWO = {"lab/effects"}  # of seventeen effects: test_lab_effects goes through all of them
needs_speed = pytest.mark.skipif(
    not physics.JIT, reason="hundreds of frames; nothing here depends on who runs the kernels"
)
costs = count(1)


def tiers_of(request):
    """Return the measured figures of a pair of sprites, {tier: figures}. request: SpriteRequest of a scene.

    To save time, only 200 poses and four tiers are measured. Other tests measure all of them.
    """
    found = {}
    poses = poses_around(*request, count=200)
    measure_at(
        *request, poses, lambda figures: found.update({figures.tier: figures}), ("aabb", "hull", "outline", "mask")
    )
    return found


def figures_of(scene):
    """Return figures for the measurement request of a scene.

    The figures of a pair of sprites are measured; those of runs are made up.
    """
    request = scene.measured()
    if isinstance(request, SpriteRequest):
        return tiers_of(request)
    if isinstance(request, RunRequest):
        seconds = [1e-6 * (10 * next(costs) + number) for number in range(len(request.names))]
        cost = {name: Cost.of([each] * RUNS, 60) for name, each in zip(request.names, seconds, strict=True)}
        return {
            name: RunFigures(each, 0.01 * number, 0.01 * number) for number, (name, each) in enumerate(cost.items())
        }
    return scene.figures


def know(play):
    """Give the scene of a Play its figures, as the measuring process would."""
    if play.scene.measured() is not None:
        play.scene.figures = play.measuring.bench.figures = figures_of(play.scene)
        request = play.scene.measured()
        play.measuring.benched = request.names if isinstance(request, RunRequest) else request


def has_found(finding):
    return bool(re.search(r"\d", finding)) and not finding.startswith(NOT_YET)


def read_whole(play, finding):
    """Assert at every size of the window that the open card shows the complete finding."""
    for size in SIZES:
        play.hint = LabCard(play.scene)
        play.hint.page = 1  # the first page has no room for a long finding
        frame = play.draw(Picture(pygame.Surface(size)))
        assert all(word in words(frame) for word in f"Found: {finding}".split()), size
        assert frame.surface.get_rect().contains(play.hint.rect), size


@needs_speed
@pytest.mark.parametrize("name", LABS)
def test_a_lab_ends_in_what_it_has_measured_in_this_run(name):
    play = Play(make_scene(name, few=True), DeviceSource(), Silent())
    scene, session = play.scene, Session(play.scene, BotSource())
    first = scene.finding()
    assert name in COUNTED_AT_ONCE or first.startswith(NOT_YET), "nothing is told before it was measured"
    found, other = PLAYED.get(name, USUAL)
    for _ in range(found):
        session.step()
    know(play)
    finding = scene.finding()
    assert has_found(finding) or name in LOOKED_AT_TWO, finding
    read_whole(play, finding)
    for _ in range(other - found):
        session.step()
    if name in OF_FIGURES:
        known = scene.figures
        scene.figures = {tier: known[as_] for tier, as_ in zip(known, reversed(known), strict=True)}
    elif name in OTHERWISE:
        slider = next(each for each in scene.sliders if each.name == OTHERWISE[name])
        scene.restart()
        scene.change_slider(slider.name, slider.high)
        for _ in range(other):
            session.step()
    later = scene.finding()
    assert later != finding, "it goes on with what is measured"
    scene.figures = {}
    scene.restart()
    assert name in COUNTED_AT_ONCE or scene.finding().startswith(NOT_YET), "another run has found nothing"
