"""Who is in the air, and who may meet whom. Sides are filters: what cannot meet never becomes a pair.

A shot never pairs with a shot, a bullet never with a bullet or with the planes that fired it. A plane that
was just hit is a ghost: for a while it meets pick-ups only, and nothing has to ask whether a hit counts.
"""

from physics import Filter

PLAYER, ENEMY, SHOT, BULLET, ITEM = (1 << bit for bit in range(5))

FLYING = Filter(PLAYER, ENEMY | BULLET | ITEM)      # the player
GHOST = Filter(PLAYER, ITEM)                        # the player, just after a hit
HOSTILE = Filter(ENEMY, PLAYER | SHOT)
FIRED = Filter(SHOT, ENEMY)                         # what the player fires
INCOMING = Filter(BULLET, PLAYER)                   # what is fired at the player
LOOT = Filter(ITEM, PLAYER)

WIDTH, HEIGHT = 480, 270      # [px] the sky that is seen; nothing scrolls but the ground
MARGIN = 34                   # [px] outside of it, where bodies are removed: more than half of the largest sprite


def steps(seconds):
    """Seconds as whole steps of 1/60 s."""
    return round(seconds * 60)
