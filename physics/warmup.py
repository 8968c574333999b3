"""Compilation ahead of time: run small worlds to find and compile the kernels of a world with given effects."""

from collections.abc import Callable, Iterable
from itertools import pairwise
from typing import Any

import numpy as np

from physics import checks
from physics.background import compile_ahead
from physics.broadphase.brute_force import BruteForce
from physics.broadphase.dynamic_tree import REBUILD_FROM, DynamicTree
from physics.broadphase.spatial_hash import SpatialHashGrid
from physics.broadphase.sweep_and_prune import SweepAndPrune
from physics.character.character import Character
from physics.collision.manifold import contacts_of
from physics.effects import Effects, checked_effects
from physics.jit import tiers
from physics.joints.kinds import Gear, Prismatic, Pulley, Revolute, Target, Weld
from physics.settings import LARGE_MASK, MASK_TILE, SLEEP_TIME
from physics.shapes.kinds import Bounds
from physics.shapes.mask import PixelMask
from physics.shapes.outline import outline_of
from physics.shapes.values import Capsule, Chain, Circle, Polygon, TileGrid
from physics.tables.contact import with_rows
from physics.tables.table import rows_of
from physics.world import World

STRATEGIES = {each.name: each for each in (BruteForce, SweepAndPrune, SpatialHashGrid, DynamicTree)}

BOX, MASK, TILES = Polygon.box(8, 8), PixelMask(np.ones((4, 4), bool)), TileGrid(np.ones((1, 2), bool), 16)
EXACT = PixelMask(np.ones((4, 4), bool), snap=False)
OPEN = PixelMask(np.ones((4, 40), bool), one_way=True)
PAIRS = {
    "circles": ((BOX, Circle(4)),),
    "boxes": ((BOX, Bounds(BOX)), (Bounds(BOX), Bounds(BOX))),
    "masks": ((MASK, MASK), (MASK, BOX), (MASK, Circle(4))),
    "exact masks": ((EXACT, MASK), (EXACT, BOX)),
    "one-way masks": ((OPEN, BOX),),
    "tiles": ((TILES, BOX),),
    "chains": ((Chain([(-9, 0), (9, 0)]), BOX),),
    "capsules": ((BOX, Capsule((-2, 0), (2, 0), 2)),),
}


def warmup(
    effects: Effects | None = None,
    broadphase: str = "hash",
    solver: str | None = None,
    progress: Callable[[int, int, str], Any] | None = None,
    pieces: Iterable[str] | None = None,
) -> None:
    """Compile all kernels that a world with these effects calls, on all cores, or load them from the cache.

    effects: the Effects of the world; None: Effects.rigid_bodies(), the default of World().
    broadphase: "brute", "sweep", "hash", "tree" or "all".
    solver: one of SOLVERS; None: the default solver for the effects.
    progress: function (done, total, name), called before each small world, for each kernel, and at the end; `total`
        grows when the number of kernels is known.
    pieces: names of the shapes and queries that the world will use, see physics.warmup.PIECES; None: all. The kernels
        of other pieces are compiled at their first call.

    The kernels are found by running small worlds that call them. Without numba, the worlds run, but nothing is
    compiled. Raises KeyError for an unknown broad phase or piece, ValueError for an unknown solver.
    """
    if progress is not None and not callable(progress):
        raise TypeError(f"progress must be a function (done, total, name), or None (got {checks.shown(progress)})")
    runs = _runs(effects, broadphase, solver, pieces)

    def report(done, total, name):
        if progress:
            progress(len(runs) + done, len(runs) + total, name)

    with tiers.collecting() as found:
        for number, (name, run) in enumerate(runs):
            if progress:
                progress(number, len(runs), name)
            run()
    compile_ahead(found, report)
    report(len(found), len(found), "ready")


def run_warmup(
    effects: Effects | None = None,
    broadphase: str = "hash",
    solver: str | None = None,
    pieces: Iterable[str] | None = None,
) -> None:
    """Run small worlds that call all kernels of a world with these effects. For arguments and errors see warmup()."""
    for _, run in _runs(effects, broadphase, solver, pieces):
        run()


def _runs(effects, broadphase, solver, pieces):
    """Return the small worlds of warmup() as a list of (name, function that makes and steps the world).

    The arguments are those of warmup(). Raises KeyError for an unknown broad phase or piece.
    """
    effects = Effects.rigid_bodies() if effects is None else checked_effects(effects)
    if not isinstance(broadphase, str) or broadphase not in (*STRATEGIES, "all"):
        known = ", ".join((*STRATEGIES, "all"))
        raise checks.NoSuchId(f"broadphase must be one of {known} (got {checks.shown(broadphase)})")
    names = list(STRATEGIES) if broadphase == "all" else [broadphase]
    runs: list[tuple[str, Callable[[], None]]] = [
        (
            f"broad phase {name}",
            lambda name=name: _small_world(effects, solver, STRATEGIES[name](), (Circle(4), Circle(4))),
        )
        for name in names
    ]
    strategy = STRATEGIES[names[0]]
    if effects.stacking:
        runs.append(("rest", lambda: _rest(effects, solver)))
    if effects.joints:
        runs.append(("joints", lambda: _joints(effects, solver)))
    if "tree" in names:
        runs.append(("broad phase tree", lambda: _crowd(effects)))
    if effects.response and effects.sensors:
        runs.append(("sensors", lambda: _sensor(effects, solver)))
    if effects.carving:
        runs.append(("carving", lambda: _carve(effects, solver)))
    if effects.continuous:
        runs.append(("sweeps", lambda: _impacts(effects, solver)))
    given = list(PIECES) if pieces is None else checks.listed(pieces)
    if given is None:
        raise TypeError(f"pieces must be a list of names, or None (got {checks.shown(pieces)})")
    pieces = tuple(given)
    if "masks" in pieces or "exact masks" in pieces:
        runs.append(("outlines", _fit))
    if not effects.one_way:
        pieces = tuple(each for each in pieces if each != "one-way masks")
    for piece in pieces:
        if piece in PAIRS and effects.narrowphase:
            runs += [
                (piece, lambda pair=pair: _small_world(effects, solver, strategy(), pair)) for pair in PAIRS[piece]
            ]
            if piece == "masks" and effects.response:
                runs.append((piece, lambda: _amid(effects, solver)))
            if piece == "masks" and effects.response and effects.sensors:
                runs.append((piece, lambda: _zone(effects, solver)))
            if piece == "tiles":
                runs.append((piece, lambda: _ground(effects, solver, TILES)))
            if piece == "one-way masks":
                runs.append((piece, lambda: _ground(effects, solver, OPEN)))
        elif piece == "queries":
            runs += [(piece, lambda name=name: _queries(effects, STRATEGIES[name]())) for name in names]
            if "masks" in pieces:
                runs.append((piece, lambda: _pixels(effects)))
        elif piece in QUESTIONS:
            runs.append((piece, lambda piece=piece: QUESTIONS[piece](effects)))
            if piece == "casts" and "masks" in pieces:
                runs.append((piece, lambda: _casts_at_pixels(effects)))
            if piece == "casts" and ("chains" in pieces or "one-way masks" in pieces):
                runs.append((piece, lambda: _casts_at_a_chain(effects)))
        elif piece == "characters" and effects.response:
            runs.append((piece, lambda: _character(effects, solver)))
        elif piece not in PIECES:
            raise checks.NoSuchId(f"no piece {checks.shown(piece)}; there are {', '.join(PIECES)}")
    if effects.narrowphase:
        runs.append(
            ("several pairs", lambda: _together(effects, solver, [PAIRS[each][0] for each in PAIRS if each in pieces]))
        )
        if effects.stacking:
            runs.append(("seams", lambda: _seams(effects, solver)))
    return runs


def _kind_of(shape):
    """Return the kind of body for a shape: "kinematic" if the shape is not for dynamic bodies, otherwise "dynamic"."""
    return "kinematic" if shape._is_ground or shape is OPEN else "dynamic"


def _seams(effects, solver):
    """Step a world in which a box slides across the seam between two adjacent ground boxes."""
    world, box = World(effects, solver=solver), Polygon.box(8, 8)
    for x in (-4, 4):
        world.add_body(box, kind="static", position=(x, 0))
    world.add_body(box, position=(-5, -8), velocity=(100.0, 0.0))
    for _ in range(8):
        world.step()


def _small_world(effects, solver, strategy, pair):
    world = World(effects, strategy, solver)
    first = world.add_body(pair[0], kind=_kind_of(pair[0]), position=(0, 0))
    second = world.add_body(pair[1], position=(3, 2), velocity=(-900.0, 0.0))
    world.step()
    world.query_aabb((0, 0), (1, 1))  # calls the query kernel of the broad phase
    for table in (world.bodies, world.shapes):
        rows_of(table, table["id"])  # World.rows calls rows_of once bodies were removed
    world.reported_rows()
    contacts_of(world.contact_rows)
    with_rows(world.bodies, world.shapes, world.contact_rows)  # called by a change of shapes
    second.move_to((3, 2))
    second.velocity = 0.0, 0.0
    world.move([second], [(3, 2)])
    world.step()
    world.remove_body(first)  # while it is touched
    world.step()


def _together(effects, solver, pairs):
    """Step a world in which several kinds of shape pairs collide, so that the contacts must be sorted.

    pairs: list of (shape, shape).
    """
    world = World(effects, solver=solver)
    for number, pair in enumerate(pairs):
        for shape in pair:
            world.add_body(shape, kind=_kind_of(shape), position=(80.0 * number, 0.0))
    world.step()


def _ground(effects, solver, tiles):
    """Make three steps of a world in which a box slides on `tiles`, a TileGrid or a one-way mask."""
    world = World(effects, solver=solver)
    world.add_body(tiles, kind="static")
    world.add_body(BOX, position=(8.0, -4.0), velocity=(120.0, 0.0))
    for _ in range(3):
        world.step()


def _rest(effects, solver):
    """Step a world with touching circles, in which contacts persist and begin, and islands fall asleep and wake.

    The last step has a fixed number of substeps; all others have adaptive substeps.
    """
    world = World(effects, solver=solver, gravity=(0.0, 0.0) if effects.gravity else None)
    for place in ((0.0, 0.0), (8.3, 0.0), (0.0, 8.3), (-7.95, 0.0)):  # gaps found as contacts; an overlap
        world.add_body(Circle(4), position=place)
        for _ in range(3):
            world.step()
    for _ in range(int(2.0 * SLEEP_TIME / world.dt) if effects.sleeping else 0):
        world.step()
    world.remove_body(world.add_body(Circle(4), position=(8.3, 8.3)))
    world.add_body(Circle(4), position=(40.0, 0.0), kind="kinematic", velocity=(9.0, 0.0))
    world.add_body(Circle(4), position=(7.0, 7.0), velocity=(-99.0, -99.0))
    world.step()
    world.substeps = 4
    world.step()


def _joints(effects, solver):
    """Step a world with a tree of joints, a slider with limits, a pulley and a gear, with each joint solver.

    One joint breaks. In the end a body falls asleep.
    """
    world = World(effects, solver=solver)
    if not world.stacks:
        return  # the solver does not solve joints
    bodies = [world.add_body(Circle(4), position=(7.0 * k, 0.0)) for k in range(4)]
    hinges = [world.add_joint(Revolute(None, body, at=body.position)) for body in bodies[:2]]
    if effects.rotation:
        world.add_joint(Gear(hinges[0], hinges[1]))
    chain = [world.add_joint(Weld(a, b, at=b.position)) for a, b in pairwise(bodies[1:])]
    over = {
        "at_a": bodies[2].position,
        "at_b": bodies[3].position,
        "ground_a": (14.0, -90.0),
        "ground_b": (21.0, -90.0),
    }
    world.add_joint(Pulley(bodies[2], bodies[3], **over))
    ball = world.add_body(Circle(4), position=(40.0, 0.0))
    world.add_joint(Prismatic(None, ball, at=ball.position, axis=(1.0, 0.0), limits=(-9.0, 9.0)))
    drag = world.add_joint(Target(bodies[3], at=bodies[3].position))
    for name in ("iterative", "direct", "auto"):
        world.joint_solver = name
        drag.point = (21.0, len(name))
        for substeps in ("auto", 4):
            world.substeps = substeps
            world.step()
    chain[1].breaks = (1e-9, 1e-9)
    world.step()
    world.step()
    if effects.sleeping:
        if effects.gravity:
            world.gravity = (0.0, 0.0)
        world.add_body(Circle(4), position=(400.0, 0.0))  # falls asleep, whatever the joints do
        for _ in range(int(2.0 * SLEEP_TIME / world.dt)):
            world.step()


def _carve(effects, solver):
    """Carve a large and a small mask with a circle, a polygon and a mask. A body lies on each carved mask."""
    world = World(effects, solver=solver)
    solid = np.ones((20, LARGE_MASK + MASK_TILE), bool)
    solid[0, 0] = False
    for mask in (PixelMask(solid), PixelMask(solid[:, :20])):
        body = world.add_body(mask, kind="static", position=(mask.size[0], 0.0))
        world.add_body(MASK, position=(mask.size[0], -12.0))
        world.step()
        for tool in (Circle(2), Polygon.box(2, 40), MASK):
            body.carve(tool, (mask.size[0] + 4.0, -8.0), crumb=0)
            world.step()


def _sensor(effects, solver):
    """Step a world in which a body overlaps a sensor, and then is teleported away from it."""
    world = World(effects, solver=solver)
    world.add_body(BOX, kind="static", sensor=True)
    body = world.add_body(BOX, position=(1, 0))
    world.step()
    body.move_to((90.0, 0.0))
    world.step()


def _crowd(effects):
    """Step a world with so many bodies that the dynamic tree of its broad phase is rebuilt."""
    world = World(effects, DynamicTree())
    world.add_bodies(Circle(1), np.array([(40.0 * number, 0.0) for number in range(2 * REBUILD_FROM)]))
    world.step()


def _impacts(effects, solver):
    """Step a world for each mode of continuous collision, in which fast bodies hit a static body and each other."""
    for way in ("ray", "swept", "toi"):
        world = World(effects, solver=solver)
        world.add_body(BOX, kind="static")
        world.add_body(Circle(2), position=(-20, 0), velocity=(3000.0, 0.0), continuous=way)
        world.add_body(BOX, position=(20, 0), velocity=(-3000.0, 0.0), continuous=way, bullet=way == "toi")
        world.add_body(BOX, position=(60, 0), velocity=(-6000.0, 0.0), continuous=way, bullet=way == "toi")
        world.step()
        world.step()


def _amid(effects, solver):
    """Step a world with one box in the middle of a cross-shaped mask, and another box above the mask.

    The box in the middle cannot be pushed out by any single convex part of the mask's outline.
    """
    arm = abs(np.arange(12) - 5.5) < 2.0
    world = World(effects, solver=solver, gravity=(0.0, 0.0) if effects.gravity else None)
    world.add_body(PixelMask(arm[:, None] | arm), kind="static")
    world.add_body(Polygon.box(2, 2), position=(0.5, 0.3))
    world.add_body(Polygon.box(2, 2), position=(0.0, -7.3))  # the gap is found as a contact
    for _ in range(3):
        world.step()


def _fit():
    """Compute the outline of a mask with a hole and a notch, which is not in the package's file of stored outlines."""
    solid = np.ones((23, 29), bool)
    solid[8:13, 9:17] = solid[:5, 20:] = False
    outline_of(PixelMask(solid))


def _zone(effects, solver):
    """Step a world with the effect `response` in which a slow and a fast mask overlap a sensor by their outlines."""
    world = World(effects, solver=solver)
    world.add_body(BOX, kind="static", sensor=True)
    world.add_body(MASK, position=(1, 0))
    world.add_body(MASK, position=(30, 0), velocity=(-3000.0, 0.0))
    world.step()


def _queries(effects, strategy):
    """Run ray casts and overlap queries with circles and boxes.

    A world without narrow phase calls the kernels of these shapes only in queries.
    """
    world = World(effects, strategy)
    world.add_body(Circle(4), kind="static")
    world.step()
    world.ray_cast((-20, 0), (40, 0))
    world.overlap(Circle(2), (0, 0, 0))
    world.add_body(BOX, position=(3, 3), kind="static")
    world.overlap(BOX, (0, 0, 0))


def _pixels(effects):
    """Run overlap and point queries against the pixels of a mask."""
    world = World(effects)
    world.add_body(MASK, kind="static")
    for shape in (Circle(2), BOX, MASK):
        world.overlap(shape, (0, 0, 0))
    world.query_point((0, 0))


def _casts_at_pixels(effects):
    """Run ray casts, shape casts and closest-point queries against two masks: a solid square and a ring.

    The outline of the ring has several convex parts.
    """
    world = World(effects)
    ring = np.ones((12, 12), bool)
    ring[4:8, 4:8] = False
    for number, mask in enumerate((MASK, PixelMask(ring))):
        world.add_body(mask, position=(0.0, 40.0 * number), kind="static")
        world.ray_cast((-20.0, 40.0 * number), (40.0, 1.0))
        world.shape_cast(Circle(2), (-20, 40.0 * number, 0), (40, 0))
        world.closest((9.0, 40.0 * number))


def _casts_at_a_chain(effects):
    world = World(effects)
    world.add_body(Chain([(0, 20), (0, -20)]), kind="static")
    for shape in (Circle(2), MASK):
        world.shape_cast(shape, (-20, 0, 0), (40, 0))


def _casts(effects):
    world = World(effects)
    world.add_body(Circle(4), kind="static")
    world.shape_cast(Circle(2), (-20, 0, 0), (40, 0))
    world.closest((9, 9))


def _character(effects, solver):
    world = World(effects, solver=solver)
    world.add_body(Polygon.box(40, 8), position=(0, 20), kind="kinematic", velocity=(60.0, 0.0))
    hero = Character(world, Polygon.box(8, 8), (0, 0))
    hero.move(1.0, 20.0)
    hero.blocked(1, 1)
    world.step()


def _contacts(effects):
    """Read world.contacts of overlapping masks, because the shared areas of masks are measured only on reading."""
    for mask in (MASK, EXACT):
        world = World(effects)
        for x in (0.0, 2.0):
            world.add_body(mask, position=(x, 0.0))
        world.step()
        len(world.contacts)


QUESTIONS = {"casts": _casts, "contacts": _contacts}
PIECES = (*PAIRS, "queries", *QUESTIONS, "characters")
