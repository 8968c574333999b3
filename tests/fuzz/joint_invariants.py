"""Invariants of joints, checked after every line: tables and handles, broken joints, contacts, separations, energy."""

import math
import re

import numpy as np

from game.invariants.bodies import Bodies
from physics.joints.kinds import KINDS
from physics.settings import PUSH_SPEED  # [rad/s] for angles
from physics.tables.joint import ANGLE, COUPLED_STATE, GEARED, PINNED, STATE, WORLD
from tests.fuzz.invariants import hold

ENDLESS = ("lower", "upper", "point_max", "angle_max", "break_force", "break_torque")  # may be infinite
NUMBERS = [name for name, kind in (*STATE, *COUPLED_STATE) if kind is np.float64]
COLUMNS = [name for name, _ in (*STATE, *COUPLED_STATE)]
KINEMATIC = 1
ASKED = re.compile(r"^(?:world\.remove_joints\(\[)?(j\d+|world\.joint\(\d+\))(?:\.remove\(\)|\]\))$")
GAIN = 4.0  # kinetic energy over all that was there at the start or came in, at most
HASTE = 4.0  # path of a body over that at its greatest speed before and after the step, at most
APART = 2.0  # slops that bodies may overlap by
FAR = 100.0  # [px] path in a step up to which the energy of a motor is bounded
ROUNDING = 1e-9  # share of the coordinates by which a reported separation may be wrong


class JointWatch:
    """Checks of the joints of one world; it has a copy of the joints and bodies before the last line.

    lost: ids of the joints that were removed with a body or another joint, and that the next step must report.
    """

    def __init__(self, world):
        self.world, self.lost, self.kept, self.account = world, set(), None, None
        self.before()

    def before(self):
        """Record the bodies and joints before a line. Return the state that a refused call must not change."""
        world = self.world
        self.rows, self.bodies, self.time = world.joints.copy(), Bodies(world), world.time
        self.forced = any(world.bodies[name].any() for name in ("force_x", "force_y", "torque"))
        return [self.rows[name].tobytes() for name in COLUMNS], frozenset(self.lost)

    def unchanged(self, before, error):
        """Raise Broken if a call that raised an error has changed the joints. before: result of `before`."""
        hold(self.before() == before, "a wrong call changes no joint", repr(error))
        self.handles()

    def after_edit(self, line, space):
        """Check the invariants after a line that is not a step. space: the namespace of the program."""
        before, now = set(self.rows["id"].tolist()), set(self.world.joints["id"].tolist())
        if line.startswith("kept ="):
            self.kept = set(self.lost)
        if line == "world.restore(kept)":
            self.lost = set(self.kept)
        else:
            self.lost |= before - now - asked_for(line, space)
        self.account = None
        self.handles()

    def after_step(self):
        """Check the invariants after a step."""
        self.handles()
        self.numbers()
        self.broken()
        self.contacts()
        self.separations()
        self.moves()
        self.energy()

    # --- tables and handles ----------------------------------------------------------------------------------------

    def handles(self):
        """Check that joints are in the order of ids, have two bodies of the world, and are joints of these bodies."""
        world, joints = self.world, self.world.joints
        ids, bodies = joints["id"], world.bodies["id"]
        hold((np.diff(ids) > 0).all(), "joints stand in the order of ids", ids)
        of = {identity: [] for identity in bodies.tolist()}
        for row in joints:
            a, b = int(row["body_a"]), int(row["body_b"])
            there = {WORLD, *of}
            hold(a in there and b in there, "a joint has bodies that are there", row)
            hold(a != b or row["hold"] == GEARED, "a joint has two bodies", row)
            for body in {a, b} - {WORLD}:
                of[body].append(int(row["id"]))
            joint = world.joint(int(row["id"]))
            hold(joint in world and joint.kind == KINDS[row["kind"]].__name__, "a handle names its joint", row)
            for side in ("joint_a", "joint_b") if row["hold"] == GEARED else ():
                hold(row[side] == -1 or row[side] in ids, "a gear couples joints that are there", row)
        for body in world:
            hold([joint.id for joint in body.joints] == of[body.id], "a body lists its joints", body)

    def numbers(self):
        """Check that all numbers of joints are finite, except where infinity means that there is no limit."""
        for name in NUMBERS:
            column = self.world.joints[name]
            good = ~np.isnan(column) if name in ENDLESS else np.isfinite(column)
            hold(good.all(), "numbers of joints are finite", (name, column))

    # --- broken joints ---------------------------------------------------------------------------------------------

    def broken(self):
        """Check that exactly the joints that have gone since the last step are reported, each once, with its reason."""
        told, here = self.world.events.broken, set(self.world.joints["id"].tolist())
        ids = told["joint"].tolist()
        gone = self.lost | (set(self.rows["id"].tolist()) - here)
        hold(len(set(ids)) == len(ids), "a broken joint is told once", told)
        hold(set(ids) == gone, "broken joints are told, and are gone", (told, gone))
        for row in told:
            if row["joint"] in self.lost:
                hold(row["reason"] == "removed", "what went with a body is told as removed", row)
                continue
            joint = self.rows[self.rows["id"] == row["joint"]][0]
            over = {
                "force": row["force"] > joint["break_force"],
                "torque": abs(row["torque"]) > joint["break_torque"],
                "removed": joint["hold"] == GEARED and bool({joint["joint_a"], joint["joint_b"]} & gone),
            }
            hold(over[str(row["reason"])], "a joint breaks for its reason", (row, joint))
        self.lost = set()

    # --- contacts --------------------------------------------------------------------------------------------------

    def contacts(self):
        """Check that no two bodies of a joint that keeps them apart have a contact."""
        rows = self.rows
        rows = rows[rows["enabled"] & ~rows["contacts"] & (rows["body_a"] != rows["body_b"])]
        apart = {frozenset(pair) for pair in zip(rows["body_a"].tolist(), rows["body_b"].tolist(), strict=True)}
        for each in self.world.contacts:
            pair = frozenset((int(each["body_a"]), int(each["body_b"])))
            hold(pair not in apart, "a joint keeps its bodies apart", each)

    # --- separations -----------------------------------------------------------------------------------------------

    def separations(self):
        """Check that a reported separation is the distance of the anchors."""
        bodies = self.world.bodies
        scale = 1.0 + np.abs(bodies["x"]).max(initial=0.0) + np.abs(bodies["y"]).max(initial=0.0)
        for row in self.world.joints:
            joint = self.world.joint(int(row["id"]))
            hold(row["separation"] >= 0.0, "a separation is at least 0", row)
            if row["hold"] == PINNED and row["follows_point"]:
                (ax, ay), (bx, by) = joint.anchor_a, joint.anchor_b
                apart = math.hypot(bx - ax, by - ay)
                wrong = abs(apart - row["separation"])
                hold(wrong <= ROUNDING * (scale + apart), "a separation is the distance of the anchors", (apart, row))

    def moves(self):
        """Check that jointed bodies move no further than their speeds, and the speeds that remove errors, can tell.

        Joints that contradict one another must not throw a body, not even if it is at rest again after the step.
        """
        world, before, now = self.world, self.bodies, Bodies(self.world)
        if not np.array_equal(now.ids, before.ids) or len(world.events.quarantined):
            return
        rows, dt = self.rows[self.rows["enabled"]], world.time - self.time
        arms = [np.hypot(rows[f"local_{side}x"], rows[f"local_{side}y"]).max(initial=0.0) for side in "ab"]
        arms += [np.hypot(before.x, before.y).max(initial=0.0)]
        jointed = np.isin(now.ids, np.concatenate([rows["body_a"], rows["body_b"]])) & now.dynamic
        pushed = now.speed[now.kind == KINEMATIC].max(initial=world.tolerances.push_speed)
        speed = HASTE * (np.maximum(before.speed, now.speed) + pushed + PUSH_SPEED * sum(arms))
        speed += HASTE * np.maximum(np.abs(before.turn), np.abs(now.turn)) * world.bodies["extent"]
        allowed = dt * (speed + dt * math.hypot(*now.gravity) * np.abs(now.felt)) + world.tolerances.slop
        path = np.hypot(now.cx - before.cx, now.cy - before.cy)
        hold((path <= allowed)[jointed].all(), "joints do not throw bodies", (path, allowed))

    # --- energy ----------------------------------------------------------------------------------------------------

    def energy(self):
        """Check that the kinetic energy is at most GAIN times what was there at the last edit or came in since."""
        world, now = self.world, Bodies(self.world)
        if self.outside(now):
            self.account = None
            return
        if self.account is None:
            self.account = self.bodies.kinetic + self.springs() + self.slack()
        self.account += self.supply(now)
        allowed = GAIN * self.account
        hold(now.kinetic <= allowed, "joints add no energy", (now.kinetic, allowed, world.joint_solver))

    def outside(self, now):
        """Return whether energy came in during the step that `supply` does not count."""
        world, before = self.world, self.bodies
        same = np.array_equal(now.ids, before.ids) and np.array_equal(now.kind, before.kind)
        if not same or self.forced or len(world.events.quarantined):
            return True
        effects = world.effects
        if len(world.characters.rows) or (effects.wind and any(world.wind)):
            return True
        if effects.conveyor and world.shapes["surface_speed"].any():
            return True
        depths = world.contacts["separation"]
        deep = len(depths) and depths.min() < -APART * world.tolerances.slop
        fast = before.speed.max(initial=0.0) * (world.time - self.time) > FAR
        if self.drives() and (deep or fast):
            return True  # the energy of bodies on springs and motors has no bound in the solver
        moves = (now.kind == KINEMATIC) & ((now.numbers[:6] != before.numbers[:6]).any(axis=0) | (now.speed > 0.0))
        moves |= (now.kind == KINEMATIC) & (now.turn != 0.0)
        pushers = now.ids[moves]
        tables = (world.contacts, world.events.hits, self.rows)
        return any(np.isin(table[name], pushers).any() for table in tables for name in ("body_a", "body_b"))

    def drives(self):
        """Return whether a joint has a motor or a spring."""
        rows = self.rows[self.rows["enabled"]]
        names = ("motor_max", "spring_hertz", "point_hertz", "angle_hertz")
        return any((rows[name] > 0.0).any() for name in names) or not rows["follows_point"].all()

    def slack(self):
        """Return the energy of all bodies at the greatest speed at which overlaps are removed."""
        speed = self.world.tolerances.push_speed
        return 0.5 * float((self.bodies.mass * speed**2 + self.bodies.inertia * PUSH_SPEED**2).sum())

    def springs(self):
        """Return an upper bound of the energy in springs before the step, and of what joints need to remove errors."""
        rows, found = self.rows, 0.0
        at = {identity: k for k, identity in enumerate(self.bodies.ids.tolist())}
        for row in rows:
            sides = [at[int(row[name])] for name in ("body_a", "body_b") if row[name] != WORLD]
            sides = [k for k in sides if self.bodies.dynamic[k]]
            if not sides or not row["enabled"]:
                continue
            mass = min(self.bodies.mass[k] for k in sides)
            arm = max(math.hypot(row[f"local_{side}x"], row[f"local_{side}y"]) for side in "ab")
            arm += max(float(self.world.bodies["extent"][k]) for k in sides)
            turning = max(self.bodies.inertia[k] + self.bodies.mass[k] * arm**2 for k in sides)
            found += 0.5 * turning * PUSH_SPEED**2
            value = row["angle"] if row["coordinate"] == ANGLE else row["translation"]
            for hertz, error, of in (
                (row["spring_hertz"], value - row["spring_target"], turning if row["coordinate"] == ANGLE else mass),
                (row["point_hertz"], row["separation"], mass),
                (row["angle_hertz"], row["angle"], turning),
            ):
                found += 0.5 * of * (2.0 * math.pi * hertz * error) ** 2
        return found

    def supply(self, now):
        """Return an upper bound of the energy that gravity, motors and closing gaps gave to the bodies in the step."""
        before, rows, dt = self.bodies, self.rows, self.world.time - self.time
        pull = math.hypot(*now.gravity) * np.abs(now.felt)
        path = np.hypot(now.cx - before.cx, now.cy - before.cy)
        fallen = float((now.mass * pull * (path + 0.5 * pull * dt**2)).sum())
        driven = rows["motor_max"] * np.abs(rows["motor_speed"])
        moved = np.where(rows["follows_point"], 0.0, rows["point_max"]) * np.hypot(rows["target_vx"], rows["target_vy"])
        turned = np.where(rows["follows_angle"], 0.0, rows["angle_max"]) * np.abs(rows["target_spin"])
        return fallen + dt * float((driven + moved + turned).sum())


def asked_for(line, space):
    """Return the ids of the joints that a line removes by name; joints that go with them are not included.

    space: the namespace of the program.
    """
    found = ASKED.match(line)
    if not found:
        return set()
    name = found[1]
    return {space[name].id if name in space else int(name[len("world.joint(") : -1])}
