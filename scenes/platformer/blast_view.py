"""Pictures of walls that bombs break, of their rubble, of bombs and explosions. Rubble shows the wall's own pixels."""

import pygame

from game.drawing.canvas import whole
from game.drawing.fragment import FragmentPicture, cut_out
from game.drawing.rotated import RotatedPicture
from scenes.platformer.blasting import BURNS, CARRIED, GONE, RADIUS, THROWN, WAITING, arc, built
from scenes.platformer.feel import steps

EDGE = (30, 24, 40)  # colour of a stone's fracture
KEPT = 80  # pictures of walls and pieces
HELD = 21  # [px] from the hero's middle up to a carried bomb
HOT, BLINK = steps(0.5), 8  # steps before the explosion in which the bomb glows; steps of one blink
AIM = (255, 236, 190)
PICTURE_UP = 2.0  # [px] from the middle of a bomb's ball up to the middle of its picture


class BlastView:
    """Renderer of walls, rubble and bombs. Their pictures are cached by mask."""

    def __init__(self, view):
        self.view = view
        self.kept = {}  # body id -> (mask, FragmentPicture)
        self.bombs = [RotatedPicture(view.things[f"bomb_{look}"]) for look in (0, 1)]

    def draw_walls(self, canvas, scene):
        """Draw the remaining parts of the walls, and the stands of the bombs."""
        for wall in scene.things.walls:
            if wall.body is not None:
                picture = self._picture(wall.body, wall, 0, 0)
                canvas.surface.blit(picture.image, (wall.left - self.view.left, wall.top - self.view.top))
        stand = self.view.things["bomb_stand"]
        for bomb in scene.things.bombs:
            x, y = bomb.home
            canvas.surface.blit(
                stand, (whole(x) - stand.get_width() // 2 - self.view.left, whole(y + RADIUS) - 5 - self.view.top)
            )

    def draw_pieces(self, canvas, scene, alpha):
        """Draw rubble and bombs. alpha: position (0..1) between the last two steps."""
        look = scene.look
        for piece in scene.things.rubble:
            picture = self._picture(piece.body, piece.wall, piece.left, piece.top)
            before, now = look.before(piece.body), piece.body.position
            x, y = (a + (b - a) * alpha for a, b in zip(before, now, strict=True))
            angle = look.angles.get(piece.body.id, piece.body.angle)
            angle += (piece.body.angle - angle) * alpha
            picture.draw(canvas.surface, x - self.view.left, y - self.view.top, angle)
        for bomb in scene.things.bombs:
            self._draw_bomb(canvas, scene, bomb, alpha)

    def _draw_bomb(self, canvas, scene, bomb, alpha):
        if bomb.phase == GONE:
            return
        x, y, angle, hot = *bomb.place, 0.0, False
        if bomb.phase == CARRIED:
            before, now = scene.hero.before, scene.hero.character.position
            x, y = (a + (b - a) * alpha for a, b in zip(before, now, strict=True))
            y -= HELD
            self._draw_aim(canvas, scene)
        elif bomb.phase == THROWN and bomb.body is not None:
            before = scene.look.before(bomb.body)
            x, y = (a + (b - a) * alpha for a, b in zip(before, bomb.body.position, strict=True))
            angle = bomb.body.angle
            left = steps(BURNS) - bomb.count
            hot = left < HOT and (not scene.accessibility.flashing or left % BLINK < BLINK // 2)
        elif bomb.phase == WAITING:
            y -= 2.0
        self.bombs[hot].draw(canvas.surface, x - self.view.left, y - PICTURE_UP - self.view.top, angle)

    def _draw_aim(self, canvas, scene):
        """Draw dots along the path that the carried bomb would take if it were thrown now, up to the first obstacle."""
        hero = scene.hero
        for number, (x, y) in enumerate(arc(hero.character.position, hero.facing, hero.vx, False)):
            if scene.level.blocks(x - 2, y - 2, 4, 4) or any(
                box[0] < x < box[2] and box[1] < y < box[3] for box in hero.solids
            ):
                break
            if (number + int(scene.look.time * 12)) % 3:
                size = 2 if number % 2 else 1
                canvas.surface.fill(AIM, (whole(x) - self.view.left, whole(y) - self.view.top, size, size))

    def draw_bursts(self, canvas, look):
        """Draw the explosions of bombs, which are listed in the scene's Look, `look`."""
        for x, y, age in look.blasts:
            image = self.view.things.animation("blast").at(age, loop=False)
            canvas.sprite(image, x - self.view.left, y - self.view.top)
            if age < 0.2:
                light = self.view.things["lantern_light"]
                spot = pygame.Rect((0, 0), light.get_size())
                spot.center = whole(x) - self.view.left, whole(y) - self.view.top
                canvas.surface.blit(light, spot, special_flags=pygame.BLEND_RGB_ADD)

    def _picture(self, body, wall, left, top):
        (mask,) = body.shapes
        known = self.kept.get(body.id)
        if known is None or known[0] is not mask:
            if len(self.kept) >= KEPT:
                self.kept.clear()
            image = cut_out(built(*wall.size), mask, left, top, EDGE)
            known = self.kept[body.id] = (mask, FragmentPicture(image, mask))
        return known[1]
