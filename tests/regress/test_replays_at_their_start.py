"""A replay paused at 0:00 shows the scene; it was once black, because the opening iris was closed there."""

import pygame
import pytest

from game.audio.sound import Sounds
from game.files.accessibility import Accessibility
from game.input.devices import DeviceSource
from game.registry import Registry
from game.run.picture import Picture
from game.run.replay import Recorder, load_replay
from game.run.session import Session
from game.run.sources import BotSource
from game.run.tape import Tape
from game.screens.watch import Watch
from scenes import SCENES

SHORT = [name for name in SCENES if name not in ("lab/broadphases", "lab/pyramid", "lab/tumbler")]
LEAST = 0.5  # of the picture's light a little later


def light(picture, watch):
    """Return the mean brightness of the game's picture, 0..255, without the controls below it."""
    frame = watch.draw(picture)
    area = pygame.Rect(0, frame.rect.height // 6, frame.rect.width, frame.rect.height // 2)
    return float(pygame.surfarray.array3d(frame.surface.subsurface(area)).mean())


@pytest.mark.parametrize("name", SHORT)
@pytest.mark.parametrize("way", [pygame.K_HOME, pygame.K_LEFT])
def test_it_is_seen_what_there_is(name, way, tmp_path):
    scene_class = Registry(SCENES).scene_class(name)
    scene = scene_class(1)
    recorder = Recorder(scene, True)
    session = Session(scene, BotSource(), recorder)
    for _ in range(40):
        session.step()
    recorder.save(tmp_path / "run.json")
    tape = Tape(lambda: scene_class(1), load_replay(tmp_path / "run.json"))
    watch = Watch(tape, DeviceSource(), Sounds(silent=True), Accessibility())
    picture = Picture(pygame.Surface((960, 540)))
    tape.seek(30)
    watch.clock.paused = True
    later = light(picture, watch)
    watch.feed(pygame.event.Event(pygame.KEYDOWN, key=way, mod=0, unicode=""))
    for number in range(50):
        watch.advance(1.0 + number / 60)
    assert tape.position == 0 and watch.clock.paused
    assert light(picture, watch) > LEAST * later
