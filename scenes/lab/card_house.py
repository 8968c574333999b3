"""A house of cards: how much friction does it need to stand?

In short: two cards that lean on each other need a friction of 0.223. One pair has 5 % less and slides apart, one 5 %
more and stands.

What to see: two cards that lean on each other push their feet apart. The force is half their weight times the tangent
of their lean, so one pair needs a friction of 0.223 at the table. Of the two pairs on the right, one has 5 % less and
one 5 % more. The house, whose lower cards carry the upper ones, needs twice that.

Why it matters: A house of cards stands by friction alone, so friction that is too weak or creeps shows here first.

To try: lower the friction until the house falls, and compare with the single pairs beside it.

Source: Coulomb, Theorie des machines simples, 1785: a push above the friction times the load makes a body slide.
"""

from math import atan2, cos, hypot, radians, sin

import pygame

from game.drawing.camera import Camera
from game.drawing.canvas import SMALL
from game.drawing.colors import FOG, GOLD, GREEN, ORANGE, PAPER, RED, SKY
from game.drawing.headline import Headline
from game.drawing.rotated import Cast
from game.drawing.sprites import load_atlas
from game.input.inputs import InputFrame
from game.scene import STANDS, Goal, Scene, Slider
from physics import Capsule, Circle, Effects, Material, Polygon
from scenes.lab.yard import HEAD, Yard, plate

LENGTH, RADIUS = 48.0, 2.0  # [px] between the centres of a card's round ends, and their radius
LEAN = radians(25.0)  # from the vertical
REACH, RISE = LENGTH * sin(LEAN), LENGTH * cos(LEAN)
APART = 2.0 * (REACH + 2.0 * RADIUS) + 1.0  # [px] between neighbouring pairs
PLANK = 4.0  # [px] thick
STOREY = RISE + 2.0 * RADIUS + PLANK
# Moments about a foot: the push at the top, at the height RISE + RADIUS, holds the weight at half the REACH.
NEEDED = REACH / (2.0 * (RISE + RADIUS))
LESS, MORE = 0.95 * NEEDED, 1.05 * NEEDED
FLOOR = 238  # [canvas px]
GIVES = 1.0  # [px] motion of a card from which it is marked
HOUSE_X = 140.0
PAIRS = ((328.0, LESS, SKY), (436.0, MORE, GREEN))  # x, friction, colour of the cloth
CLOTH = 62.0  # [px] wide
WOOD, EDGE = (126, 78, 52), (190, 130, 88)
RAIL = (280.0, 5.0, 20.0)  # [canvas px] x, width and height of the rail between a fallen house and the pairs
COIN, COIN_SPEED, COIN_DENSITY = 5.0, 340.0, 10.0  # [px] radius, [px/s], times a card's
JUDGED_AT = 600  # step: ten seconds
SLIPPERY_AT, SLIPPERY, ROUGH = 604, 20, 70  # the bot's step; frictions with which the house falls, and stands [1/100]


class CardHouse(Scene):
    """Scene with one world: the house of cards, and two pairs of cards on cloths of known friction."""

    name = "lab/card_house"
    title = "House of cards"
    question = STANDS
    about = "Thin cards held up by nothing but friction: how much of it does the house need?"
    effects = Effects(response=True, gravity=True, rotation=True, friction=True, stacking=True)
    pieces = ("boxes", "capsules", "circles")
    features = ("thin capsules that lean on each other", "the friction that theory asks for, from both sides")
    keeps = {"solver": "how far cards creep under soft step, and with how many substeps, is what its slider shows"}
    sliders = (
        Slider("friction", 5, 100, SLIPPERY, "/ 100", step=5),
        Slider("storeys", 1, 4, 4),
        Slider("substeps", 1, 8, 4),
    )
    actions = (("Space", "throw a coin"), ("up down", "friction"), ("left right", "storeys"))
    draggable = True
    head = HEAD
    legend_at = (342, 88)

    def build(self):
        """Create the picture of the table, then call fill() to build the house and the pairs of cards."""
        self.yard = Yard(FLOOR, 60, table=True)
        self.held = None  # [px] motion of its cards in the ten seconds, or None
        self.slipped = False  # the house fell once with too little friction
        self.fill()

    def fill(self):
        """Replace the scene's world by a new one with the house and the two pairs of cards."""
        self.worlds = []
        self.camera = Camera(((0, 16), (480, 254)), 1.0, y=16.0)
        self.add_world(substeps=int(self.values["substeps"]))
        self.cast = Cast(load_atlas("lab"))
        friction = self.values["friction"] / 100.0
        self._table(-200.0, PAIRS[0][0] - CLOTH / 2, friction)
        self.cards = self._house(int(self.values["storeys"]), Material(friction=friction))
        self.pairs = []
        for x, rubs, _ in PAIRS:
            material = Material(friction=rubs)
            self._table(x - CLOTH / 2, x + CLOTH / 2, rubs)
            self.pairs.append(self._pair(x, FLOOR, material))
        self._table(PAIRS[0][0] + CLOTH / 2, PAIRS[1][0] - CLOTH / 2, friction)
        self._table(PAIRS[1][0] + CLOTH / 2, 800.0, friction)
        x, width, height = RAIL
        self.world.add_body(Polygon.box(width, height), position=(x, FLOOR - height / 2), kind="static")
        self.start = {card.id: card.center for card in (*self.cards, *self.pairs[0], *self.pairs[1])}
        self.coins = []
        self.since = 0
        self.stood = 0  # steps for which the house stood
        self.wandered = 0.0  # [px] greatest motion of a card while it stood

    def _table(self, left, right, friction):
        self.world.add_body(
            Polygon.box(right - left, 40),
            position=((left + right) / 2, FLOOR + 20.0),
            kind="static",
            material=Material(friction=friction),
        )

    def _pair(self, x, floor, material):
        """Add two cards that lean on each other, and return a list of these two bodies.

        x: horizontal centre of the pair [px]; floor: y of the cards' feet [px].
        """
        shape = Capsule((-LENGTH / 2, 0), (LENGTH / 2, 0), RADIUS)
        cards = []
        for side in (-1, 1):
            place = (x + side * (RADIUS + REACH / 2), floor - RADIUS - RISE / 2)
            angle = atan2(-RISE, -side * REACH)
            card = self.world.add_body(shape, position=place, angle=angle, material=material)
            cards.append(self.cast.add(card, "card_red"))
        return cards

    def _house(self, storeys, material):
        cards = []
        for storey in range(storeys):
            floor = FLOOR - storey * STOREY
            left = HOUSE_X - (storeys - storey - 1) * APART / 2
            for number in range(storeys - storey):
                cards += self._pair(left + number * APART, floor, material)
            for number in range(storeys - storey - 1):
                place = (left + (number + 0.5) * APART, floor - RISE - 2.0 * RADIUS - PLANK / 2)
                plank = self.world.add_body(Polygon.box(APART - 0.5, PLANK), position=place, material=material)
                cards.append(self.cast.add(plank, "card_blue"))
        return cards

    def change_slider(self, name, value):
        """Set the slider `name` to `value`, then build the house and the pairs again."""
        super().change_slider(name, value)
        self.fill()

    def update(self, inputs):
        """Process keys, make one step, and measure whether the house still stands and how far its cards have moved."""
        for name, forth, back, notch in (("friction", "up", "down", 5), ("storeys", "right", "left", 1)):
            way = inputs.pressed(forth) - inputs.pressed(back)
            if way:
                self.change_slider(name, self.values[name] + way * notch)
        if inputs.pressed("fire"):
            self._throw()
        self.world.step()
        self.since += 1
        if self.stands(self.cards):
            self.stood = self.since
            self.wandered = max(self.moved(card) for card in self.cards)
            if self.since == JUDGED_AT and self.held is None:
                self.held = self.wandered
        elif self.values["friction"] <= SLIPPERY and not self.coins:
            self.slipped = True

    def _throw(self):
        coin = self.world.add_body(
            Circle(COIN),
            position=(8.0, FLOOR - 90.0),
            velocity=(COIN_SPEED, -60.0),
            material=Material(density=COIN_DENSITY),
        )
        self.coins = [*self.coins, self.cast.add(coin, "disc_gold")][-6:]
        self.play("coin")

    def moved(self, card):
        """Return the distance of a card from its starting position [px]."""
        x, y = self.start[card.id]
        return hypot(card.center[0] - x, card.center[1] - y)

    def stands(self, cards):
        """Return whether each of the bodies `cards` is less than REACH / 2 away from its starting position."""
        return all(self.moved(card) < REACH / 2 for card in cards)

    @property
    def offer(self):
        """Text that offers the player a new run once the house has fallen; "" otherwise."""
        return "" if self.stands(self.cards) else "builds it again"

    def draw(self, canvas, alpha):
        """Draw the table with its cloths, the cards, and the text.

        alpha: position (0..1) between the last two steps.
        """
        self.yard.draw(canvas)
        for x, _, color in PAIRS:
            left = round(x - CLOTH / 2)
            canvas.surface.fill(color, (left + 1, FLOOR, round(CLOTH) - 2, 2))
            canvas.surface.fill((20, 16, 32), (left + 1, FLOOR + 2, round(CLOTH) - 2, 1))
        x, width, height = (round(size) for size in RAIL)
        rail = pygame.Rect(x - width // 2 - 1, FLOOR - height, width, height)
        canvas.surface.fill(WOOD, rail)
        canvas.surface.fill(EDGE, (rail.x, rail.y, rail.w, 1))
        canvas.surface.fill(EDGE, (rail.x, rail.y, 1, rail.h))
        self.cast.draw(canvas, self.camera, self.world, alpha)
        for (x, friction, color), cards in zip(PAIRS, self.pairs, strict=True):
            self._draw_pair_words(canvas, x, friction, color, cards)
        plate(canvas, (342, 22, 134, 60))
        stands = self.stands(self.cards)
        canvas.text("the house stands" if stands else "it fell", 348, 26, GREEN if stands else RED)
        rows = (
            ("cards", f"{len(self.cards)}"),
            ("friction", f"{self.values['friction'] / 100:.2f}"),
            ("for", f"{self.stood / 60:.1f} s"),
            ("a pair needs", f"{NEEDED:.3f}"),
        )
        for number, (word, value) in enumerate(rows):
            canvas.text(word, 348, 40 + number * 10, FOG, SMALL)
            canvas.text(value, 470, 40 + number * 10, PAPER, SMALL, align="right")

    def _draw_pair_words(self, canvas, x, friction, color, cards):
        plate(canvas, (round(x) - 31, FLOOR - 96, 62, 24))
        canvas.text(f"{friction:.3f}", x, FLOOR - 92, color, align="center")
        still = all(self.moved(card) < GIVES for card in cards)
        word = "stands" if still else "slides" if self.stands(cards) else "slid apart"
        canvas.text(word, x, FLOOR - 82, PAPER if still else ORANGE, SMALL, align="center")

    def draw_on_frame(self, frame):
        """Draw a ring at the centre of each card of the house that has moved by more than GIVES but has not fallen."""
        lens = frame.lens(self.camera)
        for card in self.cards:
            moved = self.moved(card)
            if GIVES < moved < REACH / 2:
                pygame.draw.circle(frame.surface, GOLD, lens.points(*card.center), 2 * frame.scale, 1)

    def check(self):
        """Return the scene's goals, a list of Goal.

        The house stands for ten seconds, the pairs of cards stand or slide as theory predicts, and the house falls at a
        low friction.
        """
        slid, stood = (self.stands(cards) for cards in self.pairs)
        moved = self.wandered if self.held is None else self.held
        return [
            Goal("the house stands for ten seconds", JUDGED_AT, self.held is not None, f"{self.stood} steps"),
            Goal(
                "its cards stay within a twentieth of their length", JUDGED_AT, moved < LENGTH / 20, f"{moved:.2f} px"
            ),
            Goal(
                "a pair with a twentieth less friction than theory asks slides", 540, not slid, f"friction {LESS:.4f}"
            ),
            Goal("a pair with a twentieth more stands", 540, stood, f"friction {MORE:.4f}"),
            Goal("the house falls at a friction of 0.2", 800, self.slipped, f"at {self.values['friction'] / 100:.2f}"),
        ]

    def headline(self):
        """Return the Headline: the sentence and the number in the scene's title line."""
        fell = sum(self.moved(card) >= REACH / 2 for card in self.cards)
        friction = self.values["friction"] / 100
        sentence = f"At a friction of {friction:.2f} cards slide: a pair needs {NEEDED:.3f}."
        number, unit = f"{fell} of {len(self.cards)}", "cards fell or slid"
        headline = Headline(sentence, "up: more", number, unit, self.since, 60, "steps", not fell)
        return headline.asks(f"A pair of cards needs {NEEDED:.3f}: does a friction of {friction:.2f} hold them?")

    def finding(self):
        """Return a sentence with the time that the house has stood at its friction.

        It also names the frictions of the two pairs of cards: one at which a pair stands, one at which it slides.
        """
        if self.since < 60:
            return "not yet: the cards have to stand, or slide, for a second"
        house = f"{len(self.cards)} cards at a friction of {self.values['friction'] / 100:.2f}"
        for_so_long = f"{self.stood / 60:.1f} s"
        stands = f"stand for {for_so_long}, none further than {self.wandered:.2f} px from its place"
        sentence = f"{house} {stands if self.stands(self.cards) else f'fell after {for_so_long}'}"
        slid, stood = (self.stands(cards) for cards in self.pairs)
        if slid or not stood:
            return sentence
        return f"{sentence}; a pair slides at {LESS:.3f} and stands at {MORE:.3f}, as theory says: {NEEDED:.3f}"

    def bot(self):
        """Return the bot's input for the next step.

        The bot gives the cards enough friction, and lowers the friction after ten seconds.
        """
        friction = {0: ROUGH, SLIPPERY_AT: SLIPPERY}.get(self.frame)
        return InputFrame(changes=() if friction is None else (("slider:friction", friction),))

    def state(self):
        """Return the scene's part of the state hash, a flat tuple: the measurements. The worlds are hashed
        separately.
        """
        return (
            self.frame,
            self.since,
            *self.values.values(),
            self.stood,
            self.wandered,
            self.held,
            self.slipped,
            len(self.coins),
        )
