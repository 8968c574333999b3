"""A step that was made: the world after it, its bodies before and after, and what acted on it from outside."""

from functools import cached_property

import numpy as np

from game.invariants.bodies import Bodies
from physics import DYNAMIC, KINEMATIC, World


class Step:
    """`edited`: somebody changed the world since the step before it; `forced`: forces had been applied to bodies."""

    def __init__(self, world: World, before: Bodies, edited: bool, forced: bool) -> None:
        self.world, self.before, self.edited, self.forced = world, before, edited, forced
        self.number = world.steps
        self.now = Bodies(world)
        self.contacts = world.contacts

    @property
    def slop(self) -> float:
        """[px] the overlap in which a contact is kept."""
        return self.world.tolerances.slop

    @cached_property
    def overlap(self) -> float:
        """[px] of the deepest contact; 0 without one."""
        depths = self.contacts["separation"]
        return max(0.0, -float(depths.min())) if len(depths) else 0.0

    def rows_of(self, ids: np.ndarray) -> np.ndarray:
        """Rows of bodies that are there."""
        return np.searchsorted(self.now.ids, ids)

    @cached_property
    def outside(self) -> str:
        """What adds momentum and energy from outside in this step, "" where nothing does."""
        world, effects = self.world, self.world.effects
        if self.forced:
            return "forces act"
        if len(world.characters.rows):
            return "a character walks and pushes"
        if len(self.before) != len(self.now):
            return "bodies came or went"
        movers = self.now.kind == KINEMATIC
        if movers.any():
            turned = (self.now.vx != 0.0) | (self.now.vy != 0.0) | (self.now.turn != 0.0)
            moved = (self.now.numbers[:3] != self.before.numbers[:3]).any(axis=0)
            if (movers & (turned | moved)).any():
                return "a kinematic body moves"
        if effects.wind and any(world.wind):
            return "wind blows"
        if effects.conveyor and world.shapes["surface_speed"].any():
            return "a belt runs"
        if len(world.events.quarantined):
            return "a body was taken out"
        return ""

    @cached_property
    def open(self) -> str:
        """Why the bodies are not alone with each other, so that momentum may leave them; "" where they are."""
        world, effects = self.world, self.world.effects
        if self.outside:
            return self.outside
        if any(self.now.gravity):
            return "gravity acts"
        if effects.drag and world.drag > 0.0:
            return "drag acts"
        sides = np.concatenate((self.contacts["body_a"], self.contacts["body_b"]))
        if len(sides) and (self.now.kind[self.rows_of(sides)] != DYNAMIC).any():
            return "something that stands is touched"
        return ""
