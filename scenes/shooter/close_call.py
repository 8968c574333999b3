"""Near misses: boxes that overlap while no pixel is shared. The difference that pixel masks make, counted."""

import numpy as np

from scenes.shooter.cast import BULLET, ENEMY


def close_calls(world, identity):
    """Ids of the enemies and bullets whose box overlaps that of a body, in the last step, without a hit."""
    shapes = world.shapes
    own = np.flatnonzero(shapes["body"] == identity)
    pairs = world.candidates
    mine = np.isin(pairs, shapes["id"][own])
    others = pairs[mine.any(axis=1) & ~mine.all(axis=1)]
    if not len(others):
        return set()
    others = others[~np.isin(others, shapes["id"][own])]
    rows = np.searchsorted(np.ascontiguousarray(shapes["id"]), others)
    rows = rows[(shapes["membership"][rows] & (ENEMY | BULLET)) != 0]
    box, other = shapes[own[0]], shapes[rows]
    # Open boxes: an edge that only touches an edge is nothing to be proud of.
    over = ((other["min_x"] < box["max_x"]) & (other["max_x"] > box["min_x"])
            & (other["min_y"] < box["max_y"]) & (other["max_y"] > box["min_y"]))
    contacts = world.contacts
    touching = contacts["body_a"][contacts["body_b"] == identity], contacts["body_b"][contacts["body_a"] == identity]
    return set(other["body"][over].tolist()).difference(*(each.tolist() for each in touching))
