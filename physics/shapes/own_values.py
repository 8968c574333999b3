"""What a shape may say for itself, whatever its body says of all its shapes: material, filter, sensor."""

import copy
from dataclasses import dataclass, field
from typing import Any, Self

from physics import checks
from physics.shapes.filter import Filter
from physics.shapes.material import Material


class OwnValues:
    """What all shapes have. A shape is a value: it never changes, and copies of what holds it share it."""

    material: Material | None = None  # None, of all three: its body's
    filter: Filter | None = None
    sensor: bool | None = None

    def with_(self, material: Material | None = None, filter: Filter | None = None, sensor: bool | None = None) -> Self:
        """The same shape with values of its own; None: the body's. Its density counts in the body's mass.

        A body that changes its own material, filter or sensor leaves these as they are. Raises TypeError.
        """
        for name, value, wanted in (("material", material, Material), ("filter", filter, Filter)):
            if value is not None and not isinstance(value, wanted):
                raise TypeError(f"{name} must be a {wanted.__name__} or None (got {checks.shown(value)})")
        sensor = None if sensor is None else checks.flag("sensor", sensor)
        bare = self.bare
        if material is None and filter is None and sensor is None:
            return bare
        found = copy.copy(bare)
        vars(found).update(material=material, filter=filter, sensor=sensor, _bare=bare)
        return found

    @property
    def bare(self) -> Self:
        """The shape without values of its own: what it is in a library, one for all that differ in them alone."""
        return vars(self).get("_bare", self)

    def with_values_of(self, other: "OwnValues") -> Self:
        """This shape with the own values of another one."""
        return self.with_(other.material, other.filter, other.sensor)

    def __deepcopy__(self, memo: dict[int, Any]) -> Self:
        return self


@dataclass(frozen=True)
class EqualByValue(OwnValues):
    """The shapes that are equal when their geometry and their own values are."""

    material: Material | None = field(default=None, init=False, repr=False)
    filter: Filter | None = field(default=None, init=False, repr=False)
    sensor: bool | None = field(default=None, init=False, repr=False)
