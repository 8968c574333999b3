"""Director of a stage: it launches the planes when they are due.

The director's clock stops while a leader (mid-boss or boss) is announced or in play.
"""

from dataclasses import replace

from scenes.shooter.cast import WIDTH, steps
from scenes.shooter.difficulty import Difficulty

SCATTER = 0.03  # greatest random offset of a plane's entry, as a share of the side of the picture
WARNING = steps(3.0)  # steps between the warning and the launch of its leader
CLEARING = steps(8.0)  # steps that a warning waits for the last planes of earlier waves
REST = steps(1.5)  # steps of rest after a leader
READY = steps(3.0)  # steps of the stage's title, before its clock begins


class Director:
    """The director, which launches the waves and the bosses of a stage.

    clock: time of the stage [steps]; wave: name of the latest wave; number: its number.

    mode: "ready" before the stage begins, and then "run". For a mid-boss or boss, the modes "clearing", "warning",
    "leader" and "rest" follow each other. After the boss, the mode is "over". since: steps in the current mode.
    """

    def __init__(self, stage):
        self.stage = stage
        self.clock = self.next = 0  # steps; index of the next event
        self.mode, self.since = "ready", 0
        self.number, self.wave = 0, ""
        self.grounds = [(-1e9, stage.events[0].ground)]  # (distance scrolled [px] when it came into view, name)
        self.difficulty = Difficulty()
        self.due = []  # (step, group, number in the group, wave), earliest first
        self.left = {}  # wave -> its planes that are not shot down
        self.mirrored = False

    @property
    def ground(self):
        """Name of the ground that has come into view last."""
        return self.grounds[-1][1]

    @property
    def announced(self):
        """The stage's Event of the mid-boss or boss that is announced or in play, or None if there is none."""
        return self.stage.events[self.next - 1] if self.mode in ("clearing", "warning", "leader") else None

    def step(self, sky):
        """Make one step: process the events and launch the planes that are due. sky: the scene."""
        self.since += 1
        if self.mode == "run":
            self.clock += 1
            while (
                self.mode == "run"
                and self.next < len(self.stage.events)
                and steps(self.stage.events[self.next].at) <= self.clock
            ):
                self.next += 1
                self._begin(self.stage.events[self.next - 1], sky)
        elif self.mode == "ready":
            self._go_on(READY, "run")
        elif self.mode == "clearing":
            if not len(sky.fleet) and not self.due:
                self.since = CLEARING
            if self._go_on(CLEARING, "warning"):
                sky.warn(self.announced)
        elif self.mode == "warning":
            if self._go_on(WARNING, "leader"):
                sky.fleet.launch_leader(self.announced)
        elif self.mode == "leader":
            leader = self.announced
            if sky.fleet.leader is None and leader is not None:
                sky.leader_gone(leader)
                self._enter("over" if leader.event == "boss" else "rest")
        elif self.mode == "rest":
            self._go_on(REST, "run")
        self._launch(sky)

    def _enter(self, mode):
        self.mode, self.since = mode, 0

    def _go_on(self, wait, mode):
        if self.since < wait:
            return False
        self._enter(mode)
        return True

    def _begin(self, event, sky):
        if event.event == "backdrop":
            if event.ground != self.ground:
                self.grounds.append((sky.scrolled, event.ground))
        elif event.event == "pace":
            self.difficulty = Difficulty(event.speed, event.patience, event.armour, event.extra)
        elif event.event == "item":
            sky.loot.drop(event.item, WIDTH * event.across, -12.0, sky.frame)
        elif event.event == "wave":
            self._begin_wave(event, sky)
        else:
            self._enter("clearing")

    def _begin_wave(self, event, sky):
        self.number += 1
        self.wave = event.name
        self.left[self.number] = sum(len(group.places) for group in event.groups)
        self.mirrored = sky.random.random() < 0.5
        found = [
            (self.clock + steps(group.after + group.every * number), order, number, group)
            for order, group in enumerate(event.groups)
            for number in range(len(group.places))
        ]
        self.due += [
            (when, group, number, self.number) for when, _, number, group in sorted(found, key=lambda f: f[:3])
        ]
        self.due.sort(key=lambda each: each[0])
        sky.spectacle.wave(self)

    def _launch(self, sky):
        # The clock may stop for a leader before a wave is complete: the rest of its planes still come.
        now = self.clock + (self.since if self.mode == "clearing" else 0)
        while self.due and self.due[0][0] <= now:
            _, group, number, wave = self.due.pop(0)
            share = group.places[number]
            if group.side not in ("left", "right"):
                share = 1.0 - share if self.mirrored else share
            share += sky.random.uniform(-SCATTER, SCATTER)
            carries = group.carries if number + 1 == len(group.places) else ""
            sky.fleet.launch(self._turned(group), share, carries, self.difficulty, wave, sky.scrolled)

    def _turned(self, group):
        """Return the Group, mirrored left to right if the current wave is mirrored. This is decided at random for each
        wave.
        """
        if not self.mirrored:
            return group
        other = {"left": "right", "right": "left"}.get(group.side, group.side)
        bend = -group.bend if group.side == "below" else group.bend
        return replace(group, sway=-group.sway, side=other, bend=bend)

    def shot_down(self, enemy):
        """Record that the plane `enemy` was shot down. Return whether it was the last plane of its wave."""
        if enemy.wave not in self.left:
            return False
        self.left[enemy.wave] -= 1
        return self.left[enemy.wave] == 0

    def state(self):
        """Return this object's part of Scene.state(), a flat tuple."""
        return (
            self.clock,
            self.next,
            self.mode,
            self.since,
            self.number,
            self.wave,
            self.ground,
            self.mirrored,
            len(self.due),
            *self.left.values(),
            *(since for since, _ in self.grounds),
        )
