"""What a scene asks the physics for: the stages that no effect needs do not exist in its world."""

from collections.abc import Iterable
from dataclasses import dataclass, fields, replace

from physics import checks

NEEDS_RESPONSE = ("friction", "restitution", "stacking", "one_way", "conveyor")
NEEDS = {name: ("response",) for name in NEEDS_RESPONSE} | {"sleeping": ("response", "stacking")}  # foundations


@dataclass(frozen=True)
class Effects:
    """The effects a scene calls for. All off but `narrowphase`, which off stops the collision test at AABBs.

    Raises TypeError for a value that is not a bool, ValueError for an effect whose foundation is not declared.
    """

    narrowphase: bool = True
    response: bool = False  # overlaps are pushed apart
    gravity: bool = False
    drag: bool = False
    wind: bool = False
    rotation: bool = False  # angular velocity turns bodies, impulses spin them
    friction: bool = False
    restitution: bool = False
    stacking: bool = False  # piles stand: contacts remember their impulses
    continuous: bool = False  # fast bodies stop at what is in their way
    sleeping: bool = False  # what has come to rest costs nothing until it is disturbed
    sensors: bool = False
    persist: bool = False  # the `persist` event: pairs that go on touching
    one_way: bool = False  # tiles open from below
    conveyor: bool = False  # surfaces that run: Material.surface_speed
    carving: bool = False  # pixels can be taken out of masks: Body.carve

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

    @classmethod
    def detection(cls) -> "Effects":
        """Contacts are found and reported; nothing is pushed."""
        return cls()

    @classmethod
    def rigid_bodies(cls) -> "Effects":
        """All that bodies which fall, bounce, rub, pile up and trigger need."""
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
        """Exactly the effects that names() lists, narrowphase too only where it is named. Raises TypeError for one
        that there is not, ValueError for one without what it needs."""
        return cls(narrowphase=False).with_(**dict.fromkeys(names, True))

    def with_(self, **changes: bool) -> "Effects":
        """A copy with some effects changed."""
        unknown = set(changes) - {field.name for field in fields(self)}
        if unknown:
            raise TypeError(
                f"no effect {', '.join(sorted(unknown))}; there are {', '.join(field.name for field in fields(self))}"
            )
        return replace(self, **changes)

    def without(self, name: str) -> "Effects":
        """A copy without an effect, and without all that needs it. Raises TypeError for one that there is not."""
        return self.with_(**{name: False}, **{each: False for each in self.names() if name in NEEDS.get(each, ())})

    def and_needed(self, name: str) -> "Effects":
        """A copy with all that an effect needs, itself as it is here."""
        return self.with_(**dict.fromkeys(NEEDS.get(name, ()), True))

    def names(self) -> list[str]:
        """The declared effects, in the order of the fields."""
        return [field.name for field in fields(self) if getattr(self, field.name)]
