"""Overlays change nothing in a scene, stay in their view, and report what they leave out."""

import numpy as np
import pygame
import pytest

from game.audio.sound import Sounds
from game.input.devices import DeviceSource
from game.input.inputs import InputFrame, InputState
from game.overlays.layer_pairs import Pairs
from game.overlays.stack import Overlays, layer_names
from game.run.digest import scene_digest
from game.run.picture import Picture
from game.scene import Scene
from game.screens.parts.panel import Panel
from game.screens.play import Play
from physics import Circle, Effects, Filter, PixelMask, Polygon
from tests.game.arena import Arena
from tests.game.plain_scene import Plain

STAR = np.array([[abs(x) + abs(y) < 9 or x == y for x in range(-12, 13)] for y in range(-12, 13)])


class Crowd(Plain, Scene):
    """Scene with one of each kind of shape, some of them overlapping."""

    name = title = "crowd"
    effects = Effects.detection()

    def build(self):
        self.add_world()
        for i in range(40):
            self.world.add_body(
                Circle(9.0), position=(30 + i * 11, 60 + i % 3 * 7), velocity=(30.0, 5.0), filter=Filter(1 << i % 7)
            )
        for i in range(6):
            self.world.add_body(PixelMask.from_array(STAR), position=(60 + i * 11, 160), angle=0.3 * i)
        self.world.add_body(Polygon.box(300, 20), position=(240, 220), kind="static")


def stepped(scene, steps=3):
    for _ in range(steps):
        state = InputState()
        state.set(InputFrame())
        scene.step(state)
    return scene


@pytest.fixture(params=["brute", "sweep", "hash", "tree"])
def crowd(request):
    return stepped(Crowd(broadphase=request.param))


def test_layers_have_their_keys_and_names():
    layers = Overlays().layers
    assert tuple(layer.name for layer in layers) == layer_names() and layer_names()[:2] == ("bounds", "motion")
    keys = [layer.key for layer in layers]
    assert keys[:9] == [str(i) for i in range(1, 10)] and len(set(keys)) == len(keys)
    assert not set(keys) & set("0bnoprtv"), "these keys do something else"


# Those that show what a solver does are tested on a pile, in test_overlay_layers.py.
@pytest.mark.parametrize(
    "layer",
    ["bounds", "motion", "structure", "pairs", "masks", "contacts", "filters", "features", "centers", "outlines"],
)
def test_each_layer_draws_and_only_reads(crowd, layer):
    before = scene_digest(crowd)
    plain = Picture().draw_scene(crowd, Overlays()).surface.copy()
    overlays = Overlays([layer])
    shown = Picture().draw_scene(crowd, overlays).surface
    assert scene_digest(crowd) == before
    differs = (pygame.surfarray.array2d(plain) != pygame.surfarray.array2d(shown)).any()
    assert differs and overlays.legend()


def test_nothing_on_screen_draws_nothing(crowd):
    crowd.camera.place(1e5, 1e5)
    overlays = Overlays(layer_names())
    Picture().draw_scene(crowd, overlays)
    assert all(getattr(layer, "drawn", 0) == 0 for layer in overlays.layers if layer.name != "structure")


def test_an_empty_world(crowd):
    crowd.world.clear()
    stepped(crowd, 1)
    Picture().draw_scene(crowd, Overlays(layer_names()))


def test_a_budget_is_never_silent(crowd, monkeypatch):
    monkeypatch.setattr("game.overlays.layer_pairs.PAIR_BUDGET", 2)
    overlays = Overlays(["pairs"])
    Picture().draw_scene(crowd, overlays)
    ((_, note),) = overlays.legend()
    assert note.startswith("pairs 2 of ") and not note.startswith("pairs 2 of 2,")


def test_lit_pixels_are_those_the_masks_share(crowd):
    overlays = Overlays(["masks"])
    Picture().draw_scene(crowd, overlays)
    layer = next(each for each in overlays.layers if each.name == "masks")
    from physics import debug

    assert layer.lit == sum(int(shared.sum()) for _, _, shared in debug.mask_hits(crowd.world)) > 0


def play_screen():
    return Play(Arena(), DeviceSource(), Sounds(silent=True))


def press(play, key):
    return play.feed(pygame.event.Event(pygame.KEYDOWN, key=key))


def test_keys_switch_layers_and_strategies():
    play = play_screen()
    assert press(play, pygame.K_1) and press(play, pygame.K_8)
    assert play.overlays.on == {"bounds", "times"}
    press(play, pygame.K_0)
    assert play.overlays.on == set()
    press(play, pygame.K_b)
    press(play, pygame.K_n)
    play.step()
    assert play.scene.broadphase == "tree" and play.scene.narrowphase is False
    assert not press(play, pygame.K_LEFT), "the game's own keys go through"


def test_pause_single_step_and_slow_motion():
    play = play_screen()
    play.advance(0.0)
    press(play, pygame.K_p)
    play.advance(1.0)
    assert play.session.report.steps == 0
    press(play, pygame.K_o)
    play.advance(1.1)
    assert play.session.report.steps == 1
    press(play, pygame.K_b)
    play.advance(1.2)
    assert play.scene.broadphase == "tree" and play.session.report.steps == 2, "a change while paused costs a step"
    press(play, pygame.K_p)
    press(play, pygame.K_MINUS)
    assert play.clock.speed == 0.5 and not play.clock.paused


def test_escape_opens_the_pause_menu():
    play = play_screen()
    press(play, pygame.K_ESCAPE)
    assert play.outcome == ("pause", "")


def row_number(panel, label):
    return next(i for i, row in enumerate(panel.rows()) if row.label == label)


def test_panel_by_keyboard():
    play = play_screen()
    press(play, pygame.K_TAB)
    play.panel.mark = row_number(play.panel, "Bounding boxes")
    assert press(play, pygame.K_RETURN) and "bounds" in play.overlays.on
    play.panel.mark = row_number(play.panel, "speed")
    press(play, pygame.K_RIGHT)
    play.step()
    assert play.scene.values["speed"] == 70


def test_panel_by_mouse():
    play = play_screen()
    play.panel_open = True
    picture = Picture()
    play.draw(picture)
    places = dict((number, rect) for rect, number in play.panel.places)
    pairs = places[row_number(play.panel, Pairs.title)]
    play.feed(pygame.event.Event(pygame.MOUSEBUTTONDOWN, button=1, pos=pairs.center))
    assert "pairs" in play.overlays.on
    slider = places[row_number(play.panel, "speed")]
    play.feed(pygame.event.Event(pygame.MOUSEBUTTONDOWN, button=1, pos=slider.midleft))
    place = (slider.right + 50, slider.centery)
    play.feed(pygame.event.Event(pygame.MOUSEMOTION, pos=place, rel=(1, 0), buttons=(1, 0, 0)))
    play.feed(pygame.event.Event(pygame.MOUSEBUTTONUP, button=1, pos=slider.midright))
    play.step()
    assert play.scene.values["speed"] == 200
    assert play.panel.focused
    play.feed(pygame.event.Event(pygame.MOUSEBUTTONDOWN, button=1, pos=(5, 5)))
    assert not play.panel.focused, "a click on the game gives it the keys"


def test_panel_scrolls_when_rows_do_not_fit():
    play = play_screen()
    panel = Panel(lambda: [row for _ in range(4) for row in play_screen().panel.rows()])
    frame = Picture().draw_scene(play.scene, play.overlays, panel=panel)
    shown = {number for _, number in panel.places}
    assert len(shown) < len(panel.rows()) and any("more below" in text for _, text in frame.boxes)
    panel.mark = len(panel.rows()) - 2
    Picture().draw_scene(play.scene, play.overlays, panel=panel)
    assert panel.mark in {number for _, number in panel.places}


def test_an_incomplete_scene_is_refused_where_it_is_defined():
    with pytest.raises(TypeError, match="Half must define draw, check, bot, state"):

        class Half(Scene):
            def build(self):
                self.add_world()

            def update(self, inputs):
                self.world.step()
