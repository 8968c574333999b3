"""lab/gallery: on each page the naive side exceeds the limit and the Hitbox side keeps it, or both are equal."""

import numpy as np
import pygame
import pytest

import physics
from game.audio.sound import Sounds
from game.drawing.canvas import CANVAS_SIZE, SMALL, TEXT, Canvas
from game.drawing.colors import GREEN, PAPER, RED
from game.drawing.font import load_font
from game.input.devices import DeviceSource
from game.input.inputs import InputFrame, InputState
from game.measure.measured_runs import RunFigures
from game.measure.moment import Moment
from game.measure.timing import RUNS, Cost
from game.measurement_requests import Recipe
from game.overlays.stack import Overlays, layer_names
from game.run.picture import Picture
from game.run.session import Session
from game.run.sources import BotSource
from game.screens.play import Play
from physics import World
from scenes.lab.gallery.page import Side
from scenes.lab.gallery.pages import PAGES
from scenes.lab.gallery.scene import NAMES, PLOT, TOURED, VIEWS, Gallery, amount, is_met
from tests.game.reading import assert_text_is_apart

HEAVY = {"column", "struck", "point", "crowd", "far", "asleep", "cards", "squares", "wall", "rods", "bullets", "beam"}
HEAVY |= {"gate", "bowl", "wheel", "seams", "chain", "cantilever", "stairs", "bridge"}
needs_speed = pytest.mark.skipif(not physics.JIT, reason="hundreds of steps of many bodies")
BY_WEIGHT = [pytest.param(page, id=page.name, marks=needs_speed if page.name in HEAVY else ()) for page in PAGES]


def opened(name, seed=0):
    scene = Gallery(seed)
    scene.change("slider:page", NAMES.index(name))
    return scene


def step(scene, *actions):
    inputs = InputState()
    inputs.set(InputFrame(frozenset(actions)))
    scene.step(inputs)
    scene.observe()


@pytest.mark.parametrize("page", BY_WEIGHT)
def test_the_naive_way_leaves_the_limit_and_ours_keeps_it(page):
    scene = opened(page.name)
    while page.name not in scene.verdicts:
        step(scene)
    naive, ours = scene.verdicts[page.name]
    assert scene.sides[0].steps == page.steps
    if page.alike:
        assert naive <= page.limit and ours <= page.limit
    else:
        assert naive > 1.5 * page.limit, f"{naive} {page.unit}: nothing is wrong with the naive way"
        assert ours <= page.limit, f"{ours} {page.unit}"
    assert next(goal for goal in scene.check() if goal.name == page.title).met


def test_a_page_is_met_from_both_sides_only():
    page, alike = (next(page for page in PAGES if page.alike is wanted) for wanted in (False, True))
    over, under = 2.0 * page.limit, 0.5 * page.limit
    assert is_met(page, over, under)
    assert not is_met(page, under, under) and not is_met(page, over, over)
    over, under = 2.0 * alike.limit, 0.5 * alike.limit
    assert is_met(alike, under, under) and not is_met(alike, over, under) and not is_met(alike, under, over)
    assert not is_met(page, float("nan"), float("nan")) and not is_met(alike, float("nan"), under)


def run(page, effects, steps):
    """Yield the digests of a page's Hitbox side after each step, with these effects."""
    settings = dict(page.ours.world)
    solver = settings.pop("solver", "soft_step" if effects.stacking else "projection")
    side = Side(page, page.ours, World(effects, solver=solver, **settings))
    side.begin(side)
    for _ in range(steps):
        side.step()
        yield side.world.digest()


NEEDS = {"response": ("friction", "restitution", "stacking", "sleeping"), "stacking": ("sleeping",)}
EFFECTS = [(page, effect) for page in PAGES for effect in page.effects.names()]


@needs_speed
@pytest.mark.parametrize("page, effect", EFFECTS, ids=[f"{page.name}-{effect}" for page, effect in EFFECTS])
def test_a_page_declares_only_the_effects_that_it_calls_for(page, effect):
    steps = min(page.steps, 150)
    try:
        gone = page.effects.with_(**dict.fromkeys((effect, *NEEDS.get(effect, ())), False))
        for with_it, without in zip(run(page, page.effects, steps), run(page, gone, steps), strict=True):
            if with_it != without:
                return
    except ValueError as error:
        assert any(each in str(error) for each in (effect, *NEEDS.get(effect, ())))
        return
    pytest.fail(f"{page.name} declares {effect} and does not call for it")


@pytest.mark.parametrize("page", PAGES, ids=NAMES)
def test_both_sides_begin_alike(page):
    scene = opened(page.name)
    left, right = (world.bodies[world.bodies["kind"] != 0] for world in scene.worlds)
    assert len(left) == len(right) and page.naive != page.ours
    if page.name == "far":
        return
    for column in ("x", "y", "angle", "vx", "vy", "angular_velocity"):
        assert np.array_equal(left[column], right[column]), column


@pytest.mark.parametrize("page", PAGES, ids=NAMES)
def test_its_two_lines_fit_the_picture(page):
    for text, font in ((page.seen, TEXT), (page.why, SMALL)):
        assert load_font(font).measure(text, 1)[0] <= CANVAS_SIZE[0] - 10, text
        assert text.endswith(".")
    for way in (page.naive, page.ours):
        assert load_font(TEXT).measure(way.name, 1)[0] <= 230
    assert load_font(SMALL).measure(page.unit, 1)[0] <= 110


@pytest.mark.usefixtures("nothing_is_measured")
@pytest.mark.parametrize("page", [page for page in PAGES if page.also is not None], ids=lambda page: page.name)
def test_text_of_a_page_with_two_figures_is_apart(page):
    scene = opened(page.name)
    scene.bot = InputFrame
    play = Play(scene, DeviceSource(), Sounds(silent=True), bot=True)
    for steps in (0, 25, 70):
        while scene.frame < steps:
            play.step()
        for width in (480, 960, 1440):
            for layers in ((), layer_names()):
                play.overlays = Overlays(layers)
                play.overlays.note(scene)
                frame = play.draw(Picture(pygame.Surface((width, width * 9 // 16))))
                assert_text_is_apart(frame.boxes, frame.rect)
        for side, (left, _, _, _) in zip(scene.sides, VIEWS, strict=True):
            reach = left + 2 + load_font(SMALL).measure(page.also(side), 1)[0]
            assert reach < left + PLOT[0], page.also(side)


def test_a_figure_is_green_only_when_the_page_is_judged():
    scene = opened("wheel")
    page = scene.page
    for steps, color in ((0, PAPER), (2, PAPER), (page.steps, GREEN)):
        for side in scene.sides:
            side.steps = steps
        assert color_of(scene, "0") == {color}
    for side in scene.sides:
        side.steps, side.worst = 2, 2.0 * page.limit
    assert color_of(scene, amount(2.0 * page.limit)) == {RED}, "beyond its limit it is wrong at once"


def color_of(scene, figure):
    """Return the set of colours in which a text is drawn in the scene's picture."""
    canvas, found = Canvas(), set()
    canvas.begin((0, 0, 0))
    drawn = canvas.text

    def noting(text, x, y, color, *others, **options):
        found.update([color] if text == figure else [])
        return drawn(text, x, y, color, *others, **options)

    canvas.text = noting
    scene.draw(canvas, 1.0)
    return found


def test_keys_turn_the_pages_and_begin_them_again():
    scene = Gallery(0)
    step(scene, "left")
    assert scene.page is PAGES[-1]
    step(scene, "right")
    step(scene, "right")
    assert scene.page is PAGES[1] and scene.sides[0].steps == 1
    for _ in range(3):
        step(scene)
    assert scene.sides[0].steps == 4
    step(scene, "fire")
    assert scene.page is PAGES[1] and scene.sides[0].steps == 1
    scene.restart()
    assert scene.page is PAGES[1] and scene.sides[0].steps == 0


def test_the_thousand_is_stepped_beside_the_game_and_reported_on_its_page():
    scene = opened("point")
    request = scene.measured()
    for name, side in zip(request.names, scene.sides, strict=True):
        measured_run = request.make(name)
        (recipe,) = measured_run.snapshots
        assert isinstance(recipe, Recipe), "no world of a thousand is made on the frame"
        snapshot = recipe.make()
        rows, facts = snapshot.arrays["bodies"], snapshot.facts
        assert len(rows) == 1000 and not rows["x"].any() and not rows["y"].any()
        assert (facts["solver"], facts["substeps"]) == (side.world.solver, side.world.substeps)
    assert len(words(scene, "1,000 boxes: being stepped")) == 2
    step(scene)
    assert "1,000 boxes" not in scene.finding()
    for number, runs in enumerate((1, RUNS)):
        farthest = (1.6, 2.0 + number)  # [px] a step: of 32 px to the metre, 60 steps a second
        cost = Cost.of([2.5] * runs, 2)
        scene.figures = {name: RunFigures(cost, 0.0, far) for name, far in zip(request.names, farthest, strict=True)}
        wanted = [f"1,000 boxes: {amount(far * 60 / 32)}" + ", 2.5 s" * number for far in farthest]
        assert words(scene, "1,000 boxes") == wanted
        assert f"1,000 boxes 3 and {amount(farthest[1] * 60 / 32)}" in scene.finding()
    scene.change("slider:page", NAMES.index("crowd"))
    assert scene.measured() is None and not words(scene, "1,000 boxes")


def words(scene, start):
    """Return the texts in the scene's picture that begin with `start`."""
    canvas = Canvas()
    canvas.begin((0, 0, 0))
    scene.draw(canvas, 1.0)
    return [text for _, text in canvas.boxes if text.startswith(start)]


@pytest.mark.nightly
@needs_speed
def test_the_thousand_keeps_the_limit_too():
    """A thousand bodies at one point keep the limit, too: 499,500 pairs, a step of seconds."""
    scene = opened("point")
    page, request = scene.page, scene.measured()
    for name in request.names:
        measured_run = request.make(name)
        moment = Moment(measured_run.snapshots[0].make(), measured_run.broadphase)
        way = moment.way(moment.here, 3)
        assert way.places.shape == (3, 1000, 2)
        farthest = max(np.abs(np.diff(way.places, axis=0)).max(), np.abs(way.places[0]).max())
        assert 0.0 < farthest * 60 / 32 <= page.limit


@needs_speed
def test_the_bot_looks_into_every_page_and_goes_on_when_one_is_judged():
    scene = Gallery(0)
    session = Session(scene, BotSource())
    seen = []
    for _ in range(TOURED):
        session.step()
        seen.append(scene.page.name)
    assert tuple(dict.fromkeys(seen)) == NAMES and TOURED <= 600, "as long as tests play a lab"
    for _ in range(PAGES[0].steps + 1):
        session.step()
    assert tuple(scene.verdicts) == NAMES[:1] and scene.page is PAGES[1]


def test_errors_as_short_text():
    assert [amount(v) for v in (0.0, 2.1e-13, 0.00166, 18.18, 84.3, 50313.9)] == [
        "0", "<0.001", "0.00166", "18.2", "84.3", "50,314"
    ]  # fmt: skip
