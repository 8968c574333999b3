"""Inspector of contacts and joints: a click on one of them in the frozen scene opens a card about it.

The card describes the result of each stage of the step for this pair of shapes, or for this joint.
"""

from typing import Protocol

import pygame

from game.drawing.canvas import SMALL, TEXT, wrap
from game.drawing.colors import FOG, GOLD, NIGHT, PAPER, SKY, Color, faded
from game.drawing.presenter import Frame, Lens
from game.measure import contact_inspector, joint_inspector
from game.measure.contact_inspector import NANO, Part, Touch
from game.measure.timing import Cost
from game.scene import Scene
from game.screens.parts.joint_mark import draw_bodies, draw_joint_mark, draw_letters
from game.screens.parts.lab_card import covered, least_covering
from physics import World

REACH = 5.0  # [canvas px] around a contact or joint in which a click selects it
SAME = 0.5  # [canvas px] difference of distances up to which repeated clicks select one after the other
WIDTHS, ROW, EDGE = (150, 190, 230, 270), 7, 4  # [text px] of the card: the first width at which it fits


class Subject(Protocol):
    """Contact or joint that the card is about. A subject equals another one about the same contact or joint."""

    def title(self, world: World) -> str:
        """Return the title of the card."""
        ...

    def parts(self, world: World) -> list[Part]:
        """Return the Parts of the card: the result of each stage, and the time of the subject alone."""
        ...

    def is_there(self, world: World) -> bool:
        """Return whether the world still has the contact or joint."""
        ...

    def draw(self, frame: Frame, lens: Lens, world: World) -> list[pygame.Rect]:
        """Mark the subject in the picture. Return the rectangles [frame px] that the card keeps clear of."""
        ...


class ContactSubject:
    """Contact of two shapes. touch: the Touch that was clicked."""

    def __init__(self, touch: Touch) -> None:
        self.touch = touch

    def __eq__(self, other: object) -> bool:
        mine = (self.touch.shape_a, self.touch.shape_b)
        return isinstance(other, ContactSubject) and (other.touch.shape_a, other.touch.shape_b) == mine

    def title(self, world: World) -> str:
        return f"Why do A (body {self.touch.body_a}) and B (body {self.touch.body_b}) touch?"

    def parts(self, world: World) -> list[Part]:
        cost = contact_inspector.cost_of(world, self.touch)
        return [*contact_inspector.explain(world, self.touch), Part("this pair alone, narrow phase", cost_text(cost))]

    def is_there(self, world: World) -> bool:
        return contact_inspector.still_there(world, self.touch)

    def draw(self, frame: Frame, lens: Lens, world: World) -> list[pygame.Rect]:
        place = lens.points(self.touch.x, self.touch.y)
        scale, ids = frame.text_scale, (self.touch.body_a, self.touch.body_b)
        draw_bodies(frame, lens, world, ids)
        draw_letters(frame, lens, world, ids)
        if lens.clip.collidepoint(place):
            pygame.draw.circle(frame.surface, GOLD, place, 4 * scale, max(1, scale))
        ring = pygame.Rect(0, 0, 12 * scale, 12 * scale)
        ring.center = round(place[0]), round(place[1])
        return [ring]


class JointSubject:
    """Joint with the id `identity`."""

    def __init__(self, identity: int) -> None:
        self.identity = identity

    def __eq__(self, other: object) -> bool:
        return isinstance(other, JointSubject) and other.identity == self.identity

    def title(self, world: World) -> str:
        return joint_inspector.title_of(world, self.identity)

    def parts(self, world: World) -> list[Part]:
        cost = joint_inspector.cost_of(world, self.identity)
        text = joint_inspector.untimed(world, self.identity) if cost is None else cost_text(cost, "copies in a step")
        return [*joint_inspector.explain(world, self.identity), Part("this joint alone with its bodies", text)]

    def is_there(self, world: World) -> bool:
        return joint_inspector.is_there(world, self.identity)

    def draw(self, frame: Frame, lens: Lens, world: World) -> list[pygame.Rect]:
        return draw_joint_mark(frame, lens, world, self.identity)


class InspectorView:
    """View of the inspector. feed() processes clicks, and draw() shows the card of the chosen contact or joint.

    The card closes when the scene is no longer frozen.
    """

    def __init__(self, scene: Scene) -> None:
        self.scene = scene
        self.chosen: tuple[World, Subject] | None = None
        self.others = 0  # number of other subjects in the place of the chosen one
        self.title = ""
        self.parts: list[Part] = []
        self.lenses: list[tuple[World, Lens]] = []  # of the last picture
        self.reach = REACH  # [frame px]

    def feed(self, event: pygame.event.Event, frozen: bool) -> bool:
        """Process a click while the scene is frozen. Return whether the click was used.

        A click near a contact or joint opens the card of the nearest one. If several are in one place, the next click
        there opens the card of the next one. Any other click closes the open card.
        """
        if not frozen or event.type != pygame.MOUSEBUTTONDOWN or event.button != 1:
            return False
        before, self.chosen = self.chosen, None
        for world, lens in self.lenses:
            if lens.clip.collidepoint(event.pos):
                x, y = (event.pos[0] - lens.dx) / lens.scale, (event.pos[1] - lens.dy) / lens.scale
                here = subjects_at(world, x, y, self.reach / lens.scale)
                if here:
                    self._choose(world, here, before)
                    return True
        return before is not None

    def _choose(self, world, here, before):
        """Open the card of the first subject, or of the next one if the card of one of them was open.

        here: the subjects in the place of the click; before: (world, subject) of the card that was open, or None.
        """
        at = -1
        if before is not None and before[0] is world and before[1] in here:
            at = here.index(before[1])
        subject = here[(at + 1) % len(here)]
        self.title, self.parts = subject.title(world), subject.parts(world)
        self.chosen, self.others = (world, subject), len(here) - 1

    def draw(self, frame: Frame, frozen: bool) -> None:
        """Mark the chosen contact or joint, and draw its card, if the scene is frozen."""
        self.lenses = [(world, frame.lens(camera)) for world, camera in self.scene.views()]
        self.reach = REACH * frame.scale
        if self.chosen is None:
            return
        world, subject = self.chosen
        lens = next((lens for each, lens in self.lenses if each is world), None)
        if not frozen or lens is None or not subject.is_there(world):
            self.chosen = None
            return
        self._draw_card(frame, subject.draw(frame, lens, world))

    def _lines(self, width, scale):
        """Return the lines of the card. width: width of the text [frame px]; scale: frame px per text px."""
        more = f"{self.others} more here: click again; " if self.others else ""
        paragraphs: list[tuple[str, Color, str, int]] = [(self.title, GOLD, TEXT, 10)]
        for part in self.parts:
            paragraphs += [(part.stage, SKY, SMALL, ROW), (part.text, PAPER, SMALL, ROW)]
        paragraphs.append((f"{more}a click elsewhere closes", FOG, SMALL, ROW))
        return [
            (line, ink, font, height)
            for text, ink, font, height in paragraphs
            for line in wrap(text, width, font, scale)
        ]

    def _place(self, frame, marked):
        """Return (lines, scale, rectangle) of the card: where it covers little of the subject, then little text.

        The text has the scale of other text, between the strips at the edges of the picture. If the card does not fit,
        it covers the strips; then its text is smaller. marked: rectangles of the subject [frame px].
        """
        area = frame.area.clip(frame.rect)
        inner, found = between_strips(frame, area), []
        for room, scale in ((inner, frame.text_scale), *((area, each) for each in range(frame.text_scale, 0, -1))):
            for wide in WIDTHS:
                lines = self._lines((wide - 2 * EDGE) * scale, scale)
                size = wide * scale, (sum(height for *_, height in lines) + 2 * EDGE) * scale
                if size[0] <= room.width and size[1] <= room.height:
                    found.append((lines, scale, least_covering([box for box, _ in frame.boxes], room, size, marked)))
            if found:
                break
        return min(found or [(lines, 1, pygame.Rect(area.topleft, size))], key=lambda each: covered(each[2], marked))

    def _draw_card(self, frame, marked):
        """Draw the card. marked: rectangles of the subject, which the card should not cover [frame px]."""
        lines, scale, rect = self._place(frame, marked)
        frame.surface.fill(faded(NIGHT, 0.1), rect)
        pygame.draw.rect(frame.surface, GOLD, rect, max(1, scale // 2))
        cut = [box for box, _ in frame.boxes if rect.colliderect(box)]
        frame.boxes[:] = [each for each in frame.boxes if not rect.colliderect(each[0])]
        for box in cut:  # the visible part of a text is kept clear of others
            frame.reserve(box)
        y = rect.y + EDGE * scale
        for text, ink, font, height in lines:
            frame.text(text, rect.x + EDGE * scale, y, ink, font, scale)
            y += height * scale
        frame.fix(rect)


def between_strips(frame: Frame, area: pygame.Rect) -> pygame.Rect:
    """Return `area` without the reserved strips along its upper and lower edges, such as the title and the timeline."""
    top, bottom = area.top, area.bottom
    for rect in frame.reserved:
        if rect.left <= area.left and rect.right >= area.right:
            top = max(top, rect.bottom) if rect.top <= area.top else top
            bottom = min(bottom, rect.top) if rect.bottom >= area.bottom else bottom
    return pygame.Rect(area.x, top, area.width, max(bottom - top, 0))


def subjects_at(world: World, x: float, y: float, reach: float) -> list[Subject]:
    """Return the contact or joint nearest to (x, y) [px], and the others in the same place; [] if none is in reach.

    reach: greatest distance of a contact point or joint anchor [px].
    """
    found: list[tuple[float, Subject]] = [
        (distance, JointSubject(identity)) for identity, distance in joint_inspector.near(world, x, y, reach)
    ]
    touch = contact_inspector.nearest(world, x, y, reach)
    if touch is not None:
        away = ((touch.x - x) ** 2 + (touch.y - y) ** 2) ** 0.5
        found.append((away, ContactSubject(touch)))
    found.sort(key=lambda each: each[0])  # stable: a joint comes before a contact at the same distance
    return [subject for away, subject in found if away <= found[0][0] + SAME * reach / REACH]


def cost_text(cost: Cost, how: str = "times in a row") -> str:
    """Return a Cost as text: the median, the noise, the number of pieces of work in a run, and how they were done."""
    return f"{NANO * cost.median:.0f} ns +{100 * cost.noise:.0f} %, {cost.pieces} {how}"
