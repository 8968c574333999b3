import pygame

from hitbox.physics import Effects, PixelMask, World


class Thing(pygame.sprite.Sprite):
    def __init__(self, corner):
        super().__init__()
        self.image = pygame.Surface((24, 24), pygame.SRCALPHA)
        pygame.draw.circle(self.image, "white", (12, 12), 11)
        self.rect = self.image.get_rect(topleft=corner)


things = [Thing((37 * k % 200, 53 * k % 160)) for k in range(40)]
world = World(Effects.detection())
for thing in things:  # once
    thing.body = world.add_body(PixelMask.from_surface(thing.image, origin=(0, 0)), user=thing)

for _ in range(20):
    for k, thing in enumerate(things):
        thing.rect.move_ip(k % 3 - 1, k % 5 - 2)
    world.move([thing.body for thing in things], [thing.rect.topleft for thing in things])  # in every frame
    world.step()
    hits = world.touching(users=True)

group = pygame.sprite.Group(things)
old = pygame.sprite.groupcollide(group, group, False, False, pygame.sprite.collide_mask)
pairs = {frozenset((one, other)) for one, others in old.items() for other in others if one is not other}
assert {frozenset(hit) for hit in hits} == pairs
print(len(hits), "pairs touch, the same as groupcollide finds")
