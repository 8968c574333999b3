import numpy as np

from hitbox.physics import Character, Effects, Polygon, TileGrid, World

solid, plank = np.zeros((8, 10), bool), np.zeros((8, 10), bool)
solid[7], plank[4] = True, True  # ground at the bottom, a floor open from below above it

world = World(Effects.rigid_bodies().with_(one_way=True))
world.add_body(TileGrid(solid, 16, one_way=plank), kind="static")
hero = Character(world, Polygon.box(10, 20), (80, 102))

heights, speed = [], -6.0
for frame in range(120):
    drop = frame == 90
    moved = hero.move(0, 1 if drop else speed, drop=drop)  # it falls through its ground
    speed = 0.0 if moved.grounded else speed + 0.25
    world.step()
    heights.append(hero.position.y)
print("jumped to", min(heights), "stood at", heights[80], "dropped to", heights[-1])
assert min(heights) < 54 and heights[80] == 54 and heights[-1] == 102
