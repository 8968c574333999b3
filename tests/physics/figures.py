"""Shapes of physics as shapely figures: a second opinion on what they cover."""

from shapely import LineString, Point
from shapely import Polygon as Figure

from physics import Capsule, Circle


def figure(shape):
    """Round sides as polygons of 1024 corners."""
    if isinstance(shape, Circle):
        return Point(shape.center).buffer(shape.radius, quad_segs=256)
    if isinstance(shape, Capsule):
        return LineString([shape.a, shape.b]).buffer(shape.radius, quad_segs=256)
    return Figure(shape.points).buffer(shape.radius, quad_segs=256) if shape.radius else Figure(shape.points)
