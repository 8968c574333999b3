"""Who is in the air, and who may meet whom. Sides are filters: what cannot meet never becomes a pair.

A shot never pairs with a shot, a bullet never with a bullet or with the planes that fired it. A plane that was just
lost comes back as a ghost: for a while nothing but pick-ups meets it, and nobody has to ask whether a hit counts.
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

# The player: a small core, the hull that is drawn, and a ring that bullets graze and pick-ups are taken by.
AT_RISK = {
    "core": Filter(CORE, ENEMY | BULLET),
    "hull": Filter(HULL, ENEMY | BULLET),
    "ring": Filter(RING, BULLET | ITEM),
}
GHOST = {"core": Filter(CORE, 0), "hull": Filter(HULL, 0), "ring": Filter(RING, ITEM)}
HOSTILE = Filter(ENEMY, CORE | HULL | SHOT | BLAST | WRECK)
GROUNDED = Filter(ENEMY, SHOT | BLAST)  # what is on the ground: planes fly over it
FALLING = Filter(WRECK, 0)  # what burns or falls: nothing meets it any more
WRECKED = Filter(WRECK, ENEMY)  # pieces of a plane, as long as they are where planes fly
FIRED = Filter(SHOT, ENEMY)  # what the player fires
INCOMING = Filter(BULLET, CORE | HULL | RING | BLAST)  # what is fired at the player
LOOT = Filter(ITEM, RING)
BLASTING = Filter(BLAST, ENEMY | BULLET)  # a bomb

WIDTH, HEIGHT = 480, 270  # [px] the sky that is seen; nothing scrolls but the ground
MARGIN = 34  # [px] outside of it, where bodies are removed: more than half of the largest sprite
GROUND_SPEED = 30.0  # [px/s] the ground, and what stands on it, moves down


def steps(seconds):
    """Seconds as whole steps of 1/60 s."""
    return round(seconds * 60)
