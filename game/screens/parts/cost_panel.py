"""Panel that plots error against time for the running scene. Each setting of the scene is a dot."""

from collections.abc import Callable

import pygame

from game.drawing.canvas import TEXT, shorten, small_font, wrap
from game.drawing.colors import (
    DUSK,
    FOG,
    GOLD,
    GREEN,
    NIGHT,
    ORANGE,
    PAPER,
    PINK,
    RED,
    SKY,
    SLATE,
    YELLOW,
    Color,
    faded,
)
from game.drawing.plot import Axis, LogPlot, number
from game.drawing.presenter import Frame
from game.measure.errors import VISIBLE, Error
from game.measure.setting import Setting
from game.measure.survey import own_sentence, reported_error, shown
from game.measure.timing import RUNS, Cost
from game.screens.parts.advice_rows import AdviceRows
from game.screens.parts.measuring import Measuring
from game.screens.parts.switches import following

TITLES = {
    "verdict": "false and missed hits of 100 encounters",
    "overlap": "deepest overlap of bodies [px]",
    "way": "bodies astray from a reference run [px]",
    "joints": "widest joint gap [px]",
}
# Changed part of a setting -> (name, colour, form) of its dot; forms differ, so that colour is not needed. If a setting
# differs in several parts, the first one here counts.
LOOKS: dict[str, tuple[str, Color, str]] = {
    "tier": ("tier", SKY, "square"),
    "broadphase": ("broad phase", GREEN, "diamond"),
    "joint_solver": ("joints", PINK, "wedge"),
    "solver": ("solver", YELLOW, "triangle"),
    "substeps": ("substeps", ORANGE, "circle"),
    "narrowphase": ("narrow phase", RED, "cross"),
}
NEAR = 7  # [text px] from a dot at which its name is shown
FEET = (
    "click or Enter: play with it, Shift: race it   \u2191 \u2193 choose   \u2190 \u2192 error   F9 CSV   M closes",
    "click: play with it   Shift+click: race it   F9 CSV   M closes",
    "click: play with it   \u2190 \u2192 other error   M closes",
    "click: play with it   M closes",
    "M closes",
)
LEAST = 60  # [text px] least height of the plot
BELOW = 116  # [text px] for the legend, the finding, the advice, four rows of the list and the keys
LASTS = 15  # pictures for which a painted panel is shown, even if new results arrive
TRAIL = 12  # number of last applied settings that a line joins


class CostPanel:
    """Panel of accuracy and cost.

    measuring: the measurements of the played scene; apply(setting): applies a setting to the scene, or reports why that
    is impossible; race(setting): starts a race between the scene and a copy under that setting; save(): saves the
    measurements.
    """

    def __init__(
        self,
        measuring: Measuring,
        apply: Callable[[Setting], None],
        race: Callable[[Setting], None],
        save: Callable[[], None],
    ) -> None:
        self.measuring, self.save = measuring, save
        self.surveyor, self.now, self.apply, self.race = measuring.surveyor, measuring.now, apply, race
        self.survey = self.surveyor.survey
        self.advice = AdviceRows(measuring, apply)
        self.kind: str | None = None  # kind of error to plot; None: the first one
        self.trail: list[Setting] = []
        self.places: list[tuple[tuple[float, float], Setting]] = []  # dots of the last picture
        self.rows: list[tuple[pygame.Rect, Setting]] = []
        self.hovered: Setting | None = None
        self.focused = True
        self.sheet: pygame.Surface | None = None  # the panel as painted last, …
        self.texts: list[tuple[pygame.Rect, str]] = []  # … with its texts
        self.asked: tuple = ()
        self.age = self.seen = 0
        self.rect = self.head = pygame.Rect(0, 0, 0, 0)

    def shown_kind(self) -> str:
        """Return the kind of error that is plotted (a key of TITLES); "" before the first result."""
        kinds = self.survey.kinds
        return self.kind if self.kind in kinds else kinds[0] if kinds else ""

    def ranking(self) -> list[Setting]:
        """Return the settings that have a cost and an error of the plotted kind, cheapest first."""
        known = self.survey.known(self.shown_kind())
        return sorted(known, key=lambda setting: known[setting][0].median)

    def feed(self, event: pygame.event.Event) -> bool:
        """Process an event. Return whether the event was used."""
        if event.type == pygame.KEYDOWN and self.focused:
            return self.key(event.key, bool(getattr(event, "mod", 0) & pygame.KMOD_SHIFT))
        if event.type == pygame.MOUSEMOTION:
            self.hovered = self._under(event.pos)
            return self.rect.collidepoint(event.pos)
        if event.type == pygame.MOUSEBUTTONDOWN and event.button == 1:
            self.focused = self.rect.collidepoint(event.pos)
            if self.head.collidepoint(event.pos):
                self.turn_kind(1)
            elif self.advice.click(event.pos):
                pass
            elif (setting := self._under(event.pos)) is not None:
                (self.race if pygame.key.get_mods() & pygame.KMOD_SHIFT else self.apply)(setting)
            return self.focused
        return False

    def key(self, key: int, shift: bool = False) -> bool:
        """Process a key. Return whether the key was used. shift: whether the Shift key is held.

        Up and down select a setting, Enter applies it, and Shift+Enter starts a race against it. Left and right change
        the kind of error. F9 saves the measurements.
        """
        ranking = self.ranking()
        if key in (pygame.K_UP, pygame.K_DOWN) and ranking:
            way = 1 if key == pygame.K_DOWN else -1
            self.hovered = following(ranking, self.hovered, way)
        elif key in (pygame.K_LEFT, pygame.K_RIGHT):
            self.turn_kind(1 if key == pygame.K_RIGHT else -1)
        elif key == pygame.K_F9:
            self.save()
        elif key in (pygame.K_RETURN, pygame.K_KP_ENTER) and self.hovered is not None:
            (self.race if shift else self.apply)(self.hovered)
        else:
            return self.advice.key(key)
        return True

    def turn_kind(self, way: int) -> None:
        """Plot the next kind of error (`way` 1) or the previous one (-1). Nothing changes if there is only one kind."""
        kinds = self.survey.kinds
        if kinds:
            self.kind = following(kinds, self.shown_kind(), way)

    def _under(self, position):
        for rect, setting in self.rows:
            if rect.collidepoint(position):
                return setting
        reach = NEAR * max(1, self.rect.width // 240)
        near = [(pygame.Vector2(place).distance_to(position), setting) for place, setting in self.places]
        distance, setting = min(near, key=lambda each: each[0], default=(reach, None))
        return setting if distance < reach else None

    def draw(self, frame: Frame, rect: pygame.Rect) -> None:
        """Draw the panel into a frame rectangle.

        Painting takes a tenth of a frame, so the painted panel is stored and drawn again. After a change by the player,
        the panel is repainted at once. After new results, it is repainted once LASTS pictures have passed.
        """
        now = self.now()
        if not self.trail or self.trail[-1] != now:
            self.trail = [*self.trail, now][-TRAIL:]
        asked = (tuple(rect), now, self.hovered, self.shown_kind(), self.focused, frame.palette, self.surveyor.trouble)
        asked = *asked, *self.advice.stamp(), *self.measuring.scene.own_hits.values()
        self.age += 1
        if self.sheet is None or asked != self.asked or (self.age >= LASTS and self.seen != self.surveyor.revision):
            self.asked, self.age, self.seen, before = asked, 0, self.surveyor.revision, len(frame.boxes)
            self._paint(frame, rect, now)
            self.sheet, self.texts = frame.surface.subsurface(rect).copy(), frame.boxes[before:]
        else:
            frame.surface.blit(self.sheet, rect)
            frame.boxes.extend(self.texts)
        frame.fix(rect)

    def _paint(self, frame, rect, now):
        """Paint the heading, the plot, its legend, the finding, the advice and the list. now: the current setting."""
        self.rect, scale = rect, frame.text_scale
        font, line = small_font(scale)
        frame.surface.fill(faded(NIGHT, 0.2), rect)
        pygame.draw.line(frame.surface, SLATE, rect.topleft, rect.bottomleft, scale)
        left, width = rect.x + 5 * scale, rect.width - 10 * scale
        finding = self._finding()
        opening = self._opening(finding)
        y = self._draw_head(frame, left, rect.y + 4 * scale, width, opening, scale)
        known = self.survey.known(self.shown_kind())
        self.places, self.rows = [], []
        if known:
            high = min(rect.height * 2 // 5, rect.bottom - y - BELOW * scale)
            plot = pygame.Rect(left, y, width, max(LEAST * scale, high))
            self._draw_plot(frame, plot, known, now, scale)
            y = self._draw_forms(frame, left, plot.bottom + 3 * scale, width, known, now, scale)
            if finding not in ("", opening) and self.survey.can_judge_tiers():
                y = self._draw_sentence(frame, left, y, width, finding, scale)
            y = self.advice.draw(frame, left, y, width, scale)
            self._draw_list(frame, pygame.Rect(left, y, width, rect.bottom - (line + 3) * scale - y), known, now, scale)
        else:
            self._draw_runs(frame, pygame.Rect(left, y, width, rect.bottom - (line + 3) * scale - y), now, scale)
        foot = next((each for each in FEET if frame.measure(each, font, scale)[0] <= width), FEET[-1])
        frame.text(foot, left, rect.bottom - (line + 1) * scale, FOG, font, scale)

    def _draw_head(self, frame, left, y, width, opening, scale):
        font, line = small_font(scale)
        frame.text("What accuracy costs", left, y, GOLD, TEXT, scale)
        y += 10 * scale
        kind = self.shown_kind()
        y = self._draw_sentence(frame, left, y, width, opening, scale)
        if kind == "verdict" and (own := own_sentence(self.measuring.scene.own_hits, self.measuring.scene.tier)):
            y = self._draw_sentence(frame, left, y, width, own, scale)
        lines = wrap(self._state(), width, font, scale)
        if kind:
            more = f"  ({len(self.survey.kinds)} kinds, \u2190 \u2192)" if len(self.survey.kinds) > 1 else ""
            lines = [*wrap(f"up: {TITLES[kind]}{more}; right: time of a step [us]", width, font, scale), *lines]
        self.head = pygame.Rect(left, y, width, len(lines) * line * scale)
        for row, text in enumerate(lines):
            frame.text(text, left, y + row * line * scale, FOG, font, scale)
        return self.head.bottom + 2 * scale

    def _draw_sentence(self, frame, left, y, width, sentence, scale):
        """Draw the explanatory `sentence` above the plot, with its top left corner at (left, y).

        Return the y below it.
        """
        for line in wrap(sentence, width, TEXT, scale):
            frame.text(line, left, y, PAPER, TEXT, scale)
            y += 9 * scale
        return y + 2 * scale

    def _state(self):
        if self.surveyor.trouble:
            return self.surveyor.trouble
        return self.survey.progress() if self.survey.dots else "taking this moment of the game ..."

    def _draw_plot(self, frame, rect, known, now, scale):
        x = Axis([1e6 * value for cost, _ in known.values() for value in (cost.least, cost.upper)])
        errors = [reported_error(error) for _, error in known.values()]
        in_pixels = self.shown_kind() != "verdict"
        levels = [VISIBLE] if in_pixels else [100.0]
        plot = LogPlot(rect, x, Axis([*errors, *levels]), any(error <= 0.0 for error in errors), scale)
        plot.draw_ground(frame)
        if in_pixels:
            plot.draw_level(frame, VISIBLE, PAPER, "a pixel: seen above")
        places = {s: plot.place(1e6 * cost.median, reported_error(error)) for s, (cost, error) in known.items()}
        pareto_front = [places[setting] for setting in self.survey.pareto_front(self.shown_kind())]
        if len(pareto_front) > 1:
            pygame.draw.lines(frame.surface, faded(GOLD, 0.25), False, _stairs(pareto_front), scale)
        trail = [places[setting] for setting in self.trail if setting in places]
        if len(trail) > 1:
            pygame.draw.lines(frame.surface, faded(PAPER, 0.5), False, trail, 1)
        for setting, (cost, error) in known.items():
            self._draw_dot(frame, plot, places[setting], setting, cost, error, now, scale)
        self.places = [(place, setting) for setting, place in places.items()]
        self._draw_name(frame, rect, places, known, now, scale)

    def _draw_dot(self, frame, plot, place, setting, cost, error, now, scale):
        color, form = look_of(setting, self.surveyor.here or now)
        color = frame.tone(color)
        low, high = (plot.place(1e6 * value, 1.0)[0] for value in (cost.least, cost.upper))
        if high - low > 2:
            pygame.draw.line(frame.surface, faded(color, 0.4), (low, place[1]), (high, place[1]), 1)
        least, most = (plot.place(1.0, max(value, plot.least_y))[1] for value in error.interval)
        if reported_error(error) > 0.0 and least - most > 2:
            pygame.draw.line(frame.surface, faded(color, 0.4), (place[0], least), (place[0], most), 1)
        draw_form(frame.surface, form, place, 2.2 * scale, color, error.above_floor or not error.floor)
        if setting == now:
            pygame.draw.circle(frame.surface, GOLD, place, 5 * scale, max(1, scale // 2))
        if setting == self.hovered:
            pygame.draw.circle(frame.surface, PAPER, place, 4 * scale, 1)

    def _draw_name(self, frame, rect, places, known, now, scale):
        """Draw the name of one setting beside its dot.

        It is the setting under the pointer or, if there is none, the current setting. rect: rectangle of the plot;
        places: {setting: (x, y) of its dot}; known: {setting: (cost, error)}; now: the current setting; scale: frame px
        per text px.
        """
        setting = self.hovered if self.hovered in places else now if now in places else None
        if setting is None:
            return
        font, line = small_font(scale)
        cost, error = known[setting]
        base = self.surveyor.here or now
        text = f"{setting.label(base)}: {1e6 * cost.median:.0f} us, {shown(error)}"
        width = frame.measure(text, font, scale)[0]
        x, y = places[setting]
        left = min(max(rect.x + (line + 26) * scale, x - width / 2), rect.right - width - 5 * scale)
        above = (line + 6) * scale
        top = y - above if y - above > rect.y else y + 8 * scale
        box = pygame.Rect(round(left) - 2 * scale, round(top) - scale, width + 4 * scale, line * scale)
        frame.surface.fill(NIGHT, box)
        frame.text(text, round(left), round(top), GOLD if setting == now else PAPER, font, scale)

    def _draw_forms(self, frame, left, y, width, known, now, scale):
        """Draw the legend of the plot at (left, y): name and form of each kind of dot. Return the y below it.

        known: {setting: (cost, error)}; now: the current setting; scale: frame px per text px.
        """
        font, line = small_font(scale)
        base = self.surveyor.here or now
        names = dict.fromkeys(kind_of(setting, base) for setting in known if setting != base)
        x = left
        for name in names:
            word, color, form = LOOKS[name]
            wide = frame.measure(word, font, scale)[0] + 14 * scale
            if x + wide > left + width and x > left:
                x, y = left, y + (line + 1) * scale
            draw_form(frame.surface, form, (x + 3 * scale, y + 3 * scale), 2 * scale, frame.tone(color), True)
            frame.text(word, x + 7 * scale, y, FOG, font, scale)
            x += wide
        return y + (line + 3) * scale

    def _opening(self, finding):
        """Return the first sentence of the panel: on boxes and pixels in a scene with both, otherwise the finding."""
        boxes = self.survey.boxes_and_pixels() if self.shown_kind() == "verdict" else ""
        return boxes or finding or "Measuring: the answer comes in a few seconds."

    def _finding(self):
        advice = self.measuring.advice
        proven = advice[0] if advice is not None and isinstance(advice[1], float) else None
        return self.survey.finding(self.shown_kind(), self.now(), proven)

    def _draw_runs(self, frame, rect, now, scale):
        """Draw how many runs of each setting are done, while no setting has enough of them for a number."""
        base = self.surveyor.here or now
        font, line = small_font(scale)
        high = (line + 1) * scale
        for place, (setting, dot) in enumerate(self.survey.dots.items()):
            top = rect.y + place * high
            if top + high > rect.bottom:
                break
            color, form = look_of(setting, base)
            draw_form(frame.surface, form, (rect.x + 3 * scale, top + 3 * scale), 2 * scale, frame.tone(color), True)
            done = min(sum(map(len, dot.spent.values())), RUNS)
            text = f"{done} of {RUNS} runs"
            right = frame.text(text, rect.right - 2 * scale, top + scale, FOG, font, scale, "right").left
            name = shorten(setting.label(base), right - rect.x - 12 * scale, font, scale)
            frame.text(name, rect.x + 8 * scale, top + scale, FOG, font, scale)

    def _draw_list(self, frame, rect, known, now, scale):
        """Draw the list of settings, cheapest first. A line below it gives the numbers of settings that do not fit.

        known: {setting: (cost, error)}; now: the current setting; scale: frame px per text px.
        """
        base, pareto_front = self.surveyor.here or now, set(self.survey.pareto_front(self.shown_kind()))
        font, line = small_font(scale)
        high = (line + 1) * scale
        ranking = self.ranking()
        room = rect.height // high - 2  # without the heading, and the numbers of those that do not fit
        if room < 1:
            return
        frame.text("time of a step, noise, error", rect.right - 2 * scale, rect.y + scale, FOG, font, scale, "right")
        rect = pygame.Rect(rect.x, rect.y + high, rect.width, rect.height - high)
        # The selected setting stays visible.
        places = {setting: place for place, setting in enumerate(ranking)}
        here = self.hovered if self.focused and self.hovered is not None else now
        sought = places.get(here, places.get(now, 0))
        first = max(0, sought - room + 1)
        for place, setting in enumerate(ranking[first : first + room]):
            cost, error = known[setting]
            row = pygame.Rect(rect.x, rect.y + place * high, rect.width, high)
            if setting in (now, self.hovered):
                frame.surface.fill(DUSK, row)
            color, form = look_of(setting, base)
            draw_form(frame.surface, form, (row.x + 3 * scale, row.y + 3 * scale), 2 * scale, frame.tone(color), True)
            ink = GOLD if setting == now else PAPER if setting in pareto_front else FOG
            values = f"{_short(cost)}  {shown(error)}{_failed(error)}"
            right = frame.text(values, row.right - 2 * scale, row.y + scale, ink, font, scale, "right").left
            name = shorten(setting.label(base), right - row.x - 12 * scale, font, scale)
            frame.text(name, row.x + 8 * scale, row.y + scale, ink, font, scale)
            self.rows.append((row, setting))
        more = len(ranking) - first - room
        if more > 0 or first:
            y = rect.y + room * high
            less = f"{first} cheaper above" if first else ""
            rest = ", ".join(filter(None, (less, f"{more} dearer below" if more > 0 else "")))
            frame.text(rest, rect.x, y + scale, FOG, font, scale)


def kind_of(setting: Setting, base: Setting) -> str:
    """Return the name of a field in which `setting` differs from `base`: the first one in the order of LOOKS."""
    differs = setting.differs(base)
    return next(name for name in LOOKS if name in differs)


def look_of(setting: Setting, base: Setting) -> tuple[Color, str]:
    """Return (colour, form) of a setting's dot in the plot. The dot is a white circle if `setting` equals `base`.

    Otherwise, the dot shows the field in which `setting` differs from `base`. base: the setting of the state from which
    the measurements start.
    """
    return (PAPER, "circle") if setting == base else LOOKS[kind_of(setting, base)][1:]


def draw_form(
    surface: pygame.Surface, form: str, place: tuple[float, float], size: float, color: Color, full: bool
) -> None:
    """Draw the dot of a setting at the position `place` [frame px]. size: its radius [frame px].

    form: circle, square, diamond, triangle or wedge; any other name gives a cross. full: whether the dot is filled. A
    hollow dot means that the error is only an upper bound.
    """
    x, y = place
    width = 0 if full else 1
    if form == "circle":
        pygame.draw.circle(surface, color, place, size, width)
    elif form == "square":
        pygame.draw.rect(surface, color, (x - size, y - size, 2 * size, 2 * size), width)
    elif form == "diamond":
        r = 1.3 * size
        pygame.draw.polygon(surface, color, [(x, y - r), (x + r, y), (x, y + r), (x - r, y)], width)
    elif form == "triangle":
        r = 1.2 * size
        pygame.draw.polygon(surface, color, [(x, y - r), (x + r, y + size), (x - r, y + size)], width)
    elif form == "wedge":
        r = 1.2 * size
        pygame.draw.polygon(surface, color, [(x, y + r), (x + r, y - size), (x - r, y - size)], width)
    else:
        thick = max(1, round(size / 2))
        pygame.draw.line(surface, color, (x - size, y - size), (x + size, y + size), thick)
        pygame.draw.line(surface, color, (x - size, y + size), (x + size, y - size), thick)


def _stairs(pareto_front):
    """Return the points of the stepped line along the Pareto front: right from each point, then down to the next point.

    pareto_front: list of points (x, y), from left to right.
    """
    points = []
    for (x, y), (next_x, _) in zip(pareto_front, pareto_front[1:], strict=False):
        points += [(x, y), (next_x, y)]
    return [*points, pareto_front[-1]]


def _short(cost: Cost) -> str:
    return f"{number(float(f'{1e6 * cost.median:.3g}'))} us +{100 * cost.noise:.0f}%"


def _failed(error: Error) -> str:
    """Return the numbers of failures as text to be appended to the error; "" if there are none."""
    return "".join(f", {count} {name.replace('_', ' ')}" for name, count in error.failures.items())
