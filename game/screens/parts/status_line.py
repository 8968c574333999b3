"""The line over a played scene: paused, slow, over, or which keys there are."""

import pygame

from game.drawing.canvas import SMALL
from game.drawing.colors import GOLD, PAPER, Color
from game.drawing.presenter import Frame
from game.input.bindings import help_pairs
from game.screens.parts.played import Played

HELP_SECONDS = 6.0  # how long the keys stay after the start
RESULT_WAIT = 60  # steps after the end before a key leads on: nobody skips it by holding fire
SHADE = (20, 16, 32, 225)


def draw_status(frame: Frame, play: Played) -> None:
    """Draw what there is to say of a Play."""
    text, color = status_of(play)
    if text:
        draw_line(frame, text, color)


def status_of(play: Played) -> tuple[str, Color]:
    """(text, color) of the line; "" where nothing is to be said."""
    scene, clock = play.scene, play.clock
    if clock.paused:
        return "FROZEN   P goes on   O one step   R restart   Esc menu", GOLD
    if clock.speed < 1.0:
        return f"SPEED {clock.speed:.0%}   - slower   + faster", GOLD
    if play.person and scene.result is not None:
        from_now = play.since_result > RESULT_WAIT
        return ("Space or A goes on" if from_now else ""), GOLD
    if play.session.report.steps < HELP_SECONDS * 60 and not play.panel_open and play.hint is None:
        pairs = scene.actions if play.settings is None else help_pairs(scene.actions, play.settings.keys)
        parts = [f"{key} {what}" for key, what in pairs] + ["mouse drag"] * scene.draggable
        return "   ".join([*parts, "1-9 see", "Tab panel", "Esc menu"]), PAPER
    return "", PAPER


def draw_line(frame: Frame, text: str, color: Color) -> None:
    """In the middle near the bottom, or wherever a line is free."""
    scale = frame.text_scale
    width, height = frame.measure(text, SMALL, scale)
    area = frame.area.clip(frame.rect)
    size = (width + 8 * scale, height + 6 * scale)
    x = area.centerx - size[0] // 2
    rows = [area.bottom - size[1] - n * size[1] for n in range(1, 20)] + [area.top + 4 * scale]
    place = frame.free_place(size, [(x, y) for y in rows if y >= area.top])
    if place is not None:
        shade = pygame.Surface(size, pygame.SRCALPHA)
        shade.fill(SHADE)
        frame.surface.blit(shade, place)
        frame.text(text, place[0] + 4 * scale, place[1] + 3 * scale, color, SMALL, scale)
