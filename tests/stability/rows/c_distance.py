"""Section C: distance, depth and casts."""

from tests.stability.rows.row import Row, Section, at_least, at_most, exactly

DISTANCE = Section(
    "C",
    "Distance, depth and casts",
    (1, 2, 3, 4, 7, 8, 9, 10, 12, 13, 14, 15, 16, 17),
    (
        Row(
            "C1",
            "a point 5 mm beyond the short edge of planks 3.2 mm to 0.02 mm thick",
            (at_most("error of the distance", 1e-6, "m"), at_most("normal's length less 1", 1e-12)),
            "Box2D ShapeDistanceShortEdgeTest",
            "1e-6 m",
        ),
        Row(
            "C2",
            "a point, and a disc of 1e-9, cast past the short edge of such a plank",
            (exactly("hits without a unit normal", 0), exactly("hits of what is missed, misses of what is hit", 0)),
            "Box2D ShapeCastShortEdge",
            "switched off upstream",
        ),
        Row(
            "C3",
            "a shape that slides 6e-8 above flat ground",
            (exactly("distances above 0 without a unit normal", 0), at_most("error of the distance", 1e-12, "m")),
            "Box2D issue 917",
            "a normal of (0, 0)",
        ),
        Row(
            "C4",
            "squares of 2, 1.9 apart, under 64 turns and starts",
            (at_most("error of the depth", 1e-12, "m"), at_most("error of the normal", 1e-12)),
            "libccd issue 25",
        ),
        Row(
            "C7",
            "identical shapes at one pose",
            (at_most("depth less the least width", 1e-12, "m"), at_most("rounds", 60)),
            "collision-rs issue 52",
        ),
        Row(
            "C8",
            "unit boxes that share an edge",
            (
                at_most("distance", 1e-12, "m"),
                at_most("error of the normal", 1e-12),
                at_most("points off the edge", 1e-12, "m"),
            ),
            "parry issue 315",
            "a point at the centre, a normal along the edge",
        ),
        Row(
            "C9",
            "gaps and overlaps of 1e-15 to 0.1 of boxes, discs, hulls, capsules",
            (
                at_most("error of the signed distance", 1e-12, "of the size"),
                exactly("steps at which the distance does not follow the gap", 0),
                at_most("gaps told as touching", 3),
            ),
            "fcl issues 402 and 495, mujoco_warp issue 1526",
        ),
        Row(
            "C10",
            "edges 1,700 and 10,000 times as long as the overlap is deep",
            (at_most("points outside their own box", 0.005, "m"), at_most("error of the depth", 1e-9, "m")),
            "Jolt pull request 2065",
            "tens of metres off",
        ),
        Row(
            "C12",
            "planes as good as parallel, near each other",
            (at_most("rounds", 20), at_most("rounds of 99 in 100", 10)),
            "Flexible-GJK issue 8, Chipmunk cpCollision.c",
            "20 (Box2D), 30 (Chipmunk), 100 (parry)",
        ),
        Row(
            "C13",
            "100,000 random pairs between bounds that need no distance algorithm, and a crowd in a world",
            (
                at_most("outside the bounds", 1.0, "of the room for rounding"),
                exactly("overlaps missed or made up", 0),
                at_least("share that overlaps", 0.3),
                at_most("share that overlaps, at most", 0.7),
            ),
            "MuJoCo issue 3383, Jolt GJKTests",
            "103 of 3,000 wrong (MuJoCo 3.3.5)",
        ),
        Row(
            "C14",
            "a disc at a box in closed form: deep, just touching, edge, corner, ten turns",
            (at_most("error of depth and points", 1e-9, "m"), at_most("error of the normal", 1e-9, "rad")),
            "Jolt EPATests",
            "9e-4 m, 0.1°",
        ),
        Row(
            "C15",
            "a unit box anywhere inside one of 100",
            (at_most("depth less the least translation", 1e-9, "m"),),
            "judgement",
        ),
        Row(
            "C16",
            "casts that start in contact: approaching, leaving, sliding, resting, grazing",
            (exactly("answers that are not the documented ones", 0),),
            "parry time_of_impact2",
        ),
        Row(
            "C17",
            "a disc cast at a segment turned by a rounded quarter turn, roles swapped",
            (at_most("error of the fraction", 1e-6), exactly("misses", 0)),
            "parry",
            "1e-6",
        ),
    ),
)
