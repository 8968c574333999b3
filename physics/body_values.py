"""The values of a body are read and changed here: material, filter, sensor flag, continuous mode, fixed rotation."""

import numpy as np

from physics import checks
from physics.annotations import ContinuousName
from physics.edit import checked_continuous, checked_sensor, refresh_mass, write_material
from physics.hints import MATERIALS
from physics.islands import sleep
from physics.shapes.shape import Filter, Material, checked_filter, checked_material
from physics.world_state import WorldState


def _own_rows(world, at, own) -> np.ndarray:
    """Return the row numbers of a body's shapes without a value of their own.

    at: row of the body; own: which value, "own_material", "own_filter" or "own_sensor".
    """
    rows = world._shape_rows(at)
    return rows[~world.shapes[own][rows]]


def material_of(world: WorldState, identity: int) -> Material:
    """Return the material of a body. Shapes without a material of their own have it. identity: id of the body."""
    given = world._definitions.rows[world._row_number(identity)]
    return Material(*(given[name].item() for name in MATERIALS))


def filter_of(world: WorldState, identity: int) -> Filter:
    """Return the collision filter of a body. Shapes without a filter of their own have it. identity: id of the body."""
    given = world._definitions.rows[world._row_number(identity)]
    return Filter(given["membership"].item(), given["mask"].item())


def set_material(world: WorldState, identity: int, value: Material) -> None:
    """Set the material of a body. Shapes without a material of their own get it.

    Raises TypeError for anything but a Material.
    """
    world._unlocked()
    value = checked_material(value)
    at = world._row_number(identity)
    write_material(world._definitions.rows[at : at + 1], value)
    for row in _own_rows(world, at, "own_material"):
        write_material(world.shapes[row : row + 1], value)
    refresh_mass(world, identity)


def set_filter(world: WorldState, identity: int, value: Filter) -> None:
    """Set the filter of a body. Shapes without a filter of their own get it.

    Raises TypeError for anything but a Filter.
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
    """Set whether the shapes of a body without a sensor value of their own are sensors.

    Raises the errors of checked_sensor.
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
    """Set the mode of continuous collision of a body. Raises the errors of checked_continuous."""
    world._unlocked()
    swept, row = checked_continuous(world, value), world._body_row(identity)
    row["continuous"] = swept


def set_fixed_rotation(world: WorldState, identity: int, value: bool) -> None:
    """Set whether impulses leave the rotation unchanged. True also stops the rotation.

    Raises TypeError for anything but a bool. identity: id of the body.
    """
    world._unlocked()
    value, row = checks.flag("fixed_rotation", value), world._body_row(identity)
    row["fixed_rotation"] = value
    if value:
        row["angular_velocity"] = 0.0
    refresh_mass(world, identity)
