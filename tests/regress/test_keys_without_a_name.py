"""A key that the system cannot name is refused as a binding, because pygame gives all such keys the same code."""

import pygame

from game.input.bindings import key_name


def test_such_a_key_is_refused():
    assert key_name(pygame.K_UNKNOWN) is None
    assert key_name(pygame.K_a) == "a"
