"""What a world is under, and can be set between steps: solver, broad phase, forces, the length of a step."""

from physics import checks
from physics.dynamics import sleep
from physics.step import SOLVERS, STACKING

STRATEGY_METHODS = ("find_pairs", "fresh", "update", "query")


class Environment:
    """The settings of a World, which keeps them; nothing else inherits from this."""

    @property
    def solver(self) -> str:
        """One of SOLVERS; can be set between steps."""
        return self._solver

    @solver.setter
    def solver(self, name):
        self._unlocked()
        self._solver = self._checked_solver(name)
        sleep.wake_all(self)
        self._plan()

    @property
    def stacks(self) -> bool:
        """Whether the solver is one whose contacts remember."""
        return self._solver in STACKING

    @property
    def sleeps(self) -> bool:
        """Whether what has come to rest is left out of the steps."""
        return self.stacks and self._effects.sleeping

    def _checked_solver(self, name):
        name = checks.choice("solver", name, SOLVERS)
        self._needs("stacking", f"solver {name!r}", name in STACKING)
        return name

    @property
    def substeps(self) -> int:
        """How often the stacking solvers look at the contacts in a step; can be set between steps."""
        return self._substeps

    @substeps.setter
    def substeps(self, value):
        self._unlocked()
        self._substeps = checks.whole("substeps", value, 1, 1000)

    @property
    def broadphase(self):
        """The strategy that finds the candidates; can be set between steps, without changing any result."""
        return self._broadphase

    @broadphase.setter
    def broadphase(self, strategy):
        self._unlocked()
        if isinstance(strategy, type) or not all(hasattr(strategy, each) for each in STRATEGY_METHODS):
            raise TypeError(
                "broadphase must be an instance of BruteForce, SweepAndPrune, SpatialHashGrid or DynamicTree "
                f"(got {strategy!r})"
            )
        self._broadphase = strategy.fresh()
        self.pairs.start_over()

    @property
    def gravity(self) -> tuple[float, float]:
        """[px/s2]; can be set between steps."""
        return self._gravity

    @gravity.setter
    def gravity(self, value):
        self._unlocked()
        value = checks.vector("gravity", value)
        if value != self._gravity:
            sleep.wake_all(self)
        self._gravity = value

    @property
    def dt(self) -> float:
        """Length of a step [s]; can be set between steps."""
        return self._dt

    @dt.setter
    def dt(self, value):
        self._unlocked()
        self._dt = checks.number("dt", value, above=0.0)

    @property
    def drag(self) -> float:
        """[1/s]; can be set between steps."""
        return self._drag

    @drag.setter
    def drag(self, value):
        self._unlocked()
        self._drag = checks.number("drag", value, low=0.0)

    @property
    def wind(self) -> tuple[float, float]:
        """Velocity of the air [px/s]; it acts through the drag. Can be set between steps."""
        return self._wind

    @wind.setter
    def wind(self, value):
        self._unlocked()
        self._wind = checks.vector("wind", value)
