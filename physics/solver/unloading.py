"""What bore a heavy load that is gone starts from nothing: or the forces that held the load throw what lay under it.

A contact starts from the force that it ended the step before with. Where a body of a thousand times its mass has gone,
that is a thousand times what is needed now; a pass takes back what the order of contacts lets it, the rest is speed.
"""

import math
from collections.abc import Sequence

import numpy as np

from physics.settings import BLOW
from physics.tables.rows import rows_of
from physics.tables.world_tables import WorldTables

FORCES = ("normal_force_1", "tangent_force_1", "normal_force_2", "tangent_force_2", "rolling_force")


def forget_loads(tables: WorldTables, ids: Sequence[int] | np.ndarray) -> None:
    """Of bodies that are taken away, or put elsewhere: where one lay on something with many times its weight, the
    contacts of all that this is piled with, through whatever can be pushed, forget their forces.

    O(contacts · depth of the pile), in worlds that stack.
    """
    manifolds, anchors, bodies = tables.manifolds, tables.anchors, tables.bodies
    if not len(manifolds) or len(anchors) != len(manifolds):
        return  # nothing is remembered
    ids_a, ids_b = manifolds["body_a"], manifolds["body_b"]
    going_a, going_b = np.isin(ids_a, ids), np.isin(ids_b, ids)
    lost = going_a != going_b
    if not lost.any():
        return
    left = rows_of(bodies, np.where(going_a, ids_b, ids_a)[lost])
    force = (anchors["normal_force_1"] + np.where(manifolds["count"] == 2, anchors["normal_force_2"], 0.0))[lost]
    reached = np.zeros(len(bodies), bool)
    weight = math.hypot(*tables.gravity) if tables.effects.gravity else 0.0
    reached[left[(force > 0.0) & (force * bodies["inverse_mass"][left] > BLOW * weight)]] = True
    if not reached.any():
        return
    row_a, row_b, loose = rows_of(bodies, ids_a), rows_of(bodies, ids_b), bodies["inverse_mass"] > 0.0
    inner = loose[row_a] & loose[row_b] & ~(going_a | going_b)
    a, b = row_a[inner], row_b[inner]
    while (reached[a] != reached[b]).any():
        reached[a[reached[b]]] = True
        reached[b[reached[a]]] = True
    borne = reached[row_a] | reached[row_b]
    for name in FORCES:
        anchors[name][borne] = 0.0
