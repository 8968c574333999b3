import pygame

from hitbox.physics import PixelMask, Polygon, World

frames = []
for lean in (-6, -3, 0, 3, 6, 3, 0, -3):
    image = pygame.Surface((32, 40), pygame.SRCALPHA)
    pygame.draw.polygon(image, "white", [(10 + lean, 2), (22 + lean, 2), (24, 38), (8, 38)])
    frames.append(PixelMask.from_surface(image))  # all with one origin, so that the pose does not change

world = World()
world.add_body(Polygon.box(300, 20), position=(0, 110), kind="static")
hero = world.add_body(frames[2], position=(0, 80))
begun, fastest = 0, 0.0
for tick in range(360):
    if tick % 6 == 0:
        hero.set_shapes(frames[tick // 6 % len(frames)])
    world.step()
    begun += len(world.events.begin)
    if tick > 60:
        fastest = max(fastest, hero.velocity.length)

left = frames[0].flipped(x=True)
hero.set_shapes(left)
world.step()
print(f"60 frames later it stands at {hero.position}: {begun} landing, never faster than {fastest:.2f} px/s")
assert begun == 1 and fastest < 2.0 and hero.shapes == (left,)
