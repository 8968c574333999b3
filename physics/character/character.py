"""Character: the player's body in a platformer, in whole pixels, with everything a jump needs to know."""

from typing import NamedTuple

import numpy as np

from physics import checks
from physics.character.walk import walk
from physics.shapes.bounds import Bounds
from physics.shapes.convex import Polygon
from physics.shapes.filter import Filter
from physics.shapes.mask import PixelMask

LONGEST = 1e6  # [px] of one move: it is walked pixel by pixel
PUSH = 2000.0  # [px/s2] under 9.8 m/s2 it shoves ten times its own mass over ground with friction 0.6


class Moved(NamedTuple):
    """What a move did: pixels moved, and what the character touches after it.

    wall: -1 solid at its left, 1 at its right; slope: rise per px to the right (1: 45 degrees up to the right) of tiles;
    riding: the kinematic or dynamic body, or pushable character, under its feet; squeezed: by what moved since the last
    move, and left no room.
    """

    x: int
    y: int
    grounded: bool
    wall: int
    slope: float
    riding: object
    squeezed: bool


class Character:
    """A box that is moved by the game, in whole pixels, and never overlaps a solid.

    shape: Polygon.box without angle, or Bounds, of at least one pixel; position: centre of the box [px]; pushable:
    solid for other characters, and pushed by them. Its `body` is kinematic: contacts and sensors see it. Needs the
    effect response.
    With the effect stacking, dynamic bodies stop and carry it too, and it acts on them: mass [density px2], None = that
    of its box at density 1, weighs on what it stands on and lands with momentum; push [px/s2], None = PUSH: what it
    runs into is accelerated towards the speed of its moves by at most mass * push. Raises TypeError, ValueError.
    """

    def __init__(self, world, shape, position, filter=Filter.ALL, pushable=False, user=None, mass=None, push=None):
        world._needs("response", "a Character", True)
        world._needs("stacking", "mass", mass is not None)
        world._needs("stacking", "push", push is not None)
        width, height = _size(shape)
        x, y = checks.position("position", position)
        pushable = checks.flag("pushable", pushable)
        mass = float(width * height) if mass is None else checks.number("mass", mass, above=0.0)
        push = PUSH if push is None else checks.number("push", push, low=0.0)
        self.world = world
        left, top = int(np.floor(x - width / 2.0 + 0.5)), int(np.floor(y - height / 2.0 + 0.5))
        self.body = world.add_body(
            Polygon.box(width, height),
            position=(left + width / 2.0, top + height / 2.0),
            kind="kinematic",
            filter=filter,
            continuous="off",
            user=user,
        )
        row = world.characters.append()
        row["body"], row["riding"], row["pushable"] = self.body.id, -1, pushable
        row["left"], row["top"], row["width"], row["height"] = left, top, width, height
        row["previous_left"], row["previous_top"] = left, top
        row["mass"], row["push"], row["pressed"] = mass, push, -1

    @property
    def _row(self):
        rows = self.world.characters.rows
        at = np.flatnonzero(rows["body"] == self.body.id)
        if not len(at):
            raise KeyError(f"character {self.body.id} was removed")
        return int(at[0])

    @property
    def position(self):
        """Centre of the box [px]."""
        return self.body.position

    @property
    def previous(self):
        """Centre of the box before the last move [px], for interpolated drawing."""
        row = self.world.characters.rows[self._row]
        return (row["previous_left"] + row["width"] / 2.0, row["previous_top"] + row["height"] / 2.0)

    @property
    def surface_speed(self):
        """Speed [px/s] at which the ground under its feet runs to the right, felt in the last move; 0 in the air.

        It carries the character in a step of a world with the effect conveyor.
        """
        return float(self.world.characters.rows["belt"][self._row])

    def move(self, dx, dy, drop=False) -> Moved:
        """Move by (dx, dy) [px], x first; drop: fall through one-way tiles. Raises TypeError, ValueError, RuntimeError."""
        world = self.world
        world._unlocked()
        dx, dy = (
            checks.number("dx", dx, high=LONGEST, low=-LONGEST),
            checks.number("dy", dy, high=LONGEST, low=-LONGEST),
        )
        drop = checks.flag("drop", drop)
        me = self._row
        rows = world.characters.rows
        rows["drop"][me] = drop
        rows["previous_left"][me], rows["previous_top"][me] = rows["left"][me], rows["top"][me]
        squeezed = bool(rows["squeezed"][me])
        rows["squeezed"][me] = False
        world.refresh_character_rows()
        room = world.workspace.rows_for(2 * len(world.shapes))
        walk(
            world.library.tables,
            world.shapes,
            me,
            dx,
            dy,
            int(world.effects.stacking),
            int(world.effects.rotation),
            world.dt,
            world.tolerances.slop,
            world.workspace.walk,
            room[: len(world.shapes)],
            room[len(world.shapes) : 2 * len(world.shapes)],
            rows,
            world.bodies,
            world.workspace.walked,
        )
        row = rows[me]
        riding = world.body(int(row["riding"])) if row["riding"] >= 0 else None
        return Moved(
            int(world.workspace.walked[0]),
            int(world.workspace.walked[1]),
            bool(row["grounded"]),
            int(row["wall"]),
            float(row["slope"]),
            riding,
            squeezed,
        )

    def move_to(self, position):
        """Put the centre of the box at the nearest whole pixel to a position [px], without walking there."""
        self.world._unlocked()
        x, y = checks.position("position", position)
        row = self.world.characters.rows[self._row : self._row + 1]
        row["left"] = row["previous_left"] = np.floor(x - row["width"] / 2.0 + 0.5)
        row["top"] = row["previous_top"] = np.floor(y - row["height"] / 2.0 + 0.5)
        for name in ("remainder_x", "remainder_y", "carry_x", "carry_y", "push_vx", "push_vy", "belt", "belt_x"):
            row[name] = 0.0
        row["riding"], row["grounded"], row["squeezed"] = -1, False, False
        self.body.move_to(
            (float(row["left"][0] + row["width"][0] / 2.0), float(row["top"][0] + row["height"][0] / 2.0))
        )

    def remove(self):
        """Remove the character and its body."""
        self.world.remove_body(self.body)


def _size(shape):
    wrapped = isinstance(shape, Bounds) and isinstance(shape.shape, (Polygon, PixelMask))
    shape = shape.shape if wrapped else shape
    if wrapped and isinstance(shape, PixelMask) and shape.bounds is not None:
        left, top, right, bottom = shape.bounds
    elif (
        isinstance(shape, Polygon)
        and len(shape.points) == 4
        and all(len(set(each)) == 2 for each in zip(*shape.points))
    ):
        left, top, right, bottom = *map(min, zip(*shape.points)), *map(max, zip(*shape.points))
    else:
        raise TypeError(
            f"shape must be Polygon.box(width, height) without angle, or Bounds of a sprite (got {shape!r})"
        )
    width, height = round(right - left), round(bottom - top)
    if width < 1 or height < 1:
        raise ValueError(f"shape must be at least 1 x 1 px (got {right - left} x {bottom - top})")
    return width, height
