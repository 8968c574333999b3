"""Drawing for lab/effects: the bodies of one yard, and the outlines of bodies whose positions differ in a
second yard.
"""

import numpy as np
import pygame

from game.drawing.colors import INK, PAPER, SKY, SLATE, faded
from game.drawing.rotated import RotatedPicture, poses_between
from game.drawing.sprites import load_atlas
from game.overlays.layer_bounds import draw_boxes
from game.overlays.outlines import draw_outline
from physics import debug
from physics.tables.shape import PART
from scenes.lab.busy_yard import BELT, BOB, CRATE, FLOOR, HOOK, LEFT, PLANK, RIGHT, ROCK, TARGET, TILE, ZONE
from scenes.lab.looks import mask_picture
from scenes.lab.pieces import turning
from scenes.lab.yard import Yard

STONE = (150, 118, 96)
DASH = 6  # [px] of the belt's marks


class BusyPicture:
    """The renderer of a BusyYard on the canvas."""

    def __init__(self):
        self.ground = Yard(int(FLOOR), dim=70)
        self.star = RotatedPicture(load_atlas("lab")["star_gold"])
        self.planks = load_atlas("tiles")

    def draw(self, canvas, yard, alpha, way):
        """Draw a yard, interpolated by `alpha` (0..1) between its last two steps.

        way: distance that the belt's surface has moved [px].
        """
        surface = canvas.surface
        surface.blit(self.ground.picture, (0, 0))
        surface.fill(INK, (LEFT - 2, 0, 2, FLOOR))
        for number, name in enumerate(("left", "middle", "middle", "right")):
            surface.blit(self.planks[f"plank_{name}"], (PLANK[0] + TILE * number, PLANK[1]))
        self._draw_belt(surface, way)
        surface.fill(PAPER, (TARGET[0] - 1, TARGET[1] - 20, 2, 40))
        zone = pygame.Rect(0, 0, *ZONE[2:])
        zone.center = round(ZONE[0]), round(ZONE[1])
        pygame.draw.rect(surface, faded(SKY, 0.35), zone, 1)
        if yard.rock in yard.world:
            (mask,) = yard.world.body(yard.rock).shapes
            surface.blit(mask_picture(mask, STONE), ROCK[:2])
        bodies = yard.world.bodies
        columns = (each.tolist() for each in poses_between(bodies, alpha))
        poses = dict(zip(bodies["id"].tolist(), zip(*columns, strict=True), strict=True))
        asleep = dict(zip(bodies["id"].tolist(), (~bodies["awake"]).tolist(), strict=True))
        surface.set_clip((LEFT, 0, RIGHT - LEFT, surface.get_height()))
        self._draw_rods(surface, yard, poses)
        for number, identity in yard.ids.items():
            self._picture(yard.kinds[number], asleep[identity]).draw(surface, *poses[identity])
        surface.set_clip(None)

    def _picture(self, kind, asleep):
        if kind == "star":
            return self.star
        placed = {"crate": (CRATE, "wood"), "bob": (BOB, "gold")}
        shape, ramp = placed[kind] if kind in placed else (kind.shape, kind.ramp)
        return turning(shape, "steel" if asleep else ramp)

    def _draw_rods(self, surface, yard, poses):
        """Draw the rods of the pendulum, which exist only in a world with the effect `joints`.

        poses: {body id: (x [px], y [px], angle [rad]) on the surface}.
        """
        if yard.world.effects.joints:
            at = HOOK
            for number, kind in yard.kinds.items():
                if kind == "bob":
                    bob = poses[yard.ids[number]][:2]
                    pygame.draw.line(surface, PAPER, at, bob)
                    at = bob
            pygame.draw.circle(surface, PAPER, HOOK, 2)

    def _draw_belt(self, surface, way):
        (left, y), (right, _), radius = BELT
        rect = pygame.Rect(left - radius, y - radius, right - left + 2 * radius, 2 * radius)
        pygame.draw.rect(surface, SLATE, rect, border_radius=int(radius))
        pygame.draw.rect(surface, INK, rect, 1, border_radius=int(radius))
        for x in np.arange(left + way % (2 * DASH), right, 2 * DASH):
            pygame.draw.line(surface, PAPER, (x, y - radius), (x + DASH / 2, y - radius))


def draw_ghost(frame, camera, yard, numbers, color):
    """Draw the outlines of some bodies of a BusyYard in `color` at window resolution. Pixel masks are drawn as boxes.

    numbers: the yard's numbers of these bodies, keys of `yard.ids`.
    """
    world, lens = yard.world, frame.lens(camera)
    shapes, ids = world.shapes, [yard.ids[number] for number in numbers]
    rows = np.flatnonzero(np.isin(shapes["body"], ids) & (shapes["role"] != PART))
    tone = frame.tone(color)
    masks = []
    for row, outline in zip(rows.tolist(), debug.outlines(world, rows), strict=True):
        if outline[0] == "mask":
            masks.append(row)
        else:
            draw_outline(frame.surface, lens, outline, tone, max(1, frame.scale - 1), frame.scale)
    draw_boxes(frame, lens, debug.bounds(world)[masks], (color,), np.zeros(len(masks), int))
