"""What a body is made of, whom it meets and how it is swept: the settings of a Body, all of which can be set."""

from typing import Any

import numpy as np

from physics import checks, editing, reshaping
from physics.dynamics import sleep
from physics.shape_rows import MATERIAL
from physics.shapes.filter import Filter
from physics.shapes.kinds import Shape
from physics.shapes.material import Material
from physics.tables.body import CONTINUOUS, KINDS
from physics.vec2 import Vec2
from physics.world_state import Handle


class BodySettings(Handle):
    """The settings of a Body; nothing else inherits from this."""

    __slots__ = ()

    @property
    def _row(self) -> np.void:
        return self.world._body_row(self.id)

    def _value(self, name: str) -> Any:
        """Of its row, as a Python value: out of the column, which takes half as long as out of the row."""
        world = self.world
        return world._bodies.data[name].item(world._row_number(self.id))

    def _pair(self, first: str, second: str) -> Vec2:
        world = self.world
        row, columns = world._row_number(self.id), world._bodies.data
        return Vec2(columns[first].item(row), columns[second].item(row))

    @property
    def _given(self) -> np.void:
        """The GIVEN row."""
        return self.world._given.rows[self.world._row_number(self.id)]

    def _must_exist(self) -> None:
        """Raises KeyError for a body that was removed."""
        self.world._row_number(self.id)

    def _stir(self, row) -> None:
        if not row["awake"]:
            sleep.disturb(self.world, [self.id])
        row["sleep_time"] = 0.0

    @property
    def kind(self) -> str:
        """static, kinematic or dynamic; see set_kind."""
        return KINDS[self._value("kind")]

    @property
    def user(self) -> Any:
        """Anything the game wants to find again; not part of snapshots and digests."""
        self._must_exist()
        return self.world._users.get(self.id)

    @user.setter
    def user(self, value: Any) -> None:
        self._must_exist()
        self.world._users[self.id] = value

    # --- what it says of its shapes ------------------------------------------------------------------------------

    @property
    def material(self) -> Material:
        """What those shapes are made of that have no material of their own. Set, the body is weighed anew."""
        given = self._given
        return Material(*(given[name].item() for name in MATERIAL))

    @material.setter
    def material(self, value: Material) -> None:
        editing.set_material(self.world, self.id, value)

    @property
    def filter(self) -> Filter:
        """The filter of those shapes that have none of their own."""
        given = self._given
        return Filter(given["membership"].item(), given["mask"].item())

    @filter.setter
    def filter(self, value: Filter) -> None:
        editing.set_filter(self.world, self.id, value)

    @property
    def sensor(self) -> bool:
        """Whether those shapes that do not say so themselves report and do not push. Sensors count in the mass."""
        return self._given["sensor"].item()

    @sensor.setter
    def sensor(self, value: bool) -> None:
        editing.set_sensor(self.world, self.id, value)

    # --- how it moves ----------------------------------------------------------------------------------------------

    @property
    def gravity_scale(self) -> float:
        """Factor on the world's gravity."""
        return self._value("gravity_scale")

    @gravity_scale.setter
    def gravity_scale(self, value: float) -> None:
        self.world._unlocked()
        row = self._row
        row["gravity_scale"] = checks.number("gravity_scale", value)
        self._stir(row)

    @property
    def bullet(self) -> bool:
        """Whether it is swept against moving bodies too. Raises ValueError for True without the effect continuous."""
        return self._value("bullet")

    @bullet.setter
    def bullet(self, value: bool) -> None:
        self.world._unlocked()
        row = self._row
        row["bullet"] = editing.checked_bullet(self.world, value)

    @property
    def continuous(self) -> str:
        """off, ray, swept, toi or auto: how it is kept from passing through what it meets on its way."""
        return CONTINUOUS[self._value("continuous")]

    @continuous.setter
    def continuous(self, value: str) -> None:
        editing.set_continuous(self.world, self.id, value)

    @property
    def fixed_rotation(self) -> bool:
        """Whether contacts and impulses leave its turn alone. Set to True it stops turning."""
        return self._value("fixed_rotation")

    @fixed_rotation.setter
    def fixed_rotation(self, value: bool) -> None:
        editing.set_fixed_rotation(self.world, self.id, value)

    # --- its shapes ------------------------------------------------------------------------------------------------

    @property
    def shapes(self) -> tuple[Shape, ...]:
        """The shapes as they were given; with a tier, what they are replaced by."""
        self._must_exist()
        return self.world._shapes_of[self.id]

    @property
    def shape_ids(self) -> tuple[int, ...]:
        """Ids of the shapes, in the order of `shapes`."""
        return reshaping.shape_ids(self.world, self.id)

    def set_shapes(self, *shapes: Shape) -> None:
        """Replace the shapes; what the body says of them stays. The new shapes get new ids, but for masks that take the
        place of as many masks: contacts with these go on."""
        reshaping.set_shapes(self.world, self.id, shapes)

    def add_shape(self, shape: Shape) -> int:
        """Add a shape behind those it has, and weigh the body anew. A tier ends. Returns the shape's id."""
        return reshaping.add_shape(self.world, self.id, shape)

    def remove_shape(self, shape_id: int) -> None:
        """Take one of its shapes away, and weigh the body anew. A tier ends. Raises KeyError for an id that is none of
        its shapes'."""
        reshaping.remove_shape(self.world, self.id, shape_id)

    @property
    def tier(self) -> str | None:
        """How exactly its sprite collides: one of TIERS, or None for the shapes as given."""
        self._must_exist()
        return self.world._tiers.get(self.id)

    @tier.setter
    def tier(self, value: str | None) -> None:
        reshaping.set_tier(self.world, self.id, value)
