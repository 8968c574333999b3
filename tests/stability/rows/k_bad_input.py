"""Section K: bad input."""

from tests.stability.rows.row import Row, Section, at_most, exactly

BAD_INPUT = Section(
    "K",
    "Bad input",
    (1, 2, 3, 4, 5, 6),
    (
        Row(
            "K1",
            "NaN and infinity to every setter, constructor and step",
            (exactly("accepted, or refused without the name", 0), exactly("worlds changed by a refusal", 0)),
            "Godot issue 104359, Chipmunk cpBodySanityCheck",
        ),
        Row(
            "K2",
            "steps of 0, -1/60, 1e-9 and 1 s",
            (
                exactly("negative steps accepted", 0),
                exactly("poses moved by a step of 0", 0),
                at_most("way of a box at rest over time, steps of 1e-9 s", 3.0, "m/s"),
                exactly("bodies lost or not finite in steps of 1 s", 0),
            ),
            "Rapier asserts dt >= 0",
        ),
        Row("K3", "radius, width, length, tile and scale of 0 and below", (exactly("accepted", 0),), "Box2D issue 976"),
        Row(
            "K4",
            "worlds that are empty, of statics only, asleep, emptied, filled again",
            (exactly("counters above 0 in an empty world", 0), exactly("ids given twice", 0)),
            "Box2D Empty, DestroyAllBodies",
        ),
        Row(
            "K5",
            "friction -1 and 1e6, restitution -1 and 1e6",
            (
                exactly("negative values accepted", 0),
                at_most("speed of a box at rest, friction 1e6", 1e-3, "m/s"),
                exactly("states not finite, restitution 1e6", 0),
            ),
            "judgement",
        ),
        Row(
            "K6",
            "strided, Fortran, f32, int and read-only arrays, a locked surface",
            (exactly("results that differ", 0),),
            "judgement",
        ),
    ),
)
