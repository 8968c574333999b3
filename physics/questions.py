"""What can be asked of a world between steps; it answers with bodies and hits."""

import numpy as np

from physics.body import Body
from physics.checks import Pair, Pose
from physics.queries import casts as queries
from physics.queries.casts import RayHit
from physics.shapes.filter import Filter
from physics.shapes.kinds import Shape
from physics.world_state import WorldState


class Questions(WorldState):
    """The questions of a World; nothing else inherits from this. See queries/casts.py for what each tells."""

    def body(self, identity: int) -> Body:
        """The handle of an id. Raises KeyError when there is no such body."""
        if isinstance(identity, bool) or not isinstance(identity, (int, np.integer)):
            raise TypeError(f"identity must be a whole number (got {identity!r})")
        self._body_row(identity)
        return Body(self, int(identity))

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
        """The first shape that a shape at a pose (x, y, angle) touches on its way by a translation [px], or None."""
        return queries.shape_cast(self, shape, pose, translation, filter)

    def closest(self, point: Pair, filter: Filter = Filter.ALL) -> tuple[Body, tuple[float, float], float] | None:
        """(body, point, distance) [px] of the nearest point of any shape, or None."""
        return queries.closest(self, point, filter)

    def overlap(self, shape: Shape, pose: Pose, filter: Filter = Filter.ALL) -> list[Body]:
        """The bodies that a shape at a pose (x, y, angle) overlaps, in the order of ids."""
        return queries.overlap(self, shape, pose, filter)

    def query_aabb(self, lower: Pair, upper: Pair) -> list[Body]:
        """The bodies with a shape whose AABB meets the closed box [px], in the order of ids."""
        return queries.query_aabb(self, lower, upper)

    def query_point(self, point: Pair) -> list[Body]:
        """The bodies with a shape that holds the point [px], in the order of ids."""
        return queries.query_point(self, point)
