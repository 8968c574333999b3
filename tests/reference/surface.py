"""The public names of physics: its exports, the classes of its results, and the members of these classes."""

import ast
import functools
import inspect
from collections.abc import Iterator
from types import FunctionType
from typing import Any, NamedTuple

import physics
from physics import debug
from physics.background import Background
from physics.broadphase.proxies import Strategy
from physics.carving import Carved
from physics.events import Events
from physics.joints.kinds import Kind
from physics.queries.index import Visited
from physics.queries.pairs import Distance as DistanceResult
from physics.raster.bits import Turned
from physics.settings import Tolerances
from physics.shapes.shape import EqualByValue, Shape
from physics.shapes.values import Convex
from physics.world_state import Handle, Profile, WorldState
from tests.reference.docstrings import annotations, definition, described, documentation, parameters, split_example

# Classes that physics does not export, but whose values it returns or takes.
RETURNED = {
    "Background": Background,
    "Carved": Carved,
    "Events": Events,
    "Kind": Kind,
    "Profile": Profile,
    "Shape": Shape,
    "Strategy": Strategy,
    "Tolerances": Tolerances,
    "Turned": Turned,
    "distance.Distance": DistanceResult,
    "debug.Drawn": debug.Drawn,
    "debug.Structure": debug.Structure,
    "debug.Visited": Visited,
}
# Classes of results: their fields are read, and no user makes one.
RESULTS = {
    "Carved", "Fit", "Manifold", "Mass", "Moved", "RayHit", "TimeOfImpact", "Tolerances", "Turned", "debug.Drawn",
    "debug.Structure", "debug.Visited", "distance.Distance",
}  # fmt: skip
# A base class whose members are members of the class of this name.
BASES = {WorldState: "World", Handle: "Body", EqualByValue: "Shape", Convex: "Shape"}
# Modules of physics share these attributes; they are no part of the contract.
INNER = {
    "World": {
        "awake", "characters", "contact_lists", "contact_rows", "ghosts", "library", "pairs", "queries",
        "rebuild_proxies", "refresh_character_rows", "report_contacts", "reported_rows", "sensed", "sensing_pairs",
        "sleeping_set", "span", "touching_pairs", "workspace",
    },
    "PixelMask": {
        "blocks", "bucket_at", "carved", "fingerprint", "fitted", "like", "solid_box", "tiles", "turned_to",
        "window", "with_tiles", "with_values_of",
    },
    "TileGrid": {"blocks", "is_empty"},
    "Polygon": {"known"},
    "Shape": {"bare", "snap", "with_values_of"},
    "Profile": {"__init__", "begin", "work"},
    "Events": {"__init__"},
    "Snapshot": {"__init__", "arrays", "facts", "geometry"},
    "Character": {"world", "shape", "clips"},
    "Background": {"__init__", "workers"},
    "DynamicTree": {"leaf_of", "nodes", "state", "stack", "leaves", "spans", "twice"},
    "SpatialHashGrid": {"base", "tuned_for", "chains", "near_entries", "lists"},
    "SweepAndPrune": {"updates", "sorted"},
}  # fmt: skip


# Members for those who add a shape, a kind of joint or a broad phase; CONTRIBUTING.md shows how. They need no example.
EXTENSIONS = {
    "Kind",
    "Kind.sides", "Kind.columns", "Kind.with_lengths", "Pulley.with_rope", "Strategy.update", "Strategy.query",
    "Strategy.query_box", "Strategy.structure",
}  # fmt: skip


class Item(NamedTuple):
    """A public name."""

    name: str  # such as World.add_body
    kind: str  # class, function, method, class method, property, attribute or constant
    member: Any
    owner: type | None

    @property
    def repeats(self) -> str | None:
        """Return the name of the interface member that this item implements, or None."""
        if self.owner not in physics.BROADPHASES.values() or not hasattr(Strategy, self.name.rsplit(".", 1)[1]):
            return None
        return "Strategy." + self.name.rsplit(".", 1)[1]

    @property
    def is_callable(self) -> bool:
        """Return whether the item can be called with arguments."""
        return self.kind in ("class", "function", "method", "class method")

    @property
    def parameters(self) -> dict[str, inspect.Parameter]:
        """Return the parameters of the item by name, with stars."""
        return parameters(self.member) if self.is_callable and takes_arguments(self) else {}

    @property
    def documentation(self) -> str | None:
        """Return the docstring of the item without its example, or None."""
        if self.kind == "attribute":
            assert self.owner is not None
            return described_class(self.owner).get(self.name.rsplit(".", 1)[1])
        return split_example(documentation(self.member))[0] if self.kind != "constant" else None

    @property
    def example(self) -> str:
        """Return the doctest in the docstring of the item, "" if there is none."""
        return split_example(documentation(self.member))[1] if self.kind not in ("constant", "attribute") else ""

    @property
    def annotations(self) -> dict[str, str]:
        """Return the annotations of the item as written, by argument."""
        return annotations(self.member)


def takes_arguments(item: Item) -> bool:
    """Return whether an item takes arguments; classes whose instances are only returned do not."""
    return item.kind != "class" or "__init__" not in INNER.get(item.name, ()) and item.name not in ("Shape", "Strategy")


@functools.cache
def described_class(kind: type) -> dict[str, str]:
    """Return {name: meaning} of the arguments and attributes that the docstring of a class explains."""
    known = {*attributes(kind), *(parameters(kind) if kind is not Strategy else ())}
    return described(split_example(documentation(kind))[0], known).arguments


@functools.cache
def attributes(kind: type) -> dict[str, str]:
    """Return {name: annotation} of the public attributes of instances of a class, without properties."""
    found: dict[str, str] = {}
    for base in reversed(kind.__mro__):
        node = definition(base) if base.__module__.startswith("physics.") else None
        if not isinstance(node, ast.ClassDef):
            continue
        for each in node.body:
            if isinstance(each, ast.AnnAssign) and isinstance(each.target, ast.Name):
                found[each.target.id] = ast.unparse(each.annotation)
            elif isinstance(each, ast.Assign):
                for name in (target.id for target in each.targets if isinstance(target, ast.Name)):
                    found.setdefault(name, "")
            elif isinstance(each, ast.FunctionDef) and each.name == "__init__":
                for name, annotation in assigned(each):
                    found.setdefault(name, annotation)
    known = dir(kind)
    return {
        name: annotation
        for name, annotation in found.items()
        if not name.startswith("_")
        and (name not in known or not isinstance(inspect.getattr_static(kind, name), property))
        and not name.isupper()
    }


def assigned(function: ast.FunctionDef) -> Iterator[tuple[str, str]]:
    """Yield (name, annotation) of the attributes of self that a method assigns."""
    for node in ast.walk(function):
        if not isinstance(node, ast.Assign | ast.AnnAssign):
            continue
        targets = node.targets if isinstance(node, ast.Assign) else [node.target]
        for target in targets:
            for each in target.elts if isinstance(target, ast.Tuple) else [target]:
                if isinstance(each, ast.Attribute) and isinstance(each.value, ast.Name) and each.value.id == "self":
                    yield each.attr, ast.unparse(node.annotation) if isinstance(node, ast.AnnAssign) else ""


def owner_of(base: type, names: dict[type, str]) -> str | None:
    """Return the public name of the class that documents the members of a class, or None."""
    return BASES.get(base) or names.get(base)


@functools.cache
def items() -> dict[str, Item]:
    """Return {name: Item} of all public names in order: exports, classes of results, physics.debug; members follow
    their class.
    """
    exported = {name: getattr(physics, name) for name in physics.__all__}
    drawing = {f"debug.{name}": getattr(debug, name) for name in debug.__all__}
    found: dict[str, Item] = {}
    tops = exported | RETURNED | drawing
    names = {each: name for name, each in tops.items() if isinstance(each, type)}
    for name, each in tops.items():
        kind = "class" if isinstance(each, type) else "function" if callable(each) else "constant"
        found[name] = Item(name, kind, each, None)
        if kind == "class":
            found |= {item.name: item for item in members(name, each, names)}
    return found


def members(name: str, kind: type, names: dict[type, str]) -> Iterator[Item]:
    """Yield the public members of a class that no other public class documents. names: public classes."""
    hidden = INNER.get(name, set())
    given = parameters(kind) if kind is not Strategy else {}
    seen = {each for each in given if not isinstance(inspect.getattr_static(kind, each, None), property)}
    for base in kind.__mro__:
        if not base.__module__.startswith("physics."):
            continue
        if base is not kind and owner_of(base, names) not in (None, name):
            continue
        for each, member in vars(base).items():
            if each.startswith("_") or each in seen or each in hidden:
                continue
            how = how_used(member)
            if how is None or (how != "attribute" and inherits_its_contract(kind, each, name, names)):
                continue
            seen.add(each)
            yield Item(f"{name}.{each}", how, member, kind)
    for each in attributes(kind):
        belongs = all(owner_of(base, names) in (None, name) for base in kind.__mro__ if each in own_attributes(base))
        if kind in physics.BROADPHASES.values() and each in attributes(Strategy):
            continue
        if each not in seen and each not in hidden and belongs:
            yield Item(f"{name}.{each}", "attribute", None, kind)


@functools.cache
def own_attributes(base: type) -> frozenset[str]:
    """Return the attributes that a class itself declares."""
    if not base.__module__.startswith("physics."):
        return frozenset()
    above = {name for other in base.__mro__[1:] for name in own_attributes(other)}
    return frozenset(attributes(base)) - above


def how_used(member: Any) -> str | None:
    """Return how a member of a class is used: "property", "method" or "class method". None stands for an attribute."""
    if isinstance(member, property | functools.cached_property):
        return "property"
    if isinstance(member, classmethod):
        return "class method"
    return "method" if isinstance(member, FunctionType) else None


def inherits_its_contract(kind: type, name: str, own: str, names: dict[type, str]) -> bool:
    """Return whether a member of a class is documented by another public class, whose member it overrides.

    Such a member has no docstring of its own. own: public name of the class itself.
    """
    if own_docstring(vars(kind).get(name)):
        return False
    return any(
        name in vars(base) or name in own_attributes(base)
        for base in kind.__mro__[1:]
        if owner_of(base, names) not in (None, own)
    )


def own_docstring(member: Any) -> str | None:
    """Return the docstring of a member itself, without inheritance."""
    return getattr(getattr(member, "__func__", member), "__doc__", None)
