"""Section I: mass, centre and inertia."""

from tests.stability.rows.row import Row, Section, at_most, exactly

MASS = Section(
    "I",
    "Mass properties",
    (2, 3, 4, 5, 6),
    (
        Row(
            "I2",
            "boxes, discs, capsules and polygons, here and offset, against closed forms",
            (
                at_most("relative error", 1e-12),
                at_most("change with the offset", 1e-12),
                exactly("capsules outside their hull and box", 0),
            ),
            "Box2D ShapeMassTest",
        ),
        Row(
            "I3",
            "rectangles of pixels, 1 × 1 to 40 × 23, as boxes (point masses are 100 % to 1.6 % too light)",
            (at_most("relative error of the inertia", 1e-15),),
            "derived",
        ),
        Row(
            "I4",
            "a mask, the polygon along its pixels' edges, its rectangles: the same mass",
            (
                at_most("relative error of mass and inertia", 1e-12),
                at_most("error of the centre", 1e-12, "px"),
                at_most("area between outline and pixels, per px of edge", 0.5, "px"),
            ),
            "derived",
        ),
        Row(
            "I5",
            "mass and density of 0, below, NaN; rotation locked",
            (exactly("accepted", 0), exactly("impulses not finite", 0), exactly("turn of what is locked", 0.0, "rad")),
            "Chipmunk sanity asserts, Jolt AllowedDOFsVsCollision",
        ),
        Row(
            "I6",
            "the same scenes a million times lighter and heavier",
            (
                at_most("difference of a falling, tipping box", 1e-12, "m"),
                exactly("difference of a heap, by a power of two", 0.0, "m"),
            ),
            "derived",
        ),
    ),
)
