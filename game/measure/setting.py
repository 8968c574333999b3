"""Setting of a world, and the list of settings to measure: the current one, and others that differ by one change."""

from collections.abc import Iterator
from typing import NamedTuple

from game.drawing.number_text import count_text, plain_name
from game.scene import SOLVERS_OF_JOINTS, SUBSTEPS
from physics import BROADPHASES, SOLVERS, TIERS, Effects
from physics.annotations import JointSolverName, SolverName, Substeps, TierName

SUBSTEPPED = ("soft_step", "sequential_impulse")  # solvers that use substeps, or passes in their place
JOINT_TIERS: tuple[JointSolverName, ...] = ("iterative", "direct")  # that are compared


class Setting(NamedTuple):
    """The settings of a world that affect accuracy and time. A field is None if the world does not use it."""

    broadphase: str
    narrowphase: bool
    solver: SolverName | None = None
    substeps: Substeps | None = None
    tier: TierName | None = None
    joint_solver: JointSolverName | None = None

    def differs(self, other: "Setting") -> tuple[str, ...]:
        """Return the names of the fields whose values differ from those of the setting `other`."""
        return tuple(name for name in self._fields if getattr(self, name) != getattr(other, name))

    def label(self, other: "Setting") -> str:
        """Return the values in which this setting differs from `other`, as short text; "as it is" if there are none."""
        names = self.differs(other)
        words = [_WORDS[name](value) for name in names if (value := getattr(self, name)) is not None]
        if "solver" in names and self.substeps is not None:  # the number follows the solver's name without a unit
            words = [word for name, word in zip(names, words, strict=False) if name != "substeps"]
            words[-1] += f", {'by load' if self.substeps == 'auto' else self.substeps}"
        return ", ".join(words) or "as it is"


_WORDS = {
    "broadphase": str,
    "narrowphase": lambda on: "narrow phase" if on else "boxes only",
    "solver": plain_name,
    "substeps": lambda count: "substeps by load" if count == "auto" else count_text(count, "substep"),
    "tier": lambda name: f"as {name}",
    "joint_solver": lambda name: f"{name} joints",
}


def settings_around(here: Setting, effects: Effects) -> list[Setting]:
    """Return the settings to measure: first `here`, then the settings that differ from `here` by one change.

    The changes are: another broad phase, the narrow phase on or off, another collision tier (kind of collision shape),
    another solver, another joint solver. Each solver and joint solver is listed with every number of substeps. The list
    alternates between these kinds of change. effects: effects of the world, which determine the possible solvers.
    """
    rows = [
        list(_solvers(here, effects)),
        list(_joint_solvers(here)),
        list(_tiers(here)),
        list(_broadphases(here)),
        list(_narrow(here)),
    ]
    found = [here]
    while any(rows):
        for row in rows:
            if row:
                found.append(row.pop(0))
    return list(dict.fromkeys(found))


def _broadphases(here) -> Iterator[Setting]:
    for name in BROADPHASES:
        yield here._replace(broadphase=name)


def _narrow(here) -> Iterator[Setting]:
    yield here._replace(narrowphase=not here.narrowphase)


def _tiers(here) -> Iterator[Setting]:
    for name in TIERS if here.tier is not None and here.narrowphase else ():
        yield here._replace(tier=name)


def _joint_solvers(here) -> Iterator[Setting]:
    for substeps in SUBSTEPS if here.joint_solver is not None else ():
        for name in JOINT_TIERS:
            if here.solver == "soft_step" or substeps != "auto":
                yield here._replace(joint_solver=name, substeps=substeps)


def _solvers(here, effects) -> Iterator[Setting]:
    if here.solver is None:
        return
    valid = [name for name in reversed(SOLVERS) if not effects.joints or name in SOLVERS_OF_JOINTS]
    for solver in valid if effects.stacking else ("projection", "blocking"):
        if solver in SUBSTEPPED:
            for substeps in SUBSTEPS:
                if solver == "soft_step" or substeps != "auto":
                    yield here._replace(solver=solver, substeps=substeps)
        else:
            yield here._replace(solver=solver, substeps=None)
