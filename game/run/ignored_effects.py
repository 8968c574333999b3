"""Effects that a running scene declares but its solver does not support, and a warning about them in the picture."""

from collections.abc import Iterable

import pygame

from game.drawing.canvas import SMALL, wrap
from game.drawing.colors import INK, ORANGE
from game.drawing.number_text import plain_name
from game.drawing.presenter import Frame
from game.scene import Scene
from physics import Effects, World

LINE = 7  # [text px] from one row to the next
EDGE = 4  # [text px] around the rows, and between them and the edge of the picture
SHADE = (20, 16, 32, 225)


def ignored_by_solver(worlds: Iterable[World]) -> dict[str, list[str]]:
    """Return {solver: names of the declared effects that it ignores}, in the order of the worlds.

    Solvers that ignore no effect are not included.
    """
    found: dict[str, set[str]] = {}
    for world in worlds:
        ignored = world.ignored_effects
        if ignored:
            found.setdefault(world.solver, set()).update(ignored)
    return {solver: in_order(names) for solver, names in found.items()}


def ignored_effects(scene: Scene) -> list[str]:
    """Return the names of the effects that the scene's solvers ignore, although a world of the scene declares them."""
    return in_order({name for names in ignored_by_solver(scene.worlds).values() for name in names})


def in_order(names: set[str]) -> list[str]:
    """Return the names of effects in the order of the fields of Effects."""
    return [name for name in Effects.__dataclass_fields__ if name in names]


def sentences(scene: Scene) -> list[str]:
    """Return one sentence for each solver that ignores effects of the scene."""
    return [
        f"{plain_name(solver)} ignores {', '.join(map(plain_name, names))}"
        for solver, names in ignored_by_solver(scene.worlds).items()
    ]


def draw_ignored(frame: Frame, scene: Scene) -> None:
    """Write the sentences on ignored effects into a free corner of the game's part of a frame.

    They are written in the largest text that fits, below the game's top line. If no corner is free, they are written at
    the bottom left, over any text there.
    """
    shown_ignored = sentences(scene)
    if not shown_ignored:
        return
    area = frame.area.clip(frame.rect)
    for scale in range(frame.text_scale, 0, -1):
        rows = [row for text in shown_ignored for row in wrap(text, area.width - 4 * EDGE * scale, SMALL, scale)]
        size = _size(frame, rows, scale)
        if size[0] <= area.width and size[1] <= area.height:
            place = frame.free_place(size, _places(area, size, scale))
            if place is not None:
                _write(frame, rows, pygame.Rect(place, size), scale, SHADE)
                return
    rect = pygame.Rect(area.left, area.bottom - size[1], *size).clamp(area)
    frame.boxes[:] = [each for each in frame.boxes if not rect.colliderect(each[0])]
    _write(frame, rows, rect, 1, INK)


def _size(frame, rows, scale):
    width = max(frame.measure(row, SMALL, scale)[0] for row in rows)
    return width + 2 * EDGE * scale, (len(rows) * LINE + EDGE) * scale


def _places(area, size, scale):
    """Yield positions (x, y) for a box of `size` in `area`: upwards along the left edge, then along the right edge."""
    step, edge = LINE * scale, EDGE * scale
    for x in (area.left + edge, area.right - size[0] - edge):
        for y in range(area.bottom - size[1] - edge, area.top - 1, -step):
            yield x, y


def _write(frame, rows, rect, scale, ground):
    shade = pygame.Surface(rect.size, pygame.SRCALPHA)
    shade.fill(ground)
    frame.surface.blit(shade, rect)
    for number, row in enumerate(rows):
        y = rect.y + (EDGE // 2 + 1 + number * LINE) * scale
        frame.text(row, rect.x + EDGE * scale, y, ORANGE, SMALL, scale)
    frame.fix(rect)
