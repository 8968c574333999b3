"""Files dropped on the window: pictures open in lab/ladder, and unusable files do not end the running game."""

import pygame

from scenes import SCENES


def test_a_dropped_picture_is_shown_at_every_tier(drive, tmp_path):
    picture = pygame.Surface((20, 20))
    picture.fill((90, 160, 220))
    pygame.image.save(picture, tmp_path / "mine.png")
    d = drive("--scene", "lab/filters", listing=SCENES)
    d.turns(3)
    d.post(pygame.DROPFILE, file=str(tmp_path / "mine.png"))
    d.turns(3)
    assert d.name == "Play" and d.screen.scene.name == "lab/ladder" and d.screen.scene.mask.area == 400
    d.screen.close()


def test_a_picture_that_is_none_is_reported_and_the_game_goes_on(drive, tmp_path):
    (tmp_path / "mine.png").write_bytes(b"nothing")
    d = drive("--scene", "lab/filters", listing=SCENES)
    d.turns(3)
    play = d.screen
    d.post(pygame.DROPFILE, file=str(tmp_path / "mine.png"))
    d.turns(3)
    assert d.name != "Play" and d.app.screens.played is play, "told on a screen above the game"
    d.key(pygame.K_RETURN)
    assert d.screen is play
