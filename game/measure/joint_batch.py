"""Batch of copies of one joint, with its bodies and the joints that it couples, in a world of their own.

A second world holds the same bodies without the joint. The difference of the two worlds' times, in the solver and in
the report of joints, is the time of the joint. The copies touch nothing, and start in the state after the last step.
"""

import numpy as np

from game.measure.staged import advance, stages_of
from game.measure.timing import RUNS, Cost, undisturbed
from physics import Circle, Filter, World
from physics.annotations import JointSolverName, Substeps
from physics.tables.body import KINDS
from physics.tables.joint import GEARED, NO_JOINT, WORLD
from physics.tables.table import rows_of

APART = 256.0  # [px] between two copies, in addition to the extent of bodies and anchors
NOTHING = Filter(0, 0)  # the copies touch nothing
COPIED = (  # columns of BODY that copies have from their bodies, in addition to the places
    "angle", "vx", "vy", "angular_velocity", "inverse_mass", "inverse_inertia", "fixed_rotation", "extent",
    "min_half_extent", "inradius", "gravity_scale", "mass", "inertia", "local_center_x", "local_center_y",
)  # fmt: skip
# Columns [px] of BODY, and of the joints of the world, that contain a place.
PLACES = {"x": ("x", "center_x", "previous_x", "settled_x"), "y": ("y", "center_y", "previous_y", "settled_y")}


class JointBatch:
    """Two worlds with `count` copies of the bodies of a joint: `jointed` with the joint, `bare` without it.

    substeps: number of substeps of both worlds. The copies are solved by the tier that solved the joint in the last
    step. Raises KeyError for an unknown joint.
    """

    def __init__(self, world: World, identity: int, count: int, substeps: Substeps) -> None:
        self.count = count
        joints = world.joints
        joint = joints[joints["id"] == world.joint(identity).id]
        coupled = [joint[name].item() for name in ("joint_a", "joint_b")] if joint["hold"] == GEARED else []
        others = joints[np.isin(joints["id"], [each for each in coupled if each != NO_JOINT])]
        rows = np.concatenate([others, joint])  # a gear comes after its joints
        tier: JointSolverName = "direct" if rows["direct"].any() else "iterative"
        bodies = np.unique(np.concatenate([rows["body_a"], rows["body_b"]]))
        bodies = world.bodies[world.rows(bodies[bodies != WORLD])]
        size = sum(float(np.ptp(bodies[axis])) for axis in ("x", "y")) + float(bodies["extent"].max(initial=0.0))
        across = int(np.ceil(np.sqrt(count)))
        cells = np.stack(np.divmod(np.arange(count), across), axis=1) * (APART + size)
        self.jointed, self.bare = (copies(world, bodies, each, cells, tier, substeps) for each in (rows, others))
        self.stages = stages_of(self.jointed)
        self.names = [stage.stage for stage in self.stages if stage.stage in (world.solver, "joints")]

    def seconds(self) -> float:
        """Make one step of both worlds. Return the time [s] that the joints took in it."""
        found = []
        for world in (self.jointed, self.bare):
            spent = {}
            advance(world, self.stages, world.dt, spent)
            found.append(sum(spent[name] for name in self.names))
        return max(found[0] - found[1], 0.0)

    def cost(self) -> Cost:
        """Return the time [s] of one joint in a step, from RUNS steps after one that is not timed."""
        self.seconds()
        with undisturbed():
            return Cost.of([self.seconds() / self.count for _ in range(RUNS)], self.count)


def copies(
    world: World, bodies: np.ndarray, rows: np.ndarray, cells: np.ndarray, tier: JointSolverName, substeps: Substeps
) -> World:
    """Return a world with one copy of the given bodies and joints of `world` in each cell.

    bodies: BODY rows; rows: JOINT rows, each after the joints that it couples; cells: (n, 2) offsets of the copies from
    the originals [px]; tier: solver of the joints. The joints of the copies do not break.
    """
    e, count = world.effects, len(cells)
    made = World(
        e,
        solver=world.solver,
        gravity=world.gravity if e.gravity else None,
        drag=world.drag if e.drag else 0.0,
        wind=world.wind if e.wind else (0, 0),
        pixels_per_meter=world.tolerances.pixels_per_meter,
        dt=world.dt,
        substeps=substeps,
        accuracy=world.accuracy,
    )
    made.joint_solver = tier
    for body in bodies:  # the copies of a body have consecutive ids
        places = np.array([body["x"], body["y"]]) + cells
        ids = made.add_bodies(Circle(1.0), places, kind=KINDS[body["kind"]], filter=NOTHING)
        mine = np.asarray(made.bodies)[made.rows(ids)]
        for name in COPIED:
            mine[name] = body[name]
        for axis, names in enumerate(PLACES.values()):
            for name in names:
                mine[name] = body[name] + cells[:, axis]
        made.bodies[made.rows(ids)] = mine
    if len(rows):
        taken = made.snapshot()  # a snapshot may contain any joints; add_joints would compute their rows anew
        taken.arrays["joints"] = joint_copies(rows, bodies, cells)
        taken.facts["next_joint"] = len(rows) * count
        made.restore(taken)
    return made


def joint_copies(rows: np.ndarray, bodies: np.ndarray, cells: np.ndarray) -> np.ndarray:
    """Return JOINT rows of the copies, (joints · n,), in the order of ids. Arguments: see copies()."""
    count = len(cells)
    found = np.repeat(rows, count)
    number = np.tile(np.arange(count), len(rows))
    found["id"] = np.arange(len(found))
    for side in ("a", "b"):
        held = found[f"body_{side}"] != WORLD
        body = rows_of(bodies, found[f"body_{side}"][held]) * count + number[held]
        found[f"body_{side}"][held] = found[f"body_row_{side}"][held] = body
        coupled = (found["hold"] == GEARED) & (found[f"joint_{side}"] != NO_JOINT)
        joint = np.searchsorted(rows["id"], found[f"joint_{side}"][coupled])
        found[f"joint_{side}"][coupled] = joint * count + number[coupled]
        for axis, offsets in zip("xy", cells.T, strict=True):
            found[f"local_{side}{axis}"][~held] += offsets[number[~held]]
            found[f"ground_{side}{axis}"] += offsets[number]
    found["break_force"] = found["break_torque"] = np.inf
    return found
