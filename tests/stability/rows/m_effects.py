"""Section M: effects do work only if a scene needs them."""

from tests.stability.rows.row import Row, Section, at_least, at_most, exactly

EFFECTS = Section(
    "M",
    "Only the effects a scene calls for",
    (1, 2, 3, 4, 5, 6, 7, 8),
    (
        Row(
            "M1",
            "each effect declared and not used, beside the same world without it",
            (exactly("digests that differ", 0),),
            "Newton, byte-identical when off",
        ),
        Row(
            "M2",
            "counters of work that the scene gives no cause for",
            (exactly("sweeps, tangent, restitution, mask and sensor work without cause", 0),),
            "Box2D 3.1",
        ),
        Row(
            "M3",
            "a shooter by overlap and events alone, beside a look at every pair",
            (exactly("pairs that differ", 0), exactly("rows solved", 0)),
            "judgement",
        ),
        Row(
            "M4",
            "a platformer's mover on tiles without a solver",
            (exactly("contacts that differ", 0), exactly("islands and rows solved", 0)),
            "judgement",
        ),
        Row(
            "M5",
            "2,000 bodies asleep",
            (exactly("tests, rows, sweeps, islands", 0), at_most("time over that awake", 0.05)),
            "judgement",
        ),
        Row(
            "M6",
            "each effect taken out of a scene that calls for it: what is seen changes",
            (at_least("least change of a pose or of the events", 1.0, "px or events"),),
            "judgement",
        ),
        Row(
            "M7",
            "sweeps for the bullets alone, substeps for the heavy island alone",
            (
                exactly("sweeps of those that are not bullets", 0),
                exactly("substeps of a light island beside a heavy one, more than alone", 0),
            ),
            "Rapier substep_groups_locality",
            "0.7× of the time",
        ),
        Row(
            "M8",
            "tiers that degrade under a budget of time",
            (),
            "judgement",
            absent="no tier is changed by the clock: what a step does depends on the state of the world alone",
        ),
    ),
)
