"""Camera: maps world points to canvas points by means of a position, a zoom and a viewport."""

from math import exp, sin

import pygame

from game.drawing.canvas import CANVAS_SIZE, Box, Number, whole

SHAKE_PIXELS = 5.0  # [canvas px] at full trauma; more would hide bullets
SHAKE_DECAY = 0.75  # [1/s] trauma lost per second: a full shake ends after 1.3 s


class Camera:
    """A camera. x, y: the world point at the top left of `viewport`, a canvas Rect; zoom: canvas px per world px.

    Call begin_step() once per step, before moving the camera. view(alpha) returns the world point that is drawn at the
    top left. At zoom 1 this point is rounded once, so that all drawn objects move together.
    """

    def __init__(
        self,
        viewport: Box | tuple[tuple[int, int], tuple[int, int]] | None = None,
        zoom: float = 1.0,
        x: float = 0.0,
        y: float = 0.0,
    ) -> None:
        self.viewport = pygame.Rect(viewport if viewport is not None else ((0, 0), CANVAS_SIZE))
        self.zoom = zoom
        self.x = self.previous_x = float(x)
        self.y = self.previous_y = float(y)
        self.trauma = 0.0
        self.shake_share = 1.0  # 0..1, share of the shake that is drawn
        self.clock = 0.0
        self.limits = None

    @property
    def size(self) -> tuple[float, float]:
        """(width, height) of the visible part of the world [world px]."""
        return self.viewport.width / self.zoom, self.viewport.height / self.zoom

    def keep_within(self, left: float, top: float, right: float, bottom: float) -> None:
        """Limit the camera to a rectangle of the world [px], such as the edges of a level."""
        self.limits = (left, top, right, bottom)

    def place(self, x: float, y: float) -> None:
        """Move the top left corner of the view to the world point (x, y), without interpolation.

        This is used, for example, after a restart.
        """
        self.x, self.y = self._limited(x, y)
        self.previous_x, self.previous_y = self.x, self.y

    def center_on(self, x: float, y: float) -> None:
        """Move the view so that the world point (x, y) is in its centre, without interpolation."""
        width, height = self.size
        self.place(x - width / 2, y - height / 2)

    def begin_step(self, dt: float) -> None:
        """Store the current position as the previous one, for interpolation, and decay the shake over `dt` [s].

        Call this once per step.
        """
        self.previous_x, self.previous_y = self.x, self.y
        self.clock += dt
        self.trauma = max(0.0, self.trauma - SHAKE_DECAY * dt)

    def follow(
        self, x: float, y: float, dt: float, rate: float = 8.0, dead_zone: tuple[float, float] = (0.0, 0.0)
    ) -> None:
        """Move the centre of the view towards the world point (x, y) for a step of `dt` [s].

        rate: rate of the approach [1/s]. The view does not move while the point is within `dead_zone` (x, y) [world px]
        of the centre.
        """
        width, height = self.size
        share = 1.0 - exp(-rate * dt)
        off_x = _outside(x - (self.x + width / 2), dead_zone[0])
        off_y = _outside(y - (self.y + height / 2), dead_zone[1])
        self.x, self.y = self._limited(self.x + off_x * share, self.y + off_y * share)

    def shake(self, trauma: float) -> None:
        """Add `trauma`, 0..1, to the trauma, which is the strength of the shake.

        The drawn offset is proportional to the square of the total trauma, so that small hits cause only small shakes.
        """
        self.trauma = min(1.0, self.trauma + trauma)

    def view(self, alpha: float = 1.0) -> tuple[float, float]:
        """Return the world point (x, y) that is drawn at the top left of the viewport, including the shake.

        At zoom 1, x and y are whole numbers. alpha: position between the last two steps, 0..1.
        """
        x = self.previous_x + (self.x - self.previous_x) * alpha
        y = self.previous_y + (self.y - self.previous_y) * alpha
        if self.trauma > 0.0 and self.shake_share > 0.0:
            reach = SHAKE_PIXELS * self.shake_share * self.trauma * self.trauma / self.zoom
            # Two slow sines of different periods: smooth, and the same in every run.
            x += reach * sin(self.clock * 61.0)
            y += reach * sin(self.clock * 47.0 + 1.3)
        return (whole(x), whole(y)) if self.zoom == 1.0 else (x, y)

    def to_canvas(self, x: Number, y: Number, alpha: float = 1.0) -> tuple[Number, Number]:
        """Return the canvas position (x, y) of world points. x, y: numbers or arrays.

        alpha: position between the last two steps, 0..1.
        """
        left, top = self.view(alpha)
        return (x - left) * self.zoom + self.viewport.x, (y - top) * self.zoom + self.viewport.y

    def to_world(self, x: float, y: float) -> tuple[float, float]:
        """Return the world position (x, y) of the canvas point (x, y), for the camera's position in the last step."""
        left, top = self.view()
        return (x - self.viewport.x) / self.zoom + left, (y - self.viewport.y) / self.zoom + top

    def _limited(self, x, y):
        if self.limits is None:
            return x, y
        left, top, right, bottom = self.limits
        width, height = self.size
        return max(left, min(x, right - width)), max(top, min(y, bottom - height))


def _outside(offset, zone):
    """Return the signed distance by which `offset` lies outside the range -zone .. zone, or 0 within it."""
    if offset > zone:
        return offset - zone
    return offset + zone if offset < -zone else 0.0
