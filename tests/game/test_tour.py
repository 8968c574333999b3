"""The tour stops at steps that show its subject, puts a ring around it, and places its card elsewhere."""

import pygame
import pytest

import physics
from game.drawing.colors import GOLD
from game.files.accessibility import Accessibility
from game.input.devices import DeviceSource
from game.run.picture import Picture
from game.screens.parts.subjects import SUBJECTS
from game.screens.tour import MARGIN, MISSES, PATIENCE, SECONDS, STILL, STOPS, Tour, docked
from physics import debug
from scenes import SCENES
from tests.game.arena import Arena
from tests.lockstep import make_scene

SIZES = [(960, 540), (1440, 810), (1100, 900), (480, 270)]
# That there is such a thing, asked otherwise than the tour does.
IS_THERE = {
    "bounds": lambda world: len(world.reported_rows()),
    "motion": lambda world: len(debug.motion(world)),
    "structure": lambda world: len(debug.structure(world).rects),
    "pairs": lambda world: len(world.candidates),
    "masks": lambda world: len(debug.mask_hits(world)),
    "islands": lambda world: (debug.islands(world) >= 0).sum() > 1,
    "contacts": lambda world: len(world.contacts) + len(world.sleeping_contacts),
    "outlines": lambda world: (world.bodies["kind"] != 0).any(),
    "impulses": lambda world: world.contacts["normal_impulse"].max() > 0.0,
    "ghosts": lambda world: len(debug.impact_ghosts(world)),
}


class Clock:
    """Clock that makes turns of the tour, each 1/60 s."""

    def __init__(self, tour):
        self.tour, self.now = tour, 0.0
        tour.advance(0.0)

    def turn(self):
        self.now += 1.0001 / 60
        self.tour.advance(self.now)


def make(scenes=None):
    if scenes is None:
        return Tour(lambda name: make_scene(name, seed=0), tuple(SCENES), DeviceSource(), Accessibility())
    return Tour(lambda name: scenes(), ("arena",), DeviceSource(), Accessibility())


def look(tour, size):
    return tour.draw(Picture(pygame.Surface(size)))


@pytest.mark.skipif(not physics.JIT, reason="800 steps of the shooter")
def test_every_stop_is_on_a_step_where_its_subject_is_there_ringed_and_not_under_the_card():
    """Every stop of the tour shows its subject with a ring, not covered by the card.

    One run visits all stops, because five scenes are played up to their stop, which takes time.
    """
    tour = make()
    clock = Clock(tour)
    for at, (_, layer, _, _) in enumerate(STOPS):
        while tour.waits:
            clock.turn()
        clock.turn()
        scene = tour.demo.scene
        assert tour.at == at and (tour.subject is not None) == (layer in SUBJECTS), layer
        assert layer not in SUBJECTS or any(IS_THERE[layer](world) for world, _ in scene.views()), layer
        for size in SIZES:
            frame = look(tour, size)
            if layer == "panel" and size == SIZES[-1]:
                assert tour.ring is None, "there the panel is all there is"
                continue
            if layer == MISSES:
                assert tour.ring is None and frame.rect.contains(tour.card), "the split screen is all there is"
                continue
            assert tour.ring is not None and frame.rect.contains(tour.ring), (layer, size)
            assert frame.rect.contains(tour.card) and not tour.card.colliderect(tour.ring), (layer, size)
            edge = frame.surface.get_at((tour.ring.centerx, tour.ring.top + 1))[:3]
            assert edge == GOLD or layer == "panel", (layer, size)
            if tour.subject is not None:
                subject = frame.from_canvas(tour.subject)
                assert tour.ring.inflate(-MARGIN, -MARGIN).contains(subject), (layer, size)
        tour.feed(pygame.event.Event(pygame.KEYDOWN, key=pygame.K_RIGHT))
    assert tour.outcome == ("back",)


def test_it_stands_still_on_its_subject_and_then_goes_on():
    tour = make(Arena)
    tour.at = next(at for at, stop in enumerate(STOPS) if stop[1] == "outlines")
    clock, at, frames = Clock(tour), tour.at, []
    while tour.at == at:
        clock.turn()
        frames.append((tour.subject is not None, tour.demo.scene.frame))
    still = [frame for there, frame in frames if there]
    assert len(still) == pytest.approx(STILL * 60, abs=3) and len(set(still)) == 1
    assert frames[-1][1] - still[0] == pytest.approx((SECONDS - STILL) * 60, abs=4)


def test_what_never_comes_is_not_waited_for():
    tour = make(Arena)
    tour.at = next(at for at, stop in enumerate(STOPS) if stop[1] == "ghosts")
    clock, turns = Clock(tour), 0
    while tour.waits:
        clock.turn()
        turns += 1
    assert tour.waited == PATIENCE and tour.subject is None
    look(tour, SIZES[0])
    assert tour.ring is None and tour.shown <= 1
    for _ in range(SECONDS * 60 - 5):
        clock.turn()
    assert STOPS[tour.at][1] == "ghosts"


@pytest.mark.parametrize("size", SIZES)
def test_wherever_a_ring_is_there_is_a_place_for_the_card(size):
    frame = Picture(pygame.Surface(size)).draw_screen(Blank())
    for x in range(0, 480 - 232, 31):
        for y in range(0, 270 - 96, 13):
            ring = frame.from_canvas((x, y, 232, 96))
            card = docked(frame, frame.rect, ring)
            assert frame.rect.contains(card) and not card.colliderect(ring), (x, y)


class Blank:
    """Scene with an empty canvas."""

    def draw(self, canvas, alpha):
        """Draw nothing."""
