"""The drawn picture of a scene: canvas, scaling, overlays and panel. A window and a screenshot use the same code."""

from collections.abc import Callable
from io import BytesIO
from pathlib import Path
from typing import Protocol

import pygame

from game.drawing.canvas import Canvas
from game.drawing.colors import INK, SHADE
from game.drawing.drag_line import draw_drag
from game.drawing.headline import draw_headline
from game.drawing.presenter import SCREENSHOT_SCALE, Frame, Presenter
from game.files.data_folder import write_atomically
from game.overlays.stack import Overlays, draw_legend, legend_columns, legend_size
from game.run.ignored_effects import draw_ignored
from game.scene import Scene

GRAPH_LEAST = 120  # [text px] least width of the graph of stage times


class Drawable(Protocol):
    """Interface of an object that draws a whole picture on the canvas: a title, menu or message screen."""

    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw the picture. alpha: position between the last two steps, 0..1."""
        ...


class Docked(Protocol):
    """Interface of an object that is drawn beside a scene, such as the panel."""

    def draw(self, frame: Frame, rect: pygame.Rect) -> None:
        """Draw the object into the rectangle `rect` of the frame."""
        ...


class Picture:
    """Drawing of pictures onto `surface`, such as the window's surface. None creates a surface of screenshot size."""

    def __init__(self, surface: pygame.Surface | None = None) -> None:
        if surface is None:
            surface = pygame.Surface((480 * SCREENSHOT_SCALE, 270 * SCREENSHOT_SCALE))
        self.canvas = Canvas()
        self.presenter = Presenter(surface)

    def draw_scene(
        self,
        scene: Scene,
        overlays: Overlays,
        alpha: float = 1.0,
        panel: Docked | None = None,
        reserve: Callable[[Frame], None] | None = None,
    ) -> Frame:
        """Draw the whole picture of a scene and return the frame. panel: panel to draw beside the scene, or None.

        alpha: position between the last two steps, 0..1. If overlays show geometry, 1 is used instead, so that sprites
        match the shapes. reserve(frame): called before text of the overlays is placed, to reserve rectangles for later
        drawing.
        """
        if overlays.shows_geometry():
            alpha = 1.0
        self.canvas.begin(INK)
        self.canvas.palette = self.presenter.frame.palette = scene.accessibility.palette
        scene.draw(self.canvas, alpha)
        if (headline := scene.headline()) is not None:
            draw_headline(self.canvas, scene.title, headline, scene.head)
        if scene.accessibility.flashing:
            scene.flash.draw(self.canvas.surface)
        if scene.accessibility.palette == "contrast" and overlays.shows_geometry():
            self.canvas.surface.fill((SHADE,) * 3, special_flags=pygame.BLEND_RGB_MULT)
        words = self.canvas.lift()
        overlays.draw_on_canvas(self.canvas, scene)
        self.canvas.put_back(words)
        self.presenter.docked = panel is not None
        frame = self.presenter.present(self.canvas)
        if reserve is not None:
            reserve(frame)
        scene.draw_on_frame(frame)
        draw_drag(frame, scene.drag, scene.pointer)
        frame.reserve(frame.from_canvas((0, 0, self.canvas.surface.get_width(), scene.head)))
        draw_ignored(frame, scene)
        words = frame.lift() if overlays.shows_geometry() else []
        overlays.draw_on_frame(frame, scene)
        frame.put_back(words)  # text such as score and lives, and plots stay on top
        if panel is None:
            overlays.draw_floating(frame, scene.legend_at)
        else:
            self._draw_panel(frame, panel, overlays)
        overlays.draw_labels(frame)
        return frame

    def draw_without(self, draw: Callable[[Frame], None], overlays: Overlays, panel: Docked | None = None) -> Frame:
        """Draw a picture with draw(frame) instead of a scene. Return the frame.

        panel: panel to draw beside the picture, or None; overlays: the overlays whose strip is shown together with a
        panel.
        """
        self.canvas.begin(INK)
        self.presenter.docked = panel is not None
        frame = self.presenter.present(self.canvas)
        draw(frame)
        if panel is not None:
            self._draw_panel(frame, panel, overlays)
        return frame

    def _draw_panel(self, frame, panel, overlays):
        if self.presenter.crowded:
            frame.begin()  # the panel covers the whole picture with all text so far
        panel.draw(frame, self.presenter.panel_rect)
        draw_strip(frame, self.presenter.strip_rect, overlays)

    def draw_screen(self, screen: Drawable, alpha: float = 1.0) -> Frame:
        """Draw a screen without a scene: a title, menu or message. Return the frame."""
        self.canvas.begin(INK)
        screen.draw(self.canvas, alpha)
        self.presenter.docked = False
        return self.presenter.present(self.canvas)


def draw_strip(frame: Frame, rect: pygame.Rect, overlays: Overlays) -> None:
    """Draw the strip below a game that is shown beside a panel.

    The strip shows the legend at the left, the stage times at the right, and the invariants above them. Each part is
    drawn only if its overlay is on.
    """
    scale = frame.text_scale
    if rect.height < 40 * scale:
        return
    rect = _invariants_above(frame, rect, overlays, scale)
    left = rect.x + 4 * scale
    wanted = (GRAPH_LEAST + 8) * scale if "times" in overlays.on else 0
    for column in legend_columns(frame, overlays.legend(), rect.width - wanted, rect.height - 2 * scale, scale):
        draw_legend(frame, column, left, rect.y + 2 * scale, scale)
        left += legend_size(frame, column, scale)[0] + 2 * scale
    graph = pygame.Rect(left, rect.y + 4 * scale, rect.right - left - 4 * scale, rect.height - 8 * scale)
    if "times" in overlays.on and graph.width > GRAPH_LEAST * scale:
        overlays.times.draw_graph(frame, graph)
    frame.reserve(rect)


def _invariants_above(frame, rect, overlays, scale):
    """Draw the table of invariants at the top of `rect`, if its overlay is on, in the widest form that fits.

    Return the part of `rect` below the table.
    """
    if "invariants" in overlays.on:
        for width, height in overlays.invariants.sizes(frame):
            if width <= rect.width - 8 * scale and height <= rect.height - 4 * scale:
                overlays.put_invariants(frame, pygame.Rect(rect.x + 4 * scale, rect.y + 4 * scale, width, height))
                return pygame.Rect(rect.x, rect.y + height + 4 * scale, rect.width, rect.height - height - 4 * scale)
    return rect


def save_png(surface: pygame.Surface, path: str | Path) -> None:
    """Write a surface as a PNG file, whatever the suffix of the file is. Raises OSError.

    The write is atomic: the file appears complete or not at all.
    """
    picture = BytesIO()
    pygame.image.save(surface, picture, "picture.png")
    write_atomically(path, picture.getvalue(), makes_folder=False)
