"""Section L: time, repetition, sleep and long runs."""

from tests.stability.rows.row import Row, Section, at_least, at_most, exactly

TIME = Section(
    "L",
    "Time stepping, determinism, sleep, long runs",
    (1, 2, 3, 4, 5, 6, 7, 9, 10, 11, 12),
    (
        Row(
            "L1",
            "a zoo of shapes, eight balls and eighty boxes: twice, in fresh processes, every broad phase",
            (exactly("digests that differ", 0),),
            "Rapier issue 868, Box2D DeterminismTest",
        ),
        Row(
            "L2",
            "a snapshot in mid-run, into the same and another world, and after every step",
            (exactly("digests that differ", 0),),
            "Rapier snapshot_roundtrip, Box2D recording",
        ),
        Row(
            "L3",
            "a jitter of 1e-10 at the start of a heap, 400 steps",
            (
                at_most("difference of the mean height", 0.05, "m"),
                at_most("deepest overlap of either", 0.01, "m"),
                at_most("kinetic energy of either", 1e-3, "J"),
            ),
            "matter-js Examples.spec",
        ),
        Row(
            "L4",
            "frames of 5 to 50 ms, a stall of 1 s, pauses, slow motion, through the game's clock",
            (
                exactly("digests that differ after the same steps", 0),
                at_most("steps of one frame: a quarter of a second", 15),
            ),
            "judgement",
        ),
        Row(
            "L5",
            "a stack while the step changes by 1 % every frame, halves, grows by half; substeps and solvers change",
            (at_most("hop", 0.05, "m"), at_most("way of the top aside", 0.05, "m"), at_most("rms speed", 0.05, "m/s")),
            "BEPU",
        ),
        Row(
            "L6",
            "ten boxes awake for a minute; for an hour at night",
            (
                at_most("drift of the top", 0.01, "m"),
                at_most("rms speed", 1e-3, "m/s"),
                at_most("growth of the rms speed", 1e-6, "m/s"),
            ),
            "BEPU",
        ),
        Row(
            "L7",
            "a stack at rest at 240, 1,920 and 15,360 substeps a second, 10 s",
            (at_most("drift in the second half", 1e-4, "m"),),
            "BEPU",
        ),
        Row(
            "L9",
            "a support dragged from under a sleeper at 0.15 m/s, taken away",
            (
                at_most("steps until it wakes", 2),
                at_most("behind what carries it", 0.02, "m"),
                at_most("gap to what it lies on", 0.01, "m"),
            ),
            "Rapier sleep_wake",
            "1 step",
        ),
        Row(
            "L10", "boxes of a sleeping stack woken three times", (at_most("way of a woken box", 0.005, "m"),), "Rapier"
        ),
        Row(
            "L11",
            "a spring by forces, omega dt from 0.05 to 1.95, 2,000 steps; at 2.1 it explodes",
            (at_most("swing over that of the closed form", 1.0 + 1e-9), at_least("swing beyond the limit", 1e6, "m")),
            "BEPU, derived",
        ),
        Row(
            "L12",
            "compiled and plain kernels, 40 steps of a busy scene",
            (exactly("lines that differ", 0),),
            "judgement",
        ),
    ),
)
