"""Base class of the overlay layers. A layer only reads the world. LAYERS in stack.py lists all layers."""

from game.drawing.camera import Camera
from game.drawing.canvas import Canvas
from game.drawing.colors import Color
from game.drawing.presenter import Frame, Lens
from physics import World

LegendLine = tuple[Color, str]


class Layer:
    """Overlay layer. `key`: the key that switches it; `color`: colour of its check box and first legend line."""

    name: str
    title: str
    key: str
    color: Color
    on_canvas: bool = False  # drawn on the canvas before it is scaled: exact to the canvas pixel
    on_frame: bool = True  # drawn at the window's resolution
    under: bool = False  # drawn before the other layers, since it fills areas

    def begin(self, views: int = 1) -> None:
        """Start a picture in which the layer is drawn in `views` views. The views share the layer's budget of drawn
        objects evenly.
        """

    def draw(self, frame: Frame, lens: Lens, world: World) -> None:
        """Draw a world at the window's resolution; lens: maps world to frame coordinates. Called for `on_frame`."""

    def draw_on_canvas(self, canvas: Canvas, camera: Camera, world: World) -> None:
        """Draw a world on the canvas, as the camera shows it. Called if `on_canvas` is True."""

    def draw_labels(self, frame: Frame) -> None:
        """Write the labels of drawn objects where there is room."""

    def notes(self) -> list[LegendLine]:
        """Return (color, text) lines for the legend."""
        return []
