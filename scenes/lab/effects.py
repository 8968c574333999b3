"""Seventeen effects in one busy yard, switched off one at a time: what changes, and what does each effect cost?

In short: gold is with the chosen effect, blue without it. An effect costs its stages, microseconds and bytes; without
it they are gone.

What to see: choose an effect. From then on the yard runs twice, with the effect (gold) and without it (blue); a body
whose position differs is outlined in both colours. Switch it off: the picture now shows the blue yard, and stages that
only this effect needs leave the time graph. After two seconds you see how far both yards differ, and the effect's time
per step. Sensors and persist only report, and sleep only saves.

Why it matters: Effects that a scene does not declare cost nothing, and a missing effect shows at once.

To try: switch off friction and watch the belt, then carving; put both back on and compare their costs.

Source: an ablation, one part left out at a time; the ledger of all scenes is measured alike (game/measure/ledger.py).
"""

from dataclasses import fields
from typing import NamedTuple

import numpy as np
import pygame

from game.drawing.bar_table import BarRow, bar_table_height, draw_bar_table
from game.drawing.canvas import SMALL, wrap
from game.drawing.colors import DUSK, FOG, GOLD, GREEN, INK, NIGHT, PAPER, SKY, SLATE
from game.drawing.headline import Headline
from game.drawing.number_text import count_text, plain_name
from game.drawing.typical import Typical
from game.input.inputs import InputFrame
from game.measure.effect_totals import FIELDS, SCALES, bars_of, bytes_of, sentence_of
from game.measure.errors import VISIBLE
from game.measure.moment import Moment
from game.measurement_requests import MeasuredRun, RunRequest
from game.scene import COSTS, Goal, Scene, Slider
from physics import Effects
from scenes.lab.busy_picture import BusyPicture, draw_ghost
from scenes.lab.busy_yard import DRAG, WIND, BusyYard, apart, rms
from scenes.lab.costs import UNKNOWN, difference_of
from scenes.lab.piles import step_seconds, with_effects
from scenes.lab.yard import HEAD, plate

NAMES = tuple(field.name for field in fields(Effects))
ALL = Effects.named(NAMES)
SIDE = 190  # [px] width of the list and the time graph under it
TOP, ROW = 29, 10  # [px] of the first line of the list; of a line
WINDOW = 120  # steps after which both yards are compared
SHOW = ("gravity", "friction", "joints", "response", "conveyor")  # effects that go dark before the player acts
TURN, DARK = 160, 25  # steps per effect of SHOW, and until it goes dark
AGAIN = 180  # steps after which both start again, while the effect is on
BOT_OFF, BOT_NEXT = 124, 150  # steps of its turn at which the bot switches an effect off, and continues
BOX = (4, 6)  # [px] left side and size of a box to tick
LISTED = 2  # greatest number of effects that the finding names for one figure


class Outcome(NamedTuple):
    """Differences between a BusyYard with an effect and its copy without the effect, over the first two seconds."""

    apart: float  # [px] root mean square distance over all moving things
    events: int  # number of further events with it, of all kinds
    kinds: int  # kinds of events whose numbers differ
    work: int  # further bodies moved, pairs tested and rows solved with it; below 0: fewer

    def shows(self, name):
        """Return whether the effect `name` makes the difference that it should make.

        Sleeping should save work. Every other effect should change positions, or the events that are reported.
        """
        return self.work < 0 if name == "sleeping" else self.apart > VISIBLE or self.kinds > 0


class EffectsLab(Scene):
    """Scene with two yards (worlds of class BusyYard), one with the selected effect and one without it.

    `worlds` contains the world of the visible yard only.
    """

    name = "lab/effects"
    keeps = {"substeps": "by load, as a World has them by itself: the cost of each effect is that in such a world"}
    title = "Effects"
    question = COSTS
    about = "A busy yard, with and without each of seventeen effects: what would be missed, and what does it cost?"
    effects = ALL
    other_effects = tuple(ALL.without(name) for name in NAMES)
    pieces = ("masks", "boxes", "circles", "capsules", "tiles")
    features = (
        "every effect switched off and on while it runs",
        "the same yard with it and without, as two ghosts",
        "pixels apart after two seconds, events and microseconds of each",
    )
    sliders = (
        Slider("effect", 0, len(NAMES) - 1, NAMES.index("gravity"), choices=NAMES),
        Slider("it is", 0, 1, 1, choices=("off", "on")),
    )
    lighter = {"substeps": 4}
    actions = (("up down", "effect"), ("Space or click", "switch it"))
    overlays = ("times",)
    weighs_effects = True
    head = HEAD
    hides_pointer = False
    legend_at = (198, 60)

    def build(self):
        """Build the yard with all effects, then copy it and switch the selected effect off in the copy."""
        self.picture = BusyPicture()
        self.real = BusyYard(self._new_world())
        self.real.furnish()
        self.clock = 0  # steps
        self.found = {}  # name: last Outcome
        self.below = HEAD  # [px] lower side of the plate with the words, as drawn last
        self.guided = True  # until the player acts: effects go dark one after the other
        self.times = Typical()  # [us] of a step of the visible yard
        self.sizes = {}  # effect that is off -> bytes of the yard's arrays
        self.looked = []  # effects whose ghost was started, and whose costs are measured
        self._part()

    @property
    def weighed_world(self):
        """The world whose choice of effects is measured: the yard with all effects, also while the other is visible."""
        return self.real.world

    def observe(self):
        """Record the time of the visible yard's last step."""
        self.times.note(1e6 * step_seconds(self.worlds[0]))

    def _guide(self):
        """Select the effects of SHOW in turn, and switch each one off after a moment."""
        turn, step = divmod(self.frame, TURN)
        if step == 0:
            self.change_slider("effect", NAMES.index(SHOW[turn % len(SHOW)]))
        elif step == DARK:
            self.change_slider("it is", 0)
            self._show()

    def _new_world(self):
        return self.add_world(drag=DRAG, wind=WIND)

    @property
    def marked(self):
        """Name of the selected effect, which is off in the copy of the yard."""
        return NAMES[int(self.values["effect"])]

    @property
    def is_on(self):
        """True if the yard with the selected effect is visible; False if the yard without it is."""
        return bool(self.values["it is"])

    def _part(self):
        """Make a new copy of the yard, and switch the selected effect off in the copy. The comparison starts again."""
        world = self._new_world()
        world.restore(self.real.world.snapshot())
        self.real.world.set_effects(world.effects)  # all wake in both
        world.set_effects(world.effects.without(self.marked))
        self.other = self.real.beside(world)
        self.began = self.real.reported.copy(), self.real.worked
        self.since = 0
        if self.marked not in self.looked:
            self.looked.append(self.marked)
        self._show()

    def _show(self):
        self.worlds = [(self.real if self.is_on else self.other).world]

    def solver_choices(self):
        """Return (): the player cannot choose a solver, because a world without `stacking` needs a different one."""
        return ()

    def change(self, name, value):
        """Apply a change from the panel to the worlds of both yards, as Scene.change does for the scene's worlds."""
        self.guided = False
        self.worlds = [self.real.world, self.other.world]
        try:
            super().change(name, value)
        finally:
            self._show()

    def change_slider(self, name, value):
        """Set the slider `name` to `value`. If it selects an effect, copy the yard again, and show the yard with that
        effect.
        """
        super().change_slider(name, value)
        if name == "effect":
            self.values["it is"] = 1
            self._part()

    def update(self, inputs):
        """Process keys and the pointer, and step both yards. Compare the yards two seconds after the copy was made."""
        if inputs.now.actions or inputs.pointer_pressed or inputs.wheel:
            self.guided = False
        if self.guided:
            self._guide()
        way = inputs.pressed("down") - inputs.pressed("up") - inputs.wheel
        row = (inputs.pointer[1] - TOP) // ROW
        points = inputs.pointer_pressed and inputs.pointer[0] < SIDE and 0 <= row < len(NAMES)
        if points and NAMES[row] != self.marked:
            self.change("slider:effect", row)
        elif points or inputs.pressed("fire"):
            self.change("slider:it is", int(not self.is_on))
        elif way:
            self.change("slider:effect", (int(self.values["effect"]) + way) % len(NAMES))
        if self.since == AGAIN and self.is_on:
            self._part()
        for yard in (self.real, self.other):
            yard.step(self.clock)
        self.clock += 1
        self.since += 1
        if self.since == WINDOW:
            self.found[self.marked] = self._outcome()
            self.play("coin", 80.0, 0.3)

    def _outcome(self):
        reported, worked = self.began
        more = self.real.reported - reported - self.other.reported
        _, gaps = apart(self.real, self.other)
        return Outcome(
            rms(gaps), int(more.sum()), int(np.count_nonzero(more)), self.real.worked - worked - self.other.worked
        )

    def measured(self):
        """Return a RunRequest: two runs for each effect that was selected, timed by the measuring process during the
        game.

        Both runs start from the same state of the yard, with all bodies awake. One run has the effect, the other does
        not.
        """
        return RunRequest([self._run_name(name, on) for name in self.looked for on in (True, False)], self._make)

    def _run_name(self, name, on):
        how = "with" if on else "without"
        return how, name, self.broadphase, self.substeps, None if self.narrowphase else "boxes only"

    def _make(self, run_name):
        how, name, *_ = run_name
        effects = self.real.world.effects
        made = with_effects(self.real.world, effects if how == "with" else effects.without(name))
        return MeasuredRun([made], self.broadphase, WINDOW)

    def stages(self):
        """Return (own, replaced), two lists with names of stages of a step.

        own: stages that a step has only with the selected effect; replaced: stages that a step has only without it.
        """
        real, other = self.real.world.stages, self.other.world.stages
        return [name for name in real if name not in other], [name for name in other if name not in real]

    def price(self, name):
        """Return by how much the effect `name` prolongs a step, a Difference, or None while measurements are missing.

        It is negative for an effect that saves time.
        """
        return difference_of(self, *(self._run_name(name, on) for on in (True, False)))

    def headline(self):
        """Return the Headline: the sentence and the number in the scene's title line."""
        name, outcome = plain_name(self.marked), self.found.get(self.marked)
        sentence = f"Without {name} (blue) the yard is another one than with it (gold)."
        number, _, unit = ("", "", "") if outcome is None else short(outcome, self.marked).partition(" ")
        seen = WINDOW if outcome is not None else min(self.since, WINDOW)
        headline = Headline(sentence, "Space: off and on", number, f"{unit} after two seconds", seen, WINDOW, "steps")
        return headline.asks(f"Is the yard without {name} (blue) another one than with it (gold)?")

    def finding(self):
        """Return a sentence with the effects that change positions most, cost most time and save most time.

        The sentence is complete once all effects were compared.
        """
        if len(self.found) < len(self.effects.names()):
            return f"not yet: {len(self.found)} of {len(self.effects.names())} effects were looked at"
        far = max(self.found, key=lambda name: self.found[name].apart)
        words = f"{plain_name(far)} moves most, {self.found[far].apart:.0f} px"
        prices = {name: price for name in self.found if (price := self.price(name)) is not None and price.counts}
        order = sorted(prices, key=prices.__getitem__)
        costs, saves = order[::-1], order
        if costs and prices[costs[0]].seconds > 0.0:
            # Effects whose costs cannot be told apart from the greatest cost share its place.
            most = [name for name in costs if not prices[costs[0]].exceeds(prices[name])]
            figures = [f"{1e6 * prices[name].seconds:,.0f}" for name in (most[-1], most[0])]
            names = " or ".join(plain_name(name) for name in most[:LISTED])
            names += f" or {len(most) - LISTED} more" if len(most) > LISTED else ""
            words += f"; {names} costs most, {' to '.join(dict.fromkeys(figures))} us"
        if saves and prices[saves[0]].seconds < 0.0:
            words += f"; {plain_name(saves[0])} saves {-1e6 * prices[saves[0]].seconds:,.0f} us"
        return words

    def draw(self, canvas, alpha):
        """Draw the visible yard, and the list of effects with their results.

        alpha: position (0..1) between the last two steps.
        """
        shown = self.real if self.is_on else self.other
        runs = shown.world.effects.conveyor
        self.picture.draw(canvas, shown, alpha, self.clock if runs else 0.0)
        canvas.surface.fill(NIGHT, (0, HEAD, SIDE, canvas.surface.get_height() - HEAD))
        canvas.surface.fill(SLATE, (SIDE, HEAD, 1, canvas.surface.get_height() - HEAD))
        canvas.reserve((SIDE, HEAD, 480 - SIDE, 270 - HEAD))  # the time graph goes under the list
        canvas.text("after 2 s", 136, TOP - 9, FOG, SMALL, align="right")
        canvas.text("us a step", SIDE - 6, TOP - 9, FOG, SMALL, align="right")
        for row, name in enumerate(NAMES):
            self._draw_row(canvas, name, TOP + ROW * row)
        self._draw_words(canvas)
        self._draw_totals(canvas)

    def _draw_row(self, canvas, name, y):
        marked = name == self.marked
        if marked:
            canvas.surface.fill(DUSK, (1, y - 2, SIDE - 2, ROW))
        x, size = BOX
        on = self.is_on or not marked
        canvas.surface.fill(SLATE, (x, y, size, size))
        canvas.surface.fill((GREEN if on else INK), (x + 1, y + 1, size - 2, size - 2))
        canvas.text(plain_name(name), 14, y, PAPER if on else FOG, SMALL)
        outcome, price = self.found.get(name), self.price(name)
        if outcome is not None:
            canvas.text(short(outcome, name), 136, y, PAPER, SMALL, align="right")
        if name in self.looked:
            canvas.text(UNKNOWN if price is None else price.text(), SIDE - 6, y, PAPER, SMALL, align="right")

    def _draw_words(self, canvas):
        """Draw a plate over the sky with two texts: the stages that only the selected effect needs, and finding()."""
        ours, theirs = self.stages()
        if ours:
            words = f"{plain_name(self.marked)} calls for {', '.join(map(plain_name, ours))}"
            words += f" in place of {', '.join(map(plain_name, theirs))}" if theirs else ""
        else:
            words = f"{plain_name(self.marked)} has no stage of its own: it is a part of others' passes"
        rect = pygame.Rect(SIDE + 5, HEAD + 4, 480 - SIDE - 10, 0)
        world = self.worlds[0]
        live = f"{self.times.value:,.0f} us a step, {len(world.profile.stages)} stages"
        live += f", {count_text(len(world.bodies), 'body').replace('bodys', 'bodies')}"
        live += f", {count_text(len(world.joints), 'joint')}"
        lines = [(f"{'with' if self.is_on else 'without'} {plain_name(self.marked)}: {live}", PAPER)]
        lines += [(line, GOLD if self.is_on else SKY) for line in wrap(words, rect.width - 8, SMALL)]
        lines += [(line, FOG) for line in wrap(self.finding(), rect.width - 8, SMALL)]
        rect.height = 7 * len(lines) + 5
        plate(canvas, rect)
        self.below = rect.bottom
        for number, (line, color) in enumerate(lines):
            canvas.text(line, rect.x + 4, rect.y + 3 + 7 * number, color, SMALL)

    def _bars(self):
        """Return the rows of the table of bars. While an effect is off, the first row is the yard without it."""
        bars = bars_of(self.totals)
        if self.is_on:
            return bars
        if self.marked not in self.sizes:
            moment = Moment(self.other.world.snapshot(), self.broadphase)
            self.sizes = {self.marked: bytes_of(moment.world(moment.here))}  # new arrays, as in the rows below
        figures = self.figures.get(self._run_name(self.marked, False))
        time = figures.cost.least if figures is not None and figures.sure else None
        size = self.sizes[self.marked]
        values: dict[str, float | None] = {**dict.fromkeys(FIELDS), "time": time, "bytes": size}
        cells = [
            (value, UNKNOWN if value is None else f"{SCALES[field] * value:,.0f}") for field, value in values.items()
        ]
        return [BarRow("shown", SKY, cells), *bars[1:]]

    def _draw_totals(self, canvas):
        """Draw bars under the list that compare the yard's effects, all effects and none.

        The bars show the time of a step, the kernels, the time to start and the bytes.
        """
        bars = self._bars()
        table = pygame.Rect(4, 268 - bar_table_height(len(bars)), SIDE - 8, bar_table_height(len(bars)))
        draw_bar_table(canvas, table, list(FIELDS.values()), bars)
        canvas.fix(table)
        lines = wrap(sentence_of(self.totals) or "measuring: declared, everything, nothing", table.width, SMALL)
        for number, line in enumerate(reversed(lines), 1):
            canvas.text(line, table.x, table.y - 2 - 7 * number, PAPER, SMALL)

    def draw_on_frame(self, frame):
        """Draw the outlines of all bodies whose positions differ between the two yards, once for each yard."""
        numbers, gaps = apart(self.real, self.other)
        far = [number for number, gap in zip(numbers, gaps.tolist(), strict=True) if gap > VISIBLE]
        # The outlines stay off the plate with the words.
        frame.surface.set_clip(frame.from_canvas((SIDE + 1, self.below, 480 - SIDE, 270 - self.below)))
        for yard, color in ((self.real, GOLD), (self.other, SKY)):
            draw_ghost(frame, self.camera, yard, far, color)
        frame.surface.set_clip(None)

    def check(self):
        """Return the scene's goals, a list of Goal.

        For each effect, the yard without it differs from the yard with it.
        """
        goals = []
        for turn, name in enumerate(self.effects.names(), 1):
            outcome = self.found.get(name)
            met = outcome is not None and outcome.shows(name)
            detail = "" if outcome is None else short(outcome, name)
            goals.append(Goal(f"without {plain_name(name)} something is missed", turn * BOT_NEXT, met, detail))
        return goals

    def bot(self):
        """Return the bot's input for the next step.

        The bot selects one effect after the other. It shows the yard with the effect for two seconds, then briefly the
        yard without it.
        """
        turn, step = divmod(self.frame, BOT_NEXT)
        if step == 0:
            return InputFrame(changes=(("slider:effect", turn % len(NAMES)),))
        return frozenset({"fire"} if step == BOT_OFF else ())

    def state(self):
        """Return the scene's part of the state hash, a flat tuple: both clocks, the digest of the hidden world, and
        the results.
        """
        hidden = (self.other if self.is_on else self.real).world
        found = (value for name in NAMES if name in self.found for value in self.found[name])
        reported = (*self.real.reported.tolist(), *self.other.reported.tolist())
        return (self.frame, self.clock, self.since, *self.values.values(), hidden.digest(), *reported, *found)


def short(outcome, name):
    """Return the Outcome of the effect `name` as short text: tasks saved, distance [px], or number of events."""
    if name == "sleeping":
        return f"{-outcome.work:,} tasks saved"
    if outcome.apart > VISIBLE:
        return f"{outcome.apart:,.0f} px"
    return f"{outcome.events:+,} events" if outcome.kinds else "the same"
