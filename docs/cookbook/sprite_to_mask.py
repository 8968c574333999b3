import pygame

from hitbox.physics import PixelMask, collide

image = pygame.Surface((40, 32), pygame.SRCALPHA)
pygame.draw.circle(image, "white", (20, 16), 14)

ship = PixelMask.from_surface(image)  # its origin is the centre of the image
mirrored = ship.flipped(x=True)
large = ship.scaled(2)
same = PixelMask.from_mask(pygame.mask.from_surface(image))  # if you have a Mask already

touch = collide(ship, (100, 100), large, (130, 100))
print(f"{ship.area} pixels; {touch.area:.0f} shared; move the large one by {touch.normal * -touch.separations.min()}")
assert same.area == mirrored.area == ship.area and large.area == 4 * ship.area and len(touch) > 0
