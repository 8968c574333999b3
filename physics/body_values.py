"""Getters and setters of a body's values: material, filter, sensor flag, continuous mode, fixed rotation."""

import numpy as np

from physics import checks
from physics.annotations import ContinuousName
from physics.edit import checked_continuous, checked_sensor, refresh_mass, write_material
from physics.hints import MATERIALS
from physics.islands import sleep
from physics.shapes.shape import Filter, Material, checked_filter, checked_material
from physics.world_state import WorldState


def _own_rows(world, at, own) -> np.ndarray:
    """Return the SHAPE row numbers of those shapes of a body that use the body's value.

    They have no value of their own. at: row number of the body; own: SHAPE column that flags own values:
    "own_material", "own_filter" or "own_sensor".
    """
    rows = world._shape_rows(at)
    return rows[~world.shapes[own][rows]]


def material_of(world: WorldState, identity: int) -> Material:
    """Return the material of a body (id). The body's shapes use it unless they have a material of their own."""
    given = world._definitions.rows[world._row_number(identity)]
    return Material(*(given[name].item() for name in MATERIALS))


def filter_of(world: WorldState, identity: int) -> Filter:
    """Return the collision filter of a body (id). The body's shapes use it unless they have a filter of their own."""
    given = world._definitions.rows[world._row_number(identity)]
    return Filter(given["membership"].item(), given["mask"].item())


def set_material(world: WorldState, identity: int, value: Material) -> None:
    """Set the material of a body and of its shapes that have no material of their own. Recompute the mass.

    identity: id of the body. Raises TypeError if value is not a Material.
    """
    world._unlocked()
    value = checked_material(value)
    at = world._row_number(identity)
    write_material(world._definitions.rows[at : at + 1], value)
    for row in _own_rows(world, at, "own_material"):
        write_material(world.shapes[row : row + 1], value)
    refresh_mass(world, identity)


def set_filter(world: WorldState, identity: int, value: Filter) -> None:
    """Set the collision filter of a body and of its shapes that have no filter of their own. Wake the body.

    identity: id of the body. Raises TypeError if value is not a Filter.
    """
    world._unlocked()
    value = checked_filter(value)
    at = world._row_number(identity)
    given = world._definitions.rows[at]
    given["membership"], given["mask"] = value.membership, value.mask
    rows = _own_rows(world, at, "own_filter")
    world.shapes["membership"][rows], world.shapes["mask"][rows] = value.membership, value.mask
    world.pairs.set_filter(world.shapes["proxy"][rows], value)
    sleep.disturb(world, [identity])


def set_sensor(world: WorldState, identity: int, value: bool) -> None:
    """Set the sensor flag of a body and of its shapes that have no sensor flag of their own. Wake the body.

    identity: id of the body; value: True for sensors. Raises the errors of edit.checked_sensor.
    """
    world._unlocked()
    value = checked_sensor(world, value)
    at = world._row_number(identity)
    world._definitions.rows["sensor"][at] = value
    rows = _own_rows(world, at, "own_sensor")
    world.shapes["sensor"][rows] = value
    world.pairs.set_sensor(world.shapes, rows)
    sleep.disturb(world, [identity])


def set_continuous(world: WorldState, identity: int, value: ContinuousName) -> None:
    """Set the mode of continuous collision of a body (id). Raises the errors of edit.checked_continuous."""
    world._unlocked()
    swept, row = checked_continuous(world, value), world._body_row(identity)
    row["continuous"] = swept


def set_fixed_rotation(world: WorldState, identity: int, value: bool) -> None:
    """Set whether contacts and impulses leave the angular velocity of a body unchanged. True also sets it to 0.

    identity: id of the body. Raises TypeError if value is not a bool.
    """
    world._unlocked()
    value, row = checks.flag("fixed_rotation", value), world._body_row(identity)
    row["fixed_rotation"] = value
    if value:
        row["angular_velocity"] = 0.0
    refresh_mass(world, identity)
