"""Texts are in the part of the canvas that shows the game; no side panel and no title line covers them."""

import pytest

from game.drawing.canvas import Canvas
from game.drawing.headline import draw_headline
from game.files.settings import Settings
from game.input.devices import DeviceSource
from game.run.replay import chosen_before
from game.run.replay_check import is_possible
from game.screens.play import Play
from scenes import SCENES
from scenes.shooter import ending
from scenes.shooter.scene import Shooter
from tests.game.reading import Reader
from tests.game.test_lab_card import Silent
from tests.lockstep import Run, make_scene

MOMENTS = (2, 60, 240)  # steps
SHOOTERS = ("shooter", "lab/disagreement")


def drawn(scene):
    """Return (canvas of a scene with its title line, list of (rectangle, text) of each text drawn on it)."""
    canvas = Canvas()
    canvas.begin((0, 0, 0))
    with Reader() as reader:
        scene.draw(canvas, 1.0)
    if (headline := scene.headline()) is not None:
        draw_headline(canvas, scene.title, headline, scene.head)
    return canvas, [(rect, text) for drawn_on, rect, text, _ in reader.lines if drawn_on is canvas]


@pytest.mark.parametrize("name", SCENES)
def test_a_scene_covers_none_of_its_own_texts(name):
    run = Run("", make_scene(name, few=True))
    for step in range(1, MOMENTS[-1] + 1):
        run.session.step()
        if step in MOMENTS:
            canvas, lines = drawn(run.scene)
            for line in lines:
                assert line in canvas.boxes, f"{line} is covered {step} steps after the start"


def begin(scene, mode):
    """Put a shooter into a mode such as "warning" or "bonus", with the largest numbers on the screen."""
    scene.score.points, scene.score.chain, scene.score.best_chain, scene.score.grazes = 12_345_670, 999, 999, 9999
    scene.score.kills[next(iter(scene.score.kills))] = 999
    scene.plane.power = scene.plane.bombs = scene.plane.lives = 5
    scene.spectacle.news, scene.director.wave = 60, "Weavers"
    if mode in ("ready", "run"):
        scene.director.mode, scene.director.since = mode, 60
    elif mode in ("warning", "leader"):
        events = scene.director.stage.events
        scene.director.next = next(n for n, each in enumerate(events, 1) if each.event == "boss")
        scene.director.mode, scene.director.since = mode, 60
        if mode == "leader":
            scene.fleet.launch_leader(scene.director.announced)
            scene.fleet.leader.mode, scene.fleet.leader.since = "fight", 1
    elif mode == "bonus":
        scene.director.mode, scene.spectacle.bonus = "run", ("PHASE BONUS", 100_000, 20)
    else:
        scene.ending.mode, scene.ending.since, scene.ending.left = mode, 300, 500
        scene.ending.counted = scene.score.final(5, 5)


@pytest.mark.parametrize("name", SHOOTERS)
@pytest.mark.parametrize(
    "mode, text",
    [
        ("ready", "STAGE 1"),
        ("run", "Weavers"),
        ("warning", "WARNING"),
        ("leader", "STORM CITADEL"),
        ("bonus", "PHASE BONUS"),
        (ending.ASKING, "CONTINUE? 8"),
        (ending.LOST, "GAME OVER"),
        (ending.CLEARED, "NO CONTINUE"),
        (ending.WON, "STAGE CLEAR"),
    ],
)
def test_the_shooters_texts_stand_in_its_field(name, mode, text):
    scene = make_scene(name)
    Run("", scene).session.step()
    begin(scene, mode)
    canvas = Canvas()
    canvas.begin((0, 0, 0))
    Shooter.draw(scene, canvas, 1.0)
    boxes = list(canvas.boxes)
    assert text in [line for _, line in boxes]
    for rect, line in boxes:
        assert scene.field.contains(rect), line
    for at, (rect, line) in enumerate(boxes):
        assert not any(rect.colliderect(other) for other, _ in boxes[at + 1 :]), line
    middle = next(rect.centerx for rect, line in boxes if line == text)
    if mode in (ending.ASKING, ending.LOST, ending.WON, "ready", "warning", "bonus"):
        assert abs(middle - scene.field.centerx) <= 1


@pytest.mark.parametrize("invincible", (False, True))
def test_the_labs_plane_is_invincible_whatever_is_chosen_for_the_games(invincible):
    scene = make_scene("lab/disagreement")
    play = Play(scene, DeviceSource(), Silent(), settings=Settings(invincible=invincible))
    for _ in range(3):
        play.step()
    lives = scene.plane.lives
    scene._hit([])
    for _ in range(20):
        play.step()
    assert scene.invincible and scene.plane.lives == lives and scene.ending.mode == ending.PLAYING
    assert all(is_possible(type(scene), *change) for change in chosen_before(scene)), "its recordings can be played"
