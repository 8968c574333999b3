"""Rubble: loose rocks, and loose pieces of ground and rocks. Each piece shows the pixels of its original picture."""

from dataclasses import dataclass

from physics import Circle
from scenes.lander.feel import CRUMB, LOOSE


@dataclass(frozen=True)
class Piece:
    """A loose piece of rock or ground.

    look: name of its original picture: the picture of a rock, or "ground" for the picture of the moon; source: position
    (x, y) in that picture [px] of the top left corner of the piece's mask.
    """

    look: str
    source: tuple[int, int]


class Rubble:
    """All loose pieces of rock on the moon. pieces: {body id: Piece}.

    At first the pieces are the loose rocks. Explosions add pieces of ground and of rocks.
    """

    def __init__(self, world):
        self.world = world
        self.pieces = {}

    def add_rock(self, body, look):
        """Add a loose rock that is still whole. look: name of the rock's picture."""
        self.pieces[body.id] = Piece(look, (0, 0))

    def add_ground(self, bodies):
        """Add pieces that have just come loose from the ground. Call this method before they move.

        bodies: the bodies of the pieces.
        """
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
        """Carve the disc of an explosion out of all pieces that it reaches. Return the ids of the bodies without pixels
        left.

        x, y: centre of the disc [px]; radius: its radius [px].
        """
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
        """Return this object's part of Scene.state(), a flat tuple."""
        return tuple(self.pieces)


def _source(part, before, mask, parent):
    """Return the position (x, y) [px] of a new fragment's pixels in its original picture (see Piece.source).

    part: body of the fragment. It was carved off a piece, of which these arguments are the state before the carve.
    before: its Piece; mask: its mask; parent: its body.
    """
    (own,) = part.shapes
    x, y = parent.to_local(part.position)
    return (
        before.source[0] + round(x + mask.origin[0] - own.origin[0]),
        before.source[1] + round(y + mask.origin[1] - own.origin[1]),
    )
