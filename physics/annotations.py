"""Type annotations of arguments: pairs, poses, rectangles, references to bodies, and literals of allowed strings.

Vectors and rectangles are protocols, so pygame's types match without an import of pygame.
"""

from collections.abc import Iterable, Iterator, Sequence
from typing import Any, Literal, Protocol

import numpy as np

# ---- words -----------------------------------------------------------------------------------------------------------
# The strings that an argument allows. Tables and tuples of them are made from these literals by get_args.

KindName = Literal["static", "kinematic", "dynamic"]
ContinuousName = Literal["off", "ray", "swept", "auto", "toi"]
SolverName = Literal["blocking", "projection", "sequential_impulse", "soft_step"]
BroadphaseName = Literal["brute", "sweep", "hash", "tree"]
JointSolverName = Literal["iterative", "direct", "auto"]
TierName = Literal["circle", "aabb", "obb", "capsule", "hull", "parts", "outline", "pixels", "mask"]
Substeps = int | Literal["auto"]

# ---- numbers ---------------------------------------------------------------------------------------------------------

Number = float | np.floating[Any] | np.integer[Any]


class Vector(Protocol):
    """A vector of two numbers that is not a tuple, such as pygame.Vector2. A Rect or a Vector3 does not match."""

    def __iter__(self) -> Iterator[float]: ...

    def __len__(self) -> int: ...

    def dot(self, other: Any, /) -> float:
        """Return the scalar product with another vector."""
        ...

    def rotate(self, angle: float, /) -> Any:  # a Vector3 needs an axis, and a Rect has no such method
        """Return the vector rotated by an angle."""
        ...


class Rectangle(Protocol):
    """A rectangle that unpacks into x, y, width and height, such as pygame.Rect or pygame.FRect."""

    def __iter__(self) -> Iterator[float]: ...

    def __len__(self) -> int: ...

    @property
    def size(self) -> tuple[float, float]:
        """The size (width, height)."""
        ...

    @property
    def topleft(self) -> tuple[float, float]:
        """The corner (x, y) with the least coordinates."""
        ...


Pair = tuple[Number, Number] | list[float] | list[int] | Vector | np.ndarray  # (x, y)
Pose = Pair | tuple[Number, ...]  # (x, y, angle), or (x, y) at angle 0; (*vector, angle) has no known length
Points = Sequence[Pair] | np.ndarray  # (n, 2)
Coordinates = Sequence[float] | np.ndarray  # (x, y) of checked numbers, inside the package
Corners = Sequence[Sequence[float]] | np.ndarray  # (n, 2) of checked numbers, inside the package
Numbers = Sequence[Number] | np.ndarray  # (n,)
Range = tuple[Number | None, Number | None] | list[Any] | np.ndarray  # a pair in which None means no bound
# (x, y, width, height), or ((x, y), (width, height)).
Rect = (
    Rectangle | tuple[Number, Number, Number, Number] | tuple[Pair, Pair] | list[float] | list[int] | list[Pair]
    | np.ndarray
)  # fmt: skip

# ---- bodies ----------------------------------------------------------------------------------------------------------


class BodyHandle(Protocol):
    """Protocol of Body, for annotations in modules that cannot import Body because body.py imports them."""

    @property
    def id(self) -> int:
        """The id of the body."""
        ...

    @property
    def shape_ids(self) -> tuple[int, ...]:
        """The ids of the body's shapes."""
        ...


class WorldHandle(Protocol):
    """Protocol of World, for annotations in modules that cannot import World because world.py imports them."""

    def step(self, dt: float | None = None) -> None:
        """Advance the simulation by one step of length dt [s]; None: the world's own dt."""
        ...

    def touch(self, ids: Any) -> None:
        """Wake bodies and update their AABBs, after the caller has written their columns in world.bodies.

        ids: a Body, an id, or many of them.
        """
        ...


BodyRef = BodyHandle | int | np.integer[Any]  # a Body or the id of one
BodyRefs = BodyRef | Iterable[BodyRef] | np.ndarray  # one or many
