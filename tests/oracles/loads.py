"""The contacts whose cached forces must be cleared when bodies are removed, found by a search over all contacts."""

import math

import numpy as np

from physics.settings import BLOW
from physics.tables.table import rows_of

FORCES = ("normal_force_1", "tangent_force_1", "normal_force_2", "tangent_force_2", "rolling_force")


def forget_loads(world, ids):
    """Clear the cached forces of all contacts in a pile from which a heavy load is removed.

    ids: ids of the removed bodies. A removed body is a heavy load if its contact force accelerates the body below by
    more than BLOW times gravity. The pile consists of that body and all others that it touches, directly or through
    others, up to static bodies.
    """
    contacts, bodies = world.contact_rows, world.bodies
    ids_a, ids_b = contacts["body_a"], contacts["body_b"]
    going_a, going_b = np.isin(ids_a, ids), np.isin(ids_b, ids)
    lost = going_a != going_b
    left = rows_of(bodies, np.where(going_a, ids_b, ids_a)[lost])
    force = (contacts["normal_force_1"] + np.where(contacts["count"] == 2, contacts["normal_force_2"], 0.0))[lost]
    reached = np.zeros(len(bodies), bool)
    blow = BLOW * math.hypot(*world.gravity)
    reached[left[(force > 0.0) & (force * bodies["inverse_mass"][left] > blow)]] = True
    row_a, row_b, loose = rows_of(bodies, ids_a), rows_of(bodies, ids_b), bodies["inverse_mass"] > 0.0
    inner = loose[row_a] & loose[row_b] & ~(going_a | going_b)
    a, b = row_a[inner], row_b[inner]
    while (reached[a] != reached[b]).any():
        reached[a[reached[b]]] = True
        reached[b[reached[a]]] = True
    for name in FORCES:
        contacts[name][reached[row_a] | reached[row_b]] = 0.0
