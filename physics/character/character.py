"""Character, the player figure of a platformer, which the game moves in whole pixels over ground and slopes."""

from __future__ import annotations

import math
from typing import Any, NamedTuple, cast

import numpy as np

from physics import checks, hints
from physics.annotations import Pair, WorldHandle
from physics.character.solids import STEEPEST_CLIMB, can_walk, find_own_rows, walk_for
from physics.character.walk import is_stopped, lead_out, walk
from physics.islands.sleep import disturb
from physics.shapes.kinds import names_of, with_area
from physics.shapes.shape import Filter, Shape
from physics.shapes.values import Convex, Polygon

LONGEST = 1e6  # [px] greatest move along an axis; a move is made pixel by pixel
PUSH = 2000.0  # [px/s2] under 9.8 m/s2 a character pushes ten times its own mass over ground with friction 0.6
BODY_DEF = [
    "vx",
    "vy",
    "angular_velocity",
    "force_x",
    "force_y",
    "torque",
]  # columns of other bodies that a walk may write
MAX_SLOPE = 0.8  # [rad] 46 degrees: a character walks on a slope of one tile per tile


class Moved(NamedTuple):
    """The result of Character.move: pixels moved, and the contacts of the character after the move.

    x, y: pixels moved along x and y.
    grounded: whether the character stands on ground on which it can walk, or a solid at the foot of a slope stops it.
    wall: -1: a solid touches its left side; 1: its right side; 0: neither.
    slope: rise per px to the right of the ground under the feet (1: 45 degrees up to the right), also while the
        character slides down.
    riding: the Body under the feet if it is kinematic or dynamic, or belongs to a pushable character; None on static
        ground and in the air.
    squeezed: whether a moving body has left the character no space; True in every move until this body no longer
        overlaps the character.
    """

    x: int
    y: int
    grounded: bool
    wall: int
    slope: float
    riding: Any  # a Body, whose module imports this package
    squeezed: bool


def _set_known(character: Any, name: str, value: Any) -> None:
    """Set the attribute `name` of a character. A subclass of Character may add attributes.

    Raises AttributeError for an unknown or read-only attribute.
    """
    own = vars(character)
    if name in ("world", "body") and name in own:
        raise AttributeError(f"Character.{name} cannot be set: write a new Character")
    if "body" in own and name not in own and not hasattr(type(character), name):
        checks.known_attribute(character, name, value, type(character) is Character)
    try:
        object.__setattr__(character, name, value)
    except AttributeError:
        checks.settable_attribute(character, name, value)
        raise


@checks.setting_by(_set_known)
class Character(metaclass=hints.WithForeignNames):
    """A convex shape that the game moves in whole pixels, and that stops before it overlaps a solid.

    world: the World, which must have the effect `response`.
    shape: a Polygon, Circle or Capsule, or Bounds of one of these or of a PixelMask; at least one pixel large. An
        axis-aligned box is rounded to whole pixels.
    position: position (x, y) of the shape's origin [px], rounded so that the left side and the feet are on the pixel
        grid.
    filter: the Filter of the shape.
    pushable: whether the character is solid for other characters and is pushed by them.
    user: any value of the caller, stored as body.user.
    mass: mass [density px²], > 0, which determines its weight on bodies and its momentum on landing, with the effect
        `stacking`; None: the mass of the shape at density 1.
    push: greatest force per mass with which the character pushes bodies in front of it [px/s²], >= 0, with the effect
        `stacking`; None: 2000.
    max_slope: angle of the steepest ground on which the character can walk [rad], 0 <= max_slope < pi/2. On steeper
        ground, up to 86 degrees, it slides down.

    body: the kinematic Body of the character, which takes part in contacts and sensor overlaps. Only the character
        moves it: setting its pose or velocity raises ValueError.

    With the effect `stacking`, dynamic bodies stop and carry the character, and the character pushes them. Raises
    TypeError for values of other types, ValueError for values out of range and for a world without the needed effects.
    """

    def __init__(
        self,
        world: WorldHandle,
        shape: Shape,
        position: Pair,
        filter: Filter = Filter.ALL,
        pushable: bool = False,
        user: Any = None,
        mass: float | None = None,
        push: float | None = None,
        max_slope: float = MAX_SLOPE,
    ) -> None:
        if not hints.is_own(world, "World"):
            hint = ": write Character(world, shape, position)"
            raise TypeError(f"world must be a World (got {checks.shown(world)}){hint}")
        self.world = found = cast(Any, world)  # a World, whose module imports this package
        found._needs("response", "a Character", True)
        found._needs("stacking", "mass", mass is not None)
        found._needs("stacking", "push", push is not None)
        shape, min_x, min_y, max_x, max_y = _outline(shape)
        x, y = checks.position("position", position)
        pushable = checks.flag("pushable", pushable)
        mass = shape.mass_of(1.0).mass if mass is None else checks.number("mass", mass, above=0.0)
        push = PUSH if push is None else checks.number("push", push, low=0.0)
        max_slope = checks.number("max_slope", max_slope, low=0.0)
        if max_slope >= math.pi / 2:
            raise ValueError(f"max_slope must be >= 0 and < pi/2 rad (got {max_slope!r})")
        width, height = math.ceil(max_x - min_x), math.ceil(max_y - min_y)
        offset_x, offset_y = -min_x, height - max_y
        left, top = math.floor(x - offset_x + 0.5), math.floor(y - offset_y + 0.5)
        self.body = found.add_body(
            shape,
            position=(left + offset_x, top + offset_y),
            kind="kinematic",
            filter=filter,
            continuous="off",
            user=user,
        )
        row = found.characters.append()
        row["body"], row["shape"], row["pushable"] = self.body.id, int(found.shapes["id"][-1]), pushable
        row["left"], row["top"], row["width"], row["height"] = left, top, width, height
        row["offset_x"], row["offset_y"], row["is_box"] = offset_x, offset_y, _is_upright_box(shape)
        row["previous_left"], row["previous_top"] = left, top
        row["mass"], row["push"] = mass, push
        row["climb"] = min(math.tan(max_slope), STEEPEST_CLIMB)
        row["riding"] = row["riding_shape"] = row["pressed"] = -1

    def __repr__(self):
        """Return a text with the id and the position of the character's body. No error is raised."""
        return f"Character({self.body!r})" if hasattr(self, "body") else "Character(unfinished)"

    @property
    def _row(self) -> int:
        rows = self.world.characters.rows
        at = int(np.searchsorted(rows["body"], self.body.id))
        if at == len(rows) or rows["body"][at] != self.body.id:
            raise checks.NoSuchId(f"character {self.body.id} was removed")
        return at

    @property
    def position(self) -> tuple[float, float]:
        """The position (x, y) [px] of the shape's origin."""
        return self.body.position

    @property
    def previous(self) -> tuple[float, float]:
        """The position (x, y) [px] of the shape's origin before the last move, for interpolated drawing."""
        row = self.world.characters.rows[self._row]
        return (float(row["previous_left"] + row["offset_x"]), float(row["previous_top"] + row["offset_y"]))

    @property
    def max_slope(self) -> float:
        """The angle [rad] of the steepest ground on which the character can walk."""
        return math.atan(self.world.characters.rows["climb"][self._row])

    @property
    def surface_speed(self) -> float:
        """The surface speed [px/s] of the ground under the feet after the last move, positive to the right; 0 in air.

        In a world with the effect `conveyor`, a step moves the character at this speed.
        """
        return float(self.world.characters.rows["belt"][self._row])

    def move(self, dx: float, dy: float, drop: bool = False) -> Moved:
        """Move the character by (dx, dy), along x first. Return the result as a Moved.

        dx, dy: displacement [px], each at most 1e6. Fractions of a pixel are added to the next move.
        drop: True lets the character fall through one-way tiles.

        On a slope steeper than max_slope the character slides down, by the component of dy along the slope. If its body
        is quarantined (disabled because a number is invalid), or will be in the next step, the character does not move
        and has no contacts. If the character overlaps a static solid, each move shifts it two pixels towards a free
        position, which must be within the character's size. Raises TypeError for values of other types; ValueError for
        a move that is not finite or too long; KeyError for a removed character; RuntimeError during a step.
        """
        world = self.world
        world._unlocked()
        dx, dy = _checked_move(dx, dy)
        drop = checks.flag("drop", drop)
        me = self._row
        rows = world.characters.rows
        if self.body._row["quarantined"] or not can_walk(me, rows):
            return Moved(0, 0, False, 0, 0.0, None, False)
        rows["drop"][me] = drop
        rows["previous_left"][me], rows["previous_top"][me] = rows["left"][me], rows["top"][me]
        squeezed = bool(rows["squeezed"][me])
        way = self._walk(me, dx, dy)
        asleep = _asleep(world, way.near)
        before = world.bodies[asleep][BODY_DEF]
        if walk(me, dx, dy, way, world.workspace.walked):
            reach = int(max(rows["width"][me], rows["height"][me]))
            lead_out(me, reach, self._walk(me, reach, reach), world.workspace.walked)
        if len(asleep):
            # A pushed body may be less than a pixel away from the character; then no contact would wake it.
            disturb(world, world.bodies["id"][asleep[before != world.bodies[asleep][BODY_DEF]]])
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

    def blocked(self, dx: float, dy: float) -> bool:
        """Return whether the character cannot move by even one pixel in a direction.

        dx, dy: the direction; only the signs are used.

        Other characters that can be pushed, and slopes that the character can walk on or slide down, do not block it.
        The world is unchanged. Raises TypeError for values that are not numbers; ValueError for a value that is not
        finite or above 1e6; KeyError for a removed character; RuntimeError during a step.
        """
        self.world._unlocked()
        dx, dy = _checked_move(dx, dy)
        me = self._row
        return bool(is_stopped(me, int(np.sign(dx)), int(np.sign(dy)), self._walk(me, 0.0, 0.0)))

    def _walk(self, me, dx, dy):
        """Return the Walk for a move by (dx, dy) [px], which lists the shapes near the character's path.

        me: row number of the character in the CHARACTER table.
        """
        world = self.world
        rows = world.characters.rows
        find_own_rows(world.bodies, world.shapes, rows)
        row = rows[me]
        # The distance that it may move, slide or rise, also around the characters that it may push.
        reach = abs(dx) + abs(dy) + 5.0
        climb = STEEPEST_CLIMB + float(row["climb"]) * abs(dx)
        if rows["pushable"].any():
            reach += float(max(rows["width"][rows["pushable"]].max(), rows["height"][rows["pushable"]].max()))
        left, top = float(row["left"]), float(row["top"])
        world.queries.begin(world)
        near = world.queries.rows_in(
            world,
            (left - reach, top - reach - climb),
            (left + float(row["width"]) + reach, top + float(row["height"]) + reach + climb),
        )
        spans = np.zeros((len(rows), 2), np.int64)
        spans[:, 1] = len(near)
        return walk_for(world, rows, near, spans, world.dt)

    def move_to(self, position: Pair) -> None:
        """Teleport the character to a position.

        position: new position (x, y) of the shape's origin [px], rounded to the pixel grid.

        Raises TypeError for a value that is not a point; ValueError for a point that is not finite or too far away;
        KeyError for a removed character; RuntimeError during a step.
        """
        self.world._unlocked()
        x, y = checks.position("position", position)
        row = self.world.characters.rows[self._row : self._row + 1]
        row["left"] = row["previous_left"] = np.floor(x - row["offset_x"] + 0.5)
        row["top"] = row["previous_top"] = np.floor(y - row["offset_y"] + 0.5)
        for name in ("remainder_x", "remainder_y", "carry_x", "carry_y", "push_vx", "push_vy", "belt", "belt_x"):
            row[name] = 0.0
        row["riding"] = row["riding_shape"] = -1
        row["grounded"], row["squeezed"] = False, False
        place = float(row["left"][0] + row["offset_x"][0]), float(row["top"][0] + row["offset_y"][0])
        self.body._teleport_of_character(place)

    def remove(self) -> None:
        """Remove the character and its body from the world."""
        self.world.remove_body(self.body)


def _asleep(world, near):
    """Return the BODY row numbers of the sleeping bodies that have a shape in `near`. near: SHAPE row numbers."""
    if not world.sleeps:
        return np.zeros(0, np.int64)
    rows = np.unique(world.shapes["body_row"][near])
    return rows[~world.bodies["awake"][rows]]


def _checked_move(dx, dy):
    return (checks.number("dx", dx, high=LONGEST, low=-LONGEST), checks.number("dy", dy, high=LONGEST, low=-LONGEST))


def _is_upright_box(shape):
    return (
        shape.radius == 0.0
        and len(shape.points) == 4
        and all(len(set(each)) == 2 for each in zip(*shape.points, strict=True))
    )


def _outline(shape):
    """Check the argument `shape` of Character. Return (shape for its body, left, top, right, bottom).

    left, top, right, bottom: bounds of the returned shape [px], relative to the shape's origin. Raises TypeError or
    ValueError for a shape that is not allowed.
    """
    inner = shape._inner if isinstance(shape, Shape) else shape
    wrapped = inner is not shape
    hulls = sorted((each for each in with_area() if issubclass(each, Convex)), key=lambda each: each is not Polygon)
    if not (wrapped or isinstance(inner, tuple(hulls))):
        raise TypeError(
            f"shape must be a {names_of(hulls)}, or Bounds of one of them or of a sprite's PixelMask "
            f"(got {checks.shown(shape)}){hints.in_place_of_shape(shape)}"
        )
    extent = inner.bounds
    if extent is None:
        raise ValueError(f"shape must have solid pixels (got {shape!r})")
    left, top, right, bottom = map(float, extent)
    if not (wrapped or _is_upright_box(inner)):
        if min(right - left, bottom - top) < 1.0:
            raise ValueError(f"shape must be at least 1 x 1 px (got {right - left} x {bottom - top})")
        return inner, left, top, right, bottom
    width, height = round(right - left), round(bottom - top)
    if width < 1 or height < 1:
        raise ValueError(f"shape must be at least 1 x 1 px (got {right - left} x {bottom - top})")
    x, y = 0.5 * (left + right), 0.5 * (top + bottom)
    box = Polygon.box(width, height, (x, y))
    return box, x - width / 2.0, y - height / 2.0, x + width / 2.0, y + height / 2.0
