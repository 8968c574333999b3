"""Effects: the features of the physics that a scene declares. A step runs only the stages that these effects need."""

from collections.abc import Iterable
from dataclasses import dataclass, fields, replace
from typing import Any, Never

from physics import checks, hints

NEEDS_RESPONSE = ("friction", "restitution", "stacking", "one_way", "conveyor", "joints")
NEEDS = {name: ("response",) for name in NEEDS_RESPONSE}  # needed effects
NEEDS |= {name: ("response", "stacking") for name in ("sleeping", "joints")}


@hints.explained_class
@hints.unchangeable("world.set_effects(world.effects.with_({name}={value}))")
@dataclass(frozen=True, repr=False)
class Effects:
    """The features of the physics that a world declares. All are off by default except `narrowphase`.

    World() has those of Effects.rigid_bodies(); with_ changes some of them.

    narrowphase: shapes are tested exactly; without it collision stops at AABBs.
    response: overlaps are pushed apart. Without it contacts are only found and reported.
    gravity: World.gravity accelerates bodies; drag: World.drag slows bodies down; wind: World.wind carries bodies.
    rotation: angular velocity turns bodies, impulses spin them. Without it, bodies keep the angle that they were given.
    friction: Material.friction and rolling_resistance act; restitution: bodies bounce by Material.restitution.
    stacking: stacks are stable, because contacts are warm started; a stacking solver is the default.
    continuous: fast bodies stop at their first impact, see Body.continuous.
    sleeping: islands at rest cost nothing until they are disturbed.
    sensors: shapes with sensor=True report overlaps; persist: events.persist lists pairs that continue to touch.
    one_way: one-way tiles and masks hold bodies from above; conveyor: Material.surface_speed moves bodies.
    joints: joints hold bodies, see World.add_joint; carving: Body.carve removes pixels of masks.

    Raises TypeError for a value that is not a bool, and ValueError if an effect is on and an effect that it needs is
    off.

    >>> Effects(response=True, gravity=True)
    Effects(response=True, gravity=True)
    >>> world = World(Effects.rigid_bodies().with_(joints=True, sleeping=False))
    """

    narrowphase: bool = True
    response: bool = False
    gravity: bool = False
    drag: bool = False
    wind: bool = False
    rotation: bool = False
    friction: bool = False
    restitution: bool = False
    stacking: bool = False
    continuous: bool = False
    sleeping: bool = False
    sensors: bool = False
    persist: bool = False
    one_way: bool = False
    conveyor: bool = False
    joints: bool = False
    carving: bool = False

    def __post_init__(self):
        for field in fields(self):
            value = getattr(self, field.name)
            if not isinstance(value, bool):
                raise TypeError(f"effect {field.name} must be True or False (got {checks.shown(value)})")
        for name in NEEDS_RESPONSE:
            if getattr(self, name) and not self.response:
                raise ValueError(f"effect {name} needs response: declare both, or neither")
        if self.sleeping and not self.stacking:
            raise ValueError("effect sleeping needs stacking: without it nothing comes to rest")
        if self.joints and not self.stacking:
            raise ValueError("effect joints needs stacking: only the stacking solvers solve joints")

    def __repr__(self):
        """Return the constructor call without the effects that have their default."""
        given = [field for field in fields(self) if getattr(self, field.name) != field.default]
        return f"Effects({', '.join(f'{each.name}={getattr(self, each.name)}' for each in given)})"

    @classmethod
    @hints.without_others
    def detection(cls, **others: Never) -> "Effects":
        """Return the effects of pure detection: contacts are found and reported, and no body is pushed."""
        _check_no_effects("detection", others)
        return cls()

    @classmethod
    @hints.without_others
    def rigid_bodies(cls, **others: Never) -> "Effects":
        """Return the effects of rigid bodies: they fall, bounce, have friction, stack, sleep and trigger sensors."""
        _check_no_effects("rigid_bodies", others)
        return cls(
            response=True,
            gravity=True,
            rotation=True,
            friction=True,
            restitution=True,
            stacking=True,
            continuous=True,
            sleeping=True,
            sensors=True,
        )

    @classmethod
    def named(cls, names: Iterable[str]) -> "Effects":
        """Return the Effects in which exactly the named effects are on. It is the inverse of names().

        names: names of effects. `narrowphase`, too, must be named to be on.

        Raises TypeError for an unknown effect, and ValueError if an effect that a named one needs is not named.
        """
        if isinstance(names, str):
            raise TypeError(f"names must be a list of names (got {names!r}): write [{names!r}]")
        return cls(narrowphase=False).with_(**dict.fromkeys(names, True))

    def with_(self, **changes: bool) -> "Effects":
        """Return a copy with some effects changed, for example with_(gravity=True).

        **changes: effects by name, True or False.

        Raises TypeError for an unknown effect or a value that is not a bool, and ValueError if an effect is then on
        without an effect that it needs.
        """
        known = [field.name for field in fields(self)]
        unknown = sorted(set(changes) - set(known))
        if unknown:
            similar = hints.near(unknown[0], known)
            hint = f": did you mean {similar}?" if similar else ""
            raise TypeError(f"no effect {', '.join(unknown)}; there are {', '.join(known)}{hint}")
        return replace(self, **changes)

    def without(self, name: str) -> "Effects":
        """Return a copy in which an effect, and all effects that need it, are off.

        name: the effect.

        Raises TypeError for an unknown effect.
        """
        return self.with_(**{name: False}, **{each: False for each in self.names() if name in NEEDS.get(each, ())})

    def and_needed(self, name: str) -> "Effects":
        """Return a copy in which all effects that an effect needs are on. The effect itself is unchanged.

        name: the effect; an unknown one needs no other.
        """
        return self.with_(**dict.fromkeys(NEEDS.get(name, ()), True))

    def names(self) -> list[str]:
        """Return the names of the declared effects, in the order of the fields."""
        return [field.name for field in fields(self) if getattr(self, field.name)]


def declaring(effects: Effects, name: str) -> str:
    """Return the expression, for messages, of Effects with one more effect and those that it needs.

    name: the effect that is to be declared.
    """
    if effects == Effects.rigid_bodies():
        return f"Effects.rigid_bodies().with_({name}=True)"
    return repr(effects.and_needed(name).with_(**{name: True}))


def _check_no_effects(preset, given):
    """Raise TypeError for effects that were given to a preset, which takes none."""
    if given:
        text = ", ".join(f"{name}={hints.brief(value)}" for name, value in given.items())
        raise TypeError(
            f"Effects.{preset}() got an unexpected keyword argument {next(iter(given))!r} (got {text}): "
            f"write Effects.{preset}().with_({text})"
        )


def checked_effects(value: Any) -> Effects:
    """Return Effects unchanged. Raises TypeError for anything else."""
    if not isinstance(value, Effects):
        raise TypeError(f"effects must be an Effects (got {checks.shown(value)}){hints.in_place_of_effects(value)}")
    return value
