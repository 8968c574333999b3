"""The stack of overlay layers over a scene: the layers that are on, their drawing, and their legend."""

from collections.abc import Iterable, Sequence
from typing import TypeVar

import pygame

from game.drawing.canvas import SMALL, Canvas
from game.drawing.colors import FOG, NIGHT, PAPER, faded
from game.drawing.presenter import Frame
from game.invariants.monitor import InvariantMonitor
from game.overlays.layer import Layer, LegendLine
from game.overlays.layer_bounds import Bounds, Motion
from game.overlays.layer_centers import Centers
from game.overlays.layer_colors import Colors
from game.overlays.layer_contacts import Contacts
from game.overlays.layer_disagreement import Disagreement
from game.overlays.layer_features import Features
from game.overlays.layer_filters import Filters
from game.overlays.layer_ghosts import Ghosts
from game.overlays.layer_impulses import Impulses
from game.overlays.layer_invariants import Invariants
from game.overlays.layer_islands import Islands
from game.overlays.layer_joints import Joints
from game.overlays.layer_masks import Masks
from game.overlays.layer_outlines import Outlines
from game.overlays.layer_pairs import Pairs
from game.overlays.layer_structure import Structure
from game.overlays.layer_times import Times
from game.scene import Scene

# A new layer is added here. The panel has the same order.
LAYERS: list[type[Layer]] = [
    Bounds,
    Motion,
    Structure,
    Pairs,
    Masks,
    Contacts,
    Filters,
    Times,
    Impulses,
    Features,
    Joints,
    Islands,
    Colors,
    Centers,
    Ghosts,
    Outlines,
    Invariants,
    Disagreement,
]  # fmt: skip
Kind = TypeVar("Kind", bound=Layer)
SHORTER = (24, 16, 10, 5)  # numbers of lines to try if the whole legend does not fit


def layer_names() -> tuple[str, ...]:
    """Return the names of all layers in the order of the panel. The option --overlay accepts these names."""
    return tuple(each.name for each in LAYERS)


class Overlays:
    """The overlay layers of a scene. on: set of the names of the layers that are on."""

    def __init__(self, on: Iterable[str] = ()) -> None:
        self.layers: tuple[Layer, ...] = tuple(each() for each in LAYERS)
        self.times = self._only(Times)  # keeps a history: needs every step
        self.filters = self._only(Filters)  # needs the scene's names of its kinds
        self.invariants = self._only(Invariants)  # needs the monitor of the scene
        self.disagreement = self._only(Disagreement)  # counts the steps during which it is on
        self.on = set(on)

    def _only(self, kind: type[Kind]) -> Kind:
        """Return the only layer of the class `kind`."""
        return next(each for each in self.layers if isinstance(each, kind))

    def toggle(self, name: str) -> None:
        """Switch the layer `name` on or off."""
        self.on ^= {name}

    def toggle_all(self) -> None:
        """Switch all layers off if any layer is on. Otherwise, switch all layers on."""
        self.on = set() if self.on else {layer.name for layer in self.layers}

    def note(self, scene: Scene) -> None:
        """Record a step in the layers that need every step. Call this after every step.

        The checks of the invariants begin one step after the layer of the invariants is shown.
        """
        self.times.note(scene)
        self.invariants.note(scene.monitor)
        if "disagreement" in self.on:
            self.disagreement.note(scene)
        self.watch(scene)

    def watch(self, scene: Scene) -> None:
        """Start the checks of the scene's invariants if the layer of the invariants is on. Otherwise, stop them.

        The checks of a strict monitor are not stopped.
        """
        shown = "invariants" in self.on
        if shown and scene.monitor is None:
            scene.watch_invariants()
        elif not shown and scene.monitor is not None and not scene.monitor.strict:
            scene.watch_invariants(False)

    def shows_geometry(self) -> bool:
        """Return whether a layer is on that draws objects of the world. Sprites are then drawn at exact poses."""
        return bool(self.on - {"times", "invariants"})

    def draw_on_canvas(self, canvas: Canvas, scene: Scene) -> None:
        """Draw the layers that must match canvas pixels exactly. Call this before the canvas is scaled."""
        for layer in self._active("on_canvas"):
            layer.begin(len(scene.views()))
            for world, camera in scene.views():
                layer.draw_on_canvas(canvas, camera, world)

    def draw_on_frame(self, frame: Frame, scene: Scene) -> None:
        """Draw the layers at window resolution. Each view is clipped to its part of the picture."""
        surface = frame.surface
        self.filters.names = scene.filter_names
        self.invariants.monitor = scene.monitor or InvariantMonitor()
        for layer in self._active("on_frame"):
            if not layer.on_canvas:  # else draw_on_canvas has begun its picture
                layer.begin(len(scene.views()))
            for world, camera in scene.views():
                lens = frame.lens(camera)
                surface.set_clip(lens.clip)
                layer.draw(frame, lens, world)
            surface.set_clip(None)

    def draw_labels(self, frame: Frame) -> None:
        """Write the labels of the drawn objects.

        Call this last, because labels are only written where they cover no other text.
        """
        for layer in self._active("on_frame"):
            layer.draw_labels(frame)

    def legend(self) -> list[LegendLine]:
        """Return the legend lines (color, text) of all layers that are on, in the order of the panel."""
        return [line for layer in self.layers if layer.name in self.on for line in layer.notes()]

    def draw_floating(self, frame: Frame, legend_at: tuple[int, int] | None = None) -> None:
        """Draw the legend, the stage times and the invariants over the game, where they cover no text.

        legend_at: position to try first for the legend [canvas px], or None.
        """
        area = frame.area.clip(frame.rect)
        scale = frame.text_scale
        if "invariants" in self.on:
            self._draw_invariants(frame, area, scale)
        self.times.rect = None
        for size in self.times.sizes(frame) if "times" in self.on else ():
            place = frame.free_place(size, _corners(area, size, 4 * scale))
            if place is not None:
                rect = pygame.Rect(place, size)
                self.times.draw_graph(frame, rect)
                frame.reserve(rect)
                break
        self._draw_legend(frame, area, legend_at, scale)

    def _draw_invariants(self, frame, area, scale):
        """Draw the strip of invariants, centred, near the lower or upper edge of `area`, in as few rows as fit."""
        for size in self.invariants.sizes(frame):
            margin = 4 * scale
            top, bottom = area.top + margin, area.bottom - size[1] - margin
            x = area.centerx - size[0] // 2
            places = [(x, y) for off in range(0, area.height // 2, margin) for y in (bottom - off, top + off)]
            place = frame.free_place(size, places + _corners(area, size, margin))
            if place is not None:
                self.put_invariants(frame, pygame.Rect(place, size))
                return

    def put_invariants(self, frame: Frame, rect: pygame.Rect) -> None:
        """Draw the strip of invariants into a rectangle, and reserve the rectangle so that other text avoids it."""
        there = pygame.display.get_init() and pygame.mouse.get_focused()
        self.invariants.draw_strip(frame, rect, pygame.mouse.get_pos() if there else (-1, -1))
        frame.reserve(rect)

    def _draw_legend(self, frame, area, legend_at, scale):
        """Draw the legend where it covers no text.

        If the legend does not fit, lines are left out, and its last line gives their number. legend_at: position to try
        first [canvas px], or None; scale: frame px per text px.
        """
        lines = self.legend()
        for room in (len(lines), *(count for count in SHORTER if count < len(lines))):
            if not lines:
                return
            shown = (
                lines if room == len(lines) else [*lines[: room - 1], (FOG, f"and {len(lines) - room + 1} more lines")]
            )
            size = legend_size(frame, shown, scale)
            places = _corners(area, size, 4 * scale)
            if legend_at is not None:
                places.insert(0, frame.from_canvas((*legend_at, 0, 0)).topleft)
            place = frame.free_place(size, places)
            if place is not None:
                shade = pygame.Surface(size, pygame.SRCALPHA)
                shade.fill((*faded(NIGHT, 0.5), 190))
                frame.surface.blit(shade, place)
                draw_legend(frame, shown, place[0], place[1], scale)
                return

    def _active(self, where):
        """Return the layers that are on and whose attribute `where` is True, in drawing order.

        where: "on_canvas" or "on_frame". Layers that fill areas are drawn first.
        """
        active = [layer for layer in self.layers if layer.name in self.on and getattr(layer, where)]
        return sorted(active, key=lambda layer: not layer.under)


def legend_size(frame: Frame, lines: Sequence[LegendLine], scale: int) -> tuple[int, int]:
    """Return (width, height) [frame px] of a legend including its margin. scale: frame px per text px."""
    widest = max(frame.measure(text, SMALL, scale)[0] for _, text in lines)
    return widest + 12 * scale, len(lines) * 7 * scale + 5 * scale


def legend_columns(
    frame: Frame, lines: list[LegendLine], width: int, height: int, scale: int
) -> list[list[LegendLine]]:
    """Return the legend's lines as columns that fit into width x height [frame px]; an empty list if nothing fits.

    If lines are left out, the last line gives their number. scale: frame px per text px.
    """
    rows = max(1, (height - 5 * scale) // (7 * scale))
    for shown in range(len(lines), 0, -1):
        kept = lines if shown == len(lines) else [*lines[:shown], (FOG, f"and {len(lines) - shown} more lines")]
        columns = [kept[first : first + rows] for first in range(0, len(kept), rows)]
        if sum(legend_size(frame, column, scale)[0] + 2 * scale for column in columns) <= width:
            return columns
    return []


def draw_legend(frame: Frame, lines: Sequence[LegendLine], x: int, y: int, scale: int) -> None:
    """Draw the legend with its top left corner at (x, y). Each line is a coloured square and a text.

    scale: frame px per text px.
    """
    for index, (color, text) in enumerate(lines):
        top = y + 3 * scale + index * 7 * scale
        frame.surface.fill(frame.tone(color), (x + 3 * scale, top, 3 * scale, 5 * scale))
        frame.text(text, x + 8 * scale, top, PAPER, SMALL, scale)


def _corners(area, size, margin):
    """Return the positions (x, y) to try for a box of `size` in `area`, at least `margin` from the border of the area.

    The corners and the middles of the sides come first. Positions along the left and right sides follow.
    """
    left, right = area.left + margin, area.right - size[0] - margin
    top, bottom = area.top + margin, area.bottom - size[1] - margin
    middle_x, middle_y = (left + right) // 2, (top + bottom) // 2
    rows = range(top, bottom + 1, 8 * max(1, margin // 4))
    places = [
        (left, bottom),
        (right, bottom),
        (left, middle_y),
        (right, middle_y),
        (right, top),
        (left, top),
        (middle_x, bottom),
        (middle_x, top),
    ]
    return places + [(x, y) for y in rows for x in (left, right)]
