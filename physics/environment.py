"""What a world is under, and can be set between steps: solver, broad phase, forces, the length of a step."""

from typing import Any

import numpy as np

from physics import checks
from physics.broadphase.proxies import Strategy
from physics.checks import Pair
from physics.dynamics import sleep
from physics.dynamics.awake import Awake
from physics.effects import Effects
from physics.profile import Profile
from physics.reshaping import rebuild_masks
from physics.settings import ACCURACY
from physics.step import SOLVERS, STACKING, Workspace, ignored_effects, plans
from physics.tables.body import DYNAMIC
from physics.tables.manifold import ANCHOR, MANIFOLD
from physics.vec2 import Vec2
from physics.world_state import WorldState

STRATEGY_METHODS = ("find_pairs", "fresh", "update", "query")


def checked_substeps(value: Any) -> int | str:
    """A number of substeps, or "auto". Raises TypeError, ValueError."""
    if isinstance(value, str):
        return checks.choice("substeps", value, ("auto",))
    return checks.whole("substeps", value, 1, 1000)


def checked_accuracy(value: Any) -> float | None:
    """A length [px], or None. Raises TypeError, ValueError."""
    return None if value is None else checks.number("accuracy", value, above=0.0)


def own_solver(effects: Effects) -> str:
    """The solver of a World that is told none."""
    return "soft_step" if effects.stacking else "projection"


class Environment(WorldState):
    """The settings of a World, and the stages that follow from them; nothing else inherits from this."""

    _solver: str
    _substeps: int | str
    _accuracy: float | None
    _gravity: Vec2
    _drag: float
    _wind: Vec2
    _dt: float

    @property
    def solver(self) -> str:
        """One of SOLVERS; can be set between steps."""
        return self._solver

    @solver.setter
    def solver(self, name: str) -> None:
        self._unlocked()
        self._solver = self._checked_solver(name)
        sleep.wake_all(self)
        self._plan()

    @property
    def stacks(self) -> bool:
        """Whether the solver is one whose contacts remember."""
        return self._solver in STACKING

    @property
    def ignored_effects(self) -> tuple[str, ...]:
        """Names of the declared effects that the present solver does not honour, in the order of Effects.names().

        Without one of them everything goes the same way. Two remarks: under blocking a body turns by its own angular
        velocity, though no contact turns it; and Characters stand on dynamic bodies wherever stacking is declared.
        """
        return ignored_effects(self._effects, self._solver)

    @property
    def sleeps(self) -> bool:
        """Whether what has come to rest is left out of the steps."""
        return self.stacks and self._effects.sleeping

    def _checked_solver(self, name):
        name = checks.choice("solver", name, SOLVERS)
        self._needs("stacking", f"solver {name!r}", name in STACKING)
        return name

    def set_narrowphase(self, on: bool) -> None:
        """Switch between the narrow phase and plain AABBs, between steps."""
        self.set_effects(self._effects.with_(narrowphase=checks.flag("narrowphase", on)))

    def set_effects(self, effects: Effects) -> None:
        """Live under other effects from the next step on, and wake. What bodies were given stays, and means nothing as
        long as no effect calls for it: a spin, a bullet, a sensor, a material. The solver stays where they allow it,
        else it is the World's own choice. Where `response` comes or goes, masks get other parts, and new shape ids.

        Raises TypeError, and ValueError for effects without response in a world that has Characters."""
        self._unlocked()
        if not isinstance(effects, Effects):
            raise TypeError(f"effects must be an Effects (got {checks.shown(effects)})")
        if len(self.characters.rows) and not effects.response:
            raise ValueError("effects must have response: this world has Characters, which need it")
        before, self._effects = self._effects, effects
        sleep.wake_all(self)
        if before.stacking != effects.stacking:
            self._solver = own_solver(effects)
        self._plan()
        if before.response != effects.response:
            rebuild_masks(self)

    def _plan(self):
        before, self.workspace = self.workspace, Workspace(self._effects, self._solver)
        self._plans = plans(self._effects, self._solver)
        if before is None or before.stacks != self.stacks:
            # The two kinds of worlds keep other facts of their contacts.
            self.manifolds, self.anchors = np.zeros(0, MANIFOLD), np.zeros(0, ANCHOR)
            self.sensed = None
        if (self.sensed is not None) != self._effects.response:
            self.sensed = np.zeros(0, MANIFOLD) if self._effects.response else None
        if self.awake.sleeping != self.sleeps:
            self._let_sleep(self.sleeps)
        self.profile = Profile(self._plan_now.names)

    def _let_sleep(self, sleeping):
        """From now on the steps go over what is awake, or over everything."""
        self.awake = Awake(sleeping)
        self.bodies["active"] = not sleeping
        self.awake.stir(self.bodies["id"][self.bodies["kind"] != DYNAMIC].tolist())
        self.pairs.let_sleep(sleeping)
        self._broadphase = self._broadphase.fresh()  # it is told of all there is, and of nothing that is gone
        self.sleepers.return_all(self)

    @property
    def substeps(self) -> int | str:
        """How often the stacking solvers look at the contacts in a step; "auto": as often as each island needs for its
        contacts to sink by no more than the accuracy, 4 to 32 times, and up to 128 where it leans. Can be set between
        steps."""
        return self._substeps

    @substeps.setter
    def substeps(self, value: int | str) -> None:
        self._unlocked()
        self._substeps = checked_substeps(value)

    @property
    def accuracy(self) -> float:
        """[px] what contacts may sink under their loads where substeps are "auto", as far as 32 of them reach; None: a
        millimetre. Can be set between steps."""
        return ACCURACY * self.tolerances.pixels_per_meter if self._accuracy is None else self._accuracy

    @accuracy.setter
    def accuracy(self, value: float | None) -> None:
        self._unlocked()
        self._accuracy = checked_accuracy(value)

    @property
    def broadphase(self) -> Strategy:
        """The strategy that finds the candidates; can be set between steps, without changing any result."""
        return self._broadphase

    @broadphase.setter
    def broadphase(self, strategy: Strategy) -> None:
        self._unlocked()
        if isinstance(strategy, type) or not all(hasattr(strategy, each) for each in STRATEGY_METHODS):
            raise TypeError(
                "broadphase must be an instance of BruteForce, SweepAndPrune, SpatialHashGrid or DynamicTree "
                f"(got {checks.shown(strategy)})"
            )
        self._broadphase = strategy.fresh()
        self.pairs.start_over()

    @property
    def gravity(self) -> Vec2:
        """[px/s2]; can be set between steps."""
        return self._gravity

    @gravity.setter
    def gravity(self, value: Pair) -> None:
        self._unlocked()
        self._gravity = self._felt(self._gravity, checks.vector("gravity", value), self._effects.gravity)

    def _felt(self, before, now, felt):
        """A new value of a force; where it is felt, it wakes what rests under the old one."""
        if felt and now != before:
            sleep.wake_all(self)
        return now

    @property
    def dt(self) -> float:
        """Length of a step [s]; can be set between steps."""
        return self._dt

    @dt.setter
    def dt(self, value: float) -> None:
        self._unlocked()
        self._dt = checks.number("dt", value, above=0.0)

    @property
    def drag(self) -> float:
        """[1/s]; can be set between steps. What sleeps wakes, as from another gravity or wind."""
        return self._drag

    @drag.setter
    def drag(self, value: float) -> None:
        self._unlocked()
        felt = self._effects.drag or self._effects.wind
        self._drag = self._felt(self._drag, checks.number("drag", value, low=0.0), felt)

    @property
    def wind(self) -> Vec2:
        """Velocity of the air [px/s]; it acts through the drag. Can be set between steps."""
        return self._wind

    @wind.setter
    def wind(self, value: Pair) -> None:
        self._unlocked()
        self._wind = self._felt(self._wind, checks.vector("wind", value), self._effects.wind)
