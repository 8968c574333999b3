"""Snapshots of a world, in memory and as `.npz` files without pickle, and digests (hashes) of the world's state."""

import contextlib
import hashlib
import io
import json
import lzma
import os
import re
import stat
import time
import tokenize
import zipfile
import zlib
from dataclasses import astuple
from os import PathLike
from typing import Any

import numpy as np

from physics import checks
from physics.hints import MATERIALS
from physics.islands.awake import Awake
from physics.islands.sleep import Island, SleepingSet
from physics.joint import JOINT_SOLVERS
from physics.math2d import Vec2
from physics.settings import tolerances
from physics.shapes.kinds import SHAPES
from physics.shapes.library import Geometries, Library
from physics.shapes.mask import PixelMask
from physics.shapes.shape import Filter, Material, Shape
from physics.shapes.values import Chain, Convex, TileGrid
from physics.step import PUSHING, SOLVERS
from physics.tables.body import BODY, BODY_DEF
from physics.tables.character import CHARACTER
from physics.tables.contact import CONTACT, EVENT
from physics.tables.joint import BROKEN, COUPLED_SCRATCH, COUPLED_STATE, GEARED, JOINT, NO_JOINT, TOOTHED, WORLD
from physics.tables.joint import STATE as STATE_OF_JOINTS
from physics.tables.shape import MASK, PART, SHAPE
from physics.tables.table import joined
from physics.world_state import WorldState, checked_substeps

# ---- stored shapes ---------------------------------------------------------------------------------------------------
# Conversion of the shapes of a world to arrays and JSON values, for files, and back.


def pack_geometry(geometry: Geometries) -> tuple[dict[str, np.ndarray], dict[str, Any]]:
    """Convert shapes to values for a file. Return ({name: array}, dict of all other values, which JSON can represent).

    geometry: the shapes.
    """
    arrays = {}
    for number, shape in enumerate(geometry.outlines):
        arrays[f"hull_{number}"] = np.array(shape.points)
    for number, shape in enumerate(geometry.chains):
        arrays[f"chain_{number}"] = np.array(shape.points)
    for number, shape in enumerate(geometry.grids):
        arrays[f"solid_{number}"], arrays[f"one_way_{number}"] = shape.solid, shape.one_way
        arrays[f"slopes_{number}"] = shape.slopes
    for number, shape in enumerate(geometry.masks):
        arrays[f"mask_{number}"] = shape.solid
    facts = {
        "hulls": [[type(shape).__name__, shape._facts()] for shape in geometry.outlines],
        "chains": [
            [shape.loop, shape.ghosts, shape.materials and [astuple(each) for each in shape.materials]]
            for shape in geometry.chains
        ],
        "tile_sizes": [shape.tile_size for shape in geometry.grids],
        "masks": [[shape.origin, shape.snap, shape.smooth, shape.one_way, shape.carved] for shape in geometry.masks],
    }
    return arrays, facts


def unpack_geometry(arrays: dict[str, np.ndarray], facts: dict[str, Any]) -> Geometries:
    """Convert `arrays` and `facts`, the two results of pack_geometry, back to shapes, and return the shapes.

    Raises KeyError, TypeError or ValueError for damaged data.
    """
    outlines, masks = [], []
    types = {each.__name__: each for each in SHAPES if issubclass(each, Convex)}
    for number, (name, given) in enumerate(facts["hulls"]):
        points = tuple(map(tuple, arrays[f"hull_{number}"].tolist()))
        outlines.append(types[name]._load(points, given))
    chains = [
        Chain(arrays[f"chain_{number}"], loop, ghosts, materials and tuple(Material(*each) for each in materials))
        for number, (loop, ghosts, materials) in enumerate(facts["chains"])
    ]
    grids = [
        TileGrid(arrays[f"solid_{number}"], size, arrays[f"one_way_{number}"], arrays[f"slopes_{number}"])
        for number, size in enumerate(facts["tile_sizes"])
    ]
    for number, (origin, snap, smooth, one_way, carved) in enumerate(facts["masks"]):
        mask = PixelMask(arrays[f"mask_{number}"], tuple(origin), snap, smooth, one_way)
        masks.append(mask.with_tiles(mask.tiles) if carved else mask)
    return Geometries(outlines, chains, grids, masks)


# ---- snapshot --------------------------------------------------------------------------------------------------------
# Snapshots of a world, in memory and as `.npz` files without pickle.

VERSION = 15
ABANDONED = 3600.0  # [s] without a write after which a file counts as abandoned
SETTINGS = (
    "solver",
    "joint_solver",
    "dt",
    "substeps",
    "accuracy",
    "restitution_speed",
    "gravity",
    "drag",
    "wind",
)  # restore() sets these
# These settings are restored without checking their effects: after set_effects they may have inert values.
FIELDS = ("gravity", "drag", "wind")
DAMAGE = (
    ValueError, TypeError, KeyError, IndexError, EOFError,
    OSError,  # for data that is marked as bzip2 but is not
    lzma.LZMAError, OverflowError, AttributeError, zipfile.BadZipFile, zlib.error, RuntimeError, SyntaxError,
    tokenize.TokenError,
)  # fmt: skip
TABLES = {
    "bodies": BODY,
    "given": BODY_DEF,
    "shapes": SHAPE,
    "characters": CHARACTER,
    "touching": EVENT,
    "sensing": EVENT,
    "reported": CONTACT,
    "contact_rows": CONTACT,
    "resting_touching": EVENT,
    "resting_sensing": EVENT,
    "island_contacts": CONTACT,
    "island_touching": EVENT,
    "joints": JOINT,
    "lost_joints": BROKEN,
}
# Absent from files of older programs: tables, and columns of tables, which are then 0.
LATER = {"joints": np.zeros(0, JOINT), "lost_joints": np.zeros(0, BROKEN)}
LATER_COLUMNS = {"joints": {"is_pin", *(name for name, _ in (*COUPLED_STATE, *COUPLED_SCRATCH))}}


def _as_laid_out(name, rows, dtype) -> np.ndarray:
    """Convert the rows of a stored table to `dtype`, this program's row type, and return them.

    The stored columns may be in another order. Columns in LATER_COLUMNS may be missing; their values are then 0. name:
    name of the table. Raises ValueError if the columns differ otherwise.
    """
    columns = rows.dtype.fields or {}
    absent = LATER_COLUMNS.get(name, set()) - columns.keys()
    asked = [each for each in dtype.names if each not in absent]
    if {each: columns[each][0] for each in columns} != {each: dtype.fields[each][0] for each in asked}:
        raise ValueError(f"it has other columns in {name} than this program")
    if rows.dtype != dtype:
        moved = np.zeros(len(rows), dtype)
        for each in asked:
            moved[each] = rows[each]
        return moved
    # The dtype object itself, not an equal one: with another object each kernel call looks up its types
    # again, and a step of 79 boxes takes 8 ms instead of 0.2 ms.
    return rows.view(dtype)


class Snapshot:
    """A copy of the state of a world. World.snapshot returns a Snapshot; World.restore sets a world to its state."""

    def __init__(self, arrays: dict[str, np.ndarray], facts: dict[str, Any], geometry: Any = None) -> None:
        for name, value in (("arrays", arrays), ("facts", facts)):
            if not isinstance(value, dict):
                raise TypeError(f"{name} must be a dict, as World.snapshot() makes it (got {checks.shown(value)})")
        self.arrays = arrays
        self.facts = facts
        # The shapes of a library by kind and row. Shapes are immutable, and carved masks share unchanged tiles, so
        # nothing is copied before the snapshot is saved.
        self.geometry = geometry

    def __repr__(self):
        """Return a text with the numbers of bodies and joints, the time, the solver and the effects."""
        counts = [f"{len(self.arrays[name])} {name}" for name in ("bodies", "joints") if name in self.arrays]
        facts = [f"{name}={self.facts[name]!r}" for name in ("time", "solver", "effects") if name in self.facts]
        return f"Snapshot({', '.join([*counts, *facts])})"

    def save(self, path: str | PathLike[str]) -> None:
        """Write the snapshot to a versioned .npz file. An existing file is replaced atomically.

        path: path of the file.

        The data is first written to <path>.<process id>.part. Older .part files of the same path are deleted if they
        were last written more than an hour ago. Raises OSError if writing fails; an existing file is then unchanged.
        Raises TypeError if path is not a path.
        """
        arrays, facts = pack_geometry(self.geometry)
        named: dict[str, Any] = {"facts": np.array(json.dumps(self.facts | facts)), **self.arrays, **arrays}
        there = _checked_path(path)
        whole = os.path.isfile(there) or not os.path.exists(there)  # a device or a pipe is written directly
        beside = f"{there}.{os.getpid()}.part" if whole else there
        if whole:
            _remove_abandoned(there)
        try:
            with open(beside, "wb") as file:
                np.savez_compressed(file, **named)
            if whole:
                os.replace(beside, there)
        finally:
            if whole and os.path.exists(beside):
                os.remove(beside)

    @classmethod
    def load(cls, path: str | PathLike[str]) -> "Snapshot":
        """Read a snapshot from a file that save() has written, and return the Snapshot.

        path: path of the file.

        Raises OSError if the file cannot be opened; ValueError, with path and reason, if the file is damaged or has
        another version; TypeError if path is not a path.
        """
        with open(_checked_path(path), "rb") as file:
            content = io.BytesIO(file.read())
        if not zipfile.is_zipfile(content):
            raise ValueError(f"{path} is no snapshot of this program: it is not an .npz file")
        content.seek(0)
        try:
            with np.load(content, allow_pickle=False) as stored:
                arrays = {name: stored[name] for name in stored.files}
            facts = json.loads(str(arrays.pop("facts")))
            if facts["version"] != VERSION:
                raise ValueError(f"it has version {facts['version']!r}, this program reads {VERSION}")
            arrays = LATER | arrays
            for name, dtype in TABLES.items():
                arrays[name] = _as_laid_out(name, arrays[name], dtype)
            geometry = unpack_geometry(arrays, facts)
            _unpack(arrays, facts, geometry)
        except DAMAGE as error:
            raise ValueError(f"{path} is no snapshot of this program: {error!r}") from None
        return cls(arrays, facts, geometry)


def _checked_path(path: Any) -> str:
    """Return a path as a str. Raises TypeError for anything but a str, bytes or path object.

    Raises ValueError for an empty str. An int, which open() would use as a file descriptor, raises TypeError too.
    """
    try:
        found = os.fsdecode(path)
    except TypeError:
        raise TypeError(f"path must be a str or a pathlib.Path (got {checks.shown(path)})") from None
    if not found:
        raise ValueError("path must name a file (got '')")
    return found


def _remove_abandoned(path: str) -> None:
    """Delete the .part files of a path that were last written more than an hour ago. See Snapshot.save."""
    folder, name = os.path.split(os.path.abspath(path))
    part = re.compile(re.escape(name) + r"\.[0-9]+\.part")
    with contextlib.suppress(OSError):
        for found in [os.path.join(folder, each) for each in os.listdir(folder) if part.fullmatch(each)]:
            status = os.lstat(found)
            if stat.S_ISREG(status.st_mode) and time.time() - status.st_mtime > ABANDONED:
                os.remove(found)


def take(world: WorldState) -> Snapshot:
    """Return a Snapshot of a world."""
    library = world.library
    arrays = {
        "bodies": world.bodies.copy(),
        "given": world._definitions.rows.copy(),
        "shapes": world.shapes.copy(),
        "characters": world.characters.rows.copy(),
        "joints": world.joints.copy(),
        "lost_joints": np.array(world._lost_joints, BROKEN),
        "touching": world.touching_pairs.rows.copy(),
        "sensing": world.sensing_pairs.rows.copy(),
        "reported": world.reported_rows().copy(),
        "contact_rows": world.contact_rows.copy(),
        "resting_touching": world.sleeping_set.touching_pairs.copy(),
        "resting_sensing": world.sleeping_set.sensing_pairs.copy(),
        "dirty": np.unique(np.array(world.awake.dirty, np.int64)),
        "aimed": np.array([*world._targets], np.int64),
        "targets": np.array([*world._targets.values()], np.float64).reshape(-1, 3),
        **_islands_apart(world.sleeping_set.islands),
    }
    tiers = [[identity, tier, library.add(world._sources[identity][0])[1]] for identity, tier in world._tiers.items()]
    facts = {
        "version": VERSION,
        "effects": world.effects.names(),
        "next_body": world._next_body,
        "next_shape": world._next_shape,
        "next_joint": world._next_joint,
        "pixels_per_meter": world.tolerances.pixels_per_meter,
        "time": world.time,
        "span": world.span,
        **{name: getattr(world, name) for name in SETTINGS},
        "tiers": tiers,
        "random": world.random.bit_generator.state,
    }
    return Snapshot(arrays, facts, library.shapes_by_row())


def _other_effects(stored, present):
    """Return the error message for a snapshot whose effects differ from those of the world.

    stored: names of the snapshot's effects; present: names of the world's effects.
    """
    sides = ("only the snapshot has", stored - present), ("only this world has", present - stored)
    text = ", ".join(f"{side} {', '.join(sorted(names))}" for side, names in sides if names)
    return f"snapshot must be of a world with the same effects: {text}"


def restore(world: WorldState, taken: Snapshot) -> None:
    """Set a world to the state in the snapshot `taken`.

    Raises TypeError for anything but a Snapshot; ValueError if the snapshot is damaged, or if its effects or
    pixels_per_meter differ from those of the world. The world is then unchanged.
    """
    if not isinstance(taken, Snapshot):
        hint = ": write Snapshot.load(path)" if isinstance(taken, (str, PathLike)) else ""
        raise TypeError(f"snapshot must be a Snapshot (got {checks.shown(taken)}){hint}")
    facts, arrays = taken.facts, taken.arrays
    try:
        unpacked = _unpack(arrays, facts, taken.geometry)
    except DAMAGE as error:
        raise ValueError(f"snapshot is damaged: {checks.shown(error)}") from None
    if facts["effects"] != world.effects.names():
        raise ValueError(_other_effects(set(facts["effects"]), set(world.effects.names())))
    scale = world.tolerances.pixels_per_meter
    if facts["pixels_per_meter"] != scale:
        raise ValueError(
            f"snapshot is of a world with pixels_per_meter {facts['pixels_per_meter']!r} (this one has {scale!r}): "
            "its tolerances are others"
        )
    # All data has been checked: nothing fails from here on.
    for name in SETTINGS:
        value = facts.get(name, "auto") if name == "joint_solver" else facts[name]
        if name in FIELDS:
            vars(world)["_" + name] = value if name == "drag" else Vec2(*value)
        elif getattr(world, name) != value:
            setattr(world, name, value)
    world.time, world.span = facts["time"], facts["span"]
    world.library, world._shapes_of, world._sources, world.random = unpacked
    for table, name in (
        (world._bodies, "bodies"),
        (world._definitions, "given"),
        (world._shapes, "shapes"),
        (world.characters, "characters"),
        (world._joints, "joints"),
    ):
        table.count = 0
        table.append(len(arrays[name]))[:] = arrays[name]
    world._write_runs()
    world.touching_pairs.restore(arrays["touching"])
    world.sensing_pairs.restore(arrays["sensing"])
    world.report_contacts(arrays["reported"].copy())
    world.contact_rows = arrays["contact_rows"].copy()
    world.sleeping_set = _sleepers(arrays)
    if not world.sleeps:
        world.bodies["active"] = True
    world.awake = Awake(world.sleeps)
    world.awake.mark_dirty(arrays["dirty"].tolist())
    world._next_body, world._next_shape = facts["next_body"], facts["next_shape"]
    world._next_joint, world._lost_joints = facts.get("next_joint", 0), arrays["lost_joints"].tolist()
    known = set(arrays["joints"]["id"].tolist())
    world._joint_users = {identity: user for identity, user in world._joint_users.items() if identity in known}
    world._targets = _targets(arrays)
    world._users = {identity: user for identity, user in world._users.items() if identity in world._shapes_of}
    world._tiers = {identity: tier for identity, tier, _ in facts["tiers"]}
    world.rebuild_proxies()
    world.queries.seen = ()


def _islands_apart(islands) -> dict:
    """Convert the sleeping islands to arrays, and return them as {name: array}. islands: SleepingSet.islands.

    The arrays are the keys of the islands; the bodies, contacts and touching pairs of all islands, concatenated in the
    order of keys; and for each of these three tables the number of rows of each island.
    """
    keys = sorted(islands)
    apart: dict[str, np.ndarray] = {"island_keys": np.array(keys, np.int64)}
    for name, empty in (
        ("bodies", np.zeros(0, np.int64)),
        ("contacts", np.zeros(0, CONTACT)),
        ("touching", np.zeros(0, EVENT)),
    ):
        parts = [getattr(islands[key], name) for key in keys]
        apart["island_" + name] = joined([empty, *parts])
        apart[f"island_{name}_counts"] = np.array([len(part) for part in parts], np.int64)
    return apart


def _sleepers(arrays) -> SleepingSet:
    """Convert the arrays of a snapshot that _islands_apart has made back to a SleepingSet, and return it."""
    sleeping_set, fields = SleepingSet(), ("bodies", "contacts", "touching")
    parts = {
        name: np.split(arrays["island_" + name], np.cumsum(arrays[f"island_{name}_counts"])[:-1]) for name in fields
    }
    for number, key in enumerate(arrays["island_keys"].tolist()):
        sleeping_set.put(key, Island(*(parts[name][number].copy() for name in fields)))
    sleeping_set.touching_pairs = arrays["resting_touching"].copy()
    sleeping_set.sensing_pairs = arrays["resting_sensing"].copy()
    return sleeping_set


def _unpack(arrays, facts, geometry):
    """Check the data of a snapshot. Return (library, shapes by body id, original masks by body id, random generator).

    The original masks are those of bodies with a tier, whose mask was replaced by simpler shapes. arrays, facts,
    geometry: the attributes of the Snapshot. Raises one of the errors in DAMAGE for invalid data.
    """
    library = Library.of(geometry)
    shapes_of: dict[int, tuple[Shape, ...]] = {identity: () for identity in arrays["bodies"]["id"].tolist()}
    rows = arrays["shapes"]["body_row"]
    if len(rows) and not (0 <= rows.min() and rows.max() < len(arrays["bodies"])):
        raise ValueError("a shape belongs to no body")
    for row in arrays["shapes"][arrays["shapes"]["role"] != PART]:
        shapes_of[int(row["body"])] += (_with_own_values(library.shape_of(row), row),)
    sources = {identity: (library.masks[mask],) for identity, _, mask in facts["tiers"]}
    random = np.random.default_rng()
    random.bit_generator.state = facts["random"]
    _sleepers(arrays)
    checks.ids("dirty", arrays["dirty"])
    for name in ("next_body", "next_shape"):
        checks.whole(name, facts[name], 0, 2**62)
    checks.whole("next_joint", facts.get("next_joint", 0), 0, 2**62)
    joined = np.concatenate([arrays["joints"][name] for name in ("body_a", "body_b")])
    if not set(joined[joined != WORLD].tolist()) <= shapes_of.keys():
        raise ValueError("a joint has a body that is not there")
    gears = arrays["joints"][arrays["joints"]["hold"] == GEARED]
    coupled = np.concatenate([gears[name] for name in ("joint_a", "joint_b")])
    if not np.isin(coupled[coupled != NO_JOINT], arrays["joints"]["id"]).all():
        raise ValueError("a gear couples a joint that is not there")
    if len(arrays["given"]) != len(arrays["bodies"]) or not set(_targets(arrays)) <= shapes_of.keys():
        raise ValueError("what is said of bodies is said of others")
    for name in ("gravity", "wind"):
        checks.vector(name, facts[name])
    for name in ("drag", "time", "span", "restitution_speed"):
        checks.number(name, facts[name], low=0.0)
    for name in ("dt", "pixels_per_meter", "accuracy"):
        checks.number(name, facts[name], above=0.0)
    checked_substeps(facts["substeps"])
    checks.choice("joint_solver", facts.get("joint_solver", "auto"), JOINT_SOLVERS)
    checks.choice("solver", facts["solver"], SOLVERS if "stacking" in facts["effects"] else [*PUSHING])
    return library, shapes_of, sources, random


def _with_own_values(shape, row) -> Shape:
    """Return a copy of a shape with its own material, filter and sensor flag from a SHAPE row.

    A value that the row does not mark as the shape's own is None in the copy.
    """
    material = Material(*(row[name].item() for name in MATERIALS)) if row["own_material"] else None
    filter = Filter(row["membership"].item(), row["mask"].item()) if row["own_filter"] else None
    return shape.with_(material, filter, row["sensor"].item() if row["own_sensor"] else None)


def _targets(arrays) -> dict:
    """Return the targets of kinematic bodies in a snapshot, {body id: (x [px], y [px], angle [rad])}."""
    ids, poses = checks.ids("aimed", arrays["aimed"]), checks.columns("targets", arrays["targets"], width=3)
    return dict(zip(ids.tolist(), map(tuple, poses.tolist()), strict=True))


# ---- digest ----------------------------------------------------------------------------------------------------------
# The digest of a world: two worlds with equal digests continue equally.

# Increased by every change of the program that changes the digest of some world. Older recordings can still be played,
# but may diverge.
PHYSICS_VERSION = 12
STATE = ("id", "x", "y", "angle", "vx", "vy", "angular_velocity", "awake", "quarantined")
CLOCK = tuple(f"{test}_{name}" for test in ("still", "rocking") for name in ("x", "y", "angle"))
CLOCK = (*CLOCK, "sleep_time", "rocking_time")
ASKED = ("substeps", "cooldown")  # hashed only if substeps is "auto" and the solver stacks
# Hashed values of bodies and shapes. Materials are left out, because they may be inert without their effect.
GIVEN_COLUMNS = ("kind", "inverse_mass", "inverse_inertia", "gravity_scale", "continuous", "bullet")
SHAPE_COLUMNS = ("id", "membership", "mask", "sensor")
NARROW = {"kind": np.int8, "continuous": np.int8, "membership": np.uint32, "mask": np.uint32}
KEYS = ("shape_a", "shape_b", "feature", "normal_impulse", "tangent_impulse")
WALK = (
    "body", "left", "top", "remainder_x", "remainder_y", "riding", "riding_shape", "slope", "grounded", "squeezed",
    "pressed", "carry_x", "carry_y", "belt", "belt_x", "push_vx", "push_vy", "deep", "wedged",
)  # fmt: skip


def digest(world: WorldState) -> str:
    """Return a hash of the state on which the next step depends: blake2b-128, as 32 hexadecimal digits.

    The hash covers the solver, dt and substeps; poses, velocities, flags, masses, filters, characters, contacts and
    impulses, each in the order of ids; and joints, targets and forces of the next step. −0.0 counts as 0.0. Materials
    and random numbers are not included.
    """
    found = hashlib.blake2b(digest_size=16)
    auto = world.substeps == "auto"
    pace = (0, world.accuracy) if auto else (world.substeps,)
    numbers = np.array((world.dt, *pace, world.tolerances.pixels_per_meter), np.float64)
    found.update(world.solver.encode() + numbers.tobytes())
    tables = (
        (world.bodies, (*STATE, *CLOCK, *GIVEN_COLUMNS, *(ASKED if auto and world.stacks else ()))),
        (world.shapes, SHAPE_COLUMNS),
        (world.characters.rows, WALK),
        (world.contacts, KEYS),
    )
    for table, names in tables:
        rows = np.asarray(table)  # its columns may have computed names
        found.update(len(rows).to_bytes(8, "little"))
        for name in names:
            column = rows[name].astype(NARROW.get(name, rows.dtype[name]))
            found.update((column + 0.0 if column.dtype == np.float64 else column).tobytes())
    exact = world.shapes["id"][(world.shapes["kind"] == MASK) & ~world.shapes["snap"]]
    if len(exact):
        found.update(b"exact" + exact.tobytes())
    masks = [shape for shapes in world._shapes_of.values() for shape in shapes if isinstance(shape, PixelMask)]
    if any(mask.one_way for mask in masks):
        found.update(b"one way" + bytes([mask.one_way for mask in masks]))
    for mask in masks if world.effects.carving else ():
        if mask.carved:
            found.update(b"carved" + mask.fingerprint)
    if world.stacks and world.span not in (0.0, world.dt):
        found.update(b"span" + np.float64(world.span).tobytes())
    # State that only the next step reads. If it is empty, nothing is hashed.
    speed = world.tolerances.restitution_speed
    if speed != tolerances(world.tolerances.pixels_per_meter).restitution_speed:
        found.update(b"restitution_speed" + np.float64(speed + 0.0).tobytes())
    if world.effects.joints and len(world.joints):
        found.update(world.joint_solver.encode())
        joints = np.asarray(world.joints)
        for name, kind in STATE_OF_JOINTS:
            found.update((joints[name] + 0.0 if kind is np.float64 else joints[name]).tobytes())
        coupled = joints[joints["hold"] >= TOOTHED]
        for name, kind in COUPLED_STATE if len(coupled) else ():
            found.update((coupled[name] + 0.0 if kind is np.float64 else coupled[name]).tobytes())
    restless = world.bodies["id"][~world.bodies["allow_sleep"]]
    if len(restless):
        found.update(b"allow_sleep" + restless.tobytes())
    targets = world._targets
    for identity in sorted(targets):
        found.update(
            b"target" + np.array([identity], np.int64).tobytes() + (np.array(targets[identity]) + 0.0).tobytes()
        )
    waiting = np.stack([world.bodies[name] for name in ("force_x", "force_y", "torque")], axis=1) + 0.0
    rows = np.flatnonzero(waiting.any(axis=1))
    if len(rows):
        found.update(b"forces" + world.bodies["id"][rows].tobytes() + waiting[rows].tobytes())
    return found.hexdigest()
