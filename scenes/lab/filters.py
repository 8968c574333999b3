"""Six kinds of bodies, and all pairs of kinds: which may touch? Both masks must say yes.

In short: each cell swings two discs together. They touch only if both masks say yes; a click changes one mask.

What to see: each cell holds two discs that swing into each other, the row's kind on the left and the column's on the
right. A click switches whether the row's mask contains the column's kind: a yes. The discs touch only if both say yes.
The broad phase drops all other pairs before it writes them, so they cost nothing later.

Why it matters: Kinds that never meet should cost nothing; a filter in the broad phase is the cheapest test.

To try: remove one yes, and then the other, and see that one no is enough.

Source: Box2D's category and mask bits, tested both ways.
"""

from math import pi, sin

import numpy as np
import pygame

from game.drawing.canvas import SMALL, TEXT
from game.drawing.colors import FOG, GREEN, INK, NIGHT, PAPER, RED, SERIES, SLATE, WHITE, YELLOW, faded
from game.drawing.headline import Headline
from game.input.inputs import InputFrame
from game.scene import FAIR, Goal, Scene, Slider
from physics import Circle, Effects, Filter
from scenes.lab.yard import HEAD

KINDS = ("player", "enemy", "shot", "enemy shot", "wall", "pick-up")
MEETS = {  # kinds that each kind says yes to, at the start
    "player": ("enemy", "enemy shot", "wall", "pick-up"),
    "enemy": ("player", "shot", "wall"),
    "shot": ("enemy", "wall"),
    "enemy shot": ("player", "wall"),
    "wall": ("player", "enemy", "shot", "enemy shot", "pick-up"),  # one-sided: pick-ups ignore walls
    "pick-up": ("player",),
}
LEFT, TOP, CELL_WIDTH, CELL_HEIGHT = 72, 42, 40, 36
RADIUS = 6.0
APART, SWING = 15.0, 7.0  # [px] between the discs' centres: 8 to 22, touching at 12
SLOP = 0.2  # [px] a pair may keep its contact up to the physics' slop of 0.16 px
SIDE_X = 322
CELLS = [(row, column) for row in range(len(KINDS)) for column in range(len(KINDS))]
ONE_SIDED = (5, 4)  # cell that is marked at the start: pick-up and wall
BOT_CLICKS = {90: (0, 1), 130: (5, 4), 170: (0, 1)}  # frame: cell


class Filters(Scene):
    """Scene with one world: a grid of cells with two discs each. Each row and each column represents a kind of body.

    A cell holds a disc of the row's kind and a disc of the column's kind.
    """

    name = "lab/filters"
    title = "Filters"
    question = FAIR
    about = "Six kinds of thing in all pairs. Click a cell to let two kinds meet or not: it takes a yes from both."
    effects = Effects()
    keeps = {"narrowphase": "it judges where discs touch, and boxes around them meet before they do"}
    pieces = ("circles", "boxes")
    features = ("membership and mask, tested both ways", "filtered inside the broad phase, before a pair is written")
    sliders = (Slider("speed", 0.2, 3.0, 1.0, step=0.1),)
    actions = (("mouse", "click a cell"), ("arrows", "choose"), ("Space", "switch"))
    filter_names = {1 << number: kind for number, kind in enumerate(KINDS)}
    head = HEAD
    legend_at = (322, 176)
    hides_pointer = False

    def build(self):
        """Set the filter mask of each kind, then add two discs to each cell."""
        self.masks = [sum(1 << KINDS.index(other) for other in MEETS[kind]) for kind in KINDS]
        self.marked = ONE_SIDED
        self.clock = 0.0
        self.touching = np.zeros((len(KINDS), len(KINDS)), bool)
        self.steps = self.wrong = self.filtered = self.met = self.clicks = 0
        self.close = self.dropped = 0  # pairs that overlap in this step, and those of them that may not touch
        self.add_world()
        self.fill()

    def fill(self):
        """Remove all discs and add them again with the current masks."""
        self.world.clear()
        self.cell_of = {}
        self.inside = np.zeros(self.touching.shape, bool)  # whether the two discs of a cell overlap
        self.met_now = np.zeros(self.touching.shape, bool)  # whether they were in contact during this overlap
        self.overlaps = np.zeros(self.touching.shape, int)  # of each cell since the masks were set
        self.contacts = np.zeros(self.touching.shape, int)  # overlaps with a contact
        for row, column in CELLS:
            for kind in (row, column):
                body = self.world.add_body(Circle(RADIUS), filter=Filter(1 << kind, self.masks[kind]))
                self.cell_of[body.id] = (row, column)
        self.place()

    def place(self):
        """Move every disc to its position at the current phase of its swing."""
        bodies = self.world.bodies
        for number, (row, column) in enumerate(CELLS):
            x, y = cell_center(row, column)
            half = (APART + SWING * sin(2 * pi * self.clock + 0.9 * (row + column))) / 2
            bodies["x"][2 * number], bodies["x"][2 * number + 1] = x - half, x + half
            bodies["y"][2 * number : 2 * number + 2] = y

    def update(self, inputs):
        """Toggle cells by clicks and keys, move the discs, step the world, and check the contacts against the masks."""
        cell = cell_at(*inputs.pointer)
        if inputs.pointer_pressed and cell is not None:
            self.marked = cell
            self.switch(cell)
        self._keys(inputs)
        self.clock += self.values["speed"] / 60 / 2
        self.place()
        self.world.step()
        self._judge()

    def _keys(self, inputs):
        row, column = self.marked
        row += inputs.pressed("down") - inputs.pressed("up")
        column += inputs.pressed("right") - inputs.pressed("left")
        self.marked = (row % len(KINDS), column % len(KINDS))
        if inputs.pressed("fire"):
            self.switch(self.marked)

    def switch(self, cell):
        """Toggle whether the mask of the row's kind contains the column's kind. `cell`: (row, column)."""
        row, column = cell
        self.masks[row] ^= 1 << column
        self.clicks += 1
        self.fill()

    def says_yes(self, row, column):
        """Return whether the mask of the row's kind contains the column's kind."""
        return bool(self.masks[row] >> column & 1)

    def _judge(self):
        """Count wrong contacts. Overlapping discs of a cell must be in contact if, and only if, both masks allow it."""
        self.touching[:] = False
        for a, b in zip(self.world.contacts["body_a"].tolist(), self.world.contacts["body_b"].tolist(), strict=True):
            self.wrong += self.cell_of[a] != self.cell_of[b]
            self.touching[self.cell_of[a]] = True
        x = self.world.bodies["x"]
        gap = x[1::2] - x[::2] - 2 * RADIUS
        for number, (row, column) in enumerate(CELLS):
            may = self.says_yes(row, column) and self.says_yes(column, row)
            touch = bool(self.touching[row, column])
            if gap[number] <= 0.0 or gap[number] > SLOP or not may:
                self.wrong += touch != (may and gap[number] <= 0.0)
        inside = (gap <= 0.0).reshape(self.inside.shape)
        self.overlaps += inside & ~self.inside
        self.contacts += inside & self.touching & ~self.met_now
        self.inside, self.met_now = inside, inside & (self.met_now | self.touching)
        self.steps += 1
        self.met += int(self.touching.sum())
        allowed = np.array([self.says_yes(*cell) and self.says_yes(*cell[::-1]) for cell in CELLS])
        self.close, self.dropped = int((gap <= 0.0).sum()), int(((gap <= 0.0) & ~allowed).sum())
        self.filtered += self.dropped

    def draw(self, canvas, alpha):
        """Draw the grid with its headings, and the text beside it.

        alpha: position (0..1) between the last two steps.
        """
        canvas.surface.fill(NIGHT)
        for index, kind in enumerate(KINDS):
            x, y = cell_center(index, index)
            canvas.text(kind, LEFT - 6, y - 4, SERIES[index], TEXT, align="right")
            canvas.text(kind, x, TOP - 10, SERIES[index], SMALL, align="center")
        for cell in CELLS:
            self._draw_cell(canvas, cell)
        self._draw_side(canvas)

    def _draw_cell(self, canvas, cell):
        row, column = cell
        rect = cell_rect(row, column)
        own, other = self.says_yes(row, column), self.says_yes(column, row)
        ground = (24, 62, 58) if own and other else (66, 56, 30) if own or other else INK
        canvas.surface.fill(ground, rect)
        pygame.draw.rect(canvas.surface, WHITE if cell == self.marked else faded(SLATE, 0.5), rect, 1)
        bodies = self.world.bodies
        touch = self.touching[row, column]
        for offset, kind in ((0, row), (1, column)):
            body = bodies[2 * CELLS.index(cell) + offset]
            place = (round(float(body["x"])), round(float(body["y"])))
            pygame.draw.circle(canvas.surface, faded(SERIES[kind], 0.0 if own and other else 0.45), place, int(RADIUS))
            pygame.draw.circle(canvas.surface, WHITE if touch else INK, place, int(RADIUS), 1)
        for x, yes in ((rect.x + 3, own), (rect.right - 6, other)):
            canvas.surface.fill(GREEN if yes else RED, (x, rect.bottom - 5, 3, 2))

    def _draw_side(self, canvas):
        row, column = self.marked
        own, other = self.says_yes(row, column), self.says_yes(column, row)
        lines = [
            (KINDS[row], SERIES[row], TEXT),
            (f"member {bits(1 << row)}", FOG, SMALL),
            (f"mask   {bits(self.masks[row])}", PAPER, SMALL),
            ("", FOG, SMALL),
            (KINDS[column], SERIES[column], TEXT),
            (f"member {bits(1 << column)}", FOG, SMALL),
            (f"mask   {bits(self.masks[column])}", PAPER, SMALL),
            ("", FOG, SMALL),
            (
                "they meet" if own and other else "one yes is not enough" if own or other else "they pass",
                GREEN if own and other else YELLOW if own or other else RED,
                TEXT,
            ),
        ]
        y = TOP
        for text, color, font in lines:
            if text:
                canvas.text(text, SIDE_X, y, color, font)
            y += 13 if font == TEXT else 9
        counters = self.world.profile.counters
        for name, value in (
            ("filtered", self.dropped),
            ("candidates", counters["candidates"]),
            ("touching", int(self.touching.sum())),
        ):
            y += 11
            canvas.text(name, SIDE_X, y, FOG, SMALL)
            canvas.text(f"{value}", SIDE_X + 80, y, PAPER, SMALL, align="right")

    def check(self):
        """Return the scene's goals, a list of Goal.

        Only allowed pairs have contacts, and a click changes a mask.
        """
        return [
            Goal(
                "contacts are those both sides allow",
                120,
                self.steps > 0 and self.wrong == 0,
                f"{self.wrong} wrong in {self.steps} steps",
            ),
            Goal("pairs are filtered", 120, self.filtered > 0, f"{self.filtered}"),
            Goal("allowed pairs touch", 120, self.met > 0, f"{self.met}"),
            Goal("a click changes a mask", 240, self.clicks >= 3, f"{self.clicks} clicks"),
        ]

    def headline(self):
        """Return the Headline: the sentence and the number in the scene's title line."""
        row, column = self.marked
        a, b = KINDS[row], KINDS[column]
        overlaps, contacts = int(self.overlaps[row, column]), int(self.contacts[row, column])
        yes = self.says_yes(row, column) + self.says_yes(column, row)
        said = ("Neither of", "Only one of", "Each of")[yes]
        sentence = f"{said} {a} and {b} says yes: they pass through each other."
        unit = "overlaps were contacts"
        number, good = f"{contacts} of {overlaps}", contacts == overlaps
        headline = Headline(sentence, "Space: switch", number, unit, overlaps, 1, "overlaps", good)
        return headline.asks(f"Do {a} and {b} touch whenever they overlap?")

    def finding(self):
        """Return a sentence with the number of overlapping pairs that the filter dropped in the last step.

        It also gives the number of cells that may touch, and of wrong contacts so far.
        """
        if not self.steps:
            return "not yet: the discs have to swing"
        sentence = f"of {self.close} pairs that overlap {self.dropped} were"
        agreed = sum(self.says_yes(row, column) and self.says_yes(column, row) for row, column in CELLS)
        return (
            f"{sentence} dropped unwritten; {agreed} of {len(CELLS)} cells may touch, {self.wrong} ever did otherwise"
        )

    def bot(self):
        """Return the bot's input for the next step.

        The bot clicks three times: it removes a kind from a mask, adds a kind to another, and restores the first.
        """
        cell = BOT_CLICKS.get(self.frame)
        if cell is None:
            return frozenset()
        x, y = cell_center(*cell)
        return InputFrame(frozenset(), (round(x), round(y)), True)

    def state(self):
        """Return the scene's part of the state hash, a flat tuple: the masks and counts."""
        counts = (self.wrong, self.met, self.filtered, self.clicks, int(self.overlaps.sum()), int(self.contacts.sum()))
        return (self.frame, *self.masks, *self.marked, self.clock, *counts)


def cell_rect(row, column):
    """Return the canvas rectangle of the cell (row, column) of the grid."""
    return pygame.Rect(LEFT + column * CELL_WIDTH, TOP + row * CELL_HEIGHT, CELL_WIDTH - 2, CELL_HEIGHT - 2)


def cell_center(row, column):
    """Return the point (x, y) [px] about which the discs of the cell (row, column) swing, slightly above its centre."""
    return LEFT + (column + 0.5) * CELL_WIDTH - 1.0, TOP + (row + 0.5) * CELL_HEIGHT - 3.0


def cell_at(x, y):
    """Return the (row, column) of the grid cell at the canvas point (x, y), or None if the point is
    outside the grid.
    """
    column, row = (x - LEFT) // CELL_WIDTH, (y - TOP) // CELL_HEIGHT
    return (row, column) if 0 <= row < len(KINDS) and 0 <= column < len(KINDS) else None


def bits(word):
    """Return the lowest six bits of a filter word as text of "0" and "1", with the lowest bit first."""
    return "".join("1" if word >> index & 1 else "0" for index in range(len(KINDS)))
