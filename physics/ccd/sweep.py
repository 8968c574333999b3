"""Stages of continuous collision detection: fast bodies stop at their first impact."""

import math

import numpy as np

from physics.ccd.impacts import (
    cut_path,
    find_impacts,
    find_rotational_impacts,
    move_back,
    stop_at_impacts,
    stop_held,
    turn_held,
    write_impacts,
)
from physics.ccd.mask_sweep import NO_SQUARES, find_shared_areas, squares_of
from physics.ccd.rotational import BEFORE, Sweep, new_rotational_workspace, sweep_rotational
from physics.collision.manifold import measure_approach, new_workspace
from physics.collision.narrow_phase import detect, place_swept_contacts
from physics.contacts.cache import write_caches
from physics.dynamics.integrate import place_shapes, shift_bodies
from physics.islands.sleep import in_order, order_of
from physics.jit import kernel, subkernel
from physics.math2d import norm, rotate
from physics.settings import IMPACT_ROUNDS, PUSH_ROUNDS
from physics.shapes.placement import PLACED
from physics.tables.body import AUTO, DYNAMIC, KINEMATIC, OFF, RAY, STATIC, SWEPT
from physics.tables.contact import CONTACT
from physics.tables.shape import CHAIN, MASK, TILES
from physics.tables.step_state import CAP_HITS, StepState, stage
from physics.tables.table import joined

# ---- paths -----------------------------------------------------------------------------------------------------------
# Paths of the bodies in a step, and the bodies that are fast enough to pass through others.
#
# Source: Catto, Box2D v3, solver.c (half the smallest extent).


@subkernel
def leaves_out_rotation(body):
    """Return whether the sweep of a body leaves out a rotation that moves its outline. body: BODY row.

    The outline of a disc around its centre of mass, whose inradius is its extent, does not move.
    """
    return body.continuous == SWEPT and body.kind == DYNAMIC and body.extent > body.inradius


@kernel
def list_paths(rows, bodies, paths_out):
    """Write the path of each body in the step. O(rows).

    rows: row numbers in BODY; paths_out (bodies, 7): centre of mass x, y [px] and angle [rad] before the step, then
    after it. A body in mode "ray" or "swept" is swept without rotation: both angles are the angle before the step. The
    last column is the rotation [rad] that the sweep of a dynamic body in mode "swept" leaves out, otherwise 0. It is 0
    also for discs.
    """
    for k in range(len(rows)):
        i = rows[k]
        b = bodies[i]
        u, v = rotate(b.local_center_x, b.local_center_y, math.cos(b.previous_angle), math.sin(b.previous_angle))
        paths_out[i, 0] = b.previous_x + u
        paths_out[i, 1] = b.previous_y + v
        paths_out[i, 2] = b.previous_angle
        u, v = rotate(b.local_center_x, b.local_center_y, math.cos(b.angle), math.sin(b.angle))
        paths_out[i, 3] = b.x + u
        paths_out[i, 4] = b.y + v
        paths_out[i, 5] = b.previous_angle if b.continuous == RAY or b.continuous == SWEPT else b.angle
        paths_out[i, 6] = b.angle - b.previous_angle if leaves_out_rotation(b) else 0.0


@subkernel
def asks_straight(body):
    """Return whether a body is dynamic and in mode "ray" or "swept", which means a sweep without rotation."""
    return body.kind == DYNAMIC and (body.continuous == RAY or body.continuous == SWEPT)


@subkernel
def way_of(bodies, paths, row):
    """Return an upper bound [px] of the distance that any point of a body moves in the step.

    paths: see Sweep; row: row number in BODY.
    """
    moved = norm(paths[row, 3] - paths[row, 0], paths[row, 4] - paths[row, 1])
    return moved + bodies[row].extent * min(abs(paths[row, 5] - paths[row, 2]), 2.0)


@kernel
def find_fast(rows, bodies, paths, fast_out):
    """Flag the bodies to sweep. Return (number of bodies whose pairs must be tested, number swept without rotation).

    A moving body in mode "toi", "ray" or "swept" is always flagged. A body in mode "auto" is flagged if one of its
    points may move by more than its inradius. The first number also includes bodies without a flag if a kinematic body
    may pass through them, see impacts.is_fast. rows: row numbers in BODY; paths: see list_paths; fast_out (bodies,)
    bool. O(rows).
    """
    found = 0
    straight = 0
    carried = 0.0
    for k in range(len(rows)):
        if bodies[rows[k]].kind == KINEMATIC:
            carried = max(carried, way_of(bodies, paths, rows[k]))
    for k in range(len(rows)):
        i = rows[k]
        b = bodies[i]
        fast_out[i] = False
        if asks_straight(b):
            straight += 1
        if b.kind == STATIC or b.quarantined or not b.awake or b.continuous == OFF:
            continue
        moved = way_of(bodies, paths, i)
        if moved > 0.0 and (b.continuous != AUTO or moved > b.inradius):
            fast_out[i] = True
            found += 1
        elif b.kind == DYNAMIC and carried > 0.0 and moved + carried > b.inradius:
            found += 1
    return found, straight


@kernel
def find_outgrown(rows, bodies, shapes, proxies, fast, rows_out):
    """List the shapes of swept bodies that have left their broad-phase AABB. Return their number. O(rows).

    rows: row numbers in SHAPE to test; rows_out: row numbers of the listed shapes; proxies: PROXY table with the
    broad-phase AABBs; fast (bodies,) bool: bodies to sweep.
    """
    found = 0
    for k in range(len(rows)):
        row = rows[k]
        s = shapes[row]
        if s.proxy < 0:
            continue
        b = bodies[s.body_row]
        if not (fast[s.body_row] or asks_straight(b)):
            continue
        p = proxies[s.proxy]
        if s.min_x < p.lower_x or s.max_x > p.upper_x or s.min_y < p.lower_y or s.max_y > p.upper_y:
            rows_out[found] = row
            found += 1
    return found


@kernel
def foresee_paths(rows, bodies, dt, paths_out):
    """Write the predicted path of each body in dt [s], at its present velocity and without obstacles. O(rows).

    rows: row numbers in BODY; paths_out (bodies, 7): see list_paths.
    """
    for k in range(len(rows)):
        i = rows[k]
        b = bodies[i]
        moves = 0.0 if b.kind == STATIC or b.quarantined else dt
        paths_out[i, 0] = b.center_x
        paths_out[i, 1] = b.center_y
        paths_out[i, 2] = b.angle
        paths_out[i, 3] = b.center_x + moves * b.vx
        paths_out[i, 4] = b.center_y + moves * b.vy
        turns = moves * b.angular_velocity
        paths_out[i, 5] = b.angle if b.continuous == RAY or b.continuous == SWEPT else b.angle + turns
        paths_out[i, 6] = turns if leaves_out_rotation(b) else 0.0


# ---- push ahead ------------------------------------------------------------------------------------------------------
# For the rest of the step, kinematic bodies push bodies that stopped in front of them.
#
# A body that was stopped at an impact waits for the next step, but a kinematic body moves on. So the rest of the step
# is swept again: if the surface of a kinematic body would enter a stopped body, it pushes the stopped body.

MEETINGS = 2  # most tiles or links of one kinematic body that a call tests: the two sides of a corner


@kernel
def push_ahead(sweep_inout, moves_inout):
    """Push stopped bodies out of the path of kinematic bodies for the rest of the step. Return the number of pushes.

    Each push is along one normal, so in a corner the caller must repeat the call until the result is 0. moves_inout
    (bodies, 2) [px]: translation of each body since it was stopped, to which each push is added. O(candidates).
    sweep_inout: see Sweep.
    """
    bodies, shapes, candidates = sweep_inout.bodies, sweep_inout.shapes, sweep_inout.candidates
    cuts, slack = sweep_inout.cuts, sweep_inout.slack
    found = 0
    for i in range(len(candidates)):
        for side in range(2):
            mover = candidates[i, side]
            other = candidates[i, 1 - side]
            row = shapes[mover].body_row
            pusher = shapes[other].body_row
            b = bodies[row]
            if b.kind != DYNAMIC or bodies[pusher].kind != KINEMATIC or not b.fraction < 1.0:
                continue
            kind = shapes[mover].kind
            if kind == TILES or kind == CHAIN or kind == MASK or shapes[mover].sensor or shapes[other].sensor:
                continue
            cut_path(sweep_inout.paths, pusher, b.fraction, 1.0, cuts)
            for k in range(0, 6, 3):
                share = 0.0 if k == 0 else 1.0
                cuts[row, k] = b.center_x + share * moves_inout[row, 0]
                cuts[row, k + 1] = b.center_y + share * moves_inout[row, 1]
                cuts[row, k + 2] = b.angle
            but = -1
            for _ in range(MEETINGS):
                fraction, nx, ny, feature = sweep_rotational(mover, other, slack, but, sweep_inout)
                if fraction >= 1.0:
                    break
                # (dx, dy): displacement until the end of the step of the pusher's point that is now at the body's
                # centre of mass, minus the remaining move of the body.
                left = 1.0 - fraction
                x = cuts[row, 0] + fraction * moves_inout[row, 0]
                y = cuts[row, 1] + fraction * moves_inout[row, 1]
                u = x - (cuts[pusher, 3] - left * (cuts[pusher, 3] - cuts[pusher, 0]))
                v = y - (cuts[pusher, 4] - left * (cuts[pusher, 4] - cuts[pusher, 1]))
                turn = left * (cuts[pusher, 5] - cuts[pusher, 2])
                w, z = rotate(u, v, math.cos(turn), math.sin(turn))
                dx = cuts[pusher, 3] + w - x - left * moves_inout[row, 0]
                dy = cuts[pusher, 4] + z - y - left * moves_inout[row, 1]
                ahead = nx * dx + ny * dy
                if ahead > BEFORE * slack:
                    moves_inout[row, 0] += ahead * nx
                    moves_inout[row, 1] += ahead * ny
                    found += 1
                    break
                if feature < 0:
                    break
                but = feature  # this tile or link does not push further; ignore it and test the other side of a corner
    return found


# ---- sweep -----------------------------------------------------------------------------------------------------------
# The stages that stop fast bodies at their first impact.
#
# Without a stacking solver, impacts are predicted, and a body moves no farther than to its first impact. A stacking
# solver moves all bodies first; then each fast body is swept from its pose before the step to its pose after the step.
# The body is moved back to its first impact and keeps its velocity, so that the contact of the next step gets the full
# impact speed.

SAME_FRACTION = 1e-9  # smaller differences of two fractions of a step count as 0
NO_IMPACTS, NO_ROWS = np.zeros((0, 8)), np.zeros(0, np.int64)


class Sweeper:
    """Reusable arrays for the sweeps of one world."""

    def __init__(self) -> None:
        self.paths, self.cuts = np.zeros((16, 7)), np.zeros((16, 6))
        self.fast = np.zeros(16, bool)
        self.impacts = np.full((16, 8), np.nan)
        self.turning, self.workspace = new_rotational_workspace(), new_workspace()
        self.squares, self.squares_in, self.best = NO_SQUARES, None, np.zeros(5)

    def grow(self, state: StepState) -> None:
        """Enlarge the arrays for the numbers of bodies and candidate pairs of a step.

        The contents of enlarged arrays are lost.
        """
        bodies, candidates = len(state.bodies), len(state.pairs.rows)
        if len(self.fast) < bodies:
            self.paths, self.cuts = np.zeros((2 * bodies, 7)), np.zeros((2 * bodies, 6))
            self.fast = np.zeros(2 * bodies, bool)
        if len(self.impacts) < candidates:
            self.impacts = np.full((2 * candidates, 8), np.nan)

    def pairs_of(self, state: StepState, strict: bool = False, sinks: bool = False) -> Sweep:
        """Return the Sweep for the candidate pairs of a step.

        strict: True if every impact stops a body, however small the motion after the impact, as in worlds with a
        stacking solver. sinks: see Mover.
        """
        return Sweep(
            state.library.tables,
            state.bodies,
            state.shapes,
            state.pairs.rows,
            strict or state.stacks,
            state.effects.one_way,
            state.tolerances.slop,
            sinks,
            self.paths,
            self.fast,
            self.cuts,
            self.turning,
            state.work,
        )


def _look(state, moving, strict=False) -> np.ndarray:
    """Return the impacts (n, 8) of fast bodies, with resting bodies (moving 0) or among moving bodies (moving 1).

    Columns: see impacts.write_impacts. strict: see Sweeper.pairs_of.
    """
    sweeper = state.workspace.sweep
    sweeper.grow(state)
    sweep = sweeper.pairs_of(state, strict, sinks=not strict)
    impacts = sweeper.impacts[: find_rotational_impacts(moving, state.effects.rotation, sweep, sweeper.impacts)].copy()
    masks = _masks_in(state)
    if not len(masks):
        return impacts
    if sweeper.squares_in is not state.library:
        sweeper.squares, sweeper.squares_in = NO_SQUARES, state.library
    sweeper.squares = squares_of(state.library, masks, sweeper.squares)
    found = find_shared_areas(moving, sweeper.squares, sweep, sweeper.best, sweeper.impacts)
    shared = sweeper.impacts[:found].copy()
    sweeper.impacts[:, 6:] = np.nan  # the other sweeps compute no point
    return np.concatenate([impacts, shared])


def _masks_in(state) -> np.ndarray:
    """Return the library row numbers of all masks in the candidate pairs. Masks are swept by their pixels."""
    if not state.library.masks:
        return NO_ROWS
    rows = state.pairs.rows
    rows = rows[state.shapes["kind"][rows] == MASK]
    return np.unique(state.shapes["geometry"][rows]) if len(rows) else NO_ROWS


def _look_straight(state, bodies, dt, only_straight) -> np.ndarray:
    """Return the impacts (n, 8) within dt [s] that are found by sweeps in closed form, see impacts.find_impacts.

    bodies: BODY table with the start poses and velocities; only_straight: True to leave out bodies in mode "auto".
    """
    sweeper = state.workspace.sweep
    sweeper.grow(state)
    sweep = sweeper.pairs_of(state)._replace(bodies=bodies)
    return sweeper.impacts[: find_impacts(dt, only_straight, sweep, sweeper.workspace, sweeper.impacts)].copy()


FORESEEN = ("effects", "stacks", "tolerances", "dt", "awake", "bodies", "shapes", "library", "pairs", "workspace")


@stage("time_of_impact", reads=FORESEEN, writes=("impacts", "library", "work", "workspace", "bodies.fraction"))
def foresee_impacts(state: StepState) -> None:
    """Predict the impacts of the coming motion, and limit the motion of each body by BODY.fraction.

    BODY.fraction is the fraction of its motion that the body may make in the step. This stage is for worlds without a
    stacking solver.
    """
    sweeper, bodies, rows, dt = state.workspace.sweep, state.bodies, state.awake.bodies, state.dt
    sweeper.grow(state)
    foresee_paths(rows, bodies, dt, sweeper.paths)
    swept, straight = find_fast(rows, bodies, sweeper.paths, sweeper.fast)
    if straight and state.effects.response:
        turn_held(state.tolerances.speculative, sweeper.pairs_of(state))
    found = _look_straight(state, bodies, dt, state.effects.rotation)
    bodies["fraction"][rows] = 1.0
    if swept:
        found = np.concatenate([found, _look(state, 0), _look(state, 1)])
    state.impacts = found
    if state.effects.response:
        stop_at_impacts(state.shapes, state.pairs.rows, found, bodies)


@stage(
    "narrow_phase",
    reads=(*FORESEEN, "impacts", "contact_rows", "swept_sensors"),
    writes=(
        "contact_rows", "swept_sensors", "library", "work", "workspace",
        *(f"bodies.{name}" for name in ("x", "y", "center_x", "center_y", "fraction")), *PLACED,
    ),
)  # fmt: skip
def detect_moved(state: StepState) -> None:
    """Find the contacts at the final poses, and add the predicted impacts of pairs that have no such contact.

    Before the detection, kinematic bodies push stopped bodies out of their path. This stage is for worlds without a
    stacking solver.
    """
    rows = state.awake.bodies
    stopped = rows[state.bodies["fraction"][rows] < 1.0] if len(state.impacts) and state.effects.response else rows[:0]
    if len(stopped) and push_stopped(state, stopped):
        place_shapes(state)
    manifolds = detect(state)
    if not len(state.impacts):
        state.contact_rows = manifolds
        return
    met = _written(state, state.impacts, int(state.effects.response))
    if state.effects.response:
        state.swept_sensors, met = met[met["sensor"]], met[~met["sensor"]]
    # If a body moved on after the impact, as a kinematic body does, the contact at the final poses may be on the wrong
    # side.
    passed = met["candidate"][met["separation_1"] < -state.tolerances.slop]
    manifolds = manifolds[~np.isin(manifolds["candidate"], passed)]
    # A pair with an impact may also have a contact at the final poses. The contact is kept, and marked as swept, if the
    # bodies approach. If they separate across a gap (the body ended just behind its obstacle), the impact replaces it.
    two = manifolds["count"] == 2
    nears = (manifolds["speed_1"] > 0.0) | (two & (manifolds["speed_2"] > 0.0))
    apart = (manifolds["separation_1"] > 0.0) & ~(two & (manifolds["separation_2"] <= 0.0))
    seen = np.isin(manifolds["candidate"], met["candidate"])
    manifolds["swept"][seen & nears] = True
    # Without response the body may have ended inside the obstacle, nearer to its far side.
    manifolds = manifolds[~(seen & ~nears & (apart | (not state.effects.response)))]
    met = met[~np.isin(met["candidate"], manifolds["candidate"])]
    state.contact_rows = in_order(joined([manifolds, met]))


def _written(state, impacts, response) -> np.ndarray:
    """Return the impacts that bodies reached before they stopped, as CONTACT rows with approach speeds.

    impacts, response: see impacts.write_impacts.
    """
    workspace = np.zeros(len(impacts), CONTACT)
    found = write_impacts(state.bodies, state.shapes, state.pairs.rows, impacts, state.dt, response, workspace)
    measure_approach(state.bodies, workspace[:found])
    return workspace[:found]


@stage(
    "time_of_impact",
    reads=(*FORESEEN, "contact_rows", "swept_sensors", "broadphase", "gravity"),
    writes=(
        "contact_rows", "swept_sensors", "ghosts", "pairs", "broadphase", "library", "work", "workspace",
        "bodies.fraction", *PLACED,
        *(f"bodies.{name}" for name in ("x", "y", "angle", "center_x", "center_y", "vx", "vy")),
    ),
)  # fmt: skip
def sweep_piles(state: StepState) -> None:
    """Find the fast bodies, move each back to its first impact in the step, and add the impacts to the contacts.

    This stage is for worlds with a stacking solver, after the solver has moved all bodies.
    """
    bodies, rows, sweeper = state.bodies, state.awake.bodies, state.workspace.sweep
    state.ghosts = None
    sweeper.grow(state)
    paths, fast = sweeper.paths, sweeper.fast
    list_paths(rows, bodies, paths)
    found, straight = find_fast(rows, bodies, paths, fast)
    if not found and not straight:
        return
    place_shapes(state)
    _cover(state)
    if straight:
        turn_held(state.tolerances.speculative, sweeper.pairs_of(state))
    met = _sweep_straight(state) if straight else NO_IMPACTS
    if found:
        met = np.concatenate([met, _sweep_rotational(state)])
    stopped = rows[bodies["fraction"][rows] < 1.0]
    if len(stopped):
        state.ghosts = np.column_stack([bodies["id"][stopped], paths[stopped, :6], bodies["fraction"][stopped]])
        gravity = state.gravity if state.effects.gravity else (0.0, 0.0)
        slop = state.tolerances.slop
        move_back(stopped, paths, *gravity, state.dt, slop, bodies)
        stop_held(state.shapes, state.pairs.rows, met, paths, slop, bodies)
        push_stopped(state, stopped)
        place_shapes(state)
    _report(state, met)


def _cover(state):
    """Enlarge the broad-phase AABBs that swept bodies have left, and find the new candidate pairs of these bodies."""
    own, shapes, pairs = state.awake.shapes, state.shapes, state.pairs
    rows = state.workspace.rows_for(len(own))
    found = find_outgrown(own, state.bodies, shapes, pairs.proxies, state.workspace.sweep.fast, rows)
    if found:
        pairs.widen(shapes[rows[:found]], state.tolerances.slop)
        pairs.update(state.broadphase, shapes, found, state.work)


def _sweep_straight(state) -> np.ndarray:
    """Stop bodies in mode "ray" or "swept" at the first impact on their straight path. Return the impacts (n, 8)."""
    dt, moved = state.dt, state.bodies.copy()
    for name, velocity in (("x", "vx"), ("y", "vy")):
        moved[velocity] = (moved[name] - moved["previous_" + name]) / dt if dt > 0.0 else 0.0
        moved[name] = moved["previous_" + name]
    moved["angle"] = moved["previous_angle"]
    impacts = _look_straight(state, moved, dt, True)
    stop_at_impacts(state.shapes, state.pairs.rows, impacts, state.bodies)
    return impacts


def _sweep_rotational(state) -> np.ndarray:
    """Stop fast bodies at their first impacts along paths with rotation. Return the impacts (n, 8).

    Impacts with resting bodies come first. Pairs of moving bodies are swept repeatedly, because a body that stops
    changes the impacts of others.
    """
    found = [_look(state, 0)]
    stop_at_impacts(state.shapes, state.pairs.rows, found[0], state.bodies)
    found.append(_look(state, 1))
    while len(found[-1]) and _stop(state, found[-1]):
        if len(found) == IMPACT_ROUNDS:
            state.work[CAP_HITS] += 1
            break
        found.append(_look(state, 1))
    # write_impacts leaves out impacts of earlier rounds that a body no longer reaches.
    return np.concatenate(found)


def _stop(state, impacts) -> bool:
    """Stop the bodies at these impacts (n, 8). Return whether any body now stops earlier in the step than before."""
    rows = state.awake.bodies
    before = state.bodies["fraction"][rows]
    stop_at_impacts(state.shapes, state.pairs.rows, impacts, state.bodies)
    # With shortened paths the same impact may be found slightly earlier, which is not a new stop.
    return bool((state.bodies["fraction"][rows] < before - SAME_FRACTION).any())


def push_stopped(state: StepState, stopped: np.ndarray) -> bool:
    """Let kinematic bodies push stopped bodies for the rest of the step. Return whether any body was pushed.

    A pushed body moves until a resting body blocks it. stopped: row numbers in BODY of bodies that an impact stopped.
    """
    sweeper, bodies = state.workspace.sweep, state.bodies
    moves = np.zeros((len(bodies), 2))
    for rounds in range(PUSH_ROUNDS):
        if not push_ahead(sweeper.pairs_of(state), moves):
            break
        state.work[CAP_HITS] += rounds == PUSH_ROUNDS - 1
    rows = stopped[moves[stopped].any(axis=1)]
    if not len(rows):
        return False
    place_shapes(state)
    shift_freely(state, rows, moves[rows])
    return True


def shift_freely(state: StepState, rows: np.ndarray, moves: np.ndarray, arrived: bool = False) -> None:
    """Translate bodies, each one until a body at rest blocks it.

    rows (n,): row numbers in BODY; moves (n, 2): translations [px]; arrived: True if kinematic bodies already are at
    their final poses. They then block bodies too.
    """
    sweeper, bodies, awake = state.workspace.sweep, state.bodies, state.awake.bodies
    sweeper.grow(state)
    fractions = bodies["fraction"][rows]
    placed = awake if arrived else rows
    for column, name in enumerate(("center_x", "center_y", "angle")):
        sweeper.paths[placed, column] = sweeper.paths[placed, 3 + column] = bodies[name][placed]
    sweeper.paths[placed, 6] = 0.0
    sweeper.paths[rows, 3:5] += moves
    sweeper.fast[awake] = False
    sweeper.fast[rows] = True
    bodies["fraction"][rows] = 1.0
    walls = _look(state, 0, strict=True)
    stop_at_impacts(state.shapes, state.pairs.rows, walls, bodies)
    shift_bodies(bodies, rows, moves * bodies["fraction"][rows][:, None])
    bodies["fraction"][rows] = fractions


def _report(state, met):
    """Add the impacts `met` (n, 8) to the contacts of the step. Impacts with sensors go to state.swept_sensors.

    An added contact begins in this step, but its impulse follows in the next step.
    """
    if not len(met):
        return
    written = _written(state, met, 0)
    # An impact that both sweeps found is one impact.
    _, first = np.unique(written["shape_a"] << 32 | written["shape_b"], return_index=True)
    written = written[first]
    sensed = written[written["sensor"]]
    if len(sensed):
        state.swept_sensors = sensed
    solid = written[~written["sensor"]]
    known = state.contact_rows["shape_a"] << 32 | state.contact_rows["shape_b"]
    keys = solid["shape_a"] << 32 | solid["shape_b"]
    state.contact_rows["swept"][np.isin(known, keys)] = True
    new = solid[~np.isin(keys, known)]
    if len(new):
        # The contact of the next step reports the impact with its impulse.
        place_swept_contacts(state, new)
        new["speed_1"] = new["speed_2"] = 0.0
        write_caches(state.library.tables, state.bodies, state.shapes, new)
        both = joined([state.contact_rows, new])
        state.contact_rows = both[order_of(both)]
