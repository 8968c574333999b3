"""Section E: ground made of pieces."""

from tests.stability.rows.row import Row, Section, at_least, at_most, exactly

GROUND = Section(
    "E",
    "Pieces, chains, tiles, one-way",
    (1, 3, 4, 5, 6, 7, 8, 9, 10, 12, 13, 14, 15, 16),
    (
        Row(
            "E1",
            "a box driven at 2 m/s over a chain of unit links, 1,000 steps",
            (
                at_most("way back in a step", 1e-6, "m"),
                at_most("height off rest", 0.05, "m"),
                at_most("travel off", 0.05, "of the way"),
            ),
            "Rapier issue 669",
        ),
        Row(
            "E3",
            "shapes over 200 tiles, links and boxes, a cube that starts a slop inside; half a pixel raised is felt",
            (
                at_most("error of the place", 1e-3, "m"),
                at_most("error of the velocity", 2e-3, "m/s"),
                at_most("relative speed lost over tiles and links", 3e-7),
                at_most("relative speed lost over separate boxes", 1e-6),
                at_least("relative speed lost at a step of half a pixel", 0.01),
            ),
            "Jolt ActiveEdges",
            "1e-3 m, 2e-3 m/s",
        ),
        Row(
            "E4",
            "a swept ball at 30 m/s over 40 unit tiles",
            (at_least("way in a step", 0.1, "m"), at_most("steps to x = 38", 90)),
            "Rapier issue 932",
        ),
        Row(
            "E5",
            "a capsule driven at 2 m/s over the seam of two grids, two chains, two slopes",
            (at_most("dip", 0.05, "m"), at_most("way behind", 0.05, "m")),
            "Rapier issue 182",
        ),
        Row(
            "E6",
            "a quarter circle of 240 links: what slides down comes up again, and on slabs of their own too",
            (
                at_least("share of the height, disc on links", 0.98),
                at_least("share of the height, capsule and box on links", 0.96),
                at_most("share of the height, at most", 1.02),
                at_most("share lost on slabs beyond that", 0.001),
            ),
            "Box2D GhostBumps",
        ),
        Row(
            "E7",
            "tiles of two sizes side by side, split over two bodies, in a T",
            (exactly("snags", 0), at_most("relative speed lost", 1e-6)),
            "Jolt Architecture",
            "told as a limit",
        ),
        Row(
            "E8",
            "an arm at 5 rad/s in a one-way circle: 150 bodies in one of 10 m, 300 steps",
            (at_most("escaped", 2),),
            "Rapier spinner_containment",
            "2 of 6,076",
        ),
        Row(
            "E9",
            "a ball at 200 m/s into a wedge of segments and of a chain, 10 s",
            (exactly("steps outside", 0), at_most("speed at the end", 0.1, "m/s")),
            "Box2D Wedge",
        ),
        Row(
            "E10",
            "a slab of 2 × 0.06, flat and tilted, dropped 5 m on box, segment, tiles, chain",
            (
                at_most("below ground", 0.1, "m"),
                at_least("height at the end", 0.0, "m"),
                at_most("height at the end, at most", 0.2, "m"),
                at_most("speed at the end", 0.05, "m/s"),
            ),
            "Rapier issue 524",
        ),
        Row(
            "E12",
            "a gear of many convex parts on one body",
            (at_most("relative error of area, centre, inertia", 1e-12), exactly("pairs of a body with itself", 0)),
            "Rapier debug_many_colliders2",
        ),
        Row(
            "E13",
            "bowtie, either winding, a hole, corners in a line, a coast of 10,000 corners",
            (exactly("neither refused nor repaired", 0), at_least("IoU of parts and polygon", 0.999)),
            "judgement",
        ),
        Row(
            "E14",
            "chains of no and of one point, grids and bodies with nothing in them",
            (exactly("chains accepted", 0), at_most("relative error of a free fall through them", 1e-12)),
            "Rapier issue 798",
        ),
        Row(
            "E15",
            "a character pushed by a wall at 2 m/s while it stands still; one that starts 0.3 m inside a box",
            (
                at_least("character ahead of the wall, less its radius", -0.05, "m"),
                at_least("character out of the box after 20 calls", -1e-3, "m"),
            ),
            "Rapier issue 485",
        ),
        Row(
            "E16",
            "six grounds in pieces, six shapes, 30 to 300 px/s, 40 phases, both ways; a step; aligned corners",
            (
                at_most("relative speed lost", 1e-3),
                at_most("hop", 0.05, "px"),
                at_most("relative speed lost at a step of 0.9 slops", 0.02),
                at_most("hop over a step of 0.9 slops", 0.16, "px"),
                at_least("relative speed lost at a step of two slops", 0.05),
                at_most("change of the velocity at aligned corners", 0.01, "px/s"),
                at_most("spin at aligned corners", 0.01, "rad/s"),
            ),
            "Box2D GhostCollision",
        ),
    ),
)
