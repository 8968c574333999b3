"""Invariants checked after every line of every program: numbers, normals, handles, events, contacts.

The checks read the tables and call public functions; they do not depend on the implementation of a step.
"""

import numpy as np

from game.invariants.numbers import not_finite, not_unit
from game.invariants.pairs import disagreement, looks_only
from game.invariants.sample import pair_of
from physics.shapes.values import Convex
from tests.stability.invariants import pulling

STATIC, DYNAMIC = 0, 2


class Broken(AssertionError):
    """Error: an invariant does not hold; it has the name of the invariant and the values found."""

    def __init__(self, name, found=""):
        super().__init__(f"{name}: {found}")
        self.name = name


def hold(condition, name, found=""):
    """Raise Broken with this name and these values unless the condition holds."""
    if not condition:
        raise Broken(name, found)


class Watch:
    """Checks of one world's invariants; it tracks the pairs that have begun to touch."""

    def __init__(self, world):
        self.world = world
        self.touching, self.sensing = set(), set()
        self.kept = None  # the two, when the snapshot was taken

    def before(self):
        """Return the state that a refused call must not change."""
        return self.world.digest()

    def unchanged(self, before, error):
        """Raise Broken if a call that raised an error has changed the world. before: result of `before`."""
        hold(self.world.digest() == before, "a wrong call changes nothing", repr(error))
        self.handles()

    def after_edit(self, line, space):
        """Check the invariants after a line that is not a step."""
        if line.startswith("kept ="):
            self.kept = set(self.touching), set(self.sensing)
        if line == "world.restore(kept)":
            self.touching, self.sensing = set(self.kept[0]), set(self.kept[1])
        self.handles()

    def after_step(self):
        """Check the invariants after a step."""
        self.numbers()
        self.handles()
        self.contacts()
        self.touching = self.events(self.touching, "begin", "end", "persist")
        self.sensing = self.events(self.sensing, "sensor_begin", "sensor_end", None)
        self.contacts_begin()
        if looks_only(self.world):
            self.as_the_shapes_are()

    def alike(self, twin):
        """Raise Broken if `twin`, a world restored from a snapshot of this one, differs from this world."""
        hold(twin.digest() == self.world.digest(), "a restored world goes on alike")

    # --- numbers ---------------------------------------------------------------------------------------------------

    def numbers(self):
        """Check that numbers are finite (U1) and normals have unit length (U2), also of sleeping contacts, and that no
        contact pulls.
        """
        world = self.world
        for name, bad in (
            ("numbers are finite", not_finite(world, sleeping=True)),
            ("normals are of unit length", not_unit(world, sleeping=True)),
        ):
            hold(bad is None, name, bad)
        pulls = pulling(world)
        hold(len(pulls) == 0, "contacts push", pulls)

    # --- handles ---------------------------------------------------------------------------------------------------

    def handles(self):
        """Check that the tables, the bodies and the shapes list the same bodies and shapes."""
        world = self.world
        ids, shapes = world.bodies["id"], world.shapes
        hold((np.diff(ids) > 0).all(), "bodies stand in the order of ids", ids)
        hold([body.id for body in world] == ids.tolist() and len(world) == len(ids), "a world lists its bodies")
        rows = shapes["body_row"]
        hold(((rows >= 0) & (rows < len(ids))).all(), "shapes have a body", rows)
        hold((ids[rows] == shapes["body"]).all(), "shapes know their body's row")
        for body in world:
            own = body.shape_ids
            hold(body in world and body.id in world and world.body(body.id) == body, "a body is in its world")
            hold(len(own) == len(body.shapes), "a body has an id for each shape", (own, body.shapes))
            hold(set(own) <= set(shapes["id"][shapes["body"] == body.id].tolist()), "shape ids are its own")
            row = world.bodies[world.rows([body.id])[0]]
            told, held = (*body.position, body.angle), tuple(row[["x", "y", "angle"]])
            hold(np.array_equal(told, held, equal_nan=True), "a handle says what the row says", (told, held))
            if row["kind"] == DYNAMIC and body.shapes:
                hold(body.mass > 0.0, "what is dynamic has mass", (body.mass, body.inertia))
            if row["kind"] == STATIC:
                still = row["vx"] == row["vy"] == row["angular_velocity"] == 0.0
                hold(still, "what is static does not move", row)

    # --- contacts and events ---------------------------------------------------------------------------------------

    def contacts(self):
        """Check that candidates and contacts have existing shapes of two bodies that may collide (invariant U10)."""
        world = self.world
        pairs = world.candidates
        once = len(np.unique(pairs, axis=0)) == len(pairs) and (pairs[:, 0] < pairs[:, 1]).all()
        hold(once and np.isin(pairs, world.shapes["id"]).all(), "candidates are of what is there, each once", pairs)
        for rows in (world.contacts, world.sleeping_contacts):
            for row in rows:
                a, b = int(row["shape_a"]), int(row["shape_b"])
                hold(a < b, "A is the shape with the smaller id", (a, b))
                one, two = self._shape(a), self._shape(b)
                hold(one["body"] == row["body_a"] and two["body"] == row["body_b"], "a contact knows its bodies", row)
                hold(one["body"] != two["body"], "no body meets itself", row)
                kinds = world.bodies["kind"][[one["body_row"], two["body_row"]]]
                hold((kinds != STATIC).any(), "two that are static do not meet", row)
                meet = one["membership"] & two["mask"] and two["membership"] & one["mask"]
                hold(bool(meet), "filters are kept", row)
                hold(not one["sensor"] and not two["sensor"], "sensors have no contacts", row)

    def _shape(self, identity):
        found = self.world.shapes[self.world.shapes["id"] == identity]
        hold(len(found) == 1, "told is only of shapes that are there", identity)
        return found[0]

    def events(self, before, begin, end, persist):
        """Check that each pair begins only if it did not touch, then persists or ends. Return the pairs that touch now.

        before: pairs that touched before. begin, end, persist: names of the event arrays (persist may be None).
        """
        told = {name: self._pairs(name) for name in (begin, end, persist) if name}
        for name, pairs in told.items():
            hold(len(set(pairs)) == len(pairs), f"{name} is told once of a pair", pairs)
        hold(not before & set(told[begin]), f"{begin} is told of what did not touch", before & set(told[begin]))
        now = before | set(told[begin])
        hold(now >= set(told[end]), f"{end} is told of what touched", set(told[end]) - now)
        now -= set(told[end])
        here = set(self.world.shapes["id"].tolist())
        gone = {pair for pair in now if not set(pair) <= here}
        hold(not gone, f"{end} is told of what is gone", gone)
        if persist:
            hold(set(told[persist]) <= now - set(told[begin]), "persist is told of what goes on", told[persist])
        return now

    def _pairs(self, name):
        rows = getattr(self.world.events, name)
        return list(zip(rows["shape_a"].tolist(), rows["shape_b"].tolist(), strict=True))

    def contacts_begin(self):
        """Check that every overlapping or pushed pair has begun to touch."""
        rows = self.world.contacts
        rows = rows[(rows["separation"] <= 0.0) | (rows["normal_impulse"] > 0.0)]
        found = set(zip(rows["shape_a"].tolist(), rows["shape_b"].tolist(), strict=True))
        hold(found <= self.touching, "contacts have begun", found - self.touching)

    def as_the_shapes_are(self):
        """Check invariant U10 in worlds without response: two shapes have a contact exactly if their distance is at
        most 0.
        """
        world, placed = self.world, []
        for body in world:
            row = world.bodies[world.rows([body.id])[0]]
            for identity, shape in zip(body.shape_ids, body.shapes, strict=True):
                if isinstance(shape, Convex) and not row["quarantined"]:
                    placed.append((identity, row))
        placed.sort(key=lambda each: each[0])
        for at, (a, row_a) in enumerate(placed):
            for b, row_b in placed[at + 1 :]:
                one, two = self._shape(a), self._shape(b)
                meet = one["membership"] & two["mask"] and two["membership"] & one["mask"]
                if row_a["id"] == row_b["id"] or not meet or row_a["kind"] == row_b["kind"] == STATIC:
                    continue
                pair = pair_of(world, a, b)
                found = pair and disagreement(world, pair)
                hold(not found, "contacts are of what overlaps", (a, b, found))
