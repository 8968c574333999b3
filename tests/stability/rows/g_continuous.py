"""Section G: fast bodies and continuous collision."""

from tests.stability.rows.row import Row, Section, at_least, at_most, exactly

CONTINUOUS = Section(
    "G",
    "Continuous collision",
    (1, 2, 3, 4, 5, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20),
    (
        Row(
            "G1",
            "a ball of 0.1 at 200 m/s at a wall of 0.1, at 0 and at 1e7, 30 steps",
            (at_least("distance from the wall's middle", 1e-9, "m"), at_most("distance at most", 0.5, "m")),
            "Box2D LargeWorldBullet",
        ),
        Row(
            "G2",
            "ball, box, capsule at 200 to 400 m/s at a box, a segment, a chain, straight and slanted",
            (at_most("beyond the wall, swept", 0.2, "m"), at_least("beyond the wall, sweep off: passes", 1.0, "m")),
            "Rapier ccd_oriented_wall, ccd_default_vs_fixed",
        ),
        Row(
            "G3",
            "a ball at 400 m/s that the sweep has stopped, restitution 0 to 1",
            (
                at_most("error of the speed that the hit tells", 1e-3, "m/s"),
                at_most("error of the speed it leaves with", 4e-4, "m/s"),
            ),
            "Rapier ccd_semantics",
            "1e-3 m/s",
        ),
        Row(
            "G4",
            "steps of 0.25 s at 20 m/s, face at 12.2, radius 0.5",
            (
                at_most("error of the free steps", 1e-3, "m"),
                at_least("place of the impact", 11.35, "m"),
                at_most("place of the impact, at most", 11.71, "m"),
                at_most("speed afterwards", 0.1, "m/s"),
            ),
            "Rapier issue 217",
        ),
        Row(
            "G5",
            "a disc that lies on a smooth floor and slides at 50 m/s, 30 steps",
            (at_least("way", 10.0, "m"), at_most("speed lost", 1e-9, "m/s")),
            "Rapier speed_cap",
            "> 10 m",
        ),
        Row(
            "G7",
            "a rod 8 m from its body's origin, at 100 m/s over a bevelled ledge, flat ground, segments",
            (at_most("below ground", 0.05, "m"),),
            "Box2D SpeculativeFallback",
            defaults=(at_most("below ground", 0.8, "m"),),
        ),
        Row(
            "G8",
            "a sliver of a triangle at 100 m/s, five angles",
            (at_most("below ground", 0.05, "m"),),
            "Box2D SpeculativeSliver",
        ),
        Row(
            "G9",
            "a box that passes a corner by 15 mm, 16 phases",
            (at_most("change of its flight", 1e-9, "m"), at_most("change of its velocity", 1e-9, "m/s")),
            "Box2D SpeculativeGhost",
        ),
        Row(
            "G10",
            "eight bullets of density 4 at 200 to 284 m/s into a column of 12 near a wall",
            (at_least("from the wall's middle to the nearest", 0.0, "m"), at_most("below ground", 0.5, "m")),
            "Box2D VerticalStack",
        ),
        Row(
            "G11",
            "a body made static, then hit by a bullet at (104.9, 281.1) m/s",
            (at_least("hits told", 1), at_most("bullet below ground", 0.0, "m")),
            "Box2D StaticVsBulletBug",
        ),
        Row(
            "G12",
            "two at 200 m/s head on: with a bullet they meet, without one they pass",
            (
                exactly("bullets that passed", 0),
                exactly("pairs without a bullet that met", 0),
                at_most("speed left of balls", 2e-4, "m/s"),
            ),
            "Rapier default_tier_ignores_dynamic, bullet",
        ),
        Row(
            "G13",
            "10,000 phases of discs at 0.5 to 100 of their size a step at a wall",
            (
                at_most("misses of what is not swept, off the formula", 3.0, "sigma"),
                exactly("misses of what is swept", 0),
            ),
            "derived",
        ),
        Row(
            "G14",
            "a rod that turns at 100 to 5,000 rad/s in a room, for 2 s",
            (exactly("steps outside", 0), exactly("states not finite", 0)),
            "Rapier, Box2D maximum rotation",
            "capped at 47 rad/s",
        ),
        Row(
            "G15",
            "a ball at 10,000 m/s in flight and at a wall",
            (at_most("relative error of the flight", 1e-12), at_least("before the wall", 0.0, "m")),
            "Rapier speed_cap",
            "capped at 400 m/s",
        ),
        Row(
            "G16",
            "a fast body through a thin sensor, a fast sensor through bodies",
            (
                exactly("begins per sensor", 1),
                exactly("ends per sensor", 1),
                at_most("solid body beyond the wall behind it", 0.0, "m"),
                at_most("error of the sensor's flight", 1e-9, "m"),
            ),
            "Rapier ccd_semantics, Box2D TestSensor",
        ),
        Row(
            "G17",
            "a box at 2 m a step at a box, awake and asleep, restitution 0 and 1",
            (at_most("error of the velocities", 1e-6, "m/s"), at_most("overlap", 0.005, "m")),
            "Jolt MotionQuality",
        ),
        Row(
            "G18",
            "a ball at 300 m/s into a gap that narrows to nothing, restitution 0.9",
            (
                at_most("sweeps in a step", 64),
                exactly("steps outside the gap", 0),
                at_most("speed into the gap at the end", 0.0, "m/s"),
            ),
            "judgement",
        ),
        Row(
            "G19",
            "a disc at 100 m/s on a floor of 40 tiles, a ruler that falls on it",
            (at_most("height over the floor at rest, off", 0.01, "m"), at_most("speed at the end", 0.05, "m/s")),
            "Box2D Drop scenes",
        ),
        Row(
            "G20",
            "times of impact in closed form: disc, box, segment",
            (at_most("error of the fraction", 1e-9), at_most("error of disc and disc", 1e-12)),
            "Box2D TOI, parry",
            "0.005",
        ),
    ),
)
