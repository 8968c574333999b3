"""Effects: the physics features that a world declares. A step runs only the stages that these effects need."""

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
    """The physics features that a world declares. All are off by default except `narrowphase`.

    World() uses Effects.rigid_bodies(); with_ returns a copy with some effects changed.

    narrowphase: shapes are tested exactly. Without it, shapes collide if their AABBs overlap.
    response: overlapping bodies are pushed apart. Without it, contacts are only detected and reported.
    gravity: World.gravity accelerates bodies; drag: World.drag slows bodies down; wind: World.wind accelerates bodies.
    rotation: angular velocity rotates bodies, and impulses change it. Without it, bodies keep their initial angles.
    friction: Material.friction and rolling_resistance act; restitution: bodies bounce by Material.restitution.
    stacking: stacks are stable, because contacts are warm started; the default solver is then a stacking solver.
    continuous: fast bodies stop at their first impact, see Body.continuous.
    sleeping: islands at rest are not simulated until they are disturbed.
    sensors: shapes with sensor=True report overlaps; persist: events.persist lists pairs that continue to touch.
    one_way: one-way tiles and masks are solid only from above; conveyor: Material.surface_speed moves bodies.
    joints: joints connect bodies, see World.add_joint; carving: Body.carve removes pixels of masks.

    Raises TypeError for a value that is not a bool, and ValueError if an effect is on while an effect that it needs is
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
        """Return the constructor call as text, without the effects that have their default value."""
        given = [field for field in fields(self) if getattr(self, field.name) != field.default]
        return f"Effects({', '.join(f'{each.name}={getattr(self, each.name)}' for each in given)})"

    @classmethod
    @hints.without_others
    def detection(cls, **others: Never) -> "Effects":
        """Return the Effects for pure collision detection: contacts are reported, and no body is pushed."""
        _check_no_effects("detection", others)
        return cls()

    @classmethod
    @hints.without_others
    def rigid_bodies(cls, **others: Never) -> "Effects":
        """Return the Effects for rigid bodies, which fall, rotate, bounce, have friction, stack and sleep.

        The following effects are on: narrowphase, response, gravity, rotation, friction, restitution, stacking,
        continuous, sleeping and sensors.
        """
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
        """Return the Effects in which exactly the named effects are on. This is the inverse of names().

        names: names of effects. `narrowphase` is off unless it is named.

        Raises TypeError for an unknown effect, and ValueError if a named effect needs an effect that is not named.
        """
        if isinstance(names, str):
            raise TypeError(f"names must be a list of names (got {names!r}): write [{names!r}]")
        wanted = checks.listed(names)
        if wanted is None or not all(isinstance(each, str) for each in wanted):
            raise TypeError(f"names must be a list of names of effects (got {checks.shown(names)})")
        return cls(narrowphase=False).with_(**dict.fromkeys(wanted, True))

    def with_(self, **changes: bool) -> "Effects":
        """Return a copy with some effects changed, for example with_(gravity=True).

        **changes: effects by name, True or False.

        Raises TypeError for an unknown effect or a value that is not a bool; ValueError if an effect would be on while
        an effect that it needs is off.
        """
        known = [field.name for field in fields(self)]
        unknown = sorted(set(changes) - set(known))
        if unknown:
            similar = hints.near(unknown[0], known)
            hint = f": did you mean {similar}?" if similar else ""
            raise TypeError(f"no effect {', '.join(unknown)}; there are {', '.join(known)}{hint}")
        return replace(self, **changes)

    def without(self, name: str) -> "Effects":
        """Return a copy in which one effect is off, together with all effects that need it.

        name: name of the effect.

        Raises TypeError for an unknown effect.
        """
        _check_name(name)
        return self.with_(**{name: False}, **{each: False for each in self.names() if name in NEEDS.get(each, ())})

    def and_needed(self, name: str) -> "Effects":
        """Return a copy in which all effects needed by the effect `name` are on. The effect itself is unchanged.

        name: name of the effect. For an unknown name, the copy equals the original.

        Raises TypeError for a value that is not a string.
        """
        _check_name(name)
        return self.with_(**dict.fromkeys(NEEDS.get(name, ()), True))

    def names(self) -> list[str]:
        """Return the names of the effects that are on, in the order of the fields."""
        return [field.name for field in fields(self) if getattr(self, field.name)]


def declaring(effects: Effects, name: str) -> str:
    """Return Python code for an Effects that has all given effects, one more effect, and the effects needed by it.

    The code is shown in messages. name: name of the additional effect.
    """
    if effects == Effects.rigid_bodies():
        return f"Effects.rigid_bodies().with_({name}=True)"
    return repr(effects.and_needed(name).with_(**{name: True}))


def _check_name(name):
    if not isinstance(name, str):
        raise TypeError(f"name must be the name of an effect, a string (got {checks.shown(name)})")


def _check_no_effects(preset, given):
    """Raise TypeError if keyword arguments were passed to a preset, which has none.

    preset: name of the preset, "detection" or "rigid_bodies"; given: {name: value} of the keyword arguments.
    """
    if given:
        text = ", ".join(f"{name}={hints.brief(value)}" for name, value in given.items())
        raise TypeError(
            f"Effects.{preset}() got an unexpected keyword argument {next(iter(given))!r} (got {text}): "
            f"write Effects.{preset}().with_({text})"
        )


def checked_effects(value: Any) -> Effects:
    """Return `value` unchanged if it is an Effects. Raises TypeError for anything else."""
    if not isinstance(value, Effects):
        hint = hints.in_place_of_effects(value, Effects.__dataclass_fields__, NEEDS)
        raise TypeError(f"effects must be an Effects (got {checks.shown(value)}){hint}")
    return value
