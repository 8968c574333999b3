import numpy as np
import pygame

from hitbox.physics import Circle, Effects, PixelMask, Polygon, World

x, y = np.arange(1024), np.arange(256)[:, None]
solid = y > 120 + 40 * np.sin(x / 90)
solid[60:70, 400:520] = True  # a bridge, which hangs on the hill at its left end
solid[60:140, 400:412] = True
picture = pygame.Surface((1024, 256), pygame.SRCALPHA)
picture.fill("sienna")  # in a game the image that the mask was made from

world = World(Effects.rigid_bodies().with_(carving=True))
ground = world.add_body(PixelMask(solid, origin=(0, 0)), kind="static")
boulder = world.add_body(Circle(9), position=(700, 40))
pebble = world.add_body(Circle(3), position=(745, 60))


def explode(at, radius):
    """Carve a crater into the ground, and push nearby bodies away."""
    crater = ground.carve(Circle(radius), at)  # bodies there wake, and fall in
    for body in world.overlap(Circle(3 * radius), at):
        away = body.center - at
        if body.kind == "dynamic" and away.length > 0:
            body.apply_impulse(away.normalized() * 200 * body.mass)  # 200 px/s
    return crater


def clear_carved(image, body):
    """Make the pixels of an image transparent where the body's mask is no longer solid."""
    alpha = pygame.surfarray.pixels_alpha(image)  # [x, y], the mask is [y, x]
    alpha[~body.shapes[0].solid.T] = 0


for _ in range(180):
    world.step()

crater = explode(boulder.position, 24)
thrown = pebble.velocity.length
cut = ground.carve(Polygon.box(14, 14), (430, 65))  # the rest of the bridge comes loose
(bridge,) = cut.fragments
corner = bridge.position - bridge.shapes[0].origin  # of its image in that of the ground, before it falls
piece = picture.subsurface(pygame.Rect(corner, bridge.shapes[0].size)).copy()
clear_carved(piece, bridge)
clear_carved(picture, ground)
before = boulder.position
for _ in range(240):
    world.step()

print(f"{crater.removed} + {cut.removed} pixels are gone, {bridge.shapes[0].area} came down to {bridge.position}")
assert boulder.position.y > before.y + 10 and thrown > 199
assert pygame.mask.from_surface(picture).count() == ground.shapes[0].area
assert pygame.mask.from_surface(piece).count() == bridge.shapes[0].area
assert bridge.kind == "dynamic" and not bridge.awake and bridge.position.y > 75
