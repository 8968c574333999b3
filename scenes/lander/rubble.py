"""Rubble: loose pieces of the ground and of rocks. Each is drawn with its original pixels.

`source`: the place [px] of its raster's top left in a picture: that of the moon, or of the rock that it came from.
"""

from dataclasses import dataclass

from physics import Circle
from scenes.lander.feel import CRUMB, LOOSE


@dataclass(frozen=True)
class Piece:
    """A loose piece. `look`: the frame of a rock, or "ground"; `source`: (x, y) in its picture [px]."""

    look: str
    source: tuple[int, int]


class Rubble:
    """The rubble. `pieces`: a Piece by body id: the rocks present at the start, and all that was blown off."""

    def __init__(self, world):
        self.world = world
        self.pieces = {}

    def add_rock(self, body, look):
        """Add a loose whole rock."""
        self.pieces[body.id] = Piece(look, (0, 0))

    def add_ground(self, bodies):
        """Add pieces of the ground that have just come loose and have not moved yet."""
        for body in bodies:
            (mask,) = body.shapes
            x, y = body.position
            self._add(body, "ground", (round(x - mask.origin[0]), round(y - mask.origin[1])))

    def _add(self, body, look, source):
        body.filter, body.user = LOOSE, "rubble"
        self.pieces[body.id] = Piece(look, source)

    def bodies(self):
        """Return the bodies of all pieces, in the order of their ids."""
        return [self.world.body(identity) for identity in sorted(self.pieces)]

    def carve(self, x, y, radius):
        """Carve a burst's disc out of the pieces in its range. Return the ids of those without pixels left."""
        gone = []
        for body in self.bodies():
            left, top, right, bottom = body.bounds
            if not (left < x + radius and x - radius < right and top < y + radius and y - radius < bottom):
                continue
            before, identity = self.pieces[body.id], body.id
            (mask,) = body.shapes
            for part in body.carve(Circle(radius), (x, y), crumb=CRUMB).fragments:
                self._add(part, before.look, _source(part, before, mask, body))
            if identity not in self.world:
                del self.pieces[identity]
                gone.append(identity)
        return gone

    def state(self):
        """Return the state for the replay digest, as a flat tuple."""
        return tuple(self.pieces)


def _source(part, before, mask, parent):
    """Return the place of a fragment's raster in the picture that both are drawn from."""
    (own,) = part.shapes
    x, y = parent.to_local(part.position)
    return (
        before.source[0] + round(x + mask.origin[0] - own.origin[0]),
        before.source[1] + round(y + mask.origin[1] - own.origin[1]),
    )
