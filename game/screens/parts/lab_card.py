"""The card of a lab (a scene for an experiment): its question, a short answer, and a thing to try.

The second page has all texts and the goals.
"""

import sys
from collections.abc import Iterable, Sequence
from typing import NamedTuple

import pygame

from game.drawing.canvas import SMALL, TEXT, wrap
from game.drawing.colors import FOG, GOLD, GREEN, INK, ORANGE, PAPER, SKY, SLATE, Color
from game.drawing.presenter import Frame
from game.files.settings import Settings
from game.scene import Goal, Scene
from game.screens.parts.first_hint import HintCard
from physics.debug import bounds

SECTIONS = ("In short", "What to see", "Why it matters", "To try", "Source")  # of the docstring at the head of a lab
INKS: dict[str, Color] = {"In short": PAPER, "What to see": PAPER, "Why it matters": FOG, "To try": SKY, "Source": FOG}
PAGES = (("In short", "To try"), ("What to see", "Why it matters", "Source"))  # sections of each page
FEET = ("F1 or ?: more about it   Enter or a click: close", "F1, ?, Enter or a click: close")
KEYS = (pygame.K_F1, pygame.K_RETURN, pygame.K_KP_ENTER, pygame.K_ESCAPE)
BUTTONS = ("a", "b", "start")
WIDTH, EDGE, MARK = 236, 7, 3  # [text px] of the card, of its margin, and of a mark before a line
LARGE = 0.25  # of a view: larger shapes are ground, walls, a table
GRID = 4  # a card is tried at GRID + 1 places in each direction
FOLLOWS = INK  # mark of a wrapped line: the space of a square, without the square
GOALS = 84  # [text px] greatest height of the list of goals
WORDS = 60  # on the first page at most: a longer finding is on the second page only
EVERY = 30  # pictures between two checks of the goals


class LabCard:
    """Card about a lab. It is shown at the first visit and on request, until it is closed. page: 0 or 1.

    Raises ValueError for a scene whose module docstring has no section "What to see:".
    """

    keeps_keys = True

    def __init__(self, scene: Scene) -> None:
        found = what_to_see(type(scene))
        if found is None:
            raise ValueError(f"{scene.name} does not say what to see")
        self.scene, self.text = scene, found
        self.finding = ""
        self.rect = self.area = pygame.Rect(0, 0, 0, 0)
        self.place = (0, 0)
        self.goals: list[Goal] = []
        self.age = self.page = 0

    def turned_by(self, event: pygame.event.Event) -> bool:
        """Change from the first page to the second if the event is the key that opens the card.

        Return whether the page changed.
        """
        if self.page or event.type != pygame.KEYDOWN or not asks_for_card(event):
            return False
        self.page, self.area = 1, pygame.Rect(0, 0, 0, 0)  # placed anew, with its new size
        return True

    def dismissed_by(self, event: pygame.event.Event, button: str | None) -> bool:
        """Return whether this event closes the card. button: the pad button that the event presses, or None."""
        if event.type == pygame.KEYDOWN:
            return event.key in KEYS or asks_for_card(event)
        if event.type == pygame.MOUSEBUTTONDOWN:
            return self.rect.collidepoint(event.pos)
        return button in BUTTONS

    def remember(self, settings: Settings) -> None:
        """Record in the settings that the card was shown, so that it does not open automatically again."""
        if self.scene.name not in settings.labs_seen:
            settings.labs_seen = [*settings.labs_seen, self.scene.name]

    def draw(self, frame: Frame) -> None:
        """Draw the card at window resolution where it covers the least text. The game continues behind it."""
        if self.age % EVERY == 0:  # some goals take time to check
            self.goals, self.finding = self.scene.check(), self.scene.finding()
        self.age += 1
        scale, area = frame.text_scale, frame.area.clip(frame.rect)
        head = round(self.scene.head * frame.zoom)  # the line on switched settings stays visible
        area = pygame.Rect(area.x, area.y + head, area.width, area.height - head)
        width = min(WIDTH * scale, area.width)
        lines = self._lines(width - 2 * EDGE * scale, scale, area.height // scale - 2 * EDGE)
        size = (width, (height_of(lines) + 2 * EDGE) * scale)
        if self.area != area:  # it stays in place as long as the picture has the same size
            subjects = [*(box for box, _ in frame.boxes), *frame.fixed, *bodies_of(self.scene, frame)]
            self.area, self.place = area, least_covering(subjects, area, size).topleft
        self.rect = pygame.Rect(self.place, size).clamp(area)
        frame.boxes[:] = [each for each in frame.boxes if not self.rect.colliderect(each[0])]  # now hidden
        frame.surface.fill(INK, self.rect)
        pygame.draw.rect(frame.surface, SLATE, self.rect, scale)
        frame.surface.fill(GOLD, (self.rect.x, self.rect.y, 2 * scale, self.rect.height))
        y = self.rect.y + EDGE * scale
        for line in lines:
            left, y = self.rect.x + EDGE * scale, y + line.gap * scale
            if line.mark is not None:
                if line.mark != FOLLOWS:
                    frame.surface.fill(line.mark, (left, y + scale, MARK * scale, MARK * scale))
                left += 2 * MARK * scale
            frame.text(line.text, left, y, line.ink, line.font, scale)
            y += line.height * scale
        frame.fix(self.rect)

    def _lines(self, width, scale, room):
        """Return the card's lines from top to bottom, as a list of Line.

        width: width of a line [frame px]; scale: frame px per text px; room: height for all lines [text px].
        """
        lines = [Line(text, GOLD, TEXT) for text in wrap(self.text.question, width, TEXT, scale)]
        sections: dict[str, str] = dict(zip(SECTIONS, self.text[1:], strict=True))
        for section in PAGES[self.page]:
            words = sections[section] if INKS[section] == PAPER else f"{section}: {sections[section]}"
            lines += paragraph(words, width, scale, INKS[section])
        words = " ".join((self.text.question, *(sections[section] for section in PAGES[0]), "Found:", self.finding))
        fits = self.page == 1 or len(words.split()) <= WORDS
        end = paragraph(f"Found: {self.finding}", width, scale, GOLD) if self.finding and fits else []
        end.append(Line(FEET[self.page], FOG, gap=4))
        if self.goals and self.page == 1:
            lines.append(Line("what it must show, and what it has measured", SKY, gap=4))
            lines += self._goal_lines(width, scale, min(GOALS, room - height_of([*lines, *end])))
        return [*lines, *end]

    def _goal_lines(self, width, scale, room):
        """Return the lines about the lab's goals. Goals that already have a result come first.

        Goals that do not fit into `room` [text px] are only counted. width: width of a line [frame px].
        """
        lines, left = [], sorted(self.goals, key=self._waits)
        while left:
            goal = left[0]
            mark = GREEN if goal.met else SLATE if self._waits(goal) else ORANGE
            wrapped = wrap(goal.text, width - 2 * MARK * scale, SMALL, scale)
            more = [Line(text, PAPER, mark=FOLLOWS if number else mark) for number, text in enumerate(wrapped)]
            last = Line(f"{len(left)} more", FOG)
            if height_of([*lines, *more, *([last] if len(left) > 1 else [])]) > room:
                return [*lines, last]
            lines, left = lines + more, left[1:]
        return lines

    def _waits(self, goal):
        return goal.waits(self.scene.frame)


class CardText(NamedTuple):
    """A lab's question, and the text of each section in SECTIONS; "" for a missing section."""

    question: str
    short: str
    see: str
    why: str
    to_try: str
    source: str


class Line(NamedTuple):
    """A line of the card. gap: space above the line [text px].

    mark: colour of a square before the text; None for no square. FOLLOWS leaves space for a square, as in the second
    and later lines of a wrapped text.
    """

    text: str
    ink: Color
    font: str = SMALL
    gap: int = 0
    mark: Color | None = None

    @property
    def height(self) -> int:
        """Height of the line, without the gap above it [text px]."""
        return 10 if self.font == TEXT else 7


def paragraph(text: str, width: int, scale: int, ink: Color) -> list[Line]:
    """Return a text wrapped into lines of at most `width` frame px, with a gap above the first line.

    ink: colour of the text.
    """
    return [Line(each, ink, gap=0 if number else 3) for number, each in enumerate(wrap(text, width, SMALL, scale))]


def height_of(lines: Iterable[Line]) -> int:
    """Return the total height of lines, including their gaps [text px]."""
    return sum(line.gap + line.height for line in lines)


def least_covering(
    boxes: Sequence[pygame.Rect], area: pygame.Rect, size: tuple[int, int], clear: Sequence[pygame.Rect] = ()
) -> pygame.Rect:
    """Return the rectangle of a given size in `area` that covers the least of `boxes`. A grid of positions is tried.

    clear: rectangles that the result covers as little as possible, which counts before `boxes`.
    """
    spare = area.width - size[0], area.height - size[1]
    places = [
        pygame.Rect(area.x + spare[0] * column // GRID, area.y + spare[1] * row // GRID, *size)
        for column in range(GRID + 1)
        for row in range(GRID + 1)
    ]
    return min(places, key=lambda place: (covered(place, clear), covered(place, boxes)))


def covered(place: pygame.Rect, boxes: Iterable[pygame.Rect]) -> int:
    """Return the total area [px] of rectangles that `place` covers."""
    return sum(both.width * both.height for both in map(place.clip, boxes))


def bodies_of(scene: Scene, frame: Frame) -> list[pygame.Rect]:
    """Return the bounding boxes [frame px] of the scene's visible shapes, except those larger than LARGE of a view."""
    found = []
    for world, camera in scene.views():
        lens = frame.lens(camera)
        clip = lens.clip.clip(frame.rect)
        low, high = (lens.points(*bounds(world)[:, side : side + 2].T) for side in (0, 2))
        for left, top, right, bottom in zip(*(each.tolist() for each in (*low, *high)), strict=True):
            rect = pygame.Rect(round(left), round(top), round(right - left) + 1, round(bottom - top) + 1).clip(clip)
            if 0 < rect.width * rect.height < LARGE * clip.width * clip.height:
                found.append(rect)
    return found


def first_card(scene: Scene, settings: Settings) -> "HintCard | LabCard | None":
    """Return the card to show when a scene opens, or None.

    At the first visit to a lab, it is the lab's own card. In the player's first game, it is the card of keys.
    """
    if what_to_see(type(scene)) is not None:
        return LabCard(scene) if scene.name not in settings.labs_seen else None
    return None if settings.hint_seen else HintCard()


def what_to_see(scene_class: type[Scene]) -> CardText | None:
    """Return a lab's question and sections, read from the module docstring of the scene class.

    A section is a paragraph that begins with its name and a colon. A missing section is "". Return None if the
    docstring has no section "What to see:".
    """
    question, *paragraphs = (sys.modules[scene_class.__module__].__doc__ or "").split("\n\n")
    found = dict.fromkeys(SECTIONS, "")
    for each in paragraphs:
        name, _, text = " ".join(each.split()).partition(": ")
        if name in found:
            found[name] = text[:1].upper() + text[1:]
    return CardText(" ".join(question.split()), *found.values()) if found["What to see"] else None


def asks_for_card(event: pygame.event.Event) -> bool:
    """Return whether the event is the key that opens a lab's card: F1 or "?"."""
    return event.key == pygame.K_F1 or getattr(event, "unicode", "") == "?"
