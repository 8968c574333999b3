"""Section F: contacts in the solver."""

from tests.stability.rows.row import Row, Section, at_least, at_most, exactly

CONTACTS = Section(
    "F",
    "Stacks, ratios, friction, bounces, overlap",
    (1, 2, 3, 4, 5, 6, 7, 9, 10, 11, 12, 13, 14, 15, 16, 17, 20, 21, 22, 23, 24, 25, 26, 27, 28, 29, 30),
    (
        Row(
            "F1",
            "a box that falls 3 m and lies, 90 steps",
            (at_most("way aside", 0.01, "m"), at_most("error of height", 0.01, "m"), at_most("turn", 0.01, "rad")),
            "Box2D HelloWorld",
        ),
        Row(
            "F2",
            "a box and a ball at rest, 1 to 8 substeps",
            (at_most("relative error of their impulses", 0.01),),
            "Rapier total_contact_impulse",
            "1 %",
        ),
        Row(
            "F3",
            "columns of 15 boxes (gaps, shifts, friction 0.3) and of 80, 10 s",
            (
                at_most("way of the top aside", 0.05, "m"),
                at_most("error of height, 15", 0.075, "m"),
                at_most("error of height, 80, substeps by load", 0.4, "m"),
                exactly("boxes of 15 awake after 10 s", 0),
            ),
            "Solver2D VerticalStack, Rapier vertical_column",
        ),
        Row(
            "F4",
            "pyramids of 20 rows, of 12 rows of 5 cm; of 100 rows at night",
            (
                at_most("overlap", 0.01, "m"),
                at_most("error of the top's height, per row", 0.005, "m"),
                exactly("tiny boxes thrown out", 0),
            ),
            "Box2D and Solver2D Pyramid, TinyPyramid",
        ),
        Row(
            "F5",
            "a box of 100, 200, 300 times the density dropped 2 m on nine rows of a pyramid, 10 s",
            (exactly("pyramids that fell, 4 substeps", 0), at_most("overlap at the end, substeps by load", 0.025, "m")),
            "Box2D HighMassRatio1",
            "44 mm (Box2D), fell (Rapier, pymunk), 18 mm (AVBD), 300 times",
        ),
        Row(
            "F6",
            "20 × 20 falls 15 m on two unit boxes (400 : 1), 2.5 m on two triangles (800 : 1), 8 substeps",
            (at_most("overlap at the end", 0.025, "m"), at_most("way of a prop aside", 1.0, "m")),
            "Box2D HighMassRatio2 and 3",
        ),
        Row(
            "F7",
            "six boxes that double in size upwards (1,024 : 1), 5 s",
            (at_most("speed", 20.0, "m/s"),),
            "Rapier inv_pyramid2",
        ),
        Row(
            "F9",
            "ten boxes that start a quarter inside one another",
            (
                at_most("speed at which two part", 3.0, "m/s"),
                at_most("highest over the height of the stack when apart", 0.5, "m"),
                at_most("kinetic energy at the end", 1e-3, "J"),
            ),
            "Box2D and Solver2D OverlapRecovery",
            "3 m/s",
        ),
        Row(
            "F10",
            "a hundred boxes at one point, 10 s",
            (
                at_most("speed", 30.0, "m/s"),
                exactly("runs that differ", 0),
                at_most("overlap at the end", 0.005, "m"),
                at_least("spread along and across", 5.0, "m"),
            ),
            "Rapier debug_total_overlap2",
            defaults=(at_most("overlap at the end", 0.8, "m"),),
        ),
        Row(
            "F11",
            "more discs in a room than fit: 100, and 625 at night's length",
            (
                exactly("escaped", 0),
                at_most("rms speed at the end", 1.0, "m/s"),
                at_most("growth of the rms speed", 0.05, "m/s"),
            ),
            "Box2D Confined",
        ),
        Row(
            "F12",
            "64 discs crushed by two plates",
            (exactly("escaped", 0), at_least("growth of the overlap with the crushing", 0.0, "m")),
            "Rapier debug_compression2",
        ),
        Row(
            "F13",
            "a capsule that cannot turn on a slope of 45°, friction 0.9, 500 steps",
            (exactly("impulses not finite", 0), at_least("tangent impulse seen", 1e-4)),
            "Rapier issue 818",
        ),
        Row(
            "F14",
            "a box that slides, friction sqrt(0.9 × 0.8), both ways, 1 s",
            (
                at_most("error of the place", 1e-2, "m"),
                at_most("error of the speed", 2e-2, "m/s"),
                at_most("difference of both ways", 1e-9, "m"),
            ),
            "Jolt TestFriction",
            "1e-2 m, 2e-2 m/s",
            defaults=(at_most("error of the place", 1.5e-2, "m"),),
        ),
        Row(
            "F15",
            "slopes 1° below and above the friction angle, friction 0.1 to 1",
            (at_most("drift below it, 10 s", 1e-3, "m"), at_most("relative error of the acceleration", 0.02)),
            "derived",
            "437 mm in 9 s (AVBD creeps), 70 % (AVBD)",
        ),
        Row(
            "F16",
            "an arch of 17 blocks with four slabs, 10 s; one thinner than its thrust line falls",
            (
                at_most("keystone's drop", 0.025, "m"),
                at_most("overlap", 0.01, "m"),
                at_least("drop of the thin one", 1.0, "m"),
            ),
            "Box2D and Solver2D Arch, Milankovitch 1907",
            "12.4 mm of overlap",
        ),
        Row(
            "F17",
            "a house of cards of five levels, 25°, friction 0.7, 10 s, substeps by load",
            (at_least("height kept", 0.95, "of the height"), at_most("lean", 0.1, "m")),
            "Box2D and Solver2D CardHouse",
            "leans 2 mm (pymunk) to 161 mm",
        ),
        Row(
            "F20",
            "fifteen dominoes, the first struck; four times as large, eight times as dense",
            (
                exactly("dominoes short of 60°", 0),
                at_most("speed of the wave off sqrt(size)", 0.02),
                at_most("change with the density", 1e-6),
            ),
            "Box2D DoubleDomino, derived",
        ),
        Row(
            "F21",
            "balls of restitution 0 to 0.95 from 2 m, margin of contact 20 and 100 mm",
            (
                at_most("apex off e²", 0.05, "of the height"),
                at_most("apex of e = 0", 0.02, "of the height"),
                at_most("change with the margin", 0.05, "of the height"),
            ),
            "Rapier issues 919 and 974",
            "1 % of the rebound (Rapier)",
        ),
        Row(
            "F22",
            "bounces of e = 1 and 0.9 against the closed form, 20 from 2 m; between walls without gravity",
            (at_most("apex off e²ⁿ", 0.01, "of it"), at_most("speed between walls off eⁿ", 1e-9, "of it")),
            "Jolt CollisionElastic",
            "0.98 (pymunk) to 0.08 (Rapier) of e = 0.9",
        ),
        Row(
            "F23",
            "disc, capsule, bar in a room, e = 1, no friction, 1,000 steps",
            (
                at_most("relative error of the disc's speeds", 1e-9),
                at_most("relative error of the energy of what turns", 0.01),
            ),
            "Box2D BounceHouse",
        ),
        Row(
            "F24",
            "2.9 m/s at a plane of 70°: 0.992 m/s across it, thresholds 1 and 0.1",
            (
                at_most("speed left below the threshold", 1e-5, "m/s"),
                at_most("error of the speed above it", 1e-5, "m/s"),
            ),
            "Box2D RestitutionThreshold",
        ),
        Row(
            "F25",
            "ten discs exactly above one another, 10 s",
            (exactly("way and speed aside", 0.0, "m"), at_most("error of the height", 0.05, "m")),
            "derived, Solver2D CircleStack",
        ),
        Row(
            "F26",
            "60 discs drawn to a fixed one by forces",
            (at_most("rms speed at the end over the greatest", 0.05), at_most("farthest from the middle", 7.0, "m")),
            "Solver2D Rush",
        ),
        Row(
            "F27",
            "a box half a slop, a slop, 4 and 20 slops inside the floor, 2 s",
            (
                at_most("way of what is in by a slop or less", 1e-5, "m"),
                at_most("overlap left of what is in further", 0.005005, "m"),
                at_most("rise above the floor", 0.005, "m"),
            ),
            "Jolt PenetrationSlop",
            "1e-5 m",
        ),
        Row(
            "F28",
            "a bumper that gives 1.5 and 2 times what it got, 60 s",
            (exactly("steps outside or not finite", 0),),
            "Box2D BounceHumans, Pinball",
            "capped at 400 m/s",
        ),
        Row(
            "F29",
            "a chain of 15 small balls with a ball of 1000 : 1 at its end, swinging, 5 s",
            (at_most("greatest separation of a joint", 1.5e-4, "m"),),
            "Rapier substep_chain",
        ),
        Row(
            "F30",
            "ten chains and a net of 16 x 16 balls on joints, swinging, 10 s",
            (at_most("greatest speed", 20.0, "m/s"), exactly("bodies outside", 0)),
            "Rapier joint_stability",
        ),
    ),
)
