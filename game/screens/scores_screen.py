"""High scores: one page for each ranked scene, and one for each level of the player that was played.

The left and right keys change the page.
"""

from pathlib import Path
from typing import NamedTuple

import pygame

from game.drawing.canvas import SMALL, TEXT, Canvas, shorten
from game.drawing.colors import DUSK, FOG, GOLD, PAPER, SKY
from game.drawing.number_text import clock, points_text
from game.errors import FileError
from game.files.own_levels import own_levels
from game.files.records import Records, table_of
from game.input.inputs import InputState
from game.registry import Registry
from game.screens.parts.background import Background, DuskBackground, draw_page
from game.screens.parts.rows import GRID, Repeat, Row, RowList, confirmed
from game.screens.screen import CanvasScreen

PAGE = pygame.Rect(40, 8, 400, 254)
LINE = 15
COLUMNS = ((0, "left"), (28, "left"), (150, "right"), (224, "right"), (240, "left"), (310, "left"))
HEADS = ("", "NAME", "POINTS", "TIME", "DATE", "")


class Page(NamedTuple):
    """A page of high scores.

    title: its heading; table: key of its table in the records; ranked_by: "points" or "seconds".
    """

    title: str
    table: str
    ranked_by: str


def pages_of(registry: Registry, records: Records, played: tuple[str, Path | None] | None = None) -> list[Page]:
    """Return the pages of high scores, in the order of the menu.

    played: (scene name, level file) of the current game, or None. The level of that game has a page even if its file is
    not in the level folder.
    """
    found = []
    for scene_class in registry.all_classes():
        if scene_class.ranked_by is None:
            continue
        found.append(Page(scene_class.title, scene_class.name, scene_class.ranked_by))
        levels = own_levels(scene_class.level_suffixes())
        if played is not None and played[0] == scene_class.name and played[1] not in (None, *levels):
            levels += (played[1],)
        for level in levels:
            try:
                table = table_of(scene_class.name, level)
            except FileError:  # unreadable; its error is shown when it is played
                continue
            if records.entries(table) and all(page.table != table for page in found):
                found.append(Page(f"{scene_class.title}: {level.stem}", table, scene_class.ranked_by))
    return found


class ScoresScreen(CanvasScreen):
    """Pages of high scores. `outcome`, the request for the next screen, becomes ("back",).

    pages: result of pages_of(); shown: key of the table to show first, or None; newest: (table, place) of the entry to
    mark, or None.
    """

    def __init__(
        self,
        pages: list[Page],
        records: Records,
        shown: str | None = None,
        newest: tuple[str, int | None] | None = None,
        ground: Background | None = None,
    ) -> None:
        super().__init__()
        self.pages, self.records, self.newest = pages, records, newest
        self.ground = ground or DuskBackground()
        self.at = next((number for number, page in enumerate(self.pages) if page.table == shown), 0)
        self.sideways = Repeat(("left", "right"))
        self.turners = RowList(self._rows, (PAGE.x + 16, PAGE.bottom - 34, PAGE.width - 32, 16), self.cues)
        self.time = 0.0

    def _rows(self):
        return [Row("Back", press=self._leave)]

    def _leave(self):
        self.outcome = ("back",)

    @property
    def arrows(self) -> tuple[pygame.Rect, pygame.Rect]:
        """(left, right) rectangles of the two arrows. A click on an arrow changes the page."""
        return pygame.Rect(PAGE.x + 8, PAGE.y + 36, 24, 16), pygame.Rect(PAGE.right - 32, PAGE.y + 36, 24, 16)

    def step(self, inputs: InputState, dt: float) -> None:
        """Process the player's input of a step of `dt` [s]: change the page or leave the screen."""
        self.time += dt
        way = self.sideways.move(inputs, dt) - (inputs.wheel > 0) + (inputs.wheel < 0)
        if inputs.pointer_pressed:
            left, right = self.arrows
            way += right.collidepoint(inputs.pointer) - left.collidepoint(inputs.pointer)
        if way and len(self.pages) > 1:
            self.at = (self.at + way) % len(self.pages)
            self.cues.append("blip")
        if inputs.pressed("cancel"):
            self.cues.append("back")
            self._leave()
        elif confirmed(inputs) or inputs.pointer_pressed:
            self.turners.step(inputs, dt)
        else:
            self.turners.pointer = inputs.pointer

    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw the current page."""
        self.ground.draw(canvas, self.time)
        draw_page(canvas, PAGE, "High scores")
        self.turners.draw(canvas)
        canvas.text("Enter or Esc back", PAGE.right - 20, PAGE.bottom - 28, FOG, SMALL, 1, "right")
        if not self.pages:
            canvas.text("No scene here keeps scores.", PAGE.centerx, PAGE.centery, FOG, TEXT, 1, "center")
            return
        page = self.pages[self.at]
        for rect, arrow in zip(self.arrows, "\u2190\u2192", strict=True):
            if len(self.pages) > 1:
                canvas.text(arrow, rect.centerx, rect.y + 4, GOLD, TEXT, 1, "center")
        canvas.text(shorten(page.title, PAGE.width - 80), PAGE.centerx, PAGE.y + 40, PAPER, TEXT, 1, "center")
        self._draw_table(canvas, page)

    def _draw_table(self, canvas, page):
        x, y = PAGE.x + 28, PAGE.y + 58
        by_time = page.ranked_by == "seconds"
        for (dx, align), head in zip(COLUMNS, HEADS, strict=True):
            if head:
                canvas.text(head, x + dx, y, GOLD, SMALL, 1, align)
        entries = self.records.entries(page.table)
        if not entries:
            canvas.text("Nobody yet. Be the first.", PAGE.centerx, y + 60, FOG, TEXT, 1, "center")
        for number, entry in enumerate(entries):
            top = y + 9 + number * LINE
            if self.newest == (page.table, number + 1):
                canvas.surface.fill(DUSK, (x - GRID, top - 3, PAGE.width - 40, LINE - 1))
                canvas.surface.fill(GOLD, (x - GRID, top - 3, 2, LINE - 1))
            color = PAPER if number < 3 else FOG
            cells = (
                f"{number + 1}",
                entry.name,
                points_text(entry.points),
                clock(entry.seconds),
                entry.date,
                "assisted" if entry.assisted else "",
            )
            ruling = 3 if by_time else 2
            for place, ((dx, align), text) in enumerate(zip(COLUMNS, cells, strict=True)):
                if text:
                    small, tone = place >= 4, SKY if place == ruling else color
                    canvas.text(text, x + dx, top + small, tone, SMALL if small else TEXT, 1, align)
