"""Invariants U1 and U2: all numbers that a world reports are finite, and all normals are of unit length."""

import numpy as np

from game.invariants.bodies import BODY_NUMBERS
from game.invariants.columns import block
from game.invariants.invariant import Answer, Invariant
from game.invariants.step import Step
from physics import World

EVENT_NUMBERS = ("point_x", "point_y", "normal_x", "normal_y")
CONTACT_NUMBERS = (*EVENT_NUMBERS, "separation", "normal_impulse", "tangent_impulse")
HIT_NUMBERS = (*EVENT_NUMBERS, "speed", "normal_impulse")
BOX_NUMBERS = ("min_x", "min_y", "max_x", "max_y")
UNIT = 2e-12  # of the square of a normal's length: 1e-12 of the length (invariant U2)
Bad = tuple[tuple[int, ...], float, str]  # ids of bodies, value, quantity


def tables(world: World, sleeping: bool) -> list:
    """Return the tables that a world reports, each as (name, rows, names of the columns to check).

    The AABBs of shapes are not included. sleeping: whether the table of sleeping contacts is included.
    """
    events = world.events
    reported = [(f"events.{name}", getattr(events, name), EVENT_NUMBERS) for name in REPORTED]
    return [
        ("bodies", world.bodies, BODY_NUMBERS),
        ("contacts", world.contacts, CONTACT_NUMBERS),
        ("events.hits", events.hits, HIT_NUMBERS),
        *reported,
        *([("sleeping_contacts", world.sleeping_contacts, CONTACT_NUMBERS)] if sleeping else []),
    ]


REPORTED = ("begin", "persist", "end", "sensor_begin", "sensor_end")


def ids_of(row: np.void) -> tuple[int, ...]:
    """Return the ids of the bodies that a row of any table refers to."""
    names = row.dtype.names or ()
    return tuple(
        int(row[name])
        for name in (("id",) if "kind" in names and "x" in names else ("body", "body_a", "body_b"))
        if name in names
    )


def not_finite(world: World, sleeping: bool = False) -> Bad | None:
    """Check that all reported numbers are finite. Return None if they are, otherwise (ids of bodies, value, quantity).

    The result is about the first number that is not finite. sleeping: True also checks the table
    world.sleeping_contacts. The AABB of a shape without a solid part extends from +inf to -inf, which is allowed.
    """
    for name, rows, columns in tables(world, sleeping):
        if not len(rows):
            continue
        numbers = block(rows, columns)
        if not np.isfinite(numbers).all():
            column, row = np.argwhere(~np.isfinite(numbers))[0]
            return ids_of(rows[row]), float(numbers[column, row]), f"{name}.{columns[column]} is not finite"
    shapes = world.shapes
    if len(shapes):
        boxes = block(shapes, BOX_NUMBERS)
        if not np.isfinite(boxes).all():
            bad = ~np.isfinite(boxes).all(axis=0) & ~(boxes[0] > boxes[2])
            if bad.any():
                row = int(np.flatnonzero(bad)[0])
                return (int(shapes["body"][row]),), float(boxes[:, row].sum()), "the box of a shape is not finite"
    return None


def not_unit(world: World, sleeping: bool = False) -> Bad | None:
    """Check that all normals are of unit length. Return None if they are, otherwise (ids of bodies, error, quantity).

    The result is about the first wrong normal. error: absolute error of its squared length. sleeping: True also checks
    the table world.sleeping_contacts.
    """
    for name, rows, columns in tables(world, sleeping)[1:]:
        if len(rows):
            x, y = block(rows, columns)[2:4]
            off = np.abs(x * x + y * y - 1.0)
            if not (off <= UNIT).all():
                row = int(np.argmax(np.where(off <= UNIT, -1.0, 1.0)))
                return ids_of(rows[row]), float(off[row]), f"a normal of {name} is not of unit length"
    return None


class Finite(Invariant):
    """Invariant U1: no NaN or infinity in poses, velocities, boxes, impulses, normals and points.

    A body with a non-finite number is disabled within the step, before its numbers can be read. Such a body also breaks
    the invariant.
    """

    id, word = "U1", "finite"

    def look(self, step: Step) -> Answer:
        """Check the invariant for `step`. Return a Broken, or None if the invariant holds."""
        lost = step.world.events.quarantined
        if len(lost):
            return self.broken(step, lost["body"], float("nan"), 0.0, f"quarantined: {lost['reason'][0]}")
        bad = not_finite(step.world)
        return None if bad is None else self.broken(step, bad[0], bad[1], 0.0, bad[2])


class Unit(Invariant):
    """Invariant U2: every reported normal is of unit length, to 1e-12."""

    id, word = "U2", "normals"

    def look(self, step: Step) -> Answer:
        """Check the invariant for `step`. Return a Broken, or None if the invariant holds."""
        bad = not_unit(step.world)
        return None if bad is None else self.broken(step, bad[0], bad[1], UNIT, bad[2])
