import pygame

from hitbox.physics import Circle, Polygon, World, debug

pygame.init()
screen = pygame.display.set_mode((320, 240))

world = World()
world.add_body(Polygon.box(300, 20), position=(160, 200), kind="static")
for k in range(5):
    world.add_body(Circle(8), position=(150 + 5 * k, 20 + 20 * k))

for _ in range(90):  # while running: events, then
    world.step()
    screen.fill("black")
    for body in world:
        left, top, right, bottom = body.bounds
        pygame.draw.rect(screen, "gray40", (left, top, right - left, bottom - top), 1)
    for contact in debug.contact_points(world):
        x, y = contact["point_x"], contact["point_y"]
        pygame.draw.line(screen, "red", (x, y), (x + 8 * contact["normal_x"], y + 8 * contact["normal_y"]))
    pygame.display.flip()

red = pygame.mask.from_threshold(screen, pygame.Color("red"), (1, 1, 1)).count()
print(len(world.contacts), "contacts drawn in", red, "pixels")
pygame.quit()
assert red > 0
