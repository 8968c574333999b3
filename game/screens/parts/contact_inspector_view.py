"""Contact inspector: a click on a contact of the frozen scene opens a card about the two shapes that touch.

The card describes the result of each stage of the step for this pair of shapes.
"""

import pygame

from game.drawing.canvas import SMALL, TEXT, wrap
from game.drawing.colors import FOG, GOLD, NIGHT, PAPER, SKY, Color, faded
from game.drawing.presenter import Frame, Lens
from game.measure.contact_inspector import NANO, Part, Touch, cost_of, explain, nearest, still_there
from game.scene import Scene
from game.screens.parts.lab_card import least_covering
from physics import World

REACH = 5.0  # [canvas px] around a contact in which a click selects it
WIDTH, ROW, EDGE = 150, 7, 4  # [text px] of the card


class ContactInspectorView:
    """View of the contact inspector. feed() processes clicks, and draw() shows the card of the chosen contact.

    The card closes when the scene is no longer frozen.
    """

    def __init__(self, scene: Scene) -> None:
        self.scene = scene
        self.chosen: tuple[World, Touch] | None = None
        self.parts: list[Part] = []
        self.lenses: list[tuple[World, Lens]] = []  # of the last picture
        self.reach = REACH  # [frame px]

    def feed(self, event: pygame.event.Event, frozen: bool) -> bool:
        """Process a click while the scene is frozen. Return whether the click was used.

        A click near a contact opens the card of this contact. Any other click closes the open card.
        """
        if not frozen or event.type != pygame.MOUSEBUTTONDOWN or event.button != 1:
            return False
        was_open, self.chosen = self.chosen is not None, None
        for world, lens in self.lenses:
            if lens.clip.collidepoint(event.pos):
                x, y = (event.pos[0] - lens.dx) / lens.scale, (event.pos[1] - lens.dy) / lens.scale
                touch = nearest(world, x, y, self.reach / lens.scale)
                if touch is not None:
                    self._choose(world, touch)
                    return True
        return was_open

    def _choose(self, world, touch):
        cost = cost_of(world, touch)
        alone = f"{NANO * cost.median:.0f} ns +{100 * cost.noise:.0f} %, {cost.pieces} times in a row"
        self.parts = [*explain(world, touch), Part("this pair alone, narrow phase", alone)]
        self.chosen = world, touch

    def draw(self, frame: Frame, frozen: bool) -> None:
        """Draw a ring around the chosen contact, and its card, if the scene is frozen."""
        self.lenses = [(world, frame.lens(camera)) for world, camera in self.scene.views()]
        self.reach = REACH * frame.scale
        if self.chosen is None:
            return
        world, touch = self.chosen
        lens = next((lens for each, lens in self.lenses if each is world), None)
        if not frozen or lens is None or not still_there(world, touch):
            self.chosen = None
            return
        place = lens.points(touch.x, touch.y)
        if lens.clip.collidepoint(place):
            pygame.draw.circle(frame.surface, GOLD, place, 4 * frame.text_scale, max(1, frame.text_scale))
        self._draw_card(frame, touch, place)

    def _draw_card(self, frame, touch, place):
        scale = frame.text_scale
        width = WIDTH * scale
        lines: list[tuple[str, Color, str, int]] = [
            (f"Why do {touch.body_a} and {touch.body_b} touch?", GOLD, TEXT, 10)
        ]
        for part in self.parts:
            lines.append((part.stage, SKY, SMALL, ROW))
            lines += [(text, PAPER, SMALL, ROW) for text in wrap(part.text, width - 2 * EDGE * scale, SMALL, scale)]
        lines.append(("a click elsewhere closes", FOG, SMALL, ROW))
        size = width, (sum(height for *_, height in lines) + 2 * EDGE) * scale
        ring = pygame.Rect(0, 0, 12 * scale, 12 * scale)
        ring.center = round(place[0]), round(place[1])
        frame.boxes.append((ring, ""))  # the card keeps clear of its contact
        rect = least_covering(frame, frame.area, size)
        frame.boxes.pop()
        frame.surface.fill(faded(NIGHT, 0.1), rect)
        pygame.draw.rect(frame.surface, GOLD, rect, max(1, scale // 2))
        y = rect.y + EDGE * scale
        for text, ink, font, height in lines:
            frame.text(text, rect.x + EDGE * scale, y, ink, font, scale)
            y += height * scale
        frame.fix(rect)
