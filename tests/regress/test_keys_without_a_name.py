"""All keys that the system cannot name are one to pygame: an action could be given to every one of them at once."""

import pygame

from game.input.bindings import key_name


def test_such_a_key_is_refused():
    assert key_name(pygame.K_UNKNOWN) is None
    assert key_name(pygame.K_a) == "a"
