"""Section J: far from the origin."""

from tests.stability.rows.row import Row, Section, at_most, exactly

FAR_AWAY = Section(
    "J",
    "Far from the origin",
    (1, 2, 3, 4),
    (
        Row(
            "J1",
            "a pyramid at 0 and at 1e7, 250 steps",
            (exactly("steps by which it sleeps sooner or later", 0), at_most("difference of the poses", 1e-7, "m")),
            "Box2D LargeWorldPyramid",
            "1e-3 m",
        ),
        Row(
            "J2",
            "pyramids at (1e5, -8e4), a stack at (4e4, -2.5e4), an overlap that resolves at (8e4, -7e4)",
            (at_most("difference of stack and pyramid", 1e-8, "m"), at_most("difference of the overlap", 5e-5, "m")),
            "Solver2D Far scenes",
        ),
        Row(
            "J3",
            "tiers of single precision over distance",
            (),
            "derived",
            absent="positions, shapes and solvers are doubles throughout; there is no single-precision tier to compare",
        ),
        Row(
            "J4",
            "an angle after a million turns",
            (at_most("difference of sine and cosine", 1e-8), at_most("length of the axis less 1", 1e-12)),
            "judgement",
        ),
    ),
)
