"""The scene menu: keyboard, controller and mouse."""

import pygame

from game.backdrop import Backdrop
from game.boxes import draw_box
from game.colors import DUSK, FOG, GOLD, PAPER, SKY
from game.draw import SMALL, TEXT, wrap
from game.sprites import load_atlas

FIRST_WAIT, NEXT_WAIT = 0.4, 0.1       # [s] before a held direction repeats, and between repeats
LIST_X, LIST_WIDTH, ABOUT_X = 26, 168, 222
TOP, BOTTOM, LINE = 88, 244, 17        # of the list; what does not fit is scrolled to
GROUPS = {"": "GAMES", "lab": "LAB"}   # by the part of a scene's name before the slash


class Repeat:
    """Turns a held direction into single moves."""

    def __init__(self, names):
        self.names = names         # (action for -1, action for +1)
        self.wait = 0.0

    def move(self, inputs, dt):
        """-1, 0 or +1 in this step."""
        back, forth = self.names
        for action, way in ((back, -1), (forth, 1)):
            if inputs.pressed(action):
                self.wait = FIRST_WAIT
                return way
        way = inputs.held(forth) - inputs.held(back)
        if way == 0:
            return 0
        self.wait -= dt
        if self.wait > 0.0:
            return 0
        self.wait += NEXT_WAIT
        return way


class Menu:
    """Chooses a scene. `outcome` becomes ("play", name), ("options",), ("title",)."""

    shows_pointer = True

    def __init__(self, registry, chosen=None):
        self.entries = [(c.name, c.title, c.about, c.features, c.effects.names()) for c in registry.all_classes()]
        self.entries.append(("options", "Options", "Window, sound and keys.", (), ()))
        self.mark = next((i for i, entry in enumerate(self.entries) if entry[0] == chosen), 0)
        self.backdrop = Backdrop()
        self.logo = load_atlas("ui")["logo"]
        self.repeat = Repeat(("up", "down"))
        self.rows = self._layout()
        self.scroll = 0                # [px] how far the list is pushed up
        self._show_marked()
        self.pointer = None
        self.time = 0.0
        self.outcome = None

    def _layout(self):
        """(rect per entry, heading rows) from top to bottom; a heading where the group changes."""
        rects, self.headings, y, group = [], [], 0, None
        for name, *_ in self.entries:
            own = "options" if name == "options" else name.split("/")[0] if "/" in name else ""
            if own != group:
                y += 6 if group is not None else 0
                if own in GROUPS:
                    self.headings.append((GROUPS[own], y))
                    y += 12
                group = own
            rects.append(pygame.Rect(LIST_X, y, LIST_WIDTH, LINE - 2))
            y += LINE
        return rects

    @property
    def places(self):
        """Where each entry is on the canvas now, None for those scrolled out of sight."""
        moved = [rect.move(0, TOP - self.scroll) for rect in self.rows]
        return [rect if TOP <= rect.top and rect.bottom <= BOTTOM else None for rect in moved]

    def _show_marked(self):
        """Scroll as little as brings the marked entry, and a heading right above it, into sight."""
        rect = self.rows[self.mark]
        top = min([rect.top, *(y for _, y in self.headings if 0 < rect.top - y <= LINE)])
        self.scroll = max(min(self.scroll, top), rect.bottom - (BOTTOM - TOP))

    def step(self, inputs, dt):
        """One fixed step."""
        self.time += dt
        way = self.repeat.move(inputs, dt)
        self.mark = (self.mark + way) % len(self.entries)
        if way:
            self._show_marked()
        hidden = max(0, self.rows[-1].bottom - (BOTTOM - TOP))
        self.scroll = max(0, min(hidden, self.scroll - inputs.wheel * LINE))
        under = next((i for i, rect in enumerate(self.places) if rect and rect.collidepoint(inputs.pointer)), None)
        if inputs.pointer != self.pointer and under is not None:
            self.mark = under          # only a pointer that moves takes the mark from the keys
        self.pointer = inputs.pointer
        clicked = inputs.pointer_pressed and under is not None
        if clicked:
            self.mark = under
        if clicked or inputs.pressed("confirm"):
            name = self.entries[self.mark][0]
            self.outcome = ("options",) if name == "options" else ("play", name)
        elif inputs.pressed("cancel"):
            self.outcome = ("title",)

    def draw(self, canvas, alpha):
        """Draw the picture."""
        self.backdrop.draw(canvas, self.time * 20.0, dim=14)
        canvas.surface.blit(self.logo, (118, 2))
        high = min(BOTTOM - TOP, self.rows[-1].bottom)
        draw_box(canvas, (LIST_X - 12, TOP - 12, LIST_WIDTH + 24, high + 24))
        for text, y in self.headings:
            if 0 <= y - self.scroll <= high - 7:
                canvas.text(text, LIST_X, TOP + y - self.scroll, GOLD, SMALL)
        for index, (rect, entry) in enumerate(zip(self.places, self.entries, strict=True)):
            if rect is None:
                continue
            marked = index == self.mark
            if marked:
                canvas.surface.fill(DUSK, rect)
                canvas.surface.fill(GOLD, (rect.x, rect.y, 2, rect.height))
            canvas.text(entry[1], rect.x + 8, rect.y + 4, PAPER if marked else FOG, TEXT)
        self._draw_bar(canvas.surface, high)
        self._draw_about(canvas, self.entries[self.mark])
        canvas.text("arrows choose, Enter plays, Esc back", LIST_X, 258, FOG, SMALL, outline=True)

    def _draw_bar(self, surface, high):
        """How much of the list is in sight, and which part."""
        whole = self.rows[-1].bottom
        if whole > high:
            surface.fill(DUSK, (LIST_X + LIST_WIDTH + 4, TOP, 2, high))
            top = TOP + round(self.scroll * high / whole)
            surface.fill(GOLD, (LIST_X + LIST_WIDTH + 4, top, 2, round(high * high / whole)))

    def _draw_about(self, canvas, entry):
        name, title, about, features, effects = entry
        width = canvas.rect.right - ABOUT_X - 22
        lines = [(title, GOLD, TEXT), *((line, PAPER, TEXT) for line in wrap(about, width - 24))]
        lines += [("", FOG, SMALL)] if features else []
        for feature in features:
            first, *rest = wrap(feature, width - 34, SMALL)
            lines += [(f"- {first}", PAPER, SMALL), *((f"  {line}", PAPER, SMALL) for line in rest)]
        if effects:
            lines += [("", FOG, SMALL)]
            lines += [(line, SKY, SMALL) for line in wrap("effects: " + ", ".join(effects), width - 24, SMALL)]
        height = sum(13 if font == TEXT else 8 for _, _, font in lines) + 24
        box = pygame.Rect(ABOUT_X, TOP - 12, width, height)
        draw_box(canvas, box)
        y = box.y + 12
        for text, color, font in lines:
            if text:
                canvas.text(text, box.x + 12, y, color, font)
            y += 13 if font == TEXT else 8
