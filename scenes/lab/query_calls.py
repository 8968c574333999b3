"""The queries of lab/queries, and their results as rows that can be compared between broad phases."""

from itertools import count
from math import atan2, hypot

from physics import Circle, Polygon

# Multiples of both, modulo 1, fill a square evenly (Roberts, The Unreasonable Effectiveness of Quasirandom Sequences,
# 2018): powers of 1/1.3247, the root of x^3 = x + 1.
ALONG, ACROSS = 0.7548776662466927, 0.5698402909980532


def ask(world, query, origin, target, size):
    """Run a query in a world, and return a list of its results.

    query: name of the kind of query, as in queries.QUERIES; origin: start (x, y) [px] of a ray or cast; target: its
    end, or the position of another query; size: size of the query's shape [px]. A query for one result returns [None]
    if it finds nothing.
    """
    way = target[0] - origin[0], target[1] - origin[1]
    if query == "ray":
        return [world.ray_cast(origin, way)]
    if query == "all":
        return world.ray_cast_all(origin, way)
    if query == "cast":
        return [world.shape_cast(Circle(size), origin, way)]
    if query == "overlap":
        return world.overlap(Polygon.box(2.0 * size, 1.2 * size), (*target, angle_of(origin, target)))
    if query == "closest":
        return [world.closest(target)]
    if query == "area":
        return world.query_aabb((target[0] - size, target[1] - size), (target[0] + size, target[1] + size))
    return world.query_point(target)


def asking(world, query, origin, area, size):
    """Return a function without arguments that runs the query once per call, each time at another target.

    query: name of the kind of query, as in queries.QUERIES; origin: start of rays and casts (x, y) [px]; area: (width,
    height) [px] over which the targets are spread evenly; size: size of the query's shape [px].
    """
    numbers = count()

    def ask_the_next():
        k = next(numbers)
        return ask(world, query, origin, (k * ALONG % 1.0 * area[0], k * ACROSS % 1.0 * area[1]), size)

    return ask_the_next


def rows_of(found):
    """Return the results of ask() as a list of tuples that can be compared.

    found: the results; None entries are left out. A tuple is (body id, x, y, normal x, normal y, fraction or distance).
    Values that a kind of query lacks are 0.
    """
    rows = []
    for each in found:
        if each is None:
            continue
        if isinstance(each, tuple):  # of closest
            body, point, distance = each
            rows.append((body.id, *point, 0.0, 0.0, distance))
        elif hasattr(each, "fraction"):
            rows.append((each.body.id, *each.point, *each.normal, each.fraction))
        else:
            rows.append((each.id, *each.position, 0.0, 0.0, 0.0))
    return rows


def angle_of(origin, target):
    """Return the angle [rad] of the line from `origin` to `target`.

    The box of an overlap query is rotated by this angle.
    """
    dx, dy = target[0] - origin[0], target[1] - origin[1]
    return atan2(dy, dx) if hypot(dx, dy) > 0.0 else 0.0
