"""Base class of the overlay layers. Layers only read; each decides where it is drawn. LAYERS in stack.py lists them."""

from game.drawing.camera import Camera
from game.drawing.canvas import Canvas
from game.drawing.colors import Color
from game.drawing.presenter import Frame, Lens
from physics import World

LegendLine = tuple[Color, str]


class Layer:
    """Overlay layer. `key`: the key that switches it; `color`: of its check box and of its first legend line."""

    name: str
    title: str
    key: str
    color: Color
    on_canvas: bool = False  # drawn on the canvas before it is scaled: exact to the canvas pixel
    on_frame: bool = True  # drawn at the window's resolution
    under: bool = False  # drawn before the other layers, since it fills areas

    def begin(self, views: int = 1) -> None:
        """Start a picture of `views` views, which share the layer's budget evenly."""

    def draw(self, frame: Frame, lens: Lens, world: World) -> None:
        """Draw one world through one lens, where `on_frame` is True."""

    def draw_on_canvas(self, canvas: Canvas, camera: Camera, world: World) -> None:
        """Draw one world on the canvas, where `on_canvas` is True."""

    def draw_labels(self, frame: Frame) -> None:
        """Write labels that follow objects, where there is room."""

    def notes(self) -> list[LegendLine]:
        """Return (color, text) lines for the legend."""
        return []
