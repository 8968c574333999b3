"""Input of three initials: up and down change a letter, left and right select one. Typing and clicking also work."""

import pygame

from game.drawing.canvas import TEXT, Canvas
from game.drawing.colors import DUSK, FOG, GOLD, PAPER
from game.drawing.nine_slice import draw_box
from game.files.settings import LETTERS
from game.input.inputs import InputState
from game.screens.parts.rows import Repeat, confirmed

CELL = (32, 44)  # of a letter with its two arrows
GAP = 8


class Initials:
    """Three letters (initials) that the player enters. `done`: whether the player has accepted them.

    `at`: index of the selected letter, 0..2, or 3 for the OK button.
    """

    def __init__(self, text: str, x: int, y: int, cues: list[str]) -> None:
        self.letters = list(text)
        self.cues = cues
        self.at = 0
        self.done = False
        self.cells = [pygame.Rect(x + number * (CELL[0] + GAP), y, *CELL) for number in range(4)]
        self.vertical, self.sideways = Repeat(("up", "down")), Repeat(("left", "right"))
        self.pointer = None

    @property
    def text(self) -> str:
        """The three letters."""
        return "".join(self.letters)

    def feed(self, event: pygame.event.Event) -> bool:
        """Process a typed letter. Return whether the event was used."""
        if event.type != pygame.KEYDOWN:
            return False
        if event.key == pygame.K_BACKSPACE:
            self.at = max(0, self.at - 1)
            self.cues.append("blip")
            return True
        letter = chr(event.key).upper() if 0 < event.key < 128 else ""
        if letter not in LETTERS or not letter:
            return False
        if self.at < 3:
            self.letters[self.at] = letter
            self.at += 1
            self.cues.append("blip")
        return True

    def step(self, inputs: InputState, dt: float) -> None:
        """Process the player's input of a step of `dt` [s]: select and change letters, and accept the initials."""
        turn, way = self.vertical.move(inputs, dt), self.sideways.move(inputs, dt)
        if turn and self.at < 3:
            self._turn(self.at, turn)
        if way:
            self.at = min(3, max(0, self.at + way))
            self.cues.append("blip")
        if inputs.pointer != self.pointer and self.pointer is not None:
            self.at = next(
                (number for number, cell in enumerate(self.cells) if cell.collidepoint(inputs.pointer)), self.at
            )
        self.pointer = inputs.pointer
        if inputs.pointer_pressed:
            self._click(inputs.pointer)
        elif confirmed(inputs):
            self.cues.append("confirm")
            self.at, self.done = min(3, self.at + 1), self.at == 3

    def _click(self, pointer):
        for number, cell in enumerate(self.cells):
            if cell.collidepoint(pointer):
                self.at = number
                if number == 3:
                    self.done = True
                    self.cues.append("confirm")
                else:
                    self._turn(number, -1 if pointer[1] < cell.centery else 1)

    def _turn(self, number, way):
        """Change letter number `number` to the letter `way` places later in LETTERS, cyclically.

        The up key is -1 and thus moves backwards in the alphabet, as is usual in arcade games.
        """
        index = (LETTERS.index(self.letters[number]) + way) % len(LETTERS)
        self.letters[number] = LETTERS[index]
        self.cues.append("blip")

    def draw(self, canvas: Canvas) -> None:
        """Draw the letters, arrows above and below the selected letter, and the OK button."""
        for number, cell in enumerate(self.cells):
            marked = number == self.at
            draw_box(canvas, cell, "panel_selected" if marked else "panel")
            if number == 3:
                canvas.text("OK", cell.centerx, cell.centery - 4, GOLD if marked else FOG, TEXT, 1, "center")
                continue
            if marked:
                canvas.text("\u2191", cell.centerx, cell.y + 3, GOLD, TEXT, 1, "center")
                canvas.text("\u2193", cell.centerx, cell.bottom - 12, GOLD, TEXT, 1, "center")
            canvas.text(self.letters[number], cell.centerx + 1, cell.centery - 8, PAPER, TEXT, 2, "center")
        canvas.surface.fill(DUSK, (self.cells[0].x, self.cells[0].bottom + 3, self.cells[3].right - self.cells[0].x, 1))
