"""Body: a handle on one row of `world.bodies`. It holds an id, no state; a removed body's handle raises."""

from typing import Any

import numpy as np

from physics import checks, editing
from physics.checks import Pair
from physics.collision.manifold import contacts_of
from physics.dynamics import sleep
from physics.shapes.filter import Filter
from physics.shapes.kinds import Shape
from physics.tables.body import DYNAMIC, KINDS, STATIC
from physics.world_state import WorldState


def _column(name, doc):
    return property(lambda self: self._row[name].item(), doc=doc)


class Body:
    """A body of a world. Positions in px, angles in rad clockwise on the screen, velocities per second."""

    __slots__ = ("world", "id")

    def __init__(self, world: WorldState, identity: int) -> None:
        self.world = world
        self.id = identity

    def __eq__(self, other):
        return isinstance(other, Body) and other.world is self.world and other.id == self.id

    def __hash__(self):
        return hash((id(self.world), self.id))

    def __repr__(self):
        return f"Body({self.id})"

    @property
    def _row(self) -> np.void:
        return self.world._body_row(self.id)

    def _must_exist(self) -> None:
        """Raises KeyError for a body that was removed."""
        self.world._row_number(self.id)

    angle = _column("angle", "Turn of the body [rad].")
    mass = _column("mass", "Mass; 0 for a body without any.")
    inertia = _column("inertia", "Inertia about the centre of mass.")
    awake = _column("awake", "Whether it takes part in the simulation.")

    @property
    def position(self) -> tuple[float, float]:
        """The body's origin [px]."""
        row = self._row
        return (row["x"].item(), row["y"].item())

    @property
    def center(self) -> tuple[float, float]:
        """The centre of mass [px]."""
        row = self._row
        return (row["center_x"].item(), row["center_y"].item())

    @property
    def kind(self) -> str:
        """static, kinematic or dynamic."""
        return KINDS[self._row["kind"]]

    @property
    def velocity(self) -> tuple[float, float]:
        """Velocity of the centre of mass [px/s]. Raises ValueError when set on a static body to other than 0."""
        row = self._row
        return (row["vx"].item(), row["vy"].item())

    @velocity.setter
    def velocity(self, value: Pair) -> None:
        self.world._unlocked()
        value = checks.vector("velocity", value)
        row = self._row
        if row["kind"] == STATIC and value != (0.0, 0.0):
            raise ValueError(f"velocity must be (0, 0) for static body {self.id} (got {value})")
        row["vx"], row["vy"] = value
        self._stir(row)

    @property
    def angular_velocity(self) -> float:
        """[rad/s]. Raises ValueError when set to other than 0 without the rotation effect, or on a static body."""
        return self._row["angular_velocity"].item()

    @angular_velocity.setter
    def angular_velocity(self, value: float) -> None:
        self.world._unlocked()
        value = checks.number("angular_velocity", value)
        self.world._needs("rotation", "angular_velocity", value != 0.0)
        row = self._row
        if row["kind"] == STATIC and value != 0.0:
            raise ValueError(f"angular_velocity must be 0 for static body {self.id} (got {value})")
        row["angular_velocity"] = value
        self._stir(row)

    @property
    def gravity_scale(self) -> float:
        """Factor on the world's gravity."""
        return self._row["gravity_scale"].item()

    @gravity_scale.setter
    def gravity_scale(self, value: float) -> None:
        self.world._unlocked()
        row = self._row
        row["gravity_scale"] = checks.number("gravity_scale", value)
        self._stir(row)

    @property
    def user(self) -> Any:
        """Anything the game wants to find again; not part of snapshots and digests."""
        self._must_exist()
        return self.world._users.get(self.id)

    @user.setter
    def user(self, value: Any) -> None:
        self._must_exist()
        self.world._users[self.id] = value

    @property
    def shapes(self) -> tuple[Shape, ...]:
        """The shapes as they were given; with a tier, what they are replaced by."""
        self._must_exist()
        return self.world._shapes_of[self.id]

    @property
    def contacts(self) -> np.ndarray:
        """CONTACT rows that name it, of the last step or asleep, in the order of shape ids: a copy."""
        world, row = self.world, self._row
        told = world.contacts
        told = told[(told["body_a"] == self.id) | (told["body_b"] == self.id)]
        asleep = contacts_of(world.sleepers.naming(self.id, int(row["island"])))
        both = np.concatenate([told, asleep])
        return both[np.lexsort((both["shape_b"], both["shape_a"]))]

    @property
    def filter(self) -> Filter:
        """The filter of the shapes."""
        return editing.filter_of(self.world, self.id)

    @filter.setter
    def filter(self, value: Filter) -> None:
        editing.set_filter(self.world, self.id, value)

    @property
    def tier(self) -> str | None:
        """How exactly its sprite collides: one of TIERS, or None for the shapes as given."""
        self._must_exist()
        return self.world._tiers.get(self.id)

    @tier.setter
    def tier(self, value: str | None) -> None:
        editing.set_tier(self.world, self.id, value)

    def apply_force(self, force: Pair, point: Pair | None = None) -> None:
        """Add a force for the coming step, at the centre of mass or at a world point [px]."""
        self.world._unlocked()
        force = checks.vector("force", force)
        self.world._needs_velocities("apply_force")
        point = None if point is None else checks.vector("point", point)
        row = self._dynamic("apply_force")
        total = checks.vector("sum of forces", (row["force_x"].item() + force[0], row["force_y"].item() + force[1]))
        row["force_x"], row["force_y"] = total
        self._stir(row)
        if point is not None:
            x, y = point
            row["torque"] += (x - row["center_x"]) * force[1] - (y - row["center_y"]) * force[0]

    def apply_impulse(self, impulse: Pair, point: Pair | None = None) -> None:
        """Change the velocity at once by impulse / mass; with a point [px] outside the centre also the spin."""
        self.world._unlocked()
        impulse = checks.vector("impulse", impulse)
        point = None if point is None else checks.vector("point", point)
        row = self._dynamic("apply_impulse")
        self._stir(row)
        inverse_mass = row["inverse_mass"].item()
        row["vx"], row["vy"] = checks.vector(
            "velocity after the impulse",
            (row["vx"].item() + inverse_mass * impulse[0], row["vy"].item() + inverse_mass * impulse[1]),
        )
        if point is not None and self.world.effects.rotation:
            x, y = point
            row["angular_velocity"] += row["inverse_inertia"] * (
                (x - row["center_x"]) * impulse[1] - (y - row["center_y"]) * impulse[0]
            )

    def apply_torque(self, torque: float) -> None:
        """Add a torque for the coming step. Raises ValueError without the rotation effect."""
        self.world._unlocked()
        torque = checks.number("torque", torque)
        self.world._needs("rotation", "apply_torque", True)
        row = self._dynamic("apply_torque")
        self._stir(row)
        row["torque"] += torque

    def _stir(self, row):
        if not row["awake"]:
            sleep.disturb(self.world, [self.id])

    def _dynamic(self, what):
        row = self._row
        if row["kind"] != DYNAMIC:
            raise ValueError(f"{what} needs a dynamic body; body {self.id} is {self.kind}")
        return row

    def move_to(self, position: Pair, angle: float | None = None) -> None:
        """Put the origin at a position [px], and turn to an angle [rad], without sweeping what lies between."""
        editing.move_to(
            self.world,
            self.id,
            checks.position("position", position),
            None if angle is None else checks.number("angle", angle),
        )

    def set_shapes(self, *shapes: Shape) -> None:
        """Replace the shapes; material and filter stay those of the first one. The new shapes get new ids."""
        editing.set_shapes(self.world, self.id, shapes)

    def wake(self) -> None:
        """Wake it, and all it is piled up with."""
        self.world._unlocked()
        self._must_exist()
        sleep.disturb(self.world, [self.id])

    def set_kind(self, kind: str) -> None:
        """static, kinematic or dynamic. A body that becomes static stops."""
        editing.set_kind(self.world, self.id, checks.choice("kind", kind, KINDS))

    def restore(self) -> None:
        """Take a quarantined body back into the simulation, at its last finite pose and at rest."""
        editing.restore(self.world, self.id)
