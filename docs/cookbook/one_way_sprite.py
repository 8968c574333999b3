import pygame

from hitbox.physics import Character, Circle, Effects, PixelMask, Polygon, World

bridge = pygame.Surface((128, 24), pygame.SRCALPHA)  # a rope bridge that sags: any sprite will do
pygame.draw.lines(bridge, "white", False, [(0, 4), (32, 14), (64, 18), (96, 14), (127, 4)], 5)

world = World(Effects.rigid_bodies().with_(one_way=True))
mask = PixelMask.from_surface(bridge, origin=(0, 0), one_way=True)  # only its upper side collides
world.add_body(mask, position=(0, 100), kind="static")  # or kinematic: it carries
ball = world.add_body(Circle(5), position=(64, 170), velocity=(0, -320))  # up through it, and down on it
hero = Character(world, Polygon.box(10, 20), (64, 160))

feet, speed = [], -6.0
for frame in range(200):
    drop = frame == 150
    moved = hero.move(0, 1 if drop else speed, drop=drop)
    speed = 0.0 if moved.grounded else min(speed + 0.25, 5.0)
    world.step()
    feet.append(hero.position.y + 10)
print("the ball lies at", ball.position, "the hero stood at", feet[140], "and dropped to", feet[-1])
assert 105 < ball.position.y < 125 and 100 < feet[140] < 125 and feet[-1] > 200
