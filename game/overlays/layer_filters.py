"""Collision filters: shapes with the same membership and mask are drawn in the same colour.

The legend lists the filters and names the kinds of bodies that may collide.
"""

import numpy as np

from game.drawing.colors import FOG, PINK, SERIES
from game.drawing.presenter import Frame, Lens
from game.overlays.layer import Layer, LegendLine
from game.overlays.layer_bounds import BOX_BUDGET, draw_boxes
from physics import World, debug

KINDS_LISTED = 6  # lines in the legend; a further line counts the rest
WRITTEN = 4  # number of names that the legend writes for a mask
EVERYBODY = (0xFFFFFFFF, 0xFFFF)  # masks that include every kind


class Filters(Layer):
    """The box of each shape, drawn slightly smaller, in the colour of the shape's filter.

    Two shapes may collide if the membership of each is in the mask of the other.
    """

    name, title, key, color = "filters", "Filters by colour", "7", PINK

    def __init__(self) -> None:
        self.names: dict[int, str] = {}  # membership bit -> its name in the scene
        self.begin()

    def begin(self, views: int = 1) -> None:
        """Start a new picture with `views` views. The limit on drawn objects is divided evenly among the views."""
        self.kinds = {}  # (membership, mask) -> [colour, count]
        self.drawn = self.total = self.filtered = 0
        self.room = BOX_BUDGET // views

    def draw(self, frame: Frame, lens: Lens, world: World) -> None:
        """Draw the boxes of a world's shapes. lens: maps world to frame coordinates."""
        rows, shapes = debug.bounds(world), debug.shape_rows(world)
        self.total += len(rows)
        self.filtered += int(world.profile.counters["filtered"])
        if len(rows) == 0:
            return
        words = shapes["membership"].astype(np.uint64) << np.uint64(32) | shapes["mask"].astype(np.uint64)
        kinds, which, counts = np.unique(words, return_inverse=True, return_counts=True)
        colors = []  # of this world's filters; an earlier view may have given them a colour already
        for word, count in zip(kinds.tolist(), counts.tolist(), strict=True):
            kind = self.kinds.setdefault((word >> 32, word & 0xFFFFFFFF), [SERIES[len(self.kinds) % len(SERIES)], 0])
            kind[1] += count
            colors.append(kind[0])
        seen = np.flatnonzero(lens.seen(rows))[: self.room]
        self.drawn += len(seen)
        inset = 1.0 / max(lens.scale, 1.0)
        inner = rows[seen] + np.array([inset, inset, -inset, -inset])
        inner[:, 2:] = np.maximum(inner[:, 2:], inner[:, :2])
        draw_boxes(frame, lens, inner, colors, which[seen])

    def _who(self, word, written=32):
        """Return the names of the kinds of bodies whose bits are set in the filter mask `word`, as text.

        written: greatest number of names in the text "a, b". Further names are only counted. If all kinds but c are
        set, the text is "all but c".
        """
        if word in EVERYBODY:
            return "all"
        if not self.names:
            return "some" if word else "nobody"
        named = [name for bit, name in self.names.items() if word & bit]
        missing = [name for bit, name in self.names.items() if not word & bit]
        if word & ~sum(self.names):
            named.append("others")
        if len(named) > 1 and len(missing) < 2:
            return f"all but {missing[0]}" if missing else "all"
        more = len(named) - written
        return ", ".join(named[:written]) + (f" and {more} more" if more > 0 else "") if named else "nobody"

    def notes(self) -> list[LegendLine]:
        """Return the lines of the layer for the legend, a list of (color, text)."""
        lines: list[LegendLine] = [(FOG, f"filter {self.drawn} of {self.total}, {self.filtered} pairs filtered")]
        listed = list(self.kinds.items())
        for (membership, mask), (color, count) in listed[:KINDS_LISTED]:
            lines.append((color, f"{count} {self._who(membership)} meet {self._who(mask, WRITTEN)}"))
        if len(listed) > KINDS_LISTED:
            lines.append((FOG, f"and {len(listed) - KINDS_LISTED} more"))
        return lines
