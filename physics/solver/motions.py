"""Motions of bodies within a step: MOTION rows are copied from awake bodies, advanced by substeps and written back.

The stacking solvers use these rows. Row 0 of MOTION represents all bodies that do not move in this step: static bodies,
sleeping bodies, and kinematic bodies at rest.
"""

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from physics.dynamics.integrate import is_finite_in_step, is_within_limits, put_center, refresh_center
from physics.islands.graph import KINEMATIC_RANK, STATIC_RANK
from physics.jit import kernel, subkernel
from physics.math2d import norm, rotate, rotation_of
from physics.shapes.placement import add_missing_rasters
from physics.tables.body import DYNAMIC, KINEMATIC, STATIC
from physics.tables.contact import BALANCE, MOTION
from physics.tables.step_state import BODIES_INTEGRATED, StepState
from physics.tables.table import zeros_in_lines

BOTH = (False, True)


@subkernel
def kinetic_energy(motion):
    """Return the kinetic energy [density px4/s2] of a MOTION row with finite mass."""
    m = motion
    energy = 0.5 * (m.vx * m.vx + m.vy * m.vy) / m.inverse_mass
    if m.inverse_inertia > 0.0:
        energy += 0.5 * m.angular_velocity * m.angular_velocity / m.inverse_inertia
    return energy


@subkernel
def reset_motion(motion_out):
    """Set a MOTION row to its state at the start of a step: no displacement, infinite mass, no contacts."""
    m = motion_out
    m.pseudo_vx, m.pseudo_vy, m.pseudo_w = 0.0, 0.0, 0.0
    m.dx, m.dy = 0.0, 0.0
    m.cosine = 1.0
    m.sine, m.turn = 0.0, 0.0
    m.acceleration_x, m.acceleration_y, m.angular_acceleration = 0.0, 0.0, 0.0
    m.inverse_mass, m.inverse_inertia = 0.0, 0.0
    m.own_inverse_inertia, m.tension = 0.0, 0.0
    m.in_contact = False
    m.is_character = False
    m.jointed = False
    m.halves = False
    m.driven = False
    m.has_wide_gap = False
    m.estimate = 0.0
    m.branching = False
    m.capped = False
    m.last_impact = 0


@subkernel
def write_fixed(motions_out, lists_out):
    """Write row 0 of MOTION, which represents all bodies that do not move in this step.

    motions_out: MOTION rows; lists_out: MotionLists.
    """
    m = motions_out[0]
    reset_motion(m)
    m.vx, m.vy, m.angular_velocity = 0.0, 0.0, 0.0
    m.free_vx, m.free_vy = 0.0, 0.0
    m.free_w, m.cooldown = 0.0, 0.0
    m.substeps = 0
    m.moves = False
    m.is_dynamic = False
    lists_out.has_finite_mass[0] = False
    lists_out.links_islands[0] = False
    lists_out.rank[0] = STATIC_RANK


class MotionLists(NamedTuple):
    """Arrays that accompany the MOTION rows of a world: the MOTION row of each body, and facts about each row."""

    motion_of: np.ndarray  # (bodies) int32 MOTION row of each body; 0: the body does not move
    has_finite_mass: np.ndarray  # (motions) bool an impulse changes the velocity of the body
    links_islands: np.ndarray  # (motions) bool the body is dynamic: its contacts join islands
    rank: np.ndarray  # (motions) int8 contacts with a greater rank are solved later, see islands.graph.color_edges
    balance: np.ndarray  # BALANCE (motions) energy of each body, see energy.py
    by_kind: np.ndarray  # (2, motions) int32 MOTION rows of dynamic bodies (row 0) and moving kinematic bodies (row 1)


class Air(NamedTuple):
    """Gravity, drag and wind of a world."""

    gravity_x: float  # [px/s2]
    gravity_y: float
    drag: float  # [1/s]
    wind_x: float  # [px/s]
    wind_y: float


def make_gather(gravity: bool, wind: bool, rotation: bool) -> Callable:
    """Return the kernel that copies bodies to MOTION rows. gravity, wind, rotation: effects that the world has."""

    @kernel
    def gather_motions(rows, bodies, air, motions_out, lists_out, work_inout):
        """Write one MOTION row for each BODY row listed in `rows`, starting at MOTION row 1. O(rows).

        Return (number of dynamic bodies, number of moving kinematic bodies). air: see Air; lists_out: see MotionLists;
        work_inout: work counters.
        """
        write_fixed(motions_out, lists_out)
        dynamic = 0
        kinematic = 0
        for k in range(len(rows)):
            b = bodies[rows[k]]
            lists_out.motion_of[rows[k]] = k + 1
            m = motions_out[k + 1]
            m.vx, m.vy = b.vx, b.vy
            m.angular_velocity = b.angular_velocity if rotation else 0.0
            m.free_vx = m.start_vx = m.vx
            m.free_vy = m.start_vy = m.vy
            m.free_w = m.start_w = m.angular_velocity
            reset_motion(m)
            m.moves = b.kind != STATIC and b.awake and not b.quarantined
            m.is_dynamic = m.moves and b.kind == DYNAMIC
            m.substeps = b.substeps
            m.cooldown = b.cooldown
            e = lists_out.balance[k + 1]
            e.reserve = b.reserve if 0.0 <= b.reserve < math.inf else 0.0
            e.before = 0.0
            e.x, e.y = b.center_x, b.center_y
            lists_out.links_islands[k + 1] = m.is_dynamic
            lists_out.rank[k + 1] = STATIC_RANK if not m.moves else (KINEMATIC_RANK if b.kind == KINEMATIC else 0)
            lists_out.has_finite_mass[k + 1] = m.is_dynamic and b.inverse_mass > 0.0
            if m.moves:
                work_inout[BODIES_INTEGRATED] += 1
            if not m.is_dynamic:
                if m.moves:
                    lists_out.by_kind[1, kinematic] = k + 1
                    kinematic += 1
                continue
            lists_out.by_kind[0, dynamic] = k + 1
            dynamic += 1
            m.inverse_mass = b.inverse_mass
            m.inverse_inertia = m.own_inverse_inertia = b.inverse_inertia if rotation else 0.0
            m.acceleration_x = b.inverse_mass * b.force_x
            m.acceleration_y = b.inverse_mass * b.force_y
            m.angular_acceleration = m.inverse_inertia * b.torque
            if m.inverse_mass > 0.0:
                e.before = kinetic_energy(m)
            if gravity:
                m.acceleration_x += b.gravity_scale * air.gravity_x
                m.acceleration_y += b.gravity_scale * air.gravity_y
            if wind:
                m.acceleration_x += air.drag * air.wind_x
                m.acceleration_y += air.drag * air.wind_y
        return dynamic, kinematic

    return gather_motions


def make_substep_velocities(drag: bool, rotation: bool) -> Callable:
    """Return the function that integrates velocities at the start of a substep.

    drag, rotation: whether the world has these effects.
    """

    @subkernel
    def integrate_substep_velocities(members, h, drag_rate, motions_inout):
        """Integrate the velocities of island bodies over a substep of h [s], and warm start their contacts. O(members).

        members: indices of MOTION rows. Accelerations are applied first, with only half of the acceleration for bodies
        with MOTION.halves (see accelerate_again). Then drag_rate [1/s] is applied implicitly, which is stable at any
        rate. The warm start adds the velocity change v - free_v that contact impulses caused in the last substep.
        Impulses and moment arms have not changed since then, so no contact has to be read.
        """
        keep = 1.0 / (1.0 + drag_rate * h)
        for i in range(len(members)):
            m = motions_inout[members[i]]
            m.in_contact = False
            given_x, given_y = m.vx - m.free_vx, m.vy - m.free_vy
            part = 0.5 * h if m.halves else h
            m.vx += part * m.acceleration_x
            m.vy += part * m.acceleration_y
            if drag:
                m.vx, m.vy = keep * m.vx, keep * m.vy
            m.free_vx, m.free_vy = m.vx, m.vy
            m.vx += given_x
            m.vy += given_y
            if rotation:
                given = m.angular_velocity - m.free_w
                m.angular_velocity += part * m.angular_acceleration
                if drag:
                    m.angular_velocity = keep * m.angular_velocity
                m.free_w = m.angular_velocity
                m.angular_velocity += given

    return integrate_substep_velocities


@subkernel
def change_velocity(vx, vy, w, motion_inout):
    """Add (vx, vy) [px/s] and w [rad/s] to the velocity of a body, and to its free velocity. motion_inout: MOTION row.

    The free velocity (free_vx, free_vy, free_w) is the velocity without contact impulses. The next warm start of
    contacts adds the velocity minus the free velocity once more, so this difference must not change here.
    """
    m = motion_inout
    m.vx += vx
    m.vy += vy
    m.angular_velocity += w
    m.free_vx += vx
    m.free_vy += vy
    m.free_w += w


@subkernel
def accelerate_again(members, h, motions_inout):
    """Add the second half of a substep's acceleration to bodies with MOTION.halves. O(members).

    members: indices of MOTION rows; h [s]: length of the substep. Bodies with MOTION.halves have rigid joints and no
    contacts. Half of their acceleration acts before the positions are integrated, and half afterwards: Verlet
    integration with constraints (RATTLE, Andersen 1983). The energy error is then of second order in h.
    """
    for i in range(len(members)):
        m = motions_inout[members[i]]
        if m.halves:
            half = 0.5 * h
            change_velocity(half * m.acceleration_x, half * m.acceleration_y, half * m.angular_acceleration, m)


def make_substep_positions(rotation: bool) -> Callable:
    """Return the function that integrates positions at the end of a substep. rotation: whether bodies rotate."""

    @subkernel
    def integrate_substep_positions(members, h, push_speed, motions_inout):
        """Move island bodies by their velocity and pseudo-velocity over a substep of h [s]. O(members).

        members: indices of MOTION rows. The pseudo-velocity is limited to push_speed [px/s], and reset afterwards.
        Bodies in contact move by the velocity at the end of the substep, which keeps stacks stable. Bodies without
        contact follow the exact parabola. Otherwise each flight of a bouncing ball would be lower by h times its speed.
        """
        for i in range(len(members)):
            m = motions_inout[members[i]]
            m.dx += h * m.vx
            m.dy += h * m.vy
            turn = m.angular_velocity
            if not m.in_contact:
                m.dx -= 0.5 * h * h * m.acceleration_x
                m.dy -= 0.5 * h * h * m.acceleration_y
                turn -= 0.5 * h * m.angular_acceleration
            if m.pseudo_vx != 0.0 or m.pseudo_vy != 0.0 or m.pseudo_w != 0.0:
                fast = norm(m.pseudo_vx, m.pseudo_vy)
                share = push_speed / fast if fast > push_speed else 1.0
                m.dx += h * share * m.pseudo_vx
                m.dy += h * share * m.pseudo_vy
                turn += share * m.pseudo_w
                m.pseudo_vx, m.pseudo_vy, m.pseudo_w = 0.0, 0.0, 0.0
            if rotation and turn != 0.0:
                m.turn += h * turn
                m.cosine, m.sine = rotation_of(m.turn)

    return integrate_substep_positions


@subkernel
def move_kinematic(kinematic, time, motions_inout):
    """Move kinematic bodies (indices of MOTION rows) to their poses at a time [s] after the start of the step.

    The poses depend on the time alone, so they are the same for every group of islands.
    """
    for i in range(len(kinematic)):
        m = motions_inout[kinematic[i]]
        m.dx, m.dy = time * m.vx, time * m.vy
        m.turn = time * m.angular_velocity
        m.cosine, m.sine = rotation_of(m.turn)


@subkernel
def is_usable(body, speed_limit):
    """Return whether the numbers of a BODY row are finite and within limits, so that the next step can use them.

    Quarantined bodies are not tested and count as usable. speed_limit [px/s]: greatest permitted speed.
    """
    return body.quarantined or (is_within_limits(body) and is_finite_in_step(body, 0.0, 0.0, speed_limit, 0.0))


@kernel
def scatter_motions(rows, motions, speed_limit, lists_inout, bodies_inout):
    """Write velocities, poses and centres of mass from the MOTION rows back to the BODY rows. O(rows).

    Return how many bodies are not usable, see is_usable. The poses before the step are stored in BODY.previous_…. rows:
    indices of BODY rows, in the order of the MOTION rows from 1 on; speed_limit [px/s]: greatest permitted speed;
    lists_inout: MotionLists.
    """
    non_finite_count = 0
    for k in range(len(rows)):
        b = bodies_inout[rows[k]]
        m = motions[k + 1]
        lists_inout.motion_of[rows[k]] = 0
        b.previous_x, b.previous_y = b.x, b.y
        b.previous_angle = b.angle
        b.force_x, b.force_y, b.torque = 0.0, 0.0, 0.0
        b.fraction = 1.0
        if not m.moves:
            refresh_center(b)
            non_finite_count += int(not is_usable(b, speed_limit))
            continue
        b.vx, b.vy = m.vx, m.vy
        b.angular_velocity = m.angular_velocity
        b.substeps = m.substeps
        b.cooldown = m.cooldown
        b.reserve = lists_inout.balance[k + 1].reserve
        b.center_x += m.dx
        b.center_y += m.dy
        if m.turn == 0.0:
            b.x += m.dx
            b.y += m.dy
            refresh_center(b)
        else:
            b.angle += m.turn
            u, v = rotate(b.local_center_x, b.local_center_y, *rotation_of(b.angle))
            b.x, b.y = b.center_x - u, b.center_y - v
            put_center(u, v, b)
        non_finite_count += int(not is_usable(b, speed_limit))
    return non_finite_count


GATHER = {(g, w, r): make_gather(gravity=g, wind=w, rotation=r) for g in BOTH for w in BOTH for r in BOTH}
SUBSTEP_VELOCITIES = {(d, r): make_substep_velocities(drag=d, rotation=r) for d in BOTH for r in BOTH}
SUBSTEP_POSITIONS = {r: make_substep_positions(rotation=r) for r in BOTH}


class Motions:
    """The MOTION rows of one world and their MotionLists. The arrays grow when needed and are reused."""

    def __init__(self) -> None:
        self._grow(16, np.zeros(16, np.int32))

    def _grow(self, count, motion_of):
        self.rows = zeros_in_lines(count, MOTION)
        finite, links = np.zeros(count, np.bool_), np.zeros(count, np.bool_)
        rank, balance, by_kind = (
            np.zeros(count, np.int8),
            zeros_in_lines(count, BALANCE),
            np.zeros((2, count), np.int32),
        )
        self.lists = MotionLists(motion_of, finite, links, rank, balance, by_kind)
        self.used, self.island_bodies, self.kinematic = self.rows[:0], *self.lists.by_kind[:, :0]

    def gather(self, state: StepState) -> None:
        """Copy the awake bodies to MOTION rows, see make_gather."""
        rows, bodies, effects = state.awake.bodies, state.bodies, state.effects
        if len(self.rows) < len(rows) + 1:
            self._grow(2 * len(rows) + 1, self.lists.motion_of)
        if len(self.lists.motion_of) < len(bodies):
            self.lists = self.lists._replace(motion_of=np.zeros(2 * len(bodies), np.int32))
        if len(self.used) != len(rows) + 1:
            self.used = self.rows[: len(rows) + 1]
        air = Air(*state.gravity, state.drag, *state.wind)
        gather = GATHER[effects.gravity, effects.wind, effects.rotation]
        dynamic, kinematic = gather(rows, bodies, air, self.used, self.lists, state.work)
        if (len(self.island_bodies), len(self.kinematic)) != (dynamic, kinematic):
            self.island_bodies, self.kinematic = self.lists.by_kind[0, :dynamic], self.lists.by_kind[1, :kinematic]
        if len(state.characters):
            characters = self.lists.motion_of[state.characters["body_row"]]
            self.used["is_character"][characters] = ~state.characters["wedged"]
            self.lists.rank[characters] = np.where(state.characters["wedged"], STATIC_RANK, 0)

    def scatter(self, state: StepState) -> None:
        """Write velocities and poses from the MOTION rows back to the bodies."""
        rows, bodies, limit = state.awake.bodies, state.bodies, state.tolerances.speed_limit
        state.non_finite_count = scatter_motions(rows, self.used, limit, self.lists, bodies)
        # A rotated mask may be at an angle for which no raster has been drawn yet.
        add_missing_rasters(state.library, state.awake.shapes, bodies, state.shapes, 0.0)


READS = (
    "effects", "tolerances", "gravity", "drag", "wind", "dt", "span", "substeps", "accuracy", "awake", "bodies",
    "shapes", "characters", "library", "contact_rows", "joints", "joint_solver",
    "workspace",
)  # fmt: skip
WRITES = (
    "contact_rows", "joints", "library", "non_finite_count", "work", "workspace", "bodies.has_current_contacts",
    *(f"bodies.{name}" for name in ("x", "y", "angle", "vx", "vy", "angular_velocity", "center_x", "center_y")),
    *(f"bodies.{state}_{name}" for state in ("previous", "settled") for name in ("x", "y", "angle")),
    *(f"bodies.{name}" for name in ("force_x", "force_y", "torque", "fraction", "substeps", "cooldown", "reserve")),
)  # fmt: skip


def run_solver(state: StepState, solve: Callable[[StepState, Any], float]) -> None:
    """Run a stacking solver: copy the bodies to MOTION rows, call solve(state, contacts), and write the rows back.

    The result of `solve` is ignored. `solve` is not called in a step of length 0. Without awake bodies the function
    does nothing.
    """
    if not len(state.awake.bodies):
        return
    motions = state.workspace.motions
    motions.gather(state)
    if state.dt > 0.0:
        solve(state, state.workspace.contacts)
    motions.scatter(state)
