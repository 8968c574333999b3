"""The status line over a played scene. It shows whether the scene is frozen, slow or ended.

While none of these applies, the line names the keys.
"""

import pygame

from game.drawing.canvas import CANVAS_SIZE, SMALL
from game.drawing.colors import FOG, GOLD, INK, PAPER, Color
from game.drawing.presenter import Frame
from game.input.bindings import help_pairs
from game.screens.parts.played import Played

HELP_SECONDS = 6.0  # time for which the keys are shown after the start
RESULT_WAIT = 60  # steps after the end before a key continues, so that holding fire does not skip it
GAP = "   "  # between the parts of a line
LINE = 7  # [text px] from one row to the next
MOST_ROWS = 4  # of a line of text that finds no place in fewer
HEAD_TITLE = 16  # [canvas px] a title begins this far from the left edge at most
SHADE = (20, 16, 32, 225)


def draw_status(frame: Frame, play: Played) -> None:
    """Draw the status line of a played scene."""
    text, color = status_of(play)
    if not text:
        return
    head = play.scene.head if play.measuring.split is None else 0
    if head and play.scene.headline() is not None and draw_line(frame, text, color):
        return  # the sentence of the headline stays visible
    draw_line(frame, text, color, head)


def status_of(play: Played) -> tuple[str, Color]:
    """Return (text, color) of the status line. The text is "" if there is nothing to show."""
    scene, clock = play.scene, play.clock
    if play.news:
        return play.news, GOLD
    if play.step_inspector.open:
        return "", GOLD
    if clock.paused:
        return "FROZEN   P goes on   O one step   E into it   click a contact: why?   R restart   Esc menu", GOLD
    if clock.speed < 1.0:
        return f"SPEED {clock.speed:.0%}   - slower   + faster", GOLD
    if play.person and scene.result is not None:
        from_now = play.since_result > RESULT_WAIT
        return ("Space or A goes on" if from_now else ""), GOLD
    steps = play.session.report.steps - play.helped_since
    offer = [f"R {scene.offer}"] if scene.offer else []
    if play.open_panel is None and (steps < HELP_SECONDS * 60 or play.hint is not None):
        pairs = scene.actions if play.settings is None else help_pairs(scene.actions, play.settings.keys)
        parts = [f"{key} {what}" for key, what in pairs] + ["mouse drag"] * scene.draggable
        return GAP.join([*offer, *parts, "1-9 see", "Tab panel", "M costs", "Esc menu"]), GOLD if offer else PAPER
    return (offer[0] if offer and play.open_panel is None else ""), GOLD


def draw_in_a_corner(frame: Frame, text: str) -> None:
    """Draw a small line of text in the first free corner. Draw nothing if no corner is free."""
    scale = frame.text_scale
    width, height = frame.measure(text, SMALL, scale)
    area = frame.area.clip(frame.rect)
    size = (width + 4 * scale, height + 4 * scale)
    right, bottom = area.right - size[0] - 2 * scale, area.bottom - size[1] - 2 * scale
    left, top = area.left + 2 * scale, area.top + 2 * scale
    rows = [bottom - number * size[1] for number in range(20)]
    place = frame.free_place(size, [*((right, y) for y in rows), *((left, y) for y in rows), (right, top), (left, top)])
    if place is not None:
        shade = pygame.Surface(size, pygame.SRCALPHA)
        shade.fill(SHADE)
        frame.surface.blit(shade, place)
        frame.text(text, place[0] + 2 * scale, place[1] + 2 * scale, FOG, SMALL, scale)


def draw_line(frame: Frame, text: str, color: Color, head: int = 0) -> bool:
    """Draw a line of text beside the scene's title, in the top `head` canvas px. Return whether it was drawn.

    If head is 0 or the line does not fit there, draw it below the game's picture or at a free position inside it. The
    text is broken into as few rows as possible.
    """
    if head and _draw_in_head(frame, text, color, head):
        return True
    scale = frame.text_scale
    area = frame.area.clip(frame.rect)
    whole = max(area.width, frame.measure(text, SMALL, scale)[0])
    for parts in range(1, MOST_ROWS + 1):
        rows = _rows(frame, text, whole // parts, scale)
        width = max((frame.measure(row, SMALL, scale)[0] for row in rows), default=0)
        size = (width + 8 * scale, (LINE * len(rows) + 4) * scale)
        place = frame.free_place(size, _places(frame, area, size)) if rows else None
        if place is not None:
            shade = pygame.Surface(size, pygame.SRCALPHA)
            shade.fill(SHADE)
            frame.surface.blit(shade, place)
            for number, row in enumerate(rows):
                frame.text(row, place[0] + 4 * scale, place[1] + (3 + LINE * number) * scale, color, SMALL, scale)
            return True
    return False


def _places(frame, area, size):
    """Return positions (x, y) for a box of `size`, best first: below the game's picture `area`, then inside it."""
    scale = frame.text_scale
    across = (area.centerx - size[0] // 2, area.left + 4 * scale, area.right - size[0] - 4 * scale)
    down = range(area.bottom - 2 * size[1], area.top, -size[1])
    below = (area.bottom + frame.rect.bottom - size[1]) // 2
    inside = [(x, y) for y in (*down, area.bottom - size[1], area.top + 4 * scale) for x in across]
    return [(across[0], below), *inside] if below > area.bottom else inside


def _draw_in_head(frame, text, color, head):
    """Draw a line of text in the top `head` canvas px, in one or more rows, in the largest text that fits.

    Other text there is hidden, except the title and the number of a headline. Return False, and draw nothing, if the
    text does not fit.
    """
    band = frame.from_canvas((0, 0, CANVAS_SIZE[0], head)).clip(frame.rect)
    titles = [box for box, _ in frame.boxes if band.contains(box) and box.left < band.left + HEAD_TITLE * frame.zoom]
    left = max((box.right for box in titles), default=band.left) + 6 * frame.scale
    right = min(
        (rect.left for rect in frame.fixed if band.contains(rect) and rect.left > left), default=band.right
    )  # a lab's number
    room = pygame.Rect(left, band.top, right - left, band.height)
    for scale in range(frame.text_scale, 0, -1):
        rows = _rows(frame, text, room.width - 8 * scale, scale)
        if rows and len(rows) * LINE * scale <= room.height:
            break
    else:
        return False
    frame.surface.fill(INK, room)
    frame.boxes[:] = [each for each in frame.boxes if not room.colliderect(each[0])]
    y = room.y + (room.height - len(rows) * LINE * scale + 2 * scale) // 2
    for number, row in enumerate(rows):
        frame.text(row, room.right - 4 * scale, y + number * LINE * scale, color, SMALL, scale, "right")
    return True


def _rows(frame, text, width, scale):
    """Return a text as a list of rows of at most `width` [frame px]. The text is broken only at GAP.

    The list is empty if a part between two gaps is too wide.
    """
    rows = []
    for part in text.split(GAP):
        longer = f"{rows[-1]}{GAP}{part}" if rows else part
        if rows and frame.measure(longer, SMALL, scale)[0] <= width:
            rows[-1] = longer
        elif frame.measure(part, SMALL, scale)[0] <= width:
            rows.append(part)
        else:
            return []
    return rows
