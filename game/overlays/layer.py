"""Base class of the overlay layers. A layer only reads the world. LAYERS in stack.py lists all layers."""

from game.drawing.camera import Camera
from game.drawing.canvas import Canvas
from game.drawing.colors import Color
from game.drawing.presenter import Frame, Lens
from physics import World

LegendLine = tuple[Color, str]


class Layer:
    """Overlay layer.

    key: the key that switches the layer; color: colour of its check box and of its first legend line.
    """

    name: str
    title: str
    key: str
    color: Color
    on_canvas: bool = False  # drawn on the canvas before it is scaled: exact to the canvas pixel
    on_frame: bool = True  # drawn at the window's resolution
    under: bool = False  # drawn before the other layers, since it fills areas

    def begin(self, views: int = 1) -> None:
        """Start a new picture with `views` views. draw() or draw_on_canvas() is then called once per view.

        The layer's limit on drawn objects is divided evenly among the views.
        """

    def draw(self, frame: Frame, lens: Lens, world: World) -> None:
        """Draw the layer for a world at window resolution, if `on_frame` is set.

        lens: maps world to frame coordinates.
        """

    def draw_on_canvas(self, canvas: Canvas, camera: Camera, world: World) -> None:
        """Draw the layer for a world on the canvas, as seen by the camera, if `on_canvas` is set."""

    def draw_labels(self, frame: Frame) -> None:
        """Draw the labels of the drawn objects that cover no other text.

        This is called after all layers have been drawn.
        """

    def notes(self) -> list[LegendLine]:
        """Return the layer's lines for the legend, a list of (color, text)."""
        return []
