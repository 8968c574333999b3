"""From a sprite's mask to simpler shapes, tier by tier: cheaper to test, wrong by more."""

from physics import checks
from physics.fitting.box import least_box
from physics.fitting.circle import least_circle
from physics.fitting.hull import mask_hull
from physics.shapes.bounds import Bounds
from physics.shapes.convex import Circle, Polygon
from physics.shapes.mask import PixelMask

TIERS = ("circle", "aabb", "obb", "pixels")


def fit(mask: PixelMask, tier: str, tolerance: float = 1.0) -> tuple:
    """The shapes that stand for a mask in a tier; () for a mask without pixels.

    circle: the least circle that holds all pixels; aabb: the bounds at each pose; obb: the least turned box; pixels:
    the mask itself. They have the mask's own values. tolerance [px] is for tiers that simplify an outline. Raises
    TypeError, ValueError.
    """
    if not isinstance(mask, PixelMask):
        raise TypeError(f"mask must be a PixelMask (got {checks.shown(mask)})")
    checks.choice("tier", tier, TIERS)
    checks.number("tolerance", tolerance, above=0.0)
    if tier == "pixels":
        return (mask,)
    if mask.area == 0:
        return ()
    if tier not in mask.fitted:  # a mask never changes, so neither does what stands for it
        mask.fitted[tier] = _fit(mask.bare, tier)
    fitted = mask.fitted[tier]
    return fitted if mask is mask.bare else tuple(each.with_values_of(mask) for each in fitted)


def _fit(mask, tier):
    if tier == "aabb":
        return (Bounds(mask),)
    hull = mask_hull(mask)
    if tier == "circle":
        x, y, radius = least_circle(hull)
        return (Circle(radius, (x, y)),)
    width, height, center, angle = least_box(hull)
    return (Polygon.box(width, height, center, angle),)
