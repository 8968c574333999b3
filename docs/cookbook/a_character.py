import numpy as np

from hitbox.physics import Character, Polygon, TileGrid, World

JUMP, GRAVITY, RUN = -5.0, 0.3, 2.0  # [px a frame]

solid = np.zeros((10, 30), bool)
solid[9], solid[8, 12:] = True, True  # a floor with one step

world = World()
world.add_body(TileGrid(solid, 16), kind="static")
hero = Character(world, Polygon.box(12, 24), (40, 132))

fall, grounded, jumps = 0.0, False, 0
for _ in range(150):
    wall_ahead = hero.blocked(1, 0)
    if grounded and wall_ahead:  # or on a key press
        fall, jumps = JUMP, jumps + 1
    moved = hero.move(RUN, fall)  # whole pixels; it never overlaps a solid
    grounded = moved.grounded
    fall = 0.0 if grounded else fall + GRAVITY
    world.step()

print("at", hero.position, "after", jumps, "jump")
assert jumps == 1 and grounded and hero.position.y == 116
