"""Section N: bodies on joints. If a goal is not reached, the limit is within twice the measured value."""

from tests.stability.rows.row import Row, Section, at_least, at_most, exactly

SI = ", sequential_impulse"
SHARE_WON = at_most("energy won, of the fall", 1e-9)
CHAIN = "a chain of 30 links of 1 m that is let go straight, level or sloping, with a ball of "

TREES = (
    Row(
        "N1",
        "a disc 2 m from its pin, let go at 1 rad, a minute; other phases 0.25 to 2.5 rad",
        (
            at_most("error of the period", 1e-4),
            at_most("change of the energy, of the fall", 1e-3),
            at_most("error of the pin", 1e-4, "m"),
            at_most("error of the period, beyond 1.5 rad", 6e-4),
            at_most("change of the energy, of the fall, beyond 1.5 rad", 1e-3),
            at_most("error of the pin, beyond 1.5 rad", 5e-4, "m"),
            at_most("error of the period" + SI, 2e-3),
            at_most("change of the energy, of the fall" + SI, 0.02),
            at_most("error of the pin" + SI, 5e-3, "m"),
            at_most("error of the period, beyond 1.5 rad" + SI, 0.025),
            at_most("change of the energy, of the fall, beyond 1.5 rad" + SI, 0.035),
            at_most("error of the pin, beyond 1.5 rad" + SI, 9e-3, "m"),
        ),
        "closed form",
        "3e-5, 1e-3, 0.38 mm (Box2D); 0.01, 0.3, 10.9 mm (pymunk)",
    ),
    Row(
        "N2",
        "a double pendulum of rods of 1 m, let go level, 30 s",
        (
            at_most("change of the energy, of the fall", 0.02),
            at_most("error of a pin", 5e-4, "m"),
            at_most("change of the energy, of the fall, 16 substeps", 0.02),
            at_most("error of a pin, 16 substeps", 5e-4, "m"),
            at_most("change of the energy, of the fall" + SI, 0.8),
            at_most("error of a pin" + SI, 0.04, "m"),
        ),
        "conservation of energy",
        "9.2 %, 16 substeps 10.5 %; 2.9 mm (Box2D)",
    ),
    *(
        Row(
            name,
            CHAIN + ball,
            (
                at_most("greatest gap of the swing", gap, "m"),
                at_most("gap after 20 s", rest, "m"),
                SHARE_WON,
                at_most("greatest gap of the swing" + SI, *more[0]),
                at_most("gap after 20 s" + SI, *more[1]),
                at_most("energy won, of the fall" + SI, 1e-9),
                at_least("greatest gap, iterative tier", naive, "m"),
            ),
            "Box2D BallAndChain",
            peer,
            defaults=defaults,
        )
        for name, ball, gap, rest, more, naive, peer, defaults in (
            (
                "N3",
                "one link's mass, 20 s",
                0.03,
                1e-3,
                ((0.8, "m"), (0.011, "m")),
                0.004,
                "95, 14.5 mm (Box2D); 338, 61 mm (pymunk)",
                (at_most("greatest gap of the swing", 5e-4, "m"),),
            ),
            (
                "N4",
                "a hundred links, 20 s",
                5e-3,
                1e-3,
                ((6e-3, "m"), (2e-3, "m")),
                0.02,
                "76, 9.4 mm (Box2D); 4.7, 1 m (pymunk)",
                (),
            ),
            ("N5", "a thousand links, 20 s", 0.02, 2e-3, ((0.02, "m"), (2e-3, "m")), 8.0, "906, 41 mm (Box2D)", ()),
        )
    ),
    Row(
        "N6",
        "a chain of 12 links and a ball of 1 to 1e6 of them, let go upwards: it falls slack and snatches",
        (SHARE_WON, at_most("greatest gap", 2.0, "m"), at_most("greatest gap" + SI, 1.5, "m")),
        "conservation of energy",
        defaults=(at_most("greatest gap", 0.11, "m"),),
    ),
    Row(
        "N7",
        "eight beams of 1 m, welded to one another and to the world, level to steep, 5 s",
        (
            at_most("tip off", 1e-9, "m"),
            at_most("tip off" + SI, 1e-9, "m"),
            at_least("tip off, iterative tier", 0.4, "m"),
            at_least("tip off, iterative tier" + SI, 6.0, "m"),
        ),
        "Box2D Cantilever",
        "461 mm (Box2D)",
    ),
    Row(
        "N8",
        "a bridge of 160 planks, let go as a V, 2 to 29 % longer than its span, comes to rest",
        tuple(
            limit
            for solver in ("", SI)
            for limit in (
                at_most("greatest gap" + solver, 1e-3 if not solver else 4e-3, "m"),
                at_most("gap at rest" + solver, 1e-9, "m"),
                at_most("error of the sag" + solver, 1e-3),
                at_most("error of the load on its ends" + solver, 1e-6),
                at_most("error of its pull" + solver, 1e-3),
            )
        ),
        "the catenary; Box2D Bridge",
    ),
)

MACHINES = (
    Row(
        "N9",
        "a crank of 0.3 m at 2 turns/s, a rod of 1 m, a piston: 20 turns, and once 1,000",
        (
            at_most("error of the piston's place, of the stroke", 1e-3),
            at_most("error of the stroke", 2e-3),
            at_most("error of the piston's place, of the stroke" + SI, 0.03),
            at_most("error of the stroke" + SI, 0.04),
            at_least("turns", 20.0),
            at_least("turns, the long run", 1000.0),
        ),
        "Box2D SliderCrank",
    ),
    Row(
        "N10",
        "a train of three gears comes up to ten turns a second: 1,000 turns",
        (
            at_least("turns", 1000.0),
            at_most("error of the ratios", 1e-9),
            at_most("greatest error of an angle", 0.012, "rad"),
            at_most("greatest error of an angle" + SI, 0.2, "rad"),
        ),
        "exact ratios",
    ),
    Row(
        "N11",
        "scissor lifts of 3 and 8 stages whose foot is drawn in by 0.2 m and held",
        (
            *(
                limit
                for stages in ("3 stages", "3 stages, direct", "8 stages", "8 stages, direct")
                for limit in (
                    at_most(f"error of the height, of a stage, {stages}", 1e-4, "m"),
                    at_most(f"greatest gap, {stages}", 1e-5, "m"),
                )
            ),
            at_most("error of the motor's force, 3 stages", 1e-6),
            at_most("error of the height, of a stage, 3 stages, direct" + SI, 1e-3, "m"),
            at_most("greatest gap, 3 stages, direct" + SI, 1e-4, "m"),
        ),
        "virtual work; Box2D ScissorLift",
    ),
    Row(
        "N12",
        "Theo Jansen's walker of six legs, 2 rad/s, 10 s",
        (
            at_most("greatest gap", 1e-4, "m"),
            at_most("a heel off the linkage", 1e-3, "m"),
            at_most("greatest gap" + SI, 1e-3, "m"),
            at_most("a heel off the linkage" + SI, 2e-3, "m"),
            at_least("way", 5.0, "m"),
            at_most("tilt at the end", 0.02, "rad"),
        ),
        "Box2D TheoJansen, by circles that meet",
    ),
    Row(
        "N13",
        "a car on springs of 1.5 to 5 Hz stands on a floor",
        (at_most("error of the sag", 0.01), at_most("tilt", 1e-6, "rad")),
        "m g / k",
    ),
    Row(
        "N14",
        "the car drives up a hill of 30 degrees at 4 m/s, and brakes there",
        (
            at_most("slip, of the way", 1e-3),
            at_most("error of the wheels' speed", 1e-3),
            at_most("creep while it brakes", 1e-3, "m/s"),
        ),
        "Box2D Car",
    ),
    Row(
        "N15",
        "a load grows on a bridge of 20 planks until it breaks, at 3 to 8 times its weight",
        (
            at_most("error of the pull at which it breaks", 0.02),
            at_most("force told, of its limit", 1.02),
            at_most("error of the pull at which it breaks" + SI, 0.7),
            at_most("force told, of its limit" + SI, 1.02),
        ),
        "statics; Box2D Breakable",
    ),
    Row(
        "N16",
        "26 ragdolls are thrown down stairs",
        (
            at_most("limits exceeded", 1.0, "degrees"),
            at_most("greatest gap", 9e-4, "m"),
            at_most("asleep after the last was at 1 m/s", 5.0, "s"),
            exactly("ragdolls awake after 12 s", 0),
            at_most("limits exceeded" + SI, 1.0, "degrees"),
            at_most("greatest gap" + SI, 0.04, "m"),
            at_most("ragdolls awake after 12 s" + SI, 26),
        ),
        "Box2D Ragdoll, SleepingTest",
        defaults=(at_most("greatest gap", 2.5e-4, "m"),),
    ),
)

SINGLE = (
    Row(
        "N17",
        "a body is dragged 3 m over a table, another is hung up, both by 5 Hz, damping 1",
        (
            at_most("overshoot, of the way", 0.05),
            at_most("distance to the goal after 2 s", 1e-3, "m"),
            exactly("dragged bodies awake after 5 s", 0),
            at_most("error of the sag", 0.01),
            exactly("hung bodies awake after 8 s", 0),
        ),
        "closed form",
    ),
    Row(
        "N18",
        "a tank seen from above drives in a circle of 5 m and stops",
        (
            at_most("error of its circle", 1e-3),
            at_most("error of its speed", 1e-6),
            at_most("error of its way to stop", 0.01),
            at_most("error of its way to stop" + SI, 0.05),
            at_most("speed at the end", 1e-9, "m/s"),
        ),
        "v² / 2a; pymunk's tank",
    ),
    Row(
        "N19",
        "a door on a spring of 0.5 to 2 Hz, opened by 0.5 to 1.4 rad, damping 0, 1, 2",
        (
            at_most("error of the period", 0.01),
            at_most("amplitude lost in four swings", 0.01),
            at_most("overshoot, damping 1 and 2", 1e-6),
            at_most("angle left", 1e-3),
            at_most("error of the period" + SI, 0.01),
            at_most("amplitude lost in four swings" + SI, 0.06),
            at_most("overshoot, damping 1 and 2" + SI, 1e-6),
        ),
        "closed form",
        "overshoots by 15 % (springs of Box2D count the inertia about the centre)",
    ),
    Row(
        "N20",
        "a slider falls 1.5 m on its limit, alone and with ten times its mass welded on beside it",
        (
            at_most("beyond the limit", 1e-9, "m"),
            at_most("rebound", 1e-9, "m"),
            at_most("turn", 1e-9, "rad"),
            at_most("beyond the limit, loaded", 1e-9, "m"),
            at_most("rebound, loaded", 1e-9, "m"),
            at_most("turn, loaded", 1e-9, "rad"),
            at_most("beyond the limit" + SI, 1e-9, "m"),
            at_most("rebound" + SI, 1e-9, "m"),
            at_most("turn" + SI, 1e-9, "rad"),
            at_most("beyond the limit, loaded" + SI, 1e-9, "m"),
            at_most("rebound, loaded" + SI, 1e-9, "m"),
            at_most("turn, loaded" + SI, 1e-9, "rad"),
        ),
        "judgement",
    ),
    Row(
        "N21",
        "Atwood's machine, masses 0.1 to 30 : 1, ratios 0.5 to 3",
        (
            at_most("error of the acceleration, of g", 1e-9),
            at_most("error of the pull", 1e-9),
            at_most("error of the length", 1e-3, "m"),
            at_most("error of the length" + SI, 5e-3, "m"),
        ),
        "closed form",
    ),
    Row(
        "N22",
        "ratchets of 7 to 200 teeth, either way",
        (
            at_most("error of its free turn", 1e-9),
            at_most("back over its tooth", 1e-3, "rad"),
            at_most("back over its tooth" + SI, 5e-3, "rad"),
            at_most("error of its torque", 1e-6),
        ),
        "closed form",
    ),
)

WORLDS = (
    Row(
        "N23",
        "sprites on joints: a hollow one swings, a chain of eight falls on a sprite",
        (
            at_most("error of a sprite's period", 1e-4),
            at_most("greatest gap of a chain of sprites", 0.015, "px"),
            exactly("sprites awake after 6 s", 0),
            at_most("error of a sprite's period" + SI, 5e-3),
            at_most("greatest gap of a chain of sprites" + SI, 1.1, "px"),
            exactly("sprites awake after 6 s" + SI, 0),
        ),
        "moments of squares",
    ),
    Row(
        "N24",
        "a chain that falls beside another island of joints, and without it",
        (exactly("change by another island", 0.0, "m"),),
        "judgement",
    ),
    Row("N25", "every kind of joint in every broad phase, 2 s", (exactly("digests", 1),), "judgement"),
    Row(
        "N26",
        "snapshots in mid-swing: restored, in new worlds, from a file, pickled",
        (exactly("digests", 1),),
        "judgement",
    ),
    Row(
        "N27",
        "a chain with a ball of ten links, in steps of 1/240 to 1/30 s by chance, 10 s",
        (
            at_most("greatest gap", 0.02, "m"),
            SHARE_WON,
            at_most("greatest gap" + SI, 0.3, "m"),
            at_most("energy won, of the fall" + SI, 1e-9),
        ),
        "conservation of energy",
    ),
    Row(
        "N28",
        "a chain with a spring at 1, 32 and 128 px to the metre",
        (exactly("difference from 32 px to the metre", 0.0, "m"),),
        "judgement",
    ),
    Row(
        "N29",
        "a net of 266 joints swings, comes to rest and sleeps",
        (
            at_most("greatest gap", 0.03, "m"),
            exactly("balls awake after 40 s", 0),
            exactly("joints solved while asleep", 0),
            at_most("greatest gap" + SI, 0.4, "m"),
            at_most("balls awake after 40 s" + SI, 144),
            exactly("joints solved while asleep" + SI, 0),
        ),
        "Box2D JointGrid",
        defaults=(at_most("greatest gap", 0.0035, "m"), exactly("balls awake after 40 s" + SI, 0)),
    ),
)

JOINTS = Section("N", "Joints", tuple(range(1, 30)), (*TREES, *MACHINES, *SINGLE, *WORLDS))
