"""From a sprite's mask to simpler shapes, tier by tier: cheaper to test, wrong by more."""

import numpy as np

from physics import checks
from physics.fitting.box import least_box
from physics.fitting.capsule import least_capsule
from physics.fitting.circle import least_circle
from physics.fitting.convex_parts import convex_parts
from physics.fitting.hull import mask_hull
from physics.fitting.outline import outline
from physics.shapes.bounds import Bounds
from physics.shapes.convex import Capsule, Circle, Polygon
from physics.shapes.mask import PixelMask
from physics.shapes.polygons import distinct, hull

TIERS = ("circle", "aabb", "obb", "capsule", "hull", "parts", "outline", "pixels", "mask")


def fit(mask: PixelMask, tier: str, tolerance: float = 1.0) -> tuple:
    """The shapes that stand for a mask in a tier; () for a mask without pixels.

    circle: the least circle that holds all pixels; aabb: the bounds at each pose; obb: the least turned box; capsule:
    the least one that holds all pixels; hull: their convex hull, of 16 corners at most; parts: convex polygons, bumps
    and notches of up to tolerance [px] left out beside what the outline leaves out; outline: mask.outline, in convex
    parts, rounded where the sprite is round; pixels: the mask as drawn, snap=True; mask: exactly, snap=False. They have
    the mask's own values. Raises TypeError, ValueError.
    """
    if not isinstance(mask, PixelMask):
        raise TypeError(f"mask must be a PixelMask (got {checks.shown(mask)})")
    checks.choice("tier", tier, TIERS)
    tolerance = checks.number("tolerance", tolerance, above=0.0)
    if tier in ("pixels", "mask"):
        return (_snapped(mask, tier == "pixels"),)
    if mask.area == 0:
        return ()
    key = (tier, tolerance if tier == "parts" else 0.0)
    if key not in mask.fitted:  # a mask never changes, so neither does what stands for it
        mask.fitted[key] = _fit(mask.bare, tier, tolerance)
    fitted = mask.fitted[key]
    return fitted if mask is mask.bare else tuple(each.with_values_of(mask) for each in fitted)


def _fit(mask, tier, tolerance):
    if tier == "aabb":
        return (Bounds(mask),)
    if tier == "parts":
        pieces = outline(mask.solid, mask.smooth)
        parts = [corners for outer, holes in pieces for corners, _ in convex_parts(outer, holes, tolerance)]
        return tuple(Polygon(distinct(corners) - np.array(mask.origin)) for corners in parts)
    if tier == "outline":
        return mask.outline
    corners = mask_hull(mask)
    if tier == "hull":
        return (hull(corners),)
    if tier == "circle":
        x, y, radius = least_circle(corners)
        return (Circle(radius, (x, y)),)
    if tier == "capsule":
        a, b, radius = least_capsule(corners)
        return (Circle(radius, a) if a == b else Capsule(a, b, radius),)
    width, height, center, angle = least_box(corners)
    return (Polygon.box(width, height, center, angle),)


def _snapped(mask, snap):
    """The mask that is tested as drawn, or exactly: itself where it is."""
    if mask.snap == snap:
        return mask
    if snap not in mask.fitted:
        mask.fitted[snap] = PixelMask(mask.solid, mask.origin, snap, mask.smooth)
    return mask.fitted[snap].with_values_of(mask)
