"""The screen of the user's replays.

The screen lists, describes, plays and keeps replays, and shows the paths of their files.
"""

from collections.abc import Callable
from functools import partial
from pathlib import Path

import pygame

from game.drawing.canvas import SMALL, TEXT, Canvas, shorten, wrap
from game.drawing.colors import FOG, GOLD, ORANGE, PAPER, SKY
from game.drawing.nine_slice import draw_box
from game.drawing.number_text import clock, points_text, short_clock
from game.input.inputs import InputState
from game.registry import Registry
from game.run.replay_shelf import keep, read_shelf_entry, replays_folder, shelf
from game.screens.parts.background import MARGIN, Background, DuskBackground, draw_page
from game.screens.parts.rows import LINE, Row, RowList
from game.screens.screen import CanvasScreen

LIST = pygame.Rect(MARGIN, MARGIN, 232, 254)
CARD = pygame.Rect(LIST.right + MARGIN, MARGIN, 224, 254)
FOOT = "Enter opens   Esc back"
MISSING = object()  # not read yet


class ReplaysScreen(CanvasScreen):
    """List of replays. `outcome`, the request for the next screen, becomes ("watch", path) or ("back",).

    copy(text): function that copies a text to the clipboard and returns whether it succeeded.
    """

    tune = "title"

    def __init__(
        self, registry: Registry, copy: Callable[[str], bool] = lambda text: False, ground: Background | None = None
    ) -> None:
        super().__init__()
        self.registry, self.copy = registry, copy
        self.ground = ground or DuskBackground()
        self.message = ""
        self.inside = False  # the keys operate the card, not the list
        self.entries = shelf()  # (path, kept by the player) each
        self.read = {}  # path -> (replay, reason); each step reads one more
        self.list = RowList(self._rows, (LIST.x + 16, LIST.y + 36, LIST.width - 32, 192), self.cues)
        self.card = RowList(
            self._card_rows, (CARD.x + 16, CARD.bottom - 20 - 4 * LINE, CARD.width - 32, 4 * LINE), self.cues
        )
        self.time = 0.0

    @property
    def chosen(self) -> tuple[Path, bool] | None:
        """(path, whether the player has chosen to keep it) of the marked replay; None if Back is marked."""
        return self.entries[self.list.mark] if self.list.mark < len(self.entries) else None

    def _rows(self):
        rows = [self._row(path, kept) for path, kept in self.entries]
        return [*rows, Row("Back", press=self._leave)]

    def _row(self, path, kept):
        replay, reason = self.read.get(path, (MISSING, ""))
        if replay is MISSING:
            return Row("reading ..", press=self._enter)
        if replay is None:
            return Row(path.name, press=self._enter, color=ORANGE)
        title = self.registry.scene_class(replay.scene).title
        mark = "* " if kept else ""
        return Row(f"{mark}{title}  {short_clock(replay.frames / 60)}", press=self._enter)

    def _card_rows(self):
        if self.chosen is None:
            return []
        path, kept = self.chosen
        rows = []
        if self.read.get(path, (None, ""))[0] is not None:
            rows.append(Row("Watch", press=lambda: self._go(("watch", path))))
            if not kept:
                rows.append(Row("Keep", press=partial(self._keep, path)))
        return [
            *rows,
            Row("Copy the path", press=partial(self._copy, path)),
            Row("Back to the list", press=self._close),
        ]

    def _leave(self):
        self.outcome = ("back",)

    def _go(self, outcome):
        self.outcome = outcome

    def _enter(self):
        self.inside, self.card.mark = True, 0

    def _close(self):
        self.inside = False

    def _keep(self, chosen):
        try:
            path = keep(chosen)
            self.message = f"Kept as {path.name}: it stays until you delete it."
        except OSError as error:
            self.message = f"It could not be kept: {error.strerror or error}"
        self.resume()

    def _copy(self, chosen):
        path = str(chosen)
        copied = self.copy(path)
        self.message = "The path is on the clipboard: send the file to a friend." if copied else f"The file: {path}"

    def resume(self) -> None:
        """Rebuild the list when the screen is shown again, because the files may have changed."""
        before = self.chosen
        self.entries = shelf()
        if before in self.entries:
            self.list.mark = self.entries.index(before)
        self.list.show_marked()
        self.inside = False

    def step(self, inputs: InputState, dt: float) -> None:
        """Process the player's input of a step of `dt` [s]. If a listed replay has not been read yet, read one."""
        self.time += dt
        unread = next((path for path, _ in self.entries if path not in self.read), None)
        if unread is not None:
            self.read[unread] = read_shelf_entry(unread, self.registry)
        if inputs.pointer != self.list.pointer and self.list.pointer is not None or inputs.pointer_pressed:
            if LIST.collidepoint(inputs.pointer):
                self.inside = False
            elif CARD.collidepoint(inputs.pointer):
                self.inside = self.chosen is not None
        if inputs.pressed("cancel"):
            self.cues.append("back")
            if self.inside:
                self.inside = False
            else:
                self._leave()
        elif self.inside:
            self.list.pointer = inputs.pointer
            self.card.step(inputs, dt)
        else:
            mark = self.list.mark
            self.list.step(inputs, dt)
            self.card.pointer = inputs.pointer
            if mark != self.list.mark:
                self.message, self.card.mark = "", 0

    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw the list, and a card about the marked replay."""
        self.ground.draw(canvas, self.time)
        draw_page(canvas, LIST, "Replays", FOOT)
        self.list.draw(canvas, not self.inside)
        draw_box(canvas, CARD)
        x, y, width = CARD.x + 16, CARD.y + 14, CARD.width - 32
        if self.chosen is None:
            text = (
                "Every game you play is kept here, the last ten. Those you keep stay. "
                f"Put a friend's file into {replays_folder()}, or drop it on the window."
            )
            for line in wrap(text, width, SMALL):
                canvas.text(shorten(line, width, SMALL), x, y, FOG, SMALL)
                y += 9
            return
        for text, color, font, height in self._about(self.chosen, width):
            if text:
                canvas.text(text, x, y, color, font)
            y += height
        self.card.draw(canvas, self.inside)

    def _about(self, chosen, width):
        """Return the lines of the card about a replay, as a list of (text, color, font, height [px]).

        chosen: value of the property `chosen`; width: width of a line [px].
        """
        path, kept = chosen
        replay, reason = self.read.get(path, (MISSING, ""))
        if replay is MISSING:
            return [("reading ..", FOG, TEXT, 12)]
        if replay is None:
            lines = [("This file cannot be used", ORANGE, TEXT, 14), (shorten(path.name, width, SMALL), FOG, SMALL, 12)]
            return lines + [(shorten(line, width), PAPER, TEXT, 12) for line in wrap(reason, width)][:6]
        lines = [
            (self.registry.scene_class(replay.scene).title, GOLD, TEXT, 14),
            (f"{replay.date or 'no date'}   {'kept' if kept else 'a recent run'}", FOG, SMALL, 11),
            (f"{clock(replay.frames / 60)}   seed {replay.seed}", PAPER, TEXT, 13),
        ]
        if replay.result is not None:
            ended = "won" if replay.result["won"] else "lost"
            points, seconds = points_text(replay.result["points"]), clock(replay.result["seconds"])
            lines.append((f"{ended}   {points}   {seconds}", SKY, TEXT, 13))
        if replay.level is not None:
            lines.append((shorten(f"level {replay.level['path']}", width, SMALL), FOG, SMALL, 10))
        lines.append(("", FOG, SMALL, 4))
        text = self.message or f"file: {path}"
        lines += [
            (shorten(line, width, SMALL), GOLD if self.message else FOG, SMALL, 9) for line in _path_lines(text, width)
        ][:7]
        return lines


def _path_lines(text, width):
    """Return a text as lines of at most `width` [px]. It is wrapped at spaces and, within paths, at slashes."""
    return [
        line.replace("/ ", "/").replace("\\ ", "\\")
        for line in wrap(text.replace("/", "/ ").replace("\\", "\\ "), width, SMALL)
    ]
