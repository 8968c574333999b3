"""Screen with a message, for example why a file cannot be used. Enter, Esc or a click closes it."""

from collections.abc import Sequence

from game.drawing.canvas import SMALL, TEXT, Canvas, wrap
from game.drawing.colors import GOLD, PAPER, RED
from game.errors import UsageError
from game.input.inputs import InputState
from game.screens.parts.background import Background, DuskBackground, draw_page
from game.screens.parts.rows import confirmed
from game.screens.screen import CanvasScreen

WIDTH = 400
MOST_LINES = 6  # of one part; longer text is cut


class MessageScreen(CanvasScreen):
    """Screen that shows a title and `parts`, a list of (label, text).

    `outcome`, the request for the next screen, becomes ("back",).
    """

    def __init__(self, title: str, parts: Sequence[tuple[str, str]], ground: Background | None = None) -> None:
        super().__init__()
        self.title, self.parts = title, parts
        self.ground = ground or DuskBackground()
        self.time = 0.0

    def step(self, inputs: InputState, dt: float) -> None:
        """Advance the background by `dt` [s]. Close the screen if the player confirms, cancels or clicks."""
        self.time += dt
        if confirmed(inputs) or inputs.pressed("cancel") or inputs.pointer_pressed:
            self.cues.append("back")
            self.outcome = ("back",)

    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw a box with the title and the parts of the message."""
        self.ground.draw(canvas, self.time)
        lines = []
        for label, text in self.parts:
            wrapped = [piece for line in wrap(text, WIDTH - 96) for piece in _broken(canvas, line, WIDTH - 96)]
            if len(wrapped) > MOST_LINES:
                wrapped = [*wrapped[: MOST_LINES - 1], wrapped[MOST_LINES - 1][:-2] + ".."]
            lines += [(label if number == 0 else "", line) for number, line in enumerate(wrapped)]
        height = 60 + 12 * len(lines)
        rect = ((canvas.rect.width - WIDTH) // 2, (canvas.rect.height - height) // 2, WIDTH, height)
        inside = draw_page(canvas, rect, self.title, "Enter or a click goes back")
        for number, (label, line) in enumerate(lines):
            y = inside.y + 12 * number
            if label:
                canvas.text(label, inside.x, y + 2, GOLD if label != "reason" else RED, SMALL)
            canvas.text(line, inside.x + 56, y, PAPER, TEXT)


def _broken(canvas, line, width):
    """Yield the pieces of a line that is too wide and has no spaces, such as a path.

    Each piece fits into `width` [px].
    """
    while canvas.measure(line)[0] > width:
        end = len(line)
        while canvas.measure(line[:end])[0] > width:
            end -= 1
        yield line[:end]
        line = line[end:]
    yield line


def error_message(error: UsageError, ground: Background | None = None) -> MessageScreen:
    """Return a MessageScreen about a UsageError. A FileError is shown in three parts.

    ground: background of the screen; None for the default.
    """
    return MessageScreen(error.headline, error.parts, ground)
