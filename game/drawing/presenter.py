"""Presentation of the 480 x 270 canvas in the window: scale, letterbox, and the frame that overlays draw on.

The scale is a whole number. Beside a docked panel, it may be a fraction, so that the picture fills the remaining space.
The module replaces pygame.SCALED, which fails under SDL's dummy driver (as OpenGL does), and which does not scale by
whole numbers in fullscreen.
"""

import numpy as np
import pygame

from game.drawing.canvas import CANVAS_SIZE, Box, Canvas, Number
from game.drawing.colors import INK
from game.input.drag import View

PANEL_SHARE = 1 / 3  # of the window's width, for the docked panel
SCREENSHOT_SCALE = 3  # 1440 x 810


class Lens:
    """Transform from world (x, y) to frame (X, Y): X = x * scale + dx, Y = y * scale + dy.

    clip: rectangle of the camera's viewport on the frame.
    """

    def __init__(self, scale: float, dx: float, dy: float, clip: pygame.Rect) -> None:
        self.scale, self.dx, self.dy, self.clip = scale, dx, dy, clip

    def points(self, x: Number, y: Number) -> tuple[Number, Number]:
        """Return the frame positions (x, y) of world points. x, y: numbers or arrays."""
        return x * self.scale + self.dx, y * self.scale + self.dy

    def seen(self, rows: np.ndarray) -> np.ndarray:
        """Return (n,) bool: whether each box is at least partly in view.

        rows: (n, 4), min x, min y, max x, max y [world px].
        """
        clip = self.clip
        left, top = (clip.left - self.dx) / self.scale, (clip.top - self.dy) / self.scale
        right, bottom = (clip.right - self.dx) / self.scale, (clip.bottom - self.dy) / self.scale
        return (rows[:, 2] >= left) & (rows[:, 0] <= right) & (rows[:, 3] >= top) & (rows[:, 1] <= bottom)


class Frame(Canvas):
    """Picture at window resolution.

    area: rectangle of the game's canvas within the frame; zoom: frame px per canvas px. scale: `zoom` rounded down to a
    whole number, used for line widths and sizes of marks.
    """

    def __init__(self, surface: pygame.Surface) -> None:
        super().__init__(surface)
        self.scale, self.zoom = 1, 1.0
        self.area = pygame.Rect((0, 0), CANVAS_SIZE)  # the game canvas on the frame

    @property
    def text_scale(self) -> int:
        """Scale of small text at this resolution: a whole number at which the text is readable."""
        return max(1, (self.surface.get_height() + 140) // 340)

    @property
    def edge(self) -> int:
        """Greatest width of a text's outline [frame px]. The outline is drawn outside the text's box.

        It is the width for text on the frame, or for text on the canvas, whichever is greater.
        """
        return max(self.scale, self.text_scale)

    @property
    def plot_scale(self) -> int:
        """Scale of small text in a plot inside the game's picture: `text_scale`, but at most the picture's scale."""
        return min(self.text_scale, self.scale)

    def scale_for(self, width: int) -> int:
        """Return the largest whole scale at which a text of `width` font px fits into the game's picture.

        The result is at least 1 and at most `text_scale`.
        """
        return max(1, min(self.text_scale, self.area.width // width))

    def lens(self, camera: View) -> Lens:
        """Return the Lens that maps world to frame for a camera, at the camera's position in the last step."""
        left, top = camera.view()
        scale = camera.zoom * self.zoom
        view = camera.viewport
        corner_x = self.area.x + view.x * self.zoom
        corner_y = self.area.y + view.y * self.zoom
        clip = self.from_canvas((view.x, view.y, view.width, view.height))
        return Lens(scale, corner_x - left * scale, corner_y - top * scale, clip)

    def from_canvas(self, rect: Box) -> pygame.Rect:
        """Return the frame rectangle of a canvas rectangle."""
        s, area = self.zoom, self.area
        left, top = area.x + round(rect[0] * s), area.y + round(rect[1] * s)
        right, bottom = area.x + round((rect[0] + rect[2]) * s), area.y + round((rect[1] + rect[3]) * s)
        return pygame.Rect(left, top, right - left, bottom - top)


class Presenter:
    """Scaling of the canvas onto a frame.

    docked: True leaves space for a panel at the right and for graphs below the canvas.
    """

    def __init__(self, surface: pygame.Surface) -> None:
        self.frame = Frame(surface)
        self.docked = False

    def place(self) -> None:
        """Choose the scale and the position of the canvas for the current size of the window's surface."""
        frame = self.frame
        width, height = frame.surface.get_size()
        beside = self.docked and not self.crowded
        free = width - self.panel_width if beside else width
        frame.zoom = max(1.0, min(free / CANVAS_SIZE[0], height / CANVAS_SIZE[1]))
        frame.scale = int(frame.zoom)
        if not beside:
            frame.zoom = float(frame.scale)
        size = (round(CANVAS_SIZE[0] * frame.zoom), round(CANVAS_SIZE[1] * frame.zoom))
        frame.area = pygame.Rect((0, 0) if beside else ((width - size[0]) // 2, (height - size[1]) // 2), size)

    @property
    def crowded(self) -> bool:
        """Whether canvas and panel do not fit side by side. If True, the panel covers the whole picture."""
        return self.frame.surface.get_width() - self.panel_width < CANVAS_SIZE[0]

    @property
    def panel_width(self) -> int:
        """Width reserved for the docked panel [frame px]."""
        return int(self.frame.surface.get_width() * PANEL_SHARE)

    @property
    def panel_rect(self) -> pygame.Rect:
        """Rectangle of the docked panel on the frame."""
        width, height = self.frame.surface.get_size()
        if self.crowded:
            return pygame.Rect(0, 0, width, height)
        return pygame.Rect(width - self.panel_width, 0, self.panel_width, height)

    @property
    def strip_rect(self) -> pygame.Rect:
        """Rectangle of the frame below the docked canvas; empty if canvas and panel do not fit side by side."""
        width, height = self.frame.surface.get_size()
        if self.crowded:
            return pygame.Rect(0, 0, 0, 0)
        return pygame.Rect(0, self.frame.area.bottom, width - self.panel_width, height - self.frame.area.bottom)

    def present(self, canvas: Canvas) -> Frame:
        """Scale the canvas onto the frame, and add the canvas's text boxes and reserved rectangles to the frame.

        Return the frame.
        """
        self.place()
        frame = self.frame
        frame.begin()
        if frame.area.size != frame.surface.get_size():
            frame.surface.fill(INK)
        visible = frame.area.clip(frame.surface.get_rect())
        if visible == frame.area:
            self._scale(canvas.surface, frame.surface.subsurface(frame.area))
        else:  # a window smaller than the canvas: the picture is cut, so that the scale stays whole
            frame.surface.blit(canvas.surface, frame.area)
        frame.boxes.extend((frame.from_canvas(rect), text) for rect, text in canvas.boxes)
        frame.reserved.extend(frame.from_canvas(rect) for rect in canvas.reserved)
        frame.fixed.extend(frame.from_canvas(rect) for rect in canvas.fixed)
        return frame

    def _scale(self, canvas, target):
        """Scale the canvas onto the surface `target`.

        For a fractional zoom, the canvas is first enlarged by the next whole number and then smoothly reduced.
        """
        if self.frame.zoom == self.frame.scale:
            pygame.transform.scale(canvas, target.get_size(), target)
            return
        larger = pygame.transform.scale_by(canvas, self.frame.scale + 1)
        target.blit(pygame.transform.smoothscale(larger, target.get_size()), (0, 0))

    def to_canvas(self, position: tuple[int, int]) -> tuple[int, int]:
        """Return the canvas pixel (x, y) at a window position. The result may be outside the canvas."""
        area = self.frame.area
        zoom = self.frame.zoom
        return int((position[0] - area.x) // zoom), int((position[1] - area.y) // zoom)
