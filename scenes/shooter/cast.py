"""Collision filters of the shooter. Bodies whose filters exclude each other never become a pair in the broad phase.

Shots never pair with shots, and enemy bullets never pair with bullets or enemy planes. After the loss of a life, the
player's plane returns as a ghost: for a while its filter lets it collide with pick-ups only. So the game rules do not
need to test for this.
"""

from physics import Filter

CORE, HULL, RING, ENEMY, SHOT, BULLET, ITEM, BLAST, WRECK = (1 << bit for bit in range(9))

FILTER_NAMES = {
    CORE: "core",
    HULL: "hull",
    RING: "graze ring",
    ENEMY: "enemy",
    SHOT: "shot",
    BULLET: "bullet",
    ITEM: "pick-up",
    BLAST: "bomb",
    WRECK: "wreckage",
}

# The player: a small core, the drawn hull, and a ring for grazing bullets and for pick-ups.
AT_RISK = {
    "core": Filter(CORE, ENEMY | BULLET),
    "hull": Filter(HULL, ENEMY | BULLET),
    "ring": Filter(RING, BULLET | ITEM),
}
GHOST = {"core": Filter(CORE, 0), "hull": Filter(HULL, 0), "ring": Filter(RING, ITEM)}
HOSTILE = Filter(ENEMY, CORE | HULL | SHOT | BLAST | WRECK)
GROUNDED = Filter(ENEMY, SHOT | BLAST)  # things on the ground: planes fly over them
FALLING = Filter(WRECK, 0)  # burning or falling things, which no longer collide
WRECKED = Filter(WRECK, ENEMY)  # pieces of a plane, at the height of the planes
FIRED = Filter(SHOT, ENEMY)  # the player's shots
INCOMING = Filter(BULLET, CORE | HULL | RING | BLAST)  # shots at the player
LOOT = Filter(ITEM, RING)
BLASTING = Filter(BLAST, ENEMY | BULLET)  # a bomb

WIDTH, HEIGHT = 480, 270  # [px] the visible sky; only the ground scrolls
MARGIN = 34  # [px] outside of the sky at which bodies are removed: more than half of the largest sprite
GROUND_SPEED = 30.0  # [px/s] downward speed of the ground and of things on it


def steps(seconds):
    """Return the time `seconds` as a number of steps of 1/60 s, rounded."""
    return round(seconds * 60)
