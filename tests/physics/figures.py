"""Shapes of physics converted to shapely figures, as an independent reference for the area that they cover."""

from shapely import LineString, Point
from shapely import Polygon as Figure

from physics import Capsule, Circle


def figure(shape):
    """Return the shapely figure of a shape; its round parts are polygons with 1024 corners per circle."""
    if isinstance(shape, Circle):
        return Point(shape.center).buffer(shape.radius, quad_segs=256)
    if isinstance(shape, Capsule):
        return LineString([shape.a, shape.b]).buffer(shape.radius, quad_segs=256)
    return Figure(shape.points).buffer(shape.radius, quad_segs=256) if shape.radius else Figure(shape.points)
