"""What can be asked of a world between steps; it answers with bodies and hits."""

from physics.body import Body
from physics.queries import casts as queries
from physics.shapes.filter import Filter


class Questions:
    """The questions of a World; nothing else inherits from this. See queries/casts.py for what each tells."""

    def ray_cast(self, origin, translation, filter=Filter.ALL, sensors=False):
        """The first shape that a ray [px] meets, or None. See queries.RayHit."""
        hits = queries.ray_cast_all(self, origin, translation, filter, sensors, first=True)
        return hits[0] if hits else None

    def ray_cast_all(self, origin, translation, filter=Filter.ALL, sensors=False) -> list:
        """All shapes that a ray [px] meets, nearest first, ties by shape id."""
        return queries.ray_cast_all(self, origin, translation, filter, sensors)

    def shape_cast(self, shape, pose, translation, filter=Filter.ALL):
        """The first shape that a shape at a pose (x, y, angle) touches on its way by a translation [px], or None."""
        return queries.shape_cast(self, shape, pose, translation, filter)

    def closest(self, point, filter=Filter.ALL):
        """(body, point, distance) [px] of the nearest point of any shape, or None."""
        return queries.closest(self, point, filter)

    def overlap(self, shape, pose, filter=Filter.ALL) -> list[Body]:
        """The bodies that a shape at a pose (x, y, angle) overlaps, in the order of ids."""
        return queries.overlap(self, shape, pose, filter)

    def query_aabb(self, lower, upper) -> list[Body]:
        """The bodies with a shape whose AABB meets the closed box [px], in the order of ids."""
        return queries.query_aabb(self, lower, upper)

    def query_point(self, point) -> list[Body]:
        """The bodies with a shape that holds the point [px], in the order of ids."""
        return queries.query_point(self, point)
