"""Objects on the moon: pads, cargo, cans of fuel, loose rocks and rubble."""

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
ZONE_HIGH = 30.0  # [px] height of the sensor on a pad in which cargo counts as delivered
CAN_RADIUS = 11.0  # [px] radius of a can's sensor
HEAVIEST = 500.0  # greatest mass that the line can carry


class Cargo:
    """A piece of cargo.

    whole: its condition, from 100 (undamaged) to 0; over: the Pad below it, or None; rest: steps at rest on this pad.
    """

    def __init__(self, body, look):
        self.body, self.look = body, look
        self.whole = 100.0
        self.over = None
        self.rest = 0

    def knock(self, change):
        """Damage the cargo by an impact, and return the loss of condition. change: change of the cargo's velocity
        [px/s].
        """
        cost = min(max(change - CARGO_HARMLESS, 0.0) * CARGO_DAMAGE, self.whole)
        self.whole -= cost
        return cost


class Yard:
    """The loose objects and the pads on the moon.

    cargo: {body id: Cargo}; cans: {body id: (x, y) [px]} of the cans of fuel; rubble: loose rocks and pieces of
    ground; pads: {body id of a pad's deck: Pad}; zones: {body id of the sensor above a pad's deck: Pad}.
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
        """Number of all pieces of cargo, including those that are delivered or destroyed."""
        return len(self.all_cargo)

    def piece(self, number):
        """Return the Cargo with this number in the moon's list, or None if it has been delivered or destroyed."""
        piece = self.all_cargo[number]
        return piece if piece in self.cargo.values() else None

    def light(self):
        """Return a list of the cargo and rubble bodies that are light enough for the line."""
        return [body for body in self.loose() if body.mass <= HEAVIEST]

    def loose(self):
        """Return a list of the bodies of all cargo and rubble, which explosions push."""
        return [*(piece.body for piece in self.cargo.values()), *self.rubble.bodies()]

    def meet(self, begun, ended):
        """Update the pad below each piece of cargo (Cargo.over) from the sensor events of the step.

        begun, ended: sensor begin and end events.
        """
        for events, came in ((ended, False), (begun, True)):
            for pair in zip(events["body_a"].tolist(), events["body_b"].tolist(), strict=True):
                for piece, zone in (pair, pair[::-1]):
                    if piece in self.cargo and zone in self.zones:
                        self.cargo[piece].over = self.zones[zone] if came else None

    def delivered(self, held):
        """Return the ids of the cargo bodies that have now rested on a pad for DELIVERED steps.

        held: body id of the line's load, which does not count; -1 for none.
        """
        done = []
        for identity, piece in self.cargo.items():
            still = piece.body.velocity.length < STILL
            piece.rest = piece.rest + 1 if piece.over is not None and still and identity != held else 0
            if piece.rest == DELIVERED:
                done.append(identity)
        return done

    def state(self):
        """Return this object's part of Scene.state(), a flat tuple."""
        return (
            *(value for identity, each in self.cargo.items() for value in (identity, each.whole, each.rest)),
            *("" if each.over is None else each.over.name for each in self.cargo.values()),
            *self.rubble.state(),
            *self.cans,
        )
