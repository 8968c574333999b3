"""Section A: the broad phase, which finds the boxes that may touch."""

from tests.stability.rows.row import Row, Section, at_least, at_most, exactly

BROAD_PHASE = Section(
    "A",
    "Broad phase",
    (1, 2, 3, 4, 5, 6, 7, 8, 9),
    (
        Row(
            "A1",
            "0 to 2,000 random boxes, points, lines, touching, nested, on cell borders, in every broad phase",
            (exactly("pairs missed", 0), exactly("pairs made up", 0), exactly("pairs told twice or out of order", 0)),
            "judgement",
        ),
        Row(
            "A2",
            "128 bodies at one point",
            (exactly("pairs", 8128), exactly("bodies that a ray meets", 128)),
            "Jolt TestAddSingleBodies",
            "8,128",
        ),
        Row(
            "A3",
            "three boxes stacked on a ground of 20 km and of 2,000 km, 500 steps",
            (
                at_most("error of height", 0.1, "m"),
                at_most("speed at the end", 0.1, "m/s"),
                at_most("speed ever", 10.0, "m/s"),
                at_most("way aside", 2.0, "m"),
            ),
            "Rapier issue 629",
            "within the same limits in f32",
        ),
        Row(
            "A4",
            "bodies that come and go every step, 400 steps, every broad phase",
            (at_most("memory against that of step 100", 1.5, "×"),),
            "Rapier issue 617",
            "1.5×",
        ),
        Row(
            "A5",
            "one box of NaN among 1,000: handed in, and written into the table behind our back",
            (
                exactly("refusals without its row or body", 0),
                exactly("pairs of others that change", 0),
                exactly("NaN bodies not told", 0),
            ),
            "shock2quest issue 507, Godot issue 104359",
        ),
        Row(
            "A6",
            "a body that flies 50 cells a step past others, along an axis and across",
            (exactly("swept pairs missed", 0), at_most("cells visited per cell of its way", 60.0)),
            "judgement",
        ),
        Row(
            "A7",
            "boxes of circles, hulls and capsules at 1e7, against rational arithmetic",
            (
                at_most("what moves outside its box", 0.0, "m"),
                at_most("what stands outside its box", 1.0, "ulp of its place"),
                exactly("touching pairs missed at 1e7", 0),
            ),
            "Box2D LargeWorldAABBTest",
            "0",
        ),
        Row(
            "A8",
            "a slider at 8 m/s over 40 tiles that are bodies of their own, and off their end",
            (at_least("begins and ends", 3), exactly("begins without an end, and ends without a begin", 0)),
            "Rapier issue 718",
            "> 2",
        ),
        Row(
            "A9",
            "14 rays at a box: inside, along an edge, at a corner, of no length, ending on the face",
            (at_most("error of the fraction", 2.3e-16), exactly("hits missed or made up", 0)),
            "Box2D AABBRayCastTest, TreeRayCast",
            "1 ulp of f32",
        ),
    ),
)
