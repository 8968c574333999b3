"""Base class of the overlay layers. A layer only reads the world. LAYERS in stack.py lists all layers."""

from game.drawing.camera import Camera
from game.drawing.canvas import Canvas
from game.drawing.colors import Color
from game.drawing.presenter import Frame, Lens
from physics import World

LegendLine = tuple[Color, str]


class Layer:
    """Overlay layer. key: the key that switches it; color: colour of its check box and of its first legend line."""

    name: str
    title: str
    key: str
    color: Color
    on_canvas: bool = False  # drawn on the canvas before it is scaled: exact to the canvas pixel
    on_frame: bool = True  # drawn at the window's resolution
    under: bool = False  # drawn before the other layers, since it fills areas

    def begin(self, views: int = 1) -> None:
        """Start a new picture, in which the layer is drawn once in each of `views` views.

        The views share the layer's limit of drawn objects evenly.
        """

    def draw(self, frame: Frame, lens: Lens, world: World) -> None:
        """Draw the layer for a world at window resolution, if the layer has `on_frame`. lens: maps world to frame."""

    def draw_on_canvas(self, canvas: Canvas, camera: Camera, world: World) -> None:
        """Draw the layer for a world on the canvas, as the camera shows it, if the layer has `on_canvas`."""

    def draw_labels(self, frame: Frame) -> None:
        """Write the labels of the drawn objects where there is room. Called after all layers have been drawn."""

    def notes(self) -> list[LegendLine]:
        """Return the layer's lines for the legend, a list of (color, text)."""
        return []
