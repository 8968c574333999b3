import pygame

from hitbox.physics import Circle, PixelMask, World, measure

image = pygame.Surface((34, 34), pygame.SRCALPHA)
pygame.draw.circle(image, "white", (17, 17), 16)
wall = pygame.Surface((400, 40), pygame.SRCALPHA)
wall.fill("white", (0, 0, 400, 40))
wall.fill((0, 0, 0, 0), (150, 0, 60, 22))  # a pit

world = World()
world.add_body(PixelMask.from_surface(wall), position=(200, 220), kind="static")
ball = world.add_body(PixelMask.from_surface(image), position=(60, 180), velocity=(150, 0))
crate = world.add_body(PixelMask.from_array([[True] * 20] * 20), position=(300, 150), angle=0.2)
for _ in range(400):
    world.step()

found = measure(ball.shapes[0], ball.shapes[0].outline)
print(f"the ball rolled into the pit at {ball.position}, its outline is {ball.shapes[0].outline}")
print(f"which leaves out {found.missed:.0f} px2 and adds {found.over:.0f} of {ball.shapes[0].area}")
assert 150 < ball.position.x < 210 and ball.position.y > 200
assert isinstance(ball.shapes[0].outline[0], Circle)
assert not crate.awake and abs(crate.angle) < 0.01
