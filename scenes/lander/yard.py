"""Things on the moon: pads, cargo, loose rocks, cans of fuel, and fragments of rock."""

from game.drawing.sprites import load_atlas
from physics import Circle, Material, Polygon
from scenes.lander.feel import (
    CARGO_DAMAGE,
    CARGO_HARMLESS,
    CARGO_MASS,
    DELIVERED,
    DENSITY,
    FUEL_CAN,
    GROUND,
    LOOSE,
    STILL,
    ZONE,
)
from scenes.lander.rubble import Rubble

BOX = Material(density=DENSITY, friction=0.55, restitution=0.15)
ROUND = Material(density=DENSITY, friction=0.6, restitution=0.25, rolling_resistance=0.02)
STONE = Material(density=DENSITY, friction=0.7)
DECK = Material(friction=0.9)
ZONE_HIGH = 30.0  # [px] over a pad in which cargo counts
CAN_RADIUS = 11.0  # [px] distance from which a can is taken
HEAVIEST = 500.0  # [mass] limit of the line


class Cargo:
    """One piece of cargo. `whole` 0..100 of it is left; `over`: the pad below it, or None; `rest`: steps at rest
    there.
    """

    def __init__(self, body, look):
        self.body, self.look = body, look
        self.whole = 100.0
        self.over = None
        self.rest = 0

    def knock(self, change):
        """Apply the damage of a change of velocity [px/s]. Return the loss."""
        cost = min(max(change - CARGO_HARMLESS, 0.0) * CARGO_DAMAGE, self.whole)
        self.whole -= cost
        return cost


class Yard:
    """Things by body id: `cargo` and `cans`; `rubble`: loose rocks; `pads`, `zones`: the Pad of each deck and
    sensor.
    """

    def __init__(self, world, moon):
        self.world, atlas = world, load_atlas("lander")
        self.pads, self.zones, self.cargo, self.cans = {}, {}, {}, {}
        self.rubble = Rubble(world)
        for pad in moon.pads:
            mask = atlas.mask(pad.look)
            deck = world.add_body(
                mask, position=(pad.x, pad.y + mask.size[1] / 2), kind="static", material=DECK, filter=GROUND
            )
            self.pads[deck.id] = pad
            zone = world.add_body(
                Polygon.box(pad.width, ZONE_HIGH),
                position=(pad.x, pad.y - ZONE_HIGH / 2),
                kind="static",
                filter=ZONE,
                sensor=True,
            )
            self.zones[zone.id] = pad
        for look, x, y in moon.cargo:
            body = world.add_body(
                atlas.mask(look),
                position=(x, y),
                mass=CARGO_MASS,
                material=ROUND if look == "drum" else BOX,
                filter=LOOSE,
                user="cargo",
            )
            self.cargo[body.id] = Cargo(body, look)
        for x, y, look in moon.rocks:
            body = world.add_body(atlas.mask(look), position=(x, y), material=STONE, filter=LOOSE, user="rock")
            self.rubble.add_rock(body, look)
        for x, y in moon.cans:
            body = world.add_body(
                Circle(CAN_RADIUS), position=(x, y), kind="static", filter=FUEL_CAN, sensor=True, user="can"
            )
            self.cans[body.id] = (x, y)
        self.all_cargo = tuple(self.cargo.values())

    @property
    def in_all(self):
        """Total number of pieces of cargo."""
        return len(self.all_cargo)

    def piece(self, number):
        """Return the Cargo of that number in the plan, None if it is gone."""
        piece = self.all_cargo[number]
        return piece if piece in self.cargo.values() else None

    def light(self):
        """Return the bodies that the line can hold."""
        return [body for body in self.loose() if body.mass <= HEAVIEST]

    def loose(self):
        """Return all bodies that a blast pushes, except the ship."""
        return [*(piece.body for piece in self.cargo.values()), *self.rubble.bodies()]

    def meet(self, begun, ended):
        """Update the cargo that entered or left a pad, from the sensors' events."""
        for events, came in ((ended, False), (begun, True)):
            for pair in zip(events["body_a"].tolist(), events["body_b"].tolist(), strict=True):
                for piece, zone in (pair, pair[::-1]):
                    if piece in self.cargo and zone in self.zones:
                        self.cargo[piece].over = self.zones[zone] if came else None

    def delivered(self, held):
        """Return the cargo that came to rest on a pad in this step. held: id of the line's load."""
        done = []
        for identity, piece in self.cargo.items():
            still = piece.body.velocity.length < STILL
            piece.rest = piece.rest + 1 if piece.over is not None and still and identity != held else 0
            if piece.rest == DELIVERED:
                done.append(identity)
        return done

    def state(self):
        """Return the state for the replay digest, as a flat tuple."""
        return (
            *(value for identity, each in self.cargo.items() for value in (identity, each.whole, each.rest)),
            *("" if each.over is None else each.over.name for each in self.cargo.values()),
            *self.rubble.state(),
            *self.cans,
        )
