"""The stages of a world whose bodies pile up: contacts are found where a step begins, solved, and carried to its end.

Found first, so that a stack is pushed where it touches and not where it would have sunk to; carried to the final poses
from their anchors, not detected twice.
"""

import math
from collections.abc import Callable
from typing import NamedTuple

import numpy as np

from physics.broadphase.fat_rectangles import update_fat_rectangles
from physics.character.push import press, tell_weight
from physics.collision.approach import measure_approach
from physics.collision.dispatch import SENSORS, SOLIDS, NarrowPhase
from physics.collision.persist import carry_over, follow_bodies, mix_materials
from physics.dynamics import sleep
from physics.dynamics.awake import is_anything_active
from physics.dynamics.graph import color_groups, group_contacts, order_groups
from physics.dynamics.integrate import refresh_centers
from physics.settings import AABB_MARGIN, AABB_MARGIN_FRACTION, COLORS
from physics.shapes.placement import refresh_aabbs
from physics.shapes.rasters import add_missing_rasters
from physics.solver import sequential_impulse, soft_step
from physics.solver.bounce import restore_bounces
from physics.solver.prepare import (
    make_gather,
    make_prepare,
    make_substep_positions,
    make_substep_velocities,
    make_warm_start,
    scatter_motions,
    store_impulses,
)
from physics.tables.body import DYNAMIC
from physics.tables.constraint import CONSTRAINT, MOTION

SOLVE = {"sequential_impulse": sequential_impulse.solve, "soft_step": soft_step.solve}
BOTH = (False, True)
GATHER = {(g, w, r): make_gather(gravity=g, wind=w, rotation=r) for g in BOTH for w in BOTH for r in BOTH}
SUBSTEP_VELOCITIES = {(d, r): make_substep_velocities(drag=d, rotation=r) for d in BOTH for r in BOTH}
SUBSTEP_POSITIONS = {r: make_substep_positions(rotation=r) for r in BOTH}
PREPARE = {(f, c): make_prepare(friction=f, conveyor=c) for f in BOTH for c in BOTH}
WARM_START = {r: make_warm_start(rotation=r) for r in BOTH}


class Passes(NamedTuple):
    """The passes that every stacking solver calls, compiled for the effects of a world."""

    velocities: Callable
    positions: Callable
    warm_start: Callable


def passes_for(effects) -> Passes:
    return Passes(
        SUBSTEP_VELOCITIES[effects.drag, effects.rotation],
        SUBSTEP_POSITIONS[effects.rotation],
        WARM_START[effects.rotation],
    )


class Room:
    """Arrays that a solve needs, grown and used again."""

    def __init__(self):
        self.motions, self.constraints = np.zeros(16, MOTION), np.zeros(16, CONSTRAINT)
        self.groups, self.ordered = np.zeros((16, 2), np.int32), np.zeros((16, 3), np.int32)
        self.colors, self.taken = np.zeros(16, np.int32), np.zeros(16, np.int64)
        self.degrees = np.zeros(16, np.int64)
        self.starts, self.cursors = np.zeros(COLORS + 2, np.int64), np.zeros(COLORS + 2, np.int64)

    def grow(self, bodies: int, contacts: int):
        if len(self.motions) < bodies:
            self.motions, self.taken = np.zeros(2 * bodies, MOTION), np.zeros(2 * bodies, np.int64)
            self.degrees = np.zeros(2 * bodies, np.int64)
        if len(self.constraints) < contacts:
            n = 2 * contacts
            self.constraints, self.colors = np.zeros(n, CONSTRAINT), np.zeros(n, np.int32)
            self.groups, self.ordered = np.zeros((n, 2), np.int32), np.zeros((n, 3), np.int32)


def update_rectangles(world, dt):
    """Bring the tight boxes, and the rectangles that no longer fit, up to date."""
    refresh_aabbs(world.library.tables, world.bodies, world.shapes)
    pairs, tolerances = world.pairs, world.tolerances
    if len(pairs.changed) < len(world.shapes):
        pairs.changed = np.zeros(2 * len(world.shapes), np.int64)
    gravity = world.gravity if world.effects.gravity else (0.0, 0.0)
    world.changed_count = update_fat_rectangles(
        world.bodies,
        world.shapes,
        *gravity,
        dt,
        tolerances.speculative,
        AABB_MARGIN * tolerances.pixels_per_meter,
        AABB_MARGIN_FRACTION,
        pairs.proxies,
        pairs.changed,
    )


def bear_characters(world):
    """Before a step: characters weigh on what they ride, and wake it when they came, left or walked."""
    characters, bodies = world.characters.rows, world.bodies
    if not len(characters):
        return
    world.refresh_character_rows()
    if world.effects.sleeping:
        own = bodies[characters["body_row"]]
        new = characters["riding"] != characters["pressed"]
        stirred = new | (own["x"] != own["previous_x"]) | (own["y"] != own["previous_y"])
        ids = np.concatenate([characters["riding"][stirred], characters["pressed"][new]])
        sleep.wake_ids(world, ids[np.isin(ids, bodies["id"][bodies["kind"] == DYNAMIC])])
    characters["pressed"] = characters["riding"]
    press(
        world.shapes,
        *(world.gravity if world.effects.gravity else (0.0, 0.0)),
        world.tolerances.sleep_speed,
        characters,
        bodies,
    )


def narrow_phase(effects):
    """Contacts where the step begins, up to the speculative distance, with the forces of the step before."""
    narrow = NarrowPhase(full_masks=True, one_way=effects.one_way, boxes_only=not effects.narrowphase)

    def run(world, dt):
        tolerances, rows = world.tolerances, world.pairs.rows
        previous = world.found_contacts
        if effects.sleeping and not is_anything_active(world.bodies):
            world.found_contacts = previous[:0]
            sleep.wake_disturbed(world, dt)
            return
        contacts = narrow.collide(
            world.library.tables,
            world.bodies,
            world.shapes,
            rows,
            len(rows),
            tolerances.speculative,
            0.1 * tolerances.slop,
            world.profile.work,
            SOLIDS,
            previous,
            tolerances.recycle,
        )
        carry_over(world.bodies, world.shapes, previous, contacts)
        mix_materials(world.library.tables, world.shapes, contacts)
        measure_approach(world.bodies, contacts)
        world.found_contacts = contacts
        if effects.sleeping:
            sleep.wake_disturbed(world, dt)

    return run


def solve_contacts(effects, solver):
    """Group, colour and solve the contacts; move the bodies; carry the contacts to the final poses."""
    solve, passes, room = SOLVE[solver], passes_for(effects), Room()
    gather = GATHER[effects.gravity, effects.wind, effects.rotation]
    prepare = PREPARE[effects.friction, effects.conveyor]

    def run(world, dt):
        bodies, contacts, work, tolerances = world.bodies, world.found_contacts, world.profile.work, world.tolerances
        if effects.sleeping and not is_anything_active(bodies):
            return
        room.grow(len(bodies), len(contacts))
        motions, constraints = room.motions[: len(bodies)], room.constraints
        gather(bodies, *world.gravity, world.drag, *world.wind, motions, work)
        if len(world.characters.rows):
            motions["walks"][world.characters.rows["body_row"]] = ~world.characters.rows["wedged"]
        if dt > 0.0:
            count = group_contacts(motions, contacts, room.groups)
            color_groups(
                motions,
                contacts,
                room.groups,
                count,
                room.taken[: len(bodies)],
                room.degrees[: len(bodies)],
                room.colors,
                room.starts,
            )
            order_groups(room.groups, count, room.colors, room.starts, room.cursors, room.ordered)
            h = dt if solver == "sequential_impulse" else dt / world.substeps
            prepare(bodies, motions, room.degrees, room.ordered, count, h, contacts, constraints, work)
            solve(effects, passes, tolerances, world.substeps, dt, world.drag, count, motions, constraints)
            if effects.restitution:
                restore_bounces(contacts, tolerances.restitution_speed, count, motions, constraints, work)
            store_impulses(constraints, count, 1.0 / h, contacts)
            if len(world.characters.rows) and effects.gravity:
                tell_weight(world.characters.rows, dt * math.hypot(*world.gravity), contacts)
        scatter_motions(motions, bodies)
        refresh_centers(bodies)
        follow_bodies(bodies, contacts)
        # Who was pushed round stands at an angle that was not foreseen.
        add_missing_rasters(world, 0.0)

    return run


def sense(effects):
    """Sensors see the final poses."""
    narrow = NarrowPhase(full_masks=False, one_way=effects.one_way, boxes_only=not effects.narrowphase)

    def run(world, dt):
        refresh_aabbs(world.library.tables, world.bodies, world.shapes)
        rows = world.pairs.rows
        contacts = narrow.collide(
            world.library.tables, world.bodies, world.shapes, rows, len(rows), 0.0, 0.0, world.profile.work, SENSORS
        )
        swept = world.swept_sensors
        if len(swept):
            known = contacts["shape_a"] << 32 | contacts["shape_b"]
            swept = swept[~np.isin(swept["shape_a"] << 32 | swept["shape_b"], known)]
            contacts = sleep.in_order(np.concatenate([contacts, swept]))
            world.swept_sensors = swept[:0]
        measure_approach(world.bodies, contacts)
        world.sensed = contacts

    return run
