"""Drawing of a mouse drag: a line from the grabbed point to the pointer."""

import pygame

from game.drawing.colors import GOLD, INK, WHITE
from game.drawing.presenter import Frame
from game.input.drag import Drag, to_world


def draw_drag(frame: Frame, drag: Drag, pointer: tuple[float, float]) -> None:
    """Draw a line from the grabbed point to the pointer, with a ring and a dot. Draw nothing if no body is dragged.

    pointer: (x, y) [canvas px].
    """
    hold = drag.hold
    if hold is None:
        return
    lens, width = frame.lens(hold.camera), max(1, frame.scale - 1)
    start = lens.points(*hold.point())
    end = lens.points(*to_world(hold.camera, pointer))
    surface = frame.surface
    pygame.draw.line(surface, INK, start, end, width + 2)
    pygame.draw.line(surface, GOLD, start, end, width)
    for place, radius in ((start, 3 * frame.scale), (end, 2 * frame.scale)):
        pygame.draw.circle(surface, INK, place, radius + 1)
        pygame.draw.circle(surface, GOLD, place, radius)
    pygame.draw.circle(surface, WHITE, start, frame.scale + 1)
