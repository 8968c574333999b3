"""Section D: pixel masks."""

from tests.stability.rows.row import Row, Section, at_least, at_most, exactly

MASKS = Section(
    "D",
    "Pixel masks",
    tuple(range(1, 19)),
    (
        Row(
            "D1",
            "masks of no size, all clear, all set",
            (exactly("hits of what is empty", 0), exactly("hits of what is full that are missed", 0)),
            "pygame-ce zero_mask tests",
        ),
        Row(
            "D2",
            "two single pixels, offsets of -2 to 2 in eighths, exact and as drawn",
            (exactly("verdicts that are wrong", 0),),
            "derived",
        ),
        Row(
            "D3",
            "widths and offsets across the border of a word, against the double loop",
            (exactly("areas that are wrong", 0),),
            "pygame-ce bit boundary tests",
        ),
        Row(
            "D4",
            "squares of 32 px at offsets that are not whole",
            (
                exactly("overlaps missed or made up at exact poses", 0),
                at_most("misses of what is drawn off 3.10 %", 0.005),
            ),
            "derived, GameMaker bugs 5098 and 6813",
            "3.1 % missed",
        ),
        Row(
            "D5",
            "a line of 1 × 32 turned by 0 to 90°",
            (at_most("error of its area", 0.05), exactly("balls of a pixel that pass", 0)),
            "derived",
            "31 % (nearest neighbour)",
        ),
        Row(
            "D6",
            "a mask turned by 4° ninety times",
            (exactly("pixels that differ after 360°", 0),),
            "derived",
            "IoU 0.32 (turned again and again)",
        ),
        Row(
            "D7",
            "a square of 32 px turned by 1 to 89°",
            (at_most("error of the area as drawn", 0.015), at_most("error of the area, exact", 0.001)),
            "derived",
        ),
        Row(
            "D8",
            "two masks turned apart, 1,000 poses, against the union of their squares",
            (exactly("verdicts that are wrong", 0),),
            "judgement",
            "0.5 % allowed",
        ),
        Row(
            "D9",
            "plus, ring, checkerboard wholly over themselves",
            (at_most("normal's length less 1", 1e-12), at_most("depth over the least extent", 1.0)),
            "judgement",
        ),
        Row(
            "D10",
            "a ball in the hole of a ring; its hull says hit",
            (exactly("contacts of the masks", 0), at_least("contacts of the hulls", 1)),
            "judgement",
        ),
        Row(
            "D11",
            "sprites at 100 px a step at a wall of 1 px, 10,000 phases",
            (exactly("misses when swept", 0), at_most("misses when not, off the formula", 3.0, "sigma")),
            "derived",
        ),
        Row(
            "D12",
            "4096² against 64² and against itself",
            (exactly("error of the shared area", 0, "px²"), at_most("relative error of the inertia", 1e-12)),
            "derived",
        ),
        Row(
            "D13",
            "a frame that grows 3 px into the floor",
            (at_most("speed out", 97.0, "px/s"), at_most("kinetic energy per mass after 1 s", 0.125, "px²/s²")),
            "Box2D and Rapier defaults",
            "3 m/s",
        ),
        Row(
            "D14",
            "flipped and scaled sprites",
            (at_most("error of the centre", 1e-9, "px"), exactly("error of the area", 0, "px²")),
            "judgement",
        ),
        Row(
            "D15",
            "alpha of 127 and 128, colour keys, wholly clear",
            (exactly("pixels that are wrong", 0),),
            "pygame-ce from_surface tests",
        ),
        Row(
            "D16",
            "gaps and walls of two pixels; deep in the middle",
            (at_most("normal's length less 1", 1e-12), at_most("error of the depth", 0.5, "px")),
            "judgement",
        ),
        Row(
            "D17",
            "the tip of a spike on a long edge, between its corners",
            (at_most("error of the depth", 0.5, "px"),),
            "Newton, water-tight contact",
        ),
        Row(
            "D18",
            "discs of pixels of radius 4 to 64, 200 centres each",
            (
                at_most("rms error of the area over that allowed", 1.15),
                at_most("rms error of the inertia over that allowed", 1.15),
            ),
            "derived",
        ),
    ),
)
