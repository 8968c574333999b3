"""Falling asleep and waking: contacts of sleeping bodies are parked, and come back with their forces.

An island sleeps as one and wakes as one. What is parked is neither tested, nor solved, nor reported, and its pairs have
not ended.
"""

import numpy as np

from physics.dynamics.awake import is_anything_active
from physics.dynamics.islands import fall_asleep, find_sleepers_to_wake, link_islands
from physics.settings import SLEEP_TIME
from physics.tables.body import DYNAMIC
from physics.tables.counters import ISLANDS


def wake_disturbed(world, dt):
    """Wake the islands that something touches, pushes or moves away from under."""
    bodies = world.bodies
    if bodies["awake"].all():
        return
    flags = np.zeros(len(bodies), bool)
    if find_sleepers_to_wake(bodies, world.found_contacts, world.parked, dt, flags):
        wake(world, flags)


def wake(world, flags):
    """Wake the islands of the flagged BODY rows: their contacts come back into the step."""
    bodies = world.bodies
    asleep = (bodies["kind"] == DYNAMIC) & ~bodies["awake"] & ~bodies["quarantined"]
    woken = asleep & (flags | np.isin(bodies["island"], bodies["island"][flags & asleep & (bodies["island"] >= 0)]))
    if not woken.any():
        return
    bodies["awake"][woken] = True
    bodies["sleep_time"][woken] = 0.0
    bodies["island"][woken] = -1
    back = woken[world.parked["body_row_a"]] | woken[world.parked["body_row_b"]]
    if back.any():
        found = world.found_contacts
        known = found["shape_a"] << 32 | found["shape_b"]
        again = world.parked[back]
        again = again[~np.isin(again["shape_a"] << 32 | again["shape_b"], known)]
        world.found_contacts = in_order(np.concatenate([found, again]))
        world.parked = world.parked[~back]


def wake_ids(world, ids):
    """Wake the islands of bodies by id, and of what touches them: a support that is moved, changed or taken away."""
    if not world.effects.sleeping or world.bodies["awake"].all():
        return
    bodies = world.bodies
    parked = world.parked
    near = np.isin(parked["body_a"], ids) | np.isin(parked["body_b"], ids)
    flags = np.isin(bodies["id"], ids)
    flags[parked["body_row_a"][near]] = True
    flags[parked["body_row_b"][near]] = True
    wake(world, flags)


def wake_all(world):
    """Wake everything: gravity, or the solver, changed."""
    if world.effects.sleeping:
        wake(world, np.ones(len(world.bodies), bool))


def rest(world, dt):
    """Let islands fall asleep that have been slow for long enough; park the contacts between what does not move."""
    bodies, contacts = world.bodies, world.found_contacts
    if not is_anything_active(bodies):
        return
    parents, least = world.scratch_rows(len(bodies)), np.empty(len(bodies))
    world.profile.work[ISLANDS] = link_islands(bodies, contacts, parents)
    if not fall_asleep(contacts, parents, dt, world.tolerances.sleep_speed, SLEEP_TIME, least, bodies):
        return
    still = (bodies["kind"] != DYNAMIC) | ~bodies["awake"]
    parking = still[contacts["body_row_a"]] & still[contacts["body_row_b"]] & ~contacts["sensor"]
    touching = parking & ((contacts["separation"] <= world.tolerances.slop) | (contacts["normal_impulse"] > 0.0))
    world.parked = in_order(np.concatenate([world.parked, contacts[touching]]))
    world.found_contacts = contacts[~parking]


def in_order(contacts) -> np.ndarray:
    """Contacts in the order of their shape ids; those of a pair keep theirs."""
    return contacts[np.lexsort((np.arange(len(contacts)), contacts["shape_b"], contacts["shape_a"]))]


def forget(world):
    """Drop the kept contacts of bodies and shapes that are gone; refresh the rows of the others."""
    bodies, shapes = np.append(world.bodies["id"], -1), np.append(world.shapes["id"], -1)  # no id is -1
    world.found_contacts, world.parked = (
        _refreshed(each, bodies, shapes) for each in (world.found_contacts, world.parked)
    )


def _refreshed(contacts, bodies, shapes):
    if not len(contacts):
        return contacts
    there, rows = np.ones(len(contacts), bool), {}
    for side in "ab":
        for ids, name, row in ((bodies, "body_", "body_row_"), (shapes, "shape_", "row_")):
            rows[row + side] = np.searchsorted(ids[:-1], contacts[name + side])
            there &= ids[rows[row + side]] == contacts[name + side]
    contacts = contacts[there]
    for row, found in rows.items():
        contacts[row] = found[there]
    return contacts
