"""Marks of the inspector in the picture: the bodies A and B of a joint or contact, and what a joint does.

A joint is drawn with its anchors, axis and limits, and its force on body B.
"""

from collections.abc import Sequence

import numpy as np
import pygame

from game.drawing.canvas import TEXT
from game.drawing.colors import GOLD, INK, SKY, Color
from game.drawing.presenter import Frame, Lens
from game.overlays.layer_joints import Joints, anchored, boxes_of
from game.overlays.mask_edges import mask_edges
from game.overlays.outlines import draw_lines, draw_outline
from physics import DYNAMIC, World, debug
from physics.tables.joint import WORLD
from physics.tables.shape import MASK, PART

FORCE = 24.0  # [canvas px] length of the arrow for the force to which the scale is rounded up
RING = 5  # [text px] radius of a ring around an anchor
MARGIN = 12  # [canvas px] by which the returned rectangles are wider and higher
SMALL_BODY = 3.0  # heights of a letter: a smaller body has its letter beside it
SIDES: tuple[tuple[str, Color], ...] = (("a", SKY), ("b", GOLD))  # colours of the outlines of bodies A and B


def draw_joint_mark(frame: Frame, lens: Lens, world: World, identity: int) -> list[pygame.Rect]:
    """Mark a joint, and return the rectangles [frame px] of its anchors and of its dynamic bodies.

    The outlines of its bodies have a letter A or B at their centres of mass. The joint itself is drawn as by the
    overlay of joints: anchors, axis, limits, force and share of the breaking force. Raises KeyError for an unknown
    joint.
    """
    world.joint(identity)
    rows = anchored(world)
    row = rows[rows["joint"] == identity]
    surface, ids = frame.surface, [row[f"body_{side}"].item() for side, _ in SIDES]
    draw_bodies(frame, lens, world, ids)
    surface.set_clip(lens.clip)
    layer = Joints(identity, FORCE)
    layer.begin()
    layer.draw(frame, lens, world)
    for x, y in {(row[f"{side}x"].item(), row[f"{side}y"].item()) for side, _ in SIDES}:
        pygame.draw.circle(surface, GOLD, lens.points(x, y), RING * frame.text_scale, max(1, frame.text_scale))
    surface.set_clip(None)
    draw_letters(frame, lens, world, ids)
    layer.draw_labels(frame)
    return _boxes(frame, lens, world, row)


def draw_bodies(frame: Frame, lens: Lens, world: World, ids: Sequence[int]) -> None:
    """Draw the outlines of the bodies A and B. ids: ids of both, WORLD for none."""
    frame.surface.set_clip(lens.clip)
    for identity, (_, color) in zip(ids, SIDES, strict=True):
        if identity != WORLD:
            _draw_body(frame, lens, world, identity, color)
    frame.surface.set_clip(None)


def draw_letters(frame: Frame, lens: Lens, world: World, ids: Sequence[int]) -> None:
    """Write the letters A and B at two bodies. ids: ids of both, WORLD for none."""
    for identity, (side, color) in zip(ids, SIDES, strict=True):
        if identity != WORLD:
            _draw_letter(frame, lens, world, identity, side, color)


def _boxes(frame, lens, world, row):
    """Return the rectangles [frame px] in view of the anchors and of the dynamic bodies of a DRAWN_JOINT row (1,)."""
    ids = [row[f"body_{side}"].item() for side, _ in SIDES]
    moving = world.bodies["id"][(world.bodies["kind"] == DYNAMIC) & np.isin(world.bodies["id"], ids)]
    bodies = debug.bounds(world)[np.isin(world.shapes["body"], moving)]
    found, margin = [], MARGIN * frame.scale
    for left, top, right, bottom in np.concatenate([boxes_of(row), bodies]).tolist():
        (x0, y0), (x1, y1) = lens.points(left, top), lens.points(right, bottom)
        place = pygame.Rect(round(x0), round(y0), round(x1 - x0), round(y1 - y0)).inflate(margin, margin)
        found.append(place.clip(lens.clip))
    return found


def _draw_letter(frame, lens, world, identity, side, color):
    """Write the letter of a body at its centre of mass, where it covers no other text.

    It is written beside a body that it would hide: to the left for A, to the right for B.
    """
    scale, letter = frame.text_scale, side.upper()
    x, y = lens.points(*world.body(identity).center)
    if not lens.clip.collidepoint(x, y):
        return
    width, height = frame.measure(letter, TEXT, scale)
    box = debug.bounds(world)[world.shapes["body"] == identity]
    size = lens.scale * max(np.ptp(box[:, ::2]), np.ptp(box[:, 1::2]))
    if size < SMALL_BODY * height:
        x += (0.5 * size + width) * (1 if side == "b" else -1)
    if frame.text_if_free(letter, x - width / 2, y - height / 2, frame.tone(color), TEXT, scale, "left", True):
        frame.reserve(frame.boxes[-1][0].inflate(8 * scale, 4 * scale))


def _draw_body(frame, lens, world, identity, color):
    """Draw the outlines of those shapes of a body that are in view."""
    shapes = world.shapes
    mine = (shapes["body"] == identity) & (shapes["kind"] != MASK)
    rows = np.flatnonzero(mine & lens.seen(debug.bounds(world)))
    parts = shapes["role"][rows] == PART
    lines = mask_edges(world, rows[parts], lens.scale).outer if parts.any() else np.zeros((0, 4))
    outlines = debug.outlines(world, rows[~parts].tolist())
    for tone, width in ((INK, frame.scale + 2), (frame.tone(color), frame.scale)):
        draw_lines(frame.surface, lens, lines, tone, width)
        for outline in outlines:
            draw_outline(frame.surface, lens, outline, tone, width, frame.scale)
