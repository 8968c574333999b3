"""Section H: queries, sensors and events."""

from tests.stability.rows.row import Row, Section, at_most, exactly

QUERIES = Section(
    "H",
    "Queries, sensors, events",
    (2, 3, 4, 5, 6, 7, 8),
    (
        Row(
            "H2",
            "rays along a segment: on it, towards it, above it, beside it, of no length",
            (exactly("answers that are not the documented ones", 0),),
            "parry ray_cast, issue 31",
        ),
        Row(
            "H3",
            "points on corners, edges and the seams of tiles and boxes",
            (
                exactly("closed shapes missed at a point of their border", 0),
                exactly("tiles of one grid told more than once", 0),
                exactly("pixels of a mask told at its far border", 0),
            ),
            "judgement",
        ),
        Row(
            "H4",
            "rays, casts, overlaps, nearest points from 1e7 away",
            (
                exactly("counts that differ from those at the origin", 0),
                at_most("error of fractions", 1e-8),
                at_most("error of points", 1e-8, "m"),
            ),
            "Box2D LargeWorldOriginQuery",
            "1e-4, 1e-3 m",
        ),
        Row(
            "H5",
            "bodies removed, disabled, reshaped while they touch, random histories",
            (
                exactly("begins without an end, and ends without a begin", 0),
                exactly("ids of what is gone that are accepted", 0),
            ),
            "pymunk test_space, Box2D TestIsValid",
        ),
        Row(
            "H6",
            "a sleeper over a static and a moving sensor",
            (exactly("begins", 1), exactly("events while it sleeps", 0), exactly("ends when it leaves", 1)),
            "Jolt SensorTests",
        ),
        Row(
            "H7",
            "questions after a removal, and of NaN",
            (exactly("hits of what is gone", 0), exactly("questions of NaN answered", 0)),
            "Rapier issue 749",
        ),
        Row(
            "H8",
            "hits at the same time: two to twenty shapes, in any order of making, every broad phase",
            (exactly("answers that are not the least id", 0),),
            "judgement",
        ),
    ),
)
