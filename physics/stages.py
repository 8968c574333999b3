"""The stages of a step, and which of them the declared effects call for.

A stage unpacks tables and calls kernels; it holds no loop over bodies. A stage that no effect needs is not planned: it
is not called, and its kernels are never compiled.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from physics import stacking
from physics.broadphase.pair_list import PairList
from physics.broadphase.rectangles import make_rectangle_pass
from physics.ccd import sweep as sweeps
from physics.ccd.linear import find_impacts_by_mode, stop_at_impacts
from physics.character import carry
from physics.collision.approach import advance_contacts, measure_approach, prepare_contacts
from physics.collision.contacts import new_scratch, write_impacts
from physics.collision.dispatch import NarrowPhase
from physics.collision.persist import mix_materials
from physics.dynamics import sleep
from physics.dynamics.integrate import find_broken, make_position_pass, make_velocity_pass, refresh_centers
from physics.settings import POSITION_LIMIT, PROJECTION_PASSES
from physics.shapes.placement import refresh_aabbs
from physics.shapes.rasters import add_missing_rasters
from physics.solver.blocking import stay_behind, stop_approach
from physics.solver.projection import make_projection_pass
from physics.tables.contact import CONTACT, QUARANTINE
from physics.tables.counters import CONTACTS

__all__ = ["PairList", "Stage", "plan"]

# One compiled pass per combination of effects that it depends on; made here, compiled when first run.
BOTH = (False, True)
VELOCITIES = {
    (g, d, w, r): make_velocity_pass(gravity=g, drag=d, wind=w, rotation=r)
    for g in BOTH
    for d in BOTH
    for w in BOTH
    for r in BOTH
}
POSITIONS = {r: make_position_pass(rotation=r) for r in (False, True)}
RECTANGLES = {r: make_rectangle_pass(rotation=r) for r in (False, True)}
PROJECTIONS = {
    (r, f, b): make_projection_pass(rotation=r, friction=f, restitution=b)
    for r in (False, True)
    for f in (False, True)
    for b in (False, True)
}


@dataclass(frozen=True)
class Stage:
    """A named step of the step: run(world, dt)."""

    name: str
    run: Callable


def plan(effects, solver) -> list[Stage]:
    """The stages that these effects call for, in order."""
    if solver in stacking.SOLVE:
        return _plan_piles(effects, solver)
    found = []
    if effects.gravity or effects.drag or effects.wind or effects.response:
        found.append(_velocities(effects))
    found += [_rectangles(effects), Stage("broad_phase", _broad_phase)]
    if effects.continuous:
        found.append(_impacts(effects))
    found.append(_positions(effects))
    if effects.response:
        found.append(Stage("carry", lambda world, dt: carry.carry_characters(world, dt)))
    found.append(_narrow_phase(effects))
    if effects.response and solver == "blocking":
        found.append(Stage("blocking", _blocking))
    elif effects.response:
        found.append(_projection(effects))
    found.append(_events(effects))
    return found


def _plan_piles(effects, solver):
    """The stages of a world with a solver for piles: contacts first, then the solver, which also moves the bodies."""
    found = [
        Stage("motion_rectangles", _fat_rectangles),
        Stage("broad_phase", _broad_phase),
        Stage("narrow_phase", stacking.narrow_phase(effects)),
        Stage(solver, stacking.solve_contacts(effects, solver)),
    ]
    if effects.continuous:
        found.append(Stage("time_of_impact", sweeps.Sweeper(effects.one_way).run))
    found += [Stage("carry", lambda world, dt: carry.carry_characters(world, dt))]
    if effects.sensors:
        found.append(Stage("sensors", stacking.sense(effects)))
    if effects.sleeping:
        found.append(Stage("islands", sleep.rest))
    found.append(_events(effects))
    return found


def _velocities(effects):
    integrate = VELOCITIES[effects.gravity, effects.drag, effects.wind, effects.rotation]

    def run(world, dt):
        if effects.stacking:  # under another solver for the moment
            stacking.bear_characters(world)
        integrate(*world.gravity, world.drag, *world.wind, dt, world.bodies)

    return Stage("integrate_velocities", run)


def _rectangles(effects):
    update = RECTANGLES[effects.rotation]

    def run(world, dt):
        _quarantine(world, dt)
        add_missing_rasters(world, dt)
        pairs = world.pairs
        if len(pairs.changed) < len(world.shapes):
            pairs.changed = np.zeros(2 * len(world.shapes), np.int64)
        world.changed_count = update(
            world.library.tables, world.bodies, dt, world.tolerances.slop, world.shapes, pairs.proxies, pairs.changed
        )

    return Stage("motion_rectangles", run)


def _fat_rectangles(world, dt):
    _quarantine(world, dt)
    add_missing_rasters(world, dt)
    stacking.bear_characters(world)
    stacking.update_rectangles(world, dt)


def _quarantine(world, dt):
    bodies = world.bodies
    broken = world.scratch_rows(len(bodies))
    found = find_broken(world.tolerances.speed_limit, POSITION_LIMIT, dt, bodies, broken)
    if found:
        ids = bodies["id"][broken[:found]]
        world.events.quarantined = np.array(
            [
                (each, "position, angle or velocity is not finite or beyond what a double resolves")
                for each in ids.tolist()
            ],
            QUARANTINE,
        )
        own = np.isin(world.shapes["body"], ids)
        world.pairs.free_proxies(world.shapes["proxy"][own])
        world.shapes["proxy"][own] = -1
        refresh_centers(bodies)


def _broad_phase(world, dt):
    world.pairs.update(world.broadphase, world.shapes, world.changed_count, world.profile.work)


def _impacts(effects):
    find, sweeper = find_impacts_by_mode[effects.one_way], sweeps.Sweeper(effects.one_way)

    def run(world, dt):
        bodies, shapes, rows = world.bodies, world.shapes, world.pairs.rows
        if len(world.impacts) < len(rows):
            world.impacts = np.zeros((2 * len(rows), 5))
        found = find(
            world.library.tables,
            bodies,
            shapes,
            rows,
            len(rows),
            dt,
            world.tolerances.slop,
            int(effects.rotation),
            world.impact_scratch,
            world.impacts,
            world.profile.work,
        )
        turning = sweeper.foresee(world, dt)
        if len(turning):
            world.impacts = np.concatenate([world.impacts[:found], turning])
            found += len(turning)
        world.impact_count = found
        bodies["fraction"] = 1.0
        if world.effects.response:
            stop_at_impacts(shapes, rows, world.impacts, world.impact_count, bodies)

    return Stage("time_of_impact", run)


def _positions(effects):
    integrate = POSITIONS[effects.rotation]

    def run(world, dt):
        integrate(dt, world.bodies, world.profile.work)
        refresh_centers(world.bodies)
        # What was stopped on its way may stand at an angle between the two that were foreseen.
        add_missing_rasters(world, 0.0)
        refresh_aabbs(world.library.tables, world.bodies, world.shapes)

    return Stage("integrate_positions", run)


def _narrow_phase(effects):
    narrow = NarrowPhase(full_masks=effects.response, one_way=effects.one_way, boxes_only=not effects.narrowphase)

    def run(world, dt):
        world.detect = lambda: narrow.collide(
            world.library.tables,
            world.bodies,
            world.shapes,
            world.pairs.rows,
            len(world.pairs.rows),
            world.tolerances.slop,
            0.1 * world.tolerances.slop,
            world.profile.work,
        )
        contacts = _measured(world, world.detect())
        if world.effects.continuous and world.impact_count:
            contacts = _append_impacts(world, contacts, dt)
        world.found_contacts = contacts

    return Stage("narrow_phase", run)


def _measured(world, contacts):
    measure_approach(world.bodies, contacts)
    if world.effects.response:
        prepare_contacts(world.bodies, contacts)
        mix_materials(world.library.tables, world.shapes, contacts)
        if not world.effects.conveyor:
            contacts["surface_speed"] = 0.0
    return contacts


def _append_impacts(world, contacts, dt):
    """The contacts with those of the impacts that the test at the final poses did not see, in the candidates' order."""
    room = np.zeros(world.impact_count, CONTACT)
    found = write_impacts(
        world.bodies,
        world.shapes,
        world.pairs.rows,
        world.impacts,
        world.impact_count,
        dt,
        int(world.effects.response),
        room,
    )
    met = _measured(world, room[:found])
    # Where a side went on after the impact, as a kinematic one does, what is found at the final poses may lie behind it.
    passed = met["candidate"][met["separation"] < -world.tolerances.slop]
    contacts = contacts[~np.isin(contacts["candidate"], passed)]
    # A body that ended just behind what it flew through is near it, but going away: the impact is what counts.
    seen = np.isin(contacts["candidate"], met["candidate"])
    contacts = contacts[~(seen & (contacts["speed"] <= 0.0) & (contacts["separation"] > 0.0))]
    seen = np.isin(contacts["candidate"], met["candidate"])
    contacts["swept"][seen & (contacts["speed"] > 0.0)] = True
    met = met[~np.isin(met["candidate"], contacts["candidate"])]
    both = np.concatenate([contacts, met])
    return both[np.argsort(both["candidate"], kind="stable")]


def _projection(effects):
    project = PROJECTIONS[effects.rotation, effects.friction, effects.restitution]

    def run(world, dt):
        if dt == 0.0:
            return  # no time, no motion: contacts are reported, nothing is pushed
        solid = ~world.found_contacts["sensor"]
        contacts = world.found_contacts if solid.all() else world.found_contacts[solid]
        for each in range(PROJECTION_PASSES):
            project(world.tolerances.restitution_speed, int(each == 0), world.bodies, contacts, world.profile.work)
        advance_contacts(world.bodies, contacts)
        if contacts is not world.found_contacts:
            world.found_contacts[solid] = contacts
        refresh_aabbs(world.library.tables, world.bodies, world.shapes)

    return Stage("projection", run)


def _blocking(world, dt):
    stopped = []
    contacts = world.found_contacts
    while True:
        sensors = contacts["sensor"]
        solid = contacts[~sensors]
        if not stay_behind(world.bodies, solid, world.profile.work):
            break
        stopped.append(solid[solid["swept"]])
        refresh_aabbs(world.library.tables, world.bodies, world.shapes)
        contacts = _measured(world, world.detect())
    stop_approach(world.bodies, contacts)
    if stopped:
        met = np.concatenate(stopped)
        stop_approach(world.bodies, met)
        advance_contacts(world.bodies, met)
        contacts = np.concatenate([contacts[~np.isin(contacts["candidate"], met["candidate"])], met])
        contacts = contacts[np.argsort(contacts["candidate"], kind="stable")]
    world.found_contacts = contacts


def _events(effects):
    def run(world, dt):
        contacts, events, tolerances = world.found_contacts, world.events, world.tolerances
        begin, persist, events.end, hits, keep = world._touching.compare(
            contacts, world.parked, False, tolerances.slop, tolerances.hit_speed
        )
        events.begin, events.hits = begin, hits
        if effects.persist:
            events.persist = persist
        if effects.sensors:
            sensed = contacts if world.sensed is None else world.sensed
            events.sensor_begin, _, events.sensor_end, _, _ = world._sensing.compare(
                sensed, world.parked[:0], True, 0.0, np.inf
            )
            keep = keep & ~contacts["sensor"]
        world.tell_contacts(contacts, keep)
        world.profile.work[CONTACTS] = np.count_nonzero(keep)
        bodies = world.bodies
        if effects.sleeping:
            bodies["awake"] &= ~bodies["quarantined"]
        else:
            bodies["awake"] = ~bodies["quarantined"]

    return Stage("events", run)


def impact_room():
    """Room for the sweeps of one world."""
    return np.zeros((16, 5)), new_scratch()
