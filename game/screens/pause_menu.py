"""The pause menu, drawn over the darkened game."""

from collections.abc import Sequence

from game.drawing.canvas import SMALL, TEXT, Canvas, wrap
from game.drawing.colors import FOG, GOLD, PAPER
from game.drawing.nine_slice import draw_box
from game.input.inputs import InputState
from game.scene import Scene
from game.screens.parts.background import SceneBackground
from game.screens.parts.rows import LINE, Row, RowList
from game.screens.screen import CanvasScreen

WIDTH = 192
HIGHEST = 46  # [canvas px] of the rows; leaves room for a message of three lines below them


class PauseMenu(CanvasScreen):
    """The menu that opens over a paused game.

    `outcome`, the request for the next screen or action, becomes ("back",), ("restart",), ("settings", page),
    ("save_replay",), ("costs",), ("effects",), ("tour",) or ("menu",).

    can_save: whether a replay of this run can be saved. message: the reason if the game paused by itself, otherwise "".
    pairs: (key, function) of the game's keys, shown under the menu.
    """

    holds_music = True

    def __init__(
        self, scene: Scene, can_save: bool = True, message: str = "", pairs: Sequence[tuple[str, str]] = ()
    ) -> None:
        super().__init__()
        self.scene, self.can_save, self.message, self.pairs = scene, can_save, message, pairs
        self.ground = SceneBackground(scene)
        self.list = RowList(self._rows, self._place(), self.cues)
        self.time = 0.0

    def _rows(self):
        entries = [
            ("Resume", ("back",)),
            ("Restart", ("restart",)),
            ("Settings", ("settings", None)),
            ("Keys", ("settings", "Keyboard")),
            ("Save replay", ("save_replay",)),
            ("What accuracy costs", ("costs",)),
            ("Only what is needed", ("effects",)),
            ("Tour of the overlays", ("tour",)),
            ("Leave", ("menu",)),
        ]
        return [
            Row(label, press=lambda outcome=outcome: self._leave(outcome))
            for label, outcome in entries
            if self.can_save or outcome[0] != "save_replay"
        ]

    def _leave(self, outcome):
        self.outcome = outcome

    def _place(self):
        high = len(self._rows()) * LINE
        return (480 - WIDTH) // 2 + 16, min(HIGHEST, (270 - high) // 2 + 14), WIDTH - 32, high

    def report(self, message: str) -> None:
        """Show a message under the menu."""
        self.message = message

    def step(self, inputs: InputState, dt: float) -> None:
        """Process the player's input of a step of `dt` [s], and advance the background."""
        self.time += dt
        if inputs.pressed("cancel") or inputs.pressed("pause"):
            self.cues.append("back")
            self.outcome = ("back",)
        self.list.step(inputs, dt)

    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw the menu over the darkened game.

        Below the menu, draw the message, or the keys if there is no message.
        """
        self.ground.draw(canvas, self.time)
        lines = wrap(self.message, WIDTH - 24, TEXT)
        rect = self.list.rect.inflate(32, 24)
        rect.y, rect.height = rect.y - 26, rect.height + 30
        draw_box(canvas, rect)
        canvas.text("PAUSED", rect.centerx, rect.y + 12, GOLD, TEXT, 2, "center")
        self.list.draw(canvas)
        if lines:
            note = rect.move(0, rect.height + 4)
            note.height = 12 * len(lines) + 12
            draw_box(canvas, note)
            for number, line in enumerate(lines):
                canvas.text(line, note.centerx, note.y + 7 + 12 * number, PAPER, TEXT, 1, "center")
        elif self.pairs:
            keys = ",  ".join(f"{key} {what}" for key, what in self.pairs)
            rows = wrap(keys, canvas.rect.width - 48, SMALL)
            box = rect.move(0, rect.height + 4)
            box.width = max(canvas.measure(row, SMALL)[0] for row in rows) + 24
            box.height, box.centerx = 9 * len(rows) + 13, rect.centerx
            draw_box(canvas, box)
            for number, row in enumerate(rows):
                canvas.text(row, box.centerx, box.y + 7 + 9 * number, FOG, SMALL, 1, "center")
