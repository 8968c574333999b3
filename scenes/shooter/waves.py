"""The waves, as data, and the director who sends them: once in this order, then for ever in any, always harder."""

from dataclasses import dataclass

from scenes.shooter.cast import WIDTH, steps

PAUSE = 0.9              # [s] of peace between two waves
SCATTER = 0.03           # of the width that a plane may enter beside its place
PATIENCE = 10.0          # [s] after which the next wave comes although some planes of the last are left


@dataclass(frozen=True)
class Group:
    """Planes of one kind, one after another. `at`: where along the width each enters, 0..1; `every` and `after` [s];
    `hover`: how far down its place is [px]; `sway` [px]; `carries`: the last one drops a power-up."""

    kind: str
    at: tuple
    every: float = 0.35
    after: float = 0.0
    hover: float = 56.0
    sway: float = 40.0
    carries: bool = False


@dataclass(frozen=True)
class Wave:
    """What comes together, under one name."""

    title: str
    groups: tuple


WAVES = (
    Wave("FIRST CONTACT", (Group("dart", (0.30, 0.70, 0.42, 0.58, 0.22, 0.78), every=0.6),)),
    Wave("WEAVERS", (Group("saucer", (0.28,) * 4, every=0.6, sway=70),
                     Group("saucer", (0.72,) * 4, every=0.6, after=1.2, sway=-70, carries=True))),
    Wave("ARROWHEAD", (Group("dart", (0.50, 0.42, 0.58, 0.34, 0.66, 0.26, 0.74), every=0.16, hover=66),
                       Group("saucer", (0.12, 0.88), every=0.1, after=1.2, sway=24))),
    Wave("GUNSHIP", (Group("gunship", (0.50,), hover=62, carries=True),
                     Group("saucer", (0.14, 0.86, 0.14, 0.86), every=0.5, after=2.4, sway=30))),
    Wave("TWO STREAMS", (Group("saucer", (0.16,) * 6, every=0.5, sway=44),
                         Group("saucer", (0.84,) * 6, every=0.5, sway=-44, carries=True))),
    Wave("ESCORT", (Group("gunship", (0.30,), hover=54),
                    Group("dart", (0.60, 0.72, 0.84, 0.92, 0.66, 0.78), every=0.45, after=1.4),
                    Group("saucer", (0.50, 0.50, 0.50), every=0.6, after=3.0, sway=120))),
    Wave("STORM", (Group("dart", (0.10, 0.90, 0.26, 0.74, 0.42, 0.58, 0.34, 0.66, 0.18, 0.82, 0.50, 0.30, 0.70, 0.50),
                         every=0.28, hover=46),)),
    Wave("CROSSING", (Group("saucer", (0.50,) * 10, every=0.36, sway=170, carries=True),
                      Group("dart", (0.12, 0.88, 0.20, 0.80), every=0.9, after=1.6))),
    Wave("TWINS", (Group("gunship", (0.24, 0.76), every=0.7, hover=58, carries=True),
                   Group("dart", (0.40, 0.60, 0.44, 0.56), every=0.8, after=3.0, hover=34))),
    Wave("ALL OUT", (Group("gunship", (0.50,), hover=50, carries=True),
                     Group("saucer", (0.16, 0.84) * 4, every=0.4, after=0.8, sway=44),
                     Group("dart", (0.30, 0.70, 0.38, 0.62, 0.24, 0.76), every=0.5, after=3.0))),
)


@dataclass(frozen=True)
class Pace:
    """How hard it is in a round of the waves, 0 the first. Every factor has an end: it stays a game."""

    round: int

    @property
    def speed(self):
        """Factor on the speed of bullets and dives."""
        return min(1.0 + 0.12 * self.round, 1.7)

    @property
    def patience(self):
        """Factor on the time between two volleys."""
        return max(0.88 ** self.round, 0.45)

    @property
    def extra(self):
        """More bullets in fans and rings."""
        return min(2 * self.round, 4)

    @property
    def armour(self):
        """Factor on health."""
        return 1.0 + 0.25 * min(self.round, 6)


class Director:
    """Sends the waves. `number` counts them from 1; `title` is the one that came last."""

    def __init__(self):
        self.number = 0
        self.clock = 0               # steps since this wave began
        self.idle = 0                # steps without any enemy
        self.mirrored = False
        self.order = list(range(len(WAVES)))     # of this round
        self.due = []                # (step, group, number in the group), earliest first

    @property
    def wave(self):
        """The wave that runs."""
        return WAVES[self.order[(self.number - 1) % len(WAVES)]]

    @property
    def pace(self):
        """How hard this round is."""
        return Pace(max(self.number - 1, 0) // len(WAVES))

    def step(self, fleet, random):
        """Launch what is due; begin the next wave when the sky is clear or patience is out."""
        self.clock += 1
        self.idle = 0 if len(fleet) or self.due else self.idle + 1
        if self.idle > steps(PAUSE) or (not self.due and self.clock > steps(PATIENCE)):
            self._begin(random)
        while self.due and self.due[0][0] <= self.clock:
            _, group, number = self.due.pop(0)
            at = (1.0 - group.at[number] if self.mirrored else group.at[number]) + random.uniform(-SCATTER, SCATTER)
            sway = -group.sway if self.mirrored else group.sway
            last = number == len(group.at) - 1
            fleet.launch(group.kind, WIDTH * at, group.hover, sway, group.carries and last, self.pace)

    def _begin(self, random):
        self.number += 1
        self.clock = self.idle = 0
        if self.pace.round and self.number % len(WAVES) == 1:
            random.shuffle(self.order)
        self.mirrored = random.random() < 0.5
        due = [(steps(group.after + group.every * number), order, group, number)
               for order, group in enumerate(self.wave.groups) for number in range(len(group.at))]
        self.due = [(when, group, number) for when, _, group, number in sorted(due, key=lambda each: each[:2])]

    def state(self):
        """For the digest."""
        return (self.number, self.clock, self.idle, self.mirrored, len(self.due), *self.order)
