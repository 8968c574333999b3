"""A pygame program in which the physics package replaces groupcollide(..., collide_mask); run
it to compare the hits.
"""

import pygame

from hitbox.physics import Effects, Filter, PixelMask, World

BULLET, ENEMY = 1, 2


class Plane(pygame.sprite.Sprite):
    """A sprite with an image and a rect, as in any pygame program."""

    def __init__(self, color, corner, size=(40, 32)):
        super().__init__()
        self.image = pygame.Surface(size, pygame.SRCALPHA)
        pygame.draw.polygon(self.image, color, [(size[0] / 2, 0), (0, size[1] - 1), (size[0] - 1, size[1] - 1)])
        self.rect = self.image.get_rect(topleft=corner)


def make_groups():
    """Return (bullets, enemies): groups of 12 bullets and 30 enemies on a field."""
    bullets = pygame.sprite.Group(*(Plane("white", (17 * k, 31 * k % 190), (8, 14)) for k in range(12)))
    enemies = pygame.sprite.Group(*(Plane("red", (53 * k % 211, 37 * k % 173)) for k in range(30)))
    return bullets, enemies


def hits_the_old_way(bullets, enemies):
    """Return the set of (bullet, enemy) hits by pygame, which tests every bullet against every enemy."""
    hits = pygame.sprite.groupcollide(bullets, enemies, False, False, pygame.sprite.collide_mask)
    return {(bullet, enemy) for bullet, others in hits.items() for enemy in others}


def enter(world, sprites, filter):
    """Add a body for every sprite, once at the start."""
    for sprite in sprites:
        sprite.body = world.add_body(
            PixelMask.from_surface(sprite.image, origin=(0, 0)),
            position=sprite.rect.topleft,
            filter=filter,
            user=sprite,
        )


def hits_in_a_world(world, sprites):
    """Move the bodies to the sprites in every frame, step the world, and return the set of (bullet, enemy) hits."""
    world.move([sprite.body for sprite in sprites], [sprite.rect.topleft for sprite in sprites])
    world.step()
    return set(world.touching(users=True))


def main():
    bullets, enemies = make_groups()
    world = World(Effects.detection())
    enter(world, bullets, Filter(BULLET, mask=ENEMY))
    enter(world, enemies, Filter(ENEMY, mask=BULLET))
    for frame in range(60):
        for number, sprite in enumerate([*bullets, *enemies]):
            sprite.rect.move_ip(number % 3 - 1, number % 5 - 2)
        old, new = hits_the_old_way(bullets, enemies), hits_in_a_world(world, [*bullets, *enemies])
        assert old == new, f"frame {frame}: {len(old)} hits by pygame, {len(new)} in the world"
    return len(new)


if __name__ == "__main__":
    print(main(), "hits in the last frame, the same as groupcollide finds")
