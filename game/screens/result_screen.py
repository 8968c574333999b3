"""The screen after a game: won or lost, points and time, the place in the high scores, initials, and a menu."""

from collections.abc import Callable, Iterable

import pygame

from game.drawing.canvas import SMALL, TEXT, Canvas, shorten
from game.drawing.colors import FOG, GOLD, GREEN, PAPER, RED, SKY
from game.drawing.nine_slice import draw_box
from game.drawing.number_text import clock, points_text
from game.input.inputs import InputState
from game.scene import Result, Scene
from game.screens.parts.background import SceneBackground
from game.screens.parts.initials import Initials
from game.screens.parts.rows import LINE, Row, RowList
from game.screens.screen import CanvasScreen

PAGE = (104, 8, 272, 254)
COUNT_SECONDS = 0.8  # the numbers count up this long


class ResultScreen(CanvasScreen):
    """Screen with the result of a game. `place`: place 1..10 of the result in the high scores, or None.

    enter(initials) is called once, when the initials are accepted. `outcome`, the request for the next screen, becomes
    ("again",), ("save_replay",), ("scores",) or ("menu",).
    """

    shows_result = True

    def __init__(
        self,
        scene: Scene,
        result: Result,
        place: int | None,
        initials: str,
        enter: Callable[[str], None],
        can_save: bool = True,
        notes: Iterable[str] = (),
        assisted: bool = False,
    ) -> None:
        super().__init__()
        self.scene, self.result, self.place, self.enter = scene, result, place, enter
        self.can_save, self.assisted = can_save, assisted
        self.notes = list(notes)  # further messages: a ghost kept, a file that cannot be written
        self.ground = SceneBackground(scene)
        x = PAGE[0] + (PAGE[2] - 152) // 2
        self.initials = Initials(initials, x, 146, self.cues) if place is not None else None
        self.list = RowList(self._rows, (PAGE[0] + 56, 154, PAGE[2] - 112, 4 * LINE), self.cues)
        self.time = 0.0

    @property
    def asked(self) -> Initials | None:
        """The Initials while the player enters them, otherwise None."""
        return self.initials if self.initials is not None and not self.initials.done else None

    @property
    def entering(self) -> bool:
        """Whether the player is entering initials."""
        return self.asked is not None

    def _rows(self):
        rows = [Row("Again", press=lambda: self._leave(("again",)))]
        if self.can_save:
            rows.append(Row("Save replay", press=lambda: self._leave(("save_replay",))))
        if self.scene.ranked_by is not None:
            rows.append(Row("High scores", press=lambda: self._leave(("scores",))))
        return [*rows, Row("Menu", press=lambda: self._leave(("menu",)))]

    def _leave(self, outcome):
        self.outcome = outcome

    def feed(self, event: pygame.event.Event) -> bool:
        """Process typed letters of the initials. Return whether the event was used."""
        return self.asked is not None and self.asked.feed(event)

    def step(self, inputs: InputState, dt: float) -> None:
        """Process the player's input of a step of `dt` [s]: the initials while they are entered, otherwise the menu."""
        self.time += dt
        asked = self.asked
        if asked is not None:
            asked.step(inputs, dt)
            if asked.done:
                self.enter(asked.text)
            elif inputs.pressed("cancel"):
                self.accept()
            return
        if inputs.pressed("cancel"):
            self.cues.append("back")
            self.outcome = ("menu",)
        self.list.step(inputs, dt)

    def report(self, message: str) -> None:
        """Show a message under the list, instead of the previous message."""
        self.notes[:] = [message]

    def accept(self) -> None:
        """Accept the initials in their current form.

        This is called on Esc and when the window closes, so that the place in the high scores is not lost.
        """
        asked = self.asked
        if asked is not None:
            asked.done = True
            self.enter(asked.text)

    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw the result, and the initials or the menu."""
        self.ground.draw(canvas, self.time)
        draw_box(canvas, PAGE)
        x, y = PAGE[0] + PAGE[2] // 2, PAGE[1] + 12
        title, color = ("YOU MADE IT", GREEN) if self.result.won else ("GAME OVER", RED)
        canvas.text(title, x, y, color, TEXT, 2, "center")
        canvas.text(self.scene.title, x, y + 22, FOG, TEXT, 1, "center")
        share = min(1.0, self.time / COUNT_SECONDS)
        share = 1.0 - (1.0 - share) ** 3
        self._pair(canvas, PAGE[0] + 24, y + 40, "POINTS", points_text(round(self.result.points * share)), "left")
        self._pair(canvas, PAGE[0] + PAGE[2] - 24, y + 40, "TIME", clock(self.result.seconds * share), "right")
        lines = [*self.result.lines, *(["played with help: marked assisted"] if self.assisted else [])]
        for number, line in enumerate(lines[:3]):
            text = shorten(str(line), PAGE[2] - 32, SMALL)
            canvas.text(text, x, y + 72 + 9 * number, FOG, SMALL, 1, "center")
        if self.place is not None and self.initials is not None:
            self._draw_place(canvas, x, y + 110, self.place, self.initials)
        if self.asked is not None:
            self.asked.draw(canvas)
            keys = "\u2191 \u2193 letter   \u2190 \u2192 place   or type   Enter goes on"
            canvas.text(keys, x, 206, FOG, SMALL, 1, "center")
            return
        self.list.draw(canvas)
        for number, note in enumerate(self.notes[:2]):
            canvas.text(shorten(note, PAGE[2] - 24, SMALL), x, 228 + 9 * number, FOG, SMALL, 1, "center")

    def _pair(self, canvas, x, y, label, value, align):
        canvas.text(label, x, y, GOLD, SMALL, 1, align)
        canvas.text(value, x, y + 8, SKY, TEXT, 2, align)

    def _draw_place(self, canvas, x, y, place, initials):
        words = "the best run so far" if place == 1 else f"place {place} of the table"
        text = f"{initials.text}   {words}" if initials.done else f"{words[0].upper()}{words[1:]}. Who was it?"
        canvas.text(text, x, y, PAPER if place > 1 else GOLD, TEXT, 1, "center")
