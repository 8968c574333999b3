"""Section B: contacts of two simple shapes."""

from tests.stability.rows.row import Row, Section, at_least, at_most, exactly

PRIMITIVES = Section(
    "B",
    "Primitives and manifolds",
    (1, 2, 5, 6, 7, 8, 9, 10, 11, 12),
    (
        Row(
            "B1",
            "unit boxes 0.9 apart, here and at 1e7",
            (
                exactly("points", 2),
                at_most("error of the separation, here", 1e-12, "m"),
                at_most("error of separation, points and normal at 1e7", 1e-4, "m"),
            ),
            "Box2D LargeWorldManifold",
            "1e-4 m at 1e7",
        ),
        Row(
            "B2",
            "boxes face to face, turned by 1e-12 to 1e-2 rad both ways",
            (
                at_least("points while the turn is below the slop", 2),
                exactly("changes of feature while the turn is below the slop", 0),
                at_most("error of the normal over the turn", 1.0),
            ),
            "Box2D manifold.c",
        ),
        Row(
            "B5",
            "a disc's centre at a box's centre, at a segment's end, on an edge and on a corner",
            (
                at_most("error of the depth", 1e-12, "m"),
                at_most("normal's length less 1", 1e-12),
                exactly("answers that differ when asked again", 0),
            ),
            "judgement",
        ),
        Row(
            "B6",
            "discs, boxes, capsules, hulls inside themselves at one pose",
            (at_most("error of the depth", 1e-12, "m"), at_most("normal's length less 1", 1e-12)),
            "parry and Jolt degenerate families",
        ),
        Row(
            "B7",
            "a box of 20 on one of 600 × 3, 200,000 poses that drift and turn, pushed out of one another",
            (
                exactly("no normal, or no contact", 0),
                at_most("overlap left after the push", 1e-9, "m"),
                at_most("push over the least overlap of their shadows", 1.0),
            ),
            "ncollide issue 181, parry epa2",
            "an assertion at step 174,668",
        ),
        Row(
            "B8",
            "capsules of length 1e-9, triangles of area 1e-12, edges of 1e-9, equal and collinear corners",
            (exactly("neither refused nor right", 0),),
            "Box2D pull request 1022",
        ),
        Row(
            "B9",
            "corner at corner, edge on edge, corner at edge, within 1e-12 of the size",
            (
                exactly("signs that are not the rationals'", 0),
                exactly("flickers on the way through touching", 0),
                exactly("contacts and distances that disagree", 0),
            ),
            "fcl issues 402 and 495",
        ),
        Row(
            "B10",
            "100,000 needles of 100 × 0.001 that cross at a thousandth of a degree",
            (
                exactly("crossings missed", 0),
                exactly("crossings made up", 0),
                at_most("error of the depth", 1e-10, "px"),
            ),
            "judgement",
        ),
        Row(
            "B11",
            "segments parallel, overlapping, crossing, with a common end",
            (at_most("error of the squared distance", 1e-14, "of the size²"),),
            "Box2D SegmentDistance",
        ),
        Row(
            "B12",
            "gaps within the margin of speculative contact: going away, not arriving, beside a sensor",
            (
                exactly("change of a velocity that goes away", 0.0, "m/s"),
                exactly("change of a velocity that does not arrive", 0.0, "m/s"),
                exactly("sensors that hear what they do not touch", 0),
            ),
            "Jolt InsideSpeculative",
        ),
    ),
)
