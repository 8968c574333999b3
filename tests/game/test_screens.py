"""On every screen of the shell, text does not overlap other text, stays in the picture and contrasts with its
background.
"""

import json
from types import SimpleNamespace

import pygame
import pytest

from game.audio.sound import Sounds
from game.errors import FileError, UsageError
from game.files.accessibility import Accessibility
from game.files.records import Entry, Records, table_of
from game.files.settings import Settings
from game.input.devices import DeviceSource
from game.registry import Registry
from game.run.picture import Picture
from game.run.replay import load_replay
from game.run.replay_shelf import recent_folder, replays_folder
from game.run.tape import Tape
from game.scene import QUESTIONS, Result
from game.screens.attract import Attract
from game.screens.menu import Menu
from game.screens.message_screen import error_message
from game.screens.parts.background import SceneBackground
from game.screens.parts.first_hint import HintCard
from game.screens.parts.settings_rows import PAGES
from game.screens.pause_menu import PauseMenu
from game.screens.play import Play
from game.screens.replays_screen import ReplaysScreen
from game.screens.result_screen import ResultScreen
from game.screens.scores_screen import ScoresScreen, pages_of
from game.screens.settings_screen import SettingsScreen
from game.screens.title import Title
from game.screens.tour import STOPS, Tour
from game.screens.watch import Watch
from scenes import SCENES
from tests.game.arena import GAMES, Arena, Race
from tests.game.reading import Reader, assert_text_is_apart
from tests.game.test_replay import record

SIZES = [(1440, 810), (1920, 1080), (960, 540), (480, 270), (1100, 900)]
LONG = (
    "/data/somebody/with/a/long/name/.local/share/hitbox/settings.json: version: must be 1; "
    "defaults are used, the old file is kept as settings.json.damaged-1"
)


@pytest.fixture(autouse=True)
def display():
    pygame.display.init()
    pygame.display.set_mode((480, 270))


def settled(screen, steps=70):
    from game.input.inputs import InputFrame, InputState

    inputs = InputState()
    for _ in range(steps):
        inputs.set(InputFrame())
        screen.step(inputs, 1 / 60)
    return screen


def check(screen):
    """Draw a screen that uses the canvas, and check its text."""
    with Reader() as reader:
        picture = Picture()
        frame = picture.draw_screen(screen)
        assert_text_is_apart(frame.boxes, frame.rect)
        assert frame.boxes
        reader.assert_readable()


def check_at_sizes(screen, sizes=SIZES):
    """Draw a screen at window resolution, and check its text at each of the sizes."""
    for size in sizes:
        with Reader() as reader:
            frame = screen.draw(Picture(pygame.Surface(size)))
            assert_text_is_apart(frame.boxes, frame.rect)
            reader.assert_readable()


def test_title():
    check(settled(Title()))
    for mark in range(6):
        title = settled(Title(LONG), 30 + 90 * mark)
        title.list.mark = mark
        check(title)


def crowded_records():
    records = Records()
    for name in ("race", "dash", "shooter", "platformer"):
        for number in range(12):
            records.add(name, "points", Entry("WWW", 123456789 - number, 5999.99, "2026-12-31", 0, True))
    return records


@pytest.mark.parametrize("listing", [SCENES, GAMES])
def test_every_entry_of_the_menu(listing, tmp_path):
    levels = tmp_path / "levels"
    levels.mkdir()
    (levels / "a very long name of a level that somebody made.json").write_text("{}")
    (levels / "b.tmj").write_text("{}")
    menu = Menu(Registry(listing), crowded_records())
    titles = [row.label for row in menu.rows]
    assert len(titles) >= len(listing)
    for mark, row in enumerate(menu.rows):
        if not row.head:
            menu.list.mark = mark
            menu.list.show_marked()
            assert menu.list.place(mark) is not None
            check(menu)


def test_labs_stand_under_the_question_that_they_answer():
    registry = Registry(SCENES)
    menu = Menu(registry)
    headings, found = "", {}
    for row, (scene_class, _) in zip(menu.rows, menu.entries, strict=True):
        headings = row.label if row.head else headings
        if scene_class is not None:
            found.setdefault(headings, []).append(scene_class.name)
    assert list(found) == ["GAMES", *QUESTIONS]
    assert sorted(name for names in found.values() for name in names) == sorted(registry.names)
    assert all(name.startswith("lab/") == (heading != "GAMES") for heading, names in found.items() for name in names)


@pytest.mark.parametrize("inside", [False, True])
@pytest.mark.parametrize("page", PAGES)
def test_every_page_and_row_of_the_settings(page, inside):
    screen = SettingsScreen(Settings(window_scale=8, palette="contrast"), DeviceSource(), page=page)
    screen.inside = inside
    for mark, row in enumerate(screen.list.rows()):
        if not row.head:
            screen.list.mark = mark
            check(screen)
    screen.waiting_for = ("buttons", "bomb")
    check(screen)
    screen.waiting_for = None
    screen.message = (
        "right: B. bomb now has pad \u2192. fire keeps X. focus now has R stick. And one more line of text, "
        "so that there are three of them."
    )
    check(screen)


def test_settings_over_a_game():
    scene = Race()
    screen = SettingsScreen(Settings(), DeviceSource(), ground=SceneBackground(scene))
    screen.pages.mark = len(PAGES)
    check(screen)


@pytest.mark.parametrize(
    "message",
    [
        "",
        "The controller is gone. Plug it in again, or play on with the keyboard.",
        "Saved as platformer-20261121-160209-12.json",
    ],
)
def test_pause_menu(message):
    menu = PauseMenu(
        Race(), True, message, (("arrows", "drive"), ("L shift", "a very long thing to do"), ("X", "bomb")) * 3
    )
    for mark in range(len(menu.list.rows())):
        menu.list.mark = mark
        check(menu)


@pytest.mark.parametrize("place", [None, 1, 10])
@pytest.mark.parametrize("won", [True, False])
def test_result(place, won):
    entered = []
    lines = ("a line that is far too long to stand in one line of the box of the result", "b", "c")
    result = Result(won, 123456789, 5999.99, lines)
    screen = ResultScreen(
        Race(),
        result,
        place,
        "WWW",
        entered.append,
        True,
        ["your fastest: it will run beside you as a ghost", LONG],
        True,
    )
    settled(screen)
    for at in range(4 if place else 0):
        screen.initials.at = at
        check(screen)
    if place:
        screen.initials.done = True
    for mark in range(4):
        screen.list.mark = mark
        check(screen)


def test_high_scores(tmp_path):
    levels = tmp_path / "levels"
    levels.mkdir()
    level = levels / "a very long name of a level that somebody made and a little longer than it should be.json"
    level.write_text("{}")
    records = crowded_records()
    records.add(table_of("race", level), "seconds", Entry("WWW", 1, 5999.99, "2026-12-31"))
    pages = pages_of(Registry(GAMES), records)
    assert [page.table for page in pages] == ["race", table_of("race", level), "dash"]
    for page in pages:
        check(settled(ScoresScreen(pages, records, page.table, (page.table, 10))))
    check(settled(ScoresScreen(pages, Records())))
    check(settled(ScoresScreen(pages_of(Registry({"arena": GAMES["arena"]}), Records()), Records())))


def test_replays(tmp_path):
    check(settled(ReplaysScreen(Registry(GAMES))))
    for folder, names in ((replays_folder(), ("kept", "damaged", "other")), (recent_folder(), "abcdefghijklmn")):
        folder.mkdir(parents=True, exist_ok=True)
        for name in names:
            record(folder / f"{name}-with-a-name-that-is-longer-than-the-list-is-wide.json", 130)
    next(replays_folder().glob("damaged*")).write_text('{"version": 1')
    path = next(replays_folder().glob("other*"))
    path.write_text(
        json.dumps({**json.loads(path.read_text()), "scene": "elsewhere", "level": {"path": LONG, "digest": "1"}})
    )
    path = next(replays_folder().glob("kept*"))
    path.write_text(
        json.dumps(
            {
                **json.loads(path.read_text()),
                "scene": "race",
                "level": {"path": LONG, "digest": "1"},
                "result": {"won": True, "points": 123456789, "seconds": 5999.99},
            }
        )
    )
    screen = ReplaysScreen(Registry(GAMES))
    check(screen)
    settled(screen)
    assert [replay is None for replay, _ in screen.read.values()].count(True) == 2
    for mark in range(len(screen.entries) + 1):
        screen.list.mark = mark
        screen.list.show_marked()
        screen.inside = screen.chosen is not None
        check(screen)
        screen.message = f"The path is on the clipboard: {LONG}"
        check(screen)
        screen.message = ""


def test_messages():
    check(error_message(FileError("/tmp/" + "x" * 300, "waves[3].enemies[12].pattern.speed", LONG * 3)))
    check(error_message(UsageError("no scene 'shoter'; valid: " + ", ".join(SCENES))))


def tape_of(tmp_path, frames=200, **spoilt):
    path = tmp_path / "run.json"
    record(path, frames)
    if spoilt:
        path.write_text(json.dumps({**json.loads(path.read_text()), **spoilt}))
    return Tape(lambda: Arena(seed=3), load_replay(path))


@pytest.mark.parametrize("panel", [False, True])
@pytest.mark.parametrize("layers", [(), ("bounds", "pairs", "contacts", "filters", "times")])
def test_watching(tmp_path, panel, layers):
    digests = ["0" * 16] * 200
    for tape in (tape_of(tmp_path), tape_of(tmp_path, digests=digests)):
        watch = Watch(tape, DeviceSource(), Sounds(silent=True), Accessibility(), LONG)
        watch.overlays.on, watch.panel_open = set(layers), panel
        for _ in range(60):
            watch.step()
        check_at_sizes(watch)
        watch.clock.paused = True
        check_at_sizes(watch)
        watch.clock.paused, watch.alone = False, 60.0
        check_at_sizes(watch)


def test_every_stop_of_the_tour():
    tour = Tour(lambda name: Arena(), ("arena",), DeviceSource(), Accessibility())
    assert len(tour.stops) == len(STOPS)
    for tour.at in range(len(STOPS)):
        check_at_sizes(tour)


def test_attract():
    attract = Attract(lambda name: Arena(), ("arena",), Accessibility())
    attract.advance(0.0)
    check_at_sizes(attract)


def played(scene, settings=None):
    return Play(scene, DeviceSource(), Sounds(silent=True), settings=settings)


def test_first_hint_and_lines_over_a_game():
    play = played(Race(), Settings())
    assert isinstance(play.hint, HintCard)
    check_at_sizes(play)
    play.hint = None
    check_at_sizes(play)
    for paused, speed in ((True, 1.0), (False, 0.25)):
        play.clock.paused, play.clock.speed = paused, speed
        check_at_sizes(play)
    play.clock.speed = 1.0
    play.scene.result, play.since_result = Result(True, 1, 1.0), 99
    check_at_sizes(play)


def test_a_text_that_sinks_into_its_ground_is_found():
    """The check itself finds grey text on grey, and text that is covered."""

    def grey(canvas, alpha):
        canvas.surface.fill((90, 90, 90))
        canvas.text("can you read this", 10, 10, (120, 120, 120))

    def covered(canvas, alpha):
        canvas.text("can you read this", 10, 10)
        canvas.surface.fill((0, 0, 0))

    for draw in (grey, covered):
        with pytest.raises(AssertionError, match="can you read this"):
            check(SimpleNamespace(draw=draw))
