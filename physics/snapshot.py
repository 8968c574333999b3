"""Snapshots of a world, in memory and as `.npz` files without pickle, and the digest of its state."""

import hashlib
import json
import tokenize
import zipfile
import zlib
from dataclasses import astuple
from os import PathLike
from typing import Any

import numpy as np

from physics import checks
from physics.dynamics.awake import Awake
from physics.dynamics.sleepers import Island, Sleepers
from physics.shapes.convex import Capsule, Polygon
from physics.shapes.kinds import Shape
from physics.shapes.library import Library
from physics.shapes.lines import Chain, Segment
from physics.shapes.mask import PixelMask
from physics.shapes.material import Material
from physics.shapes.tiles import TileGrid
from physics.tables.body import BODY
from physics.tables.character import CHARACTER
from physics.tables.contact import EVENT
from physics.tables.manifold import ANCHOR, MANIFOLD
from physics.tables.shape import SHAPE
from physics.world_state import WorldState

VERSION = 3
HULLS = {
    "Polygon": lambda points, radius: Polygon(points, radius),
    "Capsule": lambda points, radius: Capsule(*points, radius=radius),
    "Segment": lambda points, radius: Segment(*points),
}
DAMAGE = (
    ValueError,
    TypeError,
    KeyError,
    IndexError,
    EOFError,
    OverflowError,
    AttributeError,
    zipfile.BadZipFile,
    zlib.error,
    RuntimeError,
    SyntaxError,
    tokenize.TokenError,
)
TABLES = {
    "bodies": BODY,
    "shapes": SHAPE,
    "characters": CHARACTER,
    "touching": EVENT,
    "sensing": EVENT,
    "told": MANIFOLD,
    "manifolds": MANIFOLD,
    "anchors": ANCHOR,
    "resting_touching": EVENT,
    "resting_sensing": EVENT,
    "island_manifolds": MANIFOLD,
    "island_anchors": ANCHOR,
    "island_touching": EVENT,
}
STATE = ("id", "x", "y", "angle", "vx", "vy", "angular_velocity", "awake", "sleep_time", "quarantined")
KEYS = ("shape_a", "shape_b", "feature", "normal_impulse", "tangent_impulse")
WALK = (
    "body",
    "left",
    "top",
    "remainder_x",
    "remainder_y",
    "riding",
    "riding_shape",
    "slope",
    "grounded",
    "squeezed",
    "pressed",
    "carry_x",
    "carry_y",
    "belt",
    "belt_x",
    "push_vx",
    "push_vy",
    "deep",
    "wedged",
)


def digest(world: WorldState) -> str:
    """blake2b-128 over ids, poses, velocities, flags, characters, contacts and impulses in id order; −0.0 as 0.0."""
    found = hashlib.blake2b(digest_size=16)
    for rows, names in ((world.bodies, STATE), (world.characters.rows, WALK), (world.contacts, KEYS)):
        found.update(len(rows).to_bytes(8, "little"))
        for name in names:
            column = np.ascontiguousarray(rows[name])
            found.update((column + 0.0 if column.dtype == np.float64 else column).tobytes())
    return found.hexdigest()


class Snapshot:
    """The state of a world at one moment. `save` and `load` keep it in a file."""

    def __init__(self, arrays: dict[str, np.ndarray], facts: dict[str, Any]) -> None:
        self.arrays = arrays
        self.facts = facts

    def save(self, path: str | PathLike[str]) -> None:
        """Write a versioned .npz."""
        named: dict[str, Any] = {"facts": np.array(json.dumps(self.facts)), **self.arrays}
        with open(path, "wb") as file:
            np.savez_compressed(file, **named)

    @classmethod
    def load(cls, path: str | PathLike[str]) -> "Snapshot":
        """Read a file. Raises ValueError with the file, and the reason why it is refused."""
        try:
            with np.load(path, allow_pickle=False) as stored:
                arrays = {name: stored[name] for name in stored.files}
            facts = json.loads(str(arrays.pop("facts")))
            if facts["version"] != VERSION:
                raise ValueError(f"it has version {facts['version']!r}, this program reads {VERSION}")
            for name, dtype in TABLES.items():
                if arrays[name].dtype != dtype:
                    raise ValueError(f"it has other columns in {name} than this program")
            _unpack(arrays, facts)
        except DAMAGE as error:
            raise ValueError(f"{path} is no snapshot of this program: {error!r}") from None
        return cls(arrays, facts)


def take(world: WorldState) -> Snapshot:
    """Copy the state of a world."""
    library = world.library
    arrays = {
        "bodies": world.bodies.copy(),
        "shapes": world.shapes.copy(),
        "characters": world.characters.rows.copy(),
        "touching": world.touching.rows.copy(),
        "sensing": world.sensing.rows.copy(),
        "told": world.told_manifolds().copy(),
        "manifolds": world.manifolds.copy(),
        "anchors": world.anchors.copy(),
        "resting_touching": world.sleepers.touching.copy(),
        "resting_sensing": world.sleepers.sensing.copy(),
        "stirred": np.array(world.awake.stirred, np.int64),
        **_islands_apart(world.sleepers.islands),
    }
    for number, shape in enumerate(library.outlines):
        arrays[f"hull_{number}"] = np.array(shape.points)
    for number, shape in enumerate(library.chain_shapes):
        arrays[f"chain_{number}"] = np.array(shape.points)
    for number, shape in enumerate(library.tile_grids):
        arrays[f"solid_{number}"], arrays[f"one_way_{number}"] = shape.solid, shape.one_way
        arrays[f"slopes_{number}"] = shape.slopes
    for number, shape in enumerate(library.masks):
        arrays[f"mask_{number}"] = shape.solid
    tiers = [[identity, tier, library.add(world._sources[identity][0])[1]] for identity, tier in world._tiers.items()]
    facts = {
        "version": VERSION,
        "effects": world.effects.names(),
        "next_body": world._next_body,
        "next_shape": world._next_shape,
        "gravity": world.gravity,
        "wind": world.wind,
        "drag": world.drag,
        "tiers": tiers,
        "random": world.random.bit_generator.state,
        "stacks": world.stacks,
        "hulls": [[type(shape).__name__, getattr(shape, "radius", 0.0)] for shape in library.outlines],
        "chains": [
            [shape.loop, shape.ghosts, shape.materials and [astuple(each) for each in shape.materials]]
            for shape in library.chain_shapes
        ],
        "tile_sizes": [shape.tile_size for shape in library.tile_grids],
        "origins": [shape.origin for shape in library.masks],
    }
    return Snapshot(arrays, facts)


def restore(world: WorldState, taken: Snapshot) -> None:
    """Put a world back to a snapshot of a world with the same effects. Raises TypeError, ValueError."""
    if not isinstance(taken, Snapshot):
        raise TypeError(f"snapshot must be a Snapshot (got {taken!r})")
    facts, arrays = taken.facts, taken.arrays
    if facts["effects"] != world.effects.names():
        raise ValueError(f"snapshot is of a world with {facts['effects']} (this one has {world.effects.names()})")
    try:
        unpacked = _unpack(arrays, facts)
    except DAMAGE as error:
        raise ValueError(f"snapshot is damaged: {error!r}") from None
    # Everything is known to fit: from here on nothing fails.
    world.library, world._shapes_of, world._sources, world.random = unpacked
    for table, name in ((world._bodies, "bodies"), (world._shapes, "shapes"), (world.characters, "characters")):
        table.count = 0
        table.append(len(arrays[name]))[:] = arrays[name]
    world.touching.restore(arrays["touching"])
    world.sensing.restore(arrays["sensing"])
    world.tell_contacts(arrays["told"].copy())
    world.manifolds, world.anchors = arrays["manifolds"].copy(), arrays["anchors"].copy()
    world.sleepers = _sleepers(arrays)
    if facts["stacks"] != world.stacks:
        # Under the other kind of solver manifolds keep other facts, and nobody knows of those that sleep.
        world.manifolds, world.anchors = world.manifolds[:0], world.anchors[:0]
        world.sleepers = Sleepers()
        world.bodies["awake"] = ~world.bodies["quarantined"]
    world.bodies["active"] = not world.sleeps
    world.awake = Awake(world.sleeps)
    world.awake.stir(arrays["stirred"].tolist())
    world._next_body, world._next_shape = facts["next_body"], facts["next_shape"]
    world.gravity, world.wind, world.drag = facts["gravity"], facts["wind"], facts["drag"]
    world._users = {identity: user for identity, user in world._users.items() if identity in world._shapes_of}
    world._tiers = {identity: tier for identity, tier, _ in facts["tiers"]}
    world.rebuild_proxies()
    world.queries.seen = ()


def _islands_apart(islands) -> dict:
    """Sleeping islands as flat arrays: each with the key that its rows belong to."""
    keys = sorted(islands)
    apart: dict[str, np.ndarray] = {"island_keys": np.array(keys, np.int64)}
    for name, empty in (
        ("bodies", np.zeros(0, np.int64)),
        ("manifolds", np.zeros(0, MANIFOLD)),
        ("anchors", np.zeros(0, ANCHOR)),
        ("touching", np.zeros(0, EVENT)),
    ):
        parts = [getattr(islands[key], name) for key in keys]
        apart["island_" + name] = np.concatenate([empty, *parts])
        apart[f"island_{name}_counts"] = np.array([len(part) for part in parts], np.int64)
    return apart


def _sleepers(arrays) -> Sleepers:
    """Sleeping islands from flat arrays."""
    sleepers, fields = Sleepers(), ("bodies", "manifolds", "anchors", "touching")
    parts = {
        name: np.split(arrays["island_" + name], np.cumsum(arrays[f"island_{name}_counts"])[:-1]) for name in fields
    }
    for number, key in enumerate(arrays["island_keys"].tolist()):
        sleepers.put(key, Island(*(parts[name][number].copy() for name in fields)))
    sleepers.touching, sleepers.sensing = arrays["resting_touching"].copy(), arrays["resting_sensing"].copy()
    return sleepers


def _unpack(arrays, facts):
    """(library, shapes of each body, sources of tiers, random generator) of a snapshot; raises one of DAMAGE."""
    library = _library(arrays, facts)
    shapes_of: dict[int, tuple[Shape, ...]] = {identity: () for identity in arrays["bodies"]["id"].tolist()}
    rows = arrays["shapes"]["body_row"]
    if len(rows) and not (0 <= rows.min() and rows.max() < len(arrays["bodies"])):
        raise ValueError("a shape belongs to no body")
    for row in arrays["shapes"]:
        shapes_of[int(row["body"])] += (library.shape_of(row),)
    sources = {identity: (library.masks[mask],) for identity, _, mask in facts["tiers"]}
    random = np.random.default_rng()
    random.bit_generator.state = facts["random"]
    _sleepers(arrays)
    checks.ids("stirred", arrays["stirred"])
    for name in ("next_body", "next_shape"):
        checks.whole(name, facts[name], 0, 2**62)
    for name in ("gravity", "wind"):
        checks.vector(name, facts[name])
    checks.number("drag", facts["drag"], low=0.0)
    return library, shapes_of, sources, random


def _library(arrays, facts):
    library = Library()
    for number, (name, radius) in enumerate(facts["hulls"]):
        points = tuple(map(tuple, arrays[f"hull_{number}"].tolist()))
        library.add(HULLS[name](points, radius))
    for number, (loop, ghosts, materials) in enumerate(facts["chains"]):
        library.add(
            Chain(arrays[f"chain_{number}"], loop, ghosts, materials and tuple(Material(*each) for each in materials))
        )
    for number, size in enumerate(facts["tile_sizes"]):
        library.add(TileGrid(arrays[f"solid_{number}"], size, arrays[f"one_way_{number}"], arrays[f"slopes_{number}"]))
    for number, origin in enumerate(facts["origins"]):
        library.add(PixelMask(arrays[f"mask_{number}"], tuple(origin)))
    return library
