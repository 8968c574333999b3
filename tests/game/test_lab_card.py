"""The card of a lab: open at the first visit, readable at every size, correct, and closed for good by the player."""

import json

import pygame
import pytest

import physics
from game.files.settings import Settings, load_settings
from game.input.devices import DeviceSource
from game.registry import Registry
from game.run.picture import Picture
from game.screens.parts.first_hint import HintCard
from game.screens.parts.lab_card import LabCard, bodies_of, first_card, what_to_see
from game.screens.play import Play
from scenes import SCENES
from tests.game.arena import Arena
from tests.lockstep import make_scene

K = pygame
SCENE_CLASSES = Registry(SCENES)
LABS = [name for name in SCENES if name.startswith("lab/")]
SIZES = [(480, 270), (960, 540), (1440, 810), (1920, 1080)]


class Silent:
    """Replacement of the sounds that plays nothing."""

    def __getattr__(self, name):
        return lambda *a, **k: None


def screen(name, **settings):
    return Play(make_scene(name, few=True), DeviceSource(), Silent(), settings=Settings(window_scale=1, **settings))


def words(frame):
    return " ".join(text for _, text in frame.boxes)


def down(key, text=""):
    return pygame.event.Event(pygame.KEYDOWN, key=key, unicode=text, mod=0)


@pytest.mark.parametrize("name", LABS)
def test_the_first_page_has_sixty_words_at_most(name):
    text = what_to_see(SCENE_CLASSES.scene_class(name))
    assert len(" ".join((text.question, text.short, text.to_try)).split()) <= 60


@pytest.mark.parametrize("page", (0, 1))
@pytest.mark.parametrize("name", LABS)
def test_every_lab_says_what_to_see_and_all_of_it_can_be_read(name, page):
    play = screen(name)
    assert isinstance(play.hint, LabCard)
    for _ in range(3):
        play.step()
    if page:
        play.feed(down(K.K_F1))
    assert play.hint.page == page
    for size in SIZES:
        picture = Picture(pygame.Surface(size))
        frame = play.draw(picture)
        text = words(frame)
        question, short, see, why, to_try, source = play.hint.text
        shown = (question, see, why, source) if page else (question, short, to_try)
        assert all(shown), "in short and what to try; what to see, why it matters, and whose method it is"
        assert all(word in text for word in " ".join(shown).split())
        inside = [rect for rect, _ in frame.boxes if play.hint.rect.colliderect(rect)]
        assert frame.surface.get_rect().contains(play.hint.rect), size
        assert all(play.hint.rect.contains(rect) for rect in inside), "nothing else is written there, and nothing cut"
        assert inside == [rect for n, rect in enumerate(inside) if rect.collidelist(inside[:n]) < 0]


@pytest.mark.skipif(not physics.JIT, reason="sixty steps of every lab")
@pytest.mark.parametrize("name", LABS)
def test_the_first_page_has_sixty_words_with_what_was_found(name):
    play = screen(name)
    for _ in range(60):
        play.step()
    frame = play.draw(Picture(pygame.Surface((960, 540))))
    shown = [text for rect, text in frame.boxes if play.hint.rect.contains(rect)]
    assert len(" ".join(shown[:-1]).split()) <= 60 + len("To try:".split()), shown


@pytest.mark.parametrize(
    "name, size",
    [
        ("lab/stacks", (640, 360)),
        ("lab/masks", (640, 360)),
        ("lab/tunnelling", (960, 540)),
        ("lab/cradle", (960, 540)),
        ("lab/card_house", (960, 540)),
    ],
)
def test_the_card_stands_where_it_covers_the_least_of_texts_and_bodies(name, size):
    play = screen(name)
    play.hint = None
    for _ in range(3):
        play.step()
    picture = Picture(pygame.Surface(size))
    frame = play.draw(picture)
    subjects = [*(box for box, _ in frame.boxes), *frame.fixed, *bodies_of(play.scene, frame)]
    play.hint = LabCard(play.scene)
    play.draw(picture)
    card = play.hint.rect

    def covered(place):
        return sum(both.width * both.height for both in (place.clip(box) for box in subjects))

    area = play.hint.area
    corners = [card.copy() for _ in range(4)]
    for corner, at in zip(corners, ("topleft", "topright", "bottomleft", "bottomright"), strict=True):
        setattr(corner, at, getattr(area, at))
    assert covered(card) <= 1.05 * min(map(covered, corners)), name


def test_the_card_comes_once_and_when_it_is_asked_for(drive):
    d = drive(listing=SCENES)
    d.app.screens.play("lab/cradle")
    d.turns(3)
    assert isinstance(d.screen.hint, LabCard)
    d.key(K.K_ESCAPE)
    assert d.name == "Play" and d.screen.hint is None, "Esc puts the card away, and no more"
    assert load_settings()[0].labs_seen == ["lab/cradle"]
    d.post(K.KEYDOWN, key=K.K_F1, unicode="", mod=0)
    d.turns(2)
    assert isinstance(d.screen.hint, LabCard) and d.screen.hint.page == 0
    d.post(K.KEYDOWN, key=K.K_F1, unicode="", mod=0)
    d.turns(2)
    assert isinstance(d.screen.hint, LabCard) and d.screen.hint.page == 1
    d.post(K.KEYDOWN, key=K.K_SLASH, unicode="?", mod=K.KMOD_SHIFT)
    d.turns(2)
    assert d.screen.hint is None and load_settings()[0].labs_seen == ["lab/cradle"]
    d.app.screens.play("lab/cradle")
    d.turns(3)
    assert d.screen.hint is None
    d.key(K.K_m)
    d.post(K.KEYDOWN, key=K.K_F1, unicode="", mod=0)
    d.turns(2)
    assert isinstance(d.screen.hint, LabCard) and d.screen.open_panel is None
    d.press(d.screen.hint.rect.center)
    assert d.screen.hint is None
    d.screen.close()


def test_the_goals_are_what_the_lab_has_measured():
    play = screen("lab/tunnelling")
    play.feed(down(K.K_F1))
    picture = Picture(pygame.Surface((1440, 810)))
    for _ in range(90):
        play.step()
        frame = play.draw(picture)
    play.hint.age = 0
    frame = play.draw(picture)
    for goal in play.scene.check():
        assert all(word in words(frame) for word in f"{goal.name}: {goal.detail}".split())
    before = play.hint.goals
    for _ in range(90):
        play.step()
        play.draw(picture)
    assert play.hint.goals != before, "it goes on with the lab"


def test_it_stays_where_it_is_while_the_lab_goes_on():
    play = screen("lab/tunnelling")
    picture = Picture(pygame.Surface((960, 540)))
    play.draw(picture)
    place = play.hint.rect.topleft
    for _ in range(60):
        play.step()
        play.draw(picture)
        assert play.hint.rect.topleft == place


def test_what_has_no_room_is_counted():
    play = screen("lab/gallery")
    play.feed(down(K.K_F1))
    frame = play.draw(Picture(pygame.Surface((480, 270))))
    shown = sum(goal.name in words(frame) for goal in play.hint.goals)
    assert shown < len(play.hint.goals)
    assert any(text.endswith(" more") and int(text.split()[0]) > 0 for _, text in frame.boxes)


def test_a_game_has_the_keys_instead_and_a_bot_has_nothing():
    assert (
        isinstance(first_card(Arena(), Settings()), HintCard) and first_card(Arena(), Settings(hint_seen=True)) is None
    )
    assert what_to_see(Arena) is None
    with pytest.raises(ValueError, match="arena does not say"):
        LabCard(Arena())
    play = Play(make_scene("lab/cradle"), DeviceSource(), Silent(), settings=Settings(), bot=True)
    assert play.hint is None


def test_a_key_for_a_scene_without_a_card_is_left_to_it():
    play = Play(Arena(), DeviceSource(), Silent(), settings=Settings(hint_seen=True))
    assert not play.feed(down(K.K_F1)) and play.hint is None


@pytest.mark.parametrize("wrong", ["lab/cradle", [3], {"lab/cradle": True}])
def test_a_damaged_list_of_visits_is_reported_and_left_out(tmp_path, wrong):
    path = tmp_path / "settings.json"
    path.write_text(json.dumps({"version": 2, "labs_seen": wrong}))
    settings, message = load_settings(path)
    assert settings.labs_seen == [] and "labs_seen" in message and "list of names" in message
