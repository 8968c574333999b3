"""What can be asked of a world between steps; it answers with bodies and hits."""

from collections.abc import Iterator, Sequence

import numpy as np

from physics.body import Body
from physics.checks import Pair, Pose
from physics.queries import boxes
from physics.queries import casts as queries
from physics.queries.casts import RayHit
from physics.shapes.filter import Filter
from physics.shapes.kinds import Shape
from physics.vec2 import Vec2
from physics.world_state import WorldState


class Questions(WorldState):
    """The questions of a World; nothing else inherits from this. See queries/casts.py for what each tells.

    A pose is (x, y) or (x, y, angle)."""

    def body(self, identity: Body | int) -> Body:
        """The handle of an id (or of a Body, itself). Raises KeyError when there is no such body, TypeError,
        ValueError."""
        identity = self._identity("identity", identity)
        self._row_number(identity)
        return Body(self, identity)

    def __len__(self) -> int:
        """How many bodies there are."""
        return self._bodies.count

    def __bool__(self) -> bool:
        """A world is there, whether or not somebody is in it."""
        return True

    def __iter__(self) -> Iterator[Body]:
        """The bodies in the order of ids. Those that are there now: what is added on the way is left out, and what is
        removed before its turn."""
        for identity in self.bodies["id"].tolist():
            if identity in self:
                yield Body(self, identity)

    def __contains__(self, body: object) -> bool:
        """Whether a Body, or an id, is one of this world's."""
        if isinstance(body, Body):
            return body.world is self and body.id in self
        if isinstance(body, bool) or not isinstance(body, (int, np.integer)):
            return False
        return int(body) in self._shapes_of

    def ray_cast(
        self, origin: Pair, translation: Pair, filter: Filter = Filter.ALL, sensors: bool = False
    ) -> RayHit | None:
        """The first shape that a ray [px] meets, or None. See queries.RayHit."""
        hits = queries.ray_cast_all(self, origin, translation, filter, sensors, first=True)
        return hits[0] if hits else None

    def ray_cast_all(self, origin: Pair, translation: Pair, filter: Filter = Filter.ALL, sensors: bool = False) -> list:
        """All shapes that a ray [px] meets, nearest first, ties by shape id."""
        return queries.ray_cast_all(self, origin, translation, filter, sensors)

    def shape_cast(self, shape: Shape, pose: Pose, translation: Pair, filter: Filter = Filter.ALL) -> RayHit | None:
        """The first shape that a shape at a pose touches on its way by a translation [px], or None."""
        return queries.shape_cast(self, shape, pose, translation, filter)

    def closest(self, point: Pair, filter: Filter = Filter.ALL) -> tuple[Body, Vec2, float] | None:
        """(body, point, distance) [px] of the nearest point of any shape, or None."""
        return queries.closest(self, point, filter)

    def overlap(self, shape: Shape, pose: Pose, filter: Filter = Filter.ALL) -> list[Body]:
        """The bodies that a shape at a pose overlaps, in the order of ids."""
        return queries.overlap(self, shape, pose, filter)

    def query_aabb(self, lower: Pair, upper: Pair) -> list[Body]:
        """The bodies with a shape whose AABB meets the closed box [px], in the order of ids."""
        return boxes.query_aabb(self, lower, upper)

    def query_rect(self, rect: Sequence[float] | Sequence[Pair]) -> list[Body]:
        """The bodies with a shape whose AABB meets a closed box given as pygame's Rect is: (x, y, width, height), or
        ((x, y), (width, height)) [px]; in the order of ids."""
        return boxes.query_rect(self, rect)

    def query_point(self, point: Pair) -> list[Body]:
        """The bodies with a shape that holds the point [px], in the order of ids."""
        return queries.query_point(self, point)
