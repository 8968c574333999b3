"""The stage after a stacking solver that stops fast bodies at what they meet on their way.

The solver moves everybody; then each fast body is swept from where it was to where it is. It is put back to where it
first met something, and keeps its velocity: the contact of the next step takes the impact, with its whole speed.
"""

import numpy as np

from physics.ccd.impacts import find_fast, find_turning_impacts, foresee_paths, list_paths, move_back
from physics.ccd.linear import find_impacts_by_mode, stop_at_impacts
from physics.ccd.rotational import new_turning_room
from physics.collision.approach import measure_approach
from physics.collision.contacts import new_scratch, write_impacts
from physics.collision.persist import follow_bodies
from physics.dynamics.sleep import in_order
from physics.settings import IMPACT_ROUNDS
from physics.shapes.placement import refresh_aabbs
from physics.shapes.rasters import add_missing_rasters
from physics.tables.body import DYNAMIC, RAY, SWEPT
from physics.tables.contact import CONTACT
from physics.tables.counters import CAP_HITS

SAME_FRACTION = 1e-9  # of a step


class Sweeper:
    """Room for the sweeps of one world."""

    def __init__(self, one_way: bool):
        self.one_way = one_way
        self.paths, self.cuts = np.zeros((16, 6)), np.zeros((16, 6))
        self.fast = np.zeros(16, bool)
        self.impacts = np.zeros((16, 5))
        self.turning, self.scratch = new_turning_room(), new_scratch()

    def run(self, world, dt):
        """Find the fast bodies, what they meet, and put them there."""
        bodies, work = world.bodies, world.profile.work
        world.impact_ghosts = None
        fast, paths = self._room(len(bodies))
        list_paths(bodies, paths)
        found = find_fast(bodies, paths, fast)
        straight = (bodies["kind"] == DYNAMIC) & ((bodies["continuous"] == RAY) | (bodies["continuous"] == SWEPT))
        if not found and not straight.any():
            return
        refresh_aabbs(world.library.tables, bodies, world.shapes)
        self._cover(world, fast | straight)
        bodies["fraction"] = 1.0
        met = self._straight(world, dt) if straight.any() else np.zeros((0, 5))
        if found:
            met = np.concatenate([met, self._find(world, 0)])
            rounds = 0
            moving = self._find(world, 1)
            while len(moving) and self._stop(world, moving):
                rounds += 1
                if rounds == IMPACT_ROUNDS:
                    work[CAP_HITS] += 1
                    break
                moving = self._find(world, 1)
            met = np.concatenate([met, moving])
        stopped = bodies["fraction"] < 1.0
        if stopped.any():
            world.impact_ghosts = np.column_stack([bodies["id"][stopped], paths[stopped], bodies["fraction"][stopped]])
            move_back(paths, bodies)
            follow_bodies(bodies, world.found_contacts)
            add_missing_rasters(world, 0.0)
            refresh_aabbs(world.library.tables, bodies, world.shapes)
        self._tell(world, met, dt)

    def foresee(self, world, dt):
        """Impacts (n, 5) of the bodies that are about to turn or to meet what only this sweep knows, before they move."""
        bodies = world.bodies
        fast, paths = self._room(len(bodies))
        foresee_paths(bodies, dt, paths)
        if not find_fast(bodies, paths, fast):
            return np.zeros((0, 5))
        bodies["fraction"] = 1.0
        everyone = 1 if world.effects.rotation else 2
        return np.concatenate([self._look(world, 0, everyone), self._look(world, 1, everyone)])

    def _room(self, n):
        if len(self.fast) < n:
            self.paths, self.cuts, self.fast = np.zeros((2 * n, 6)), np.zeros((2 * n, 6)), np.zeros(2 * n, bool)
        return self.fast[:n], self.paths[:n]

    def _cover(self, world, rows):
        """Where a body went further than its rectangle foresaw, look for what it may have met there."""
        shapes, pairs = world.shapes, world.pairs
        own = np.flatnonzero(rows[shapes["body_row"]] & (shapes["proxy"] >= 0))
        proxies = pairs.proxies[shapes["proxy"][own]]
        s = shapes[own]
        out = (
            (s["min_x"] < proxies["lower_x"])
            | (s["max_x"] > proxies["upper_x"])
            | (s["min_y"] < proxies["lower_y"])
            | (s["max_y"] > proxies["upper_y"])
        )
        if out.any():
            pairs.widen(s[out], world.tolerances.slop)
            pairs.update(world.broadphase, shapes, int(out.sum()), world.profile.work)

    def _find(self, world, moving):
        """Impacts of the fast with what stands still (moving 0), or moves (1); those that stand still stop them at once."""
        impacts = self._look(world, moving, 0)
        if not moving:
            stop_at_impacts(world.shapes, world.pairs.rows, impacts, len(impacts), world.bodies)
        return impacts

    def _look(self, world, moving, everyone):
        rows, n = world.pairs.rows, len(world.bodies)
        if len(self.impacts) < len(rows):
            self.impacts = np.zeros((2 * len(rows), 5))
        found = find_turning_impacts(
            world.library.tables,
            world.bodies,
            world.shapes,
            rows,
            len(rows),
            self.paths[:n],
            self.fast[:n],
            moving,
            everyone,
            world.tolerances.slop,
            self.one_way,
            self.cuts[:n],
            self.turning,
            self.impacts,
            world.profile.work,
        )
        return self.impacts[:found].copy()

    def _stop(self, world, impacts):
        """Stop the bodies of these impacts. Returns whether anybody stops earlier than before."""
        before = world.bodies["fraction"].copy()
        stop_at_impacts(world.shapes, world.pairs.rows, impacts, len(impacts), world.bodies)
        # The same impact may come out a rounding earlier from the shortened paths: that stops nobody anew.
        return bool((world.bodies["fraction"] < before - SAME_FRACTION).any())

    def _straight(self, world, dt):
        """Impacts of the bodies that ask for a ray or a sweep without turning: along the way that the solver found."""
        rows = world.pairs.rows
        moved = world.bodies.copy()
        for name, velocity in (("x", "vx"), ("y", "vy")):
            moved[velocity] = (moved[name] - moved["previous_" + name]) / dt if dt > 0.0 else 0.0
            moved[name] = moved["previous_" + name]
        moved["angle"] = moved["previous_angle"]
        if len(self.impacts) < len(rows):
            self.impacts = np.zeros((2 * len(rows), 5))
        find = find_impacts_by_mode[self.one_way]
        found = find(
            world.library.tables,
            moved,
            world.shapes,
            rows,
            len(rows),
            dt,
            world.tolerances.slop,
            1,
            self.scratch,
            self.impacts,
            world.profile.work,
        )
        impacts = self.impacts[:found].copy()
        stop_at_impacts(world.shapes, rows, impacts, found, world.bodies)
        return impacts

    def _tell(self, world, met, dt):
        """Add the impacts to what touches, and to what is sensed: begun in this step, though the push comes in the next."""
        if not len(met):
            return
        room = np.zeros(len(met), CONTACT)
        found = write_impacts(world.bodies, world.shapes, world.pairs.rows, met, len(met), dt, 0, room)
        contacts = room[:found]
        # Two ways of being found are one impact.
        _, first = np.unique(contacts["shape_a"] << 32 | contacts["shape_b"], return_index=True)
        contacts = contacts[first]
        measure_approach(world.bodies, contacts)
        sensed = contacts[contacts["sensor"]]
        if len(sensed):
            world.swept_sensors = sensed
        solid = contacts[~contacts["sensor"]]
        known = world.found_contacts["shape_a"] << 32 | world.found_contacts["shape_b"]
        keys = solid["shape_a"] << 32 | solid["shape_b"]
        world.found_contacts["swept"][np.isin(known, keys)] = True
        new = solid[~np.isin(keys, known)]
        # The impact is told, with its impulse, by the contact of the next step.
        new["speed"] = 0.0
        if len(new):
            world.found_contacts = in_order(np.concatenate([world.found_contacts, new]))
