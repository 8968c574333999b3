"""The settings: a list of pages at the left, the rows of the marked page at the right. Changes take effect at once."""

from collections.abc import Callable

import pygame

from game.drawing.canvas import SMALL, Canvas, wrap
from game.drawing.colors import FOG, GOLD, PAPER
from game.drawing.nine_slice import draw_box
from game.files.settings import Settings
from game.input.bindings import key_name, shown
from game.input.devices import DeviceSource
from game.input.inputs import InputState
from game.input.rebinding import rebind
from game.screens.parts.background import MARGIN, Background, DuskBackground, draw_page
from game.screens.parts.rows import Row, RowList, confirmed
from game.screens.parts.settings_rows import PAGES, rows_of
from game.screens.screen import CanvasScreen

LIST = pygame.Rect(MARGIN, MARGIN, 136, 254)
PAGE = pygame.Rect(LIST.right + MARGIN, MARGIN, 320, 254)
HINT_Y = 205
FOOT = "Enter opens   Esc back"
VALUE_FOOT = "\u2190 \u2192 change   or click left and right on a value"
BINDING_FOOT = "Enter or click, then press the new one   Esc keeps the old"


class SettingsScreen(CanvasScreen):
    """Editor of a Settings object. `outcome`, the request for the next screen, becomes ("back",).

    changed() is called after each change, and saved() when the screen is left. page: name of the page to open first,
    with the keyboard focus on its rows; None puts the focus on the list of pages.
    """

    def __init__(
        self,
        settings: Settings,
        devices: DeviceSource,
        changed: Callable[[], None] = lambda: None,
        ground: Background | None = None,
        page: str | None = None,
        saved: Callable[[], None] = lambda: None,
    ) -> None:
        super().__init__()
        self.settings, self.devices, self.changed, self.saved = settings, devices, changed, saved
        self.ground = ground or DuskBackground()
        self.pages = RowList(
            self._page_rows,
            (LIST.x + 16, LIST.y + 36, LIST.width - 32, 192),
            self.cues,
            PAGES.index(page) if page else 0,
        )
        self.list = RowList(self._rows, (PAGE.x + 16, PAGE.y + 12, PAGE.width - 32, 192), self.cues)
        self.inside = page is not None  # the keys operate the page, not the list of pages
        self.waiting_for = None  # (device, action) that waits for its new key or button
        self.message = ""
        self.time = 0.0

    @property
    def page(self) -> str | None:
        """Name of the settings page that is marked in the list; None if Back is marked."""
        return PAGES[self.pages.mark] if self.pages.mark < len(PAGES) else None

    def _page_rows(self):
        return [*(Row(page, press=self._enter) for page in PAGES), Row("Back", press=self._leave)]

    def _rows(self):
        return rows_of(self.page, self.settings, self._change, self._wait) if self.page else []

    def _enter(self):
        self.inside = True
        self.list.mark = 0
        self.list.show_marked()

    def _leave(self):
        self.outcome = ("back",)

    def _change(self):
        self.message = ""
        self.changed()

    def _wait(self, device, action):
        self.waiting_for = device, action
        self.message = ""

    def close(self) -> None:
        """Call saved(), which writes the settings to their file."""
        self.saved()

    def feed(self, event: pygame.event.Event) -> bool:
        """Bind the key or button of this event to an action, if the screen is waiting for one.

        Return whether the event was used.
        """
        if self.waiting_for is None:
            return False
        device, action = self.waiting_for
        button = self.devices.pressed_button(event)
        if event.type == pygame.KEYDOWN and (device == "keys" or event.key == pygame.K_ESCAPE):
            control = key_name(event.key)
        elif button is not None and (device == "buttons" or button in ("b", "back")):
            control = button if device == "buttons" else "escape"
        elif event.type == pygame.MOUSEBUTTONDOWN:
            control = "escape"
        else:
            return event.type in (pygame.KEYDOWN, pygame.KEYUP)
        self.waiting_for = None
        if control == "escape":
            self.message = f"{action} stays as it was."
        else:
            self.message = rebind(getattr(self.settings, device), device, action, control)
            self.changed()
        self.cues.append("back" if control == "escape" else "confirm")
        self.devices.release_all()
        return True

    def step(self, inputs: InputState, dt: float) -> None:
        """Process the player's input of a step of `dt` [s], and advance the background.

        While the screen waits for a key or button to bind, the input is ignored.
        """
        self.time += dt
        if self.waiting_for is not None:
            return
        if inputs.pointer_pressed or inputs.pointer != self.pages.pointer:
            if LIST.collidepoint(inputs.pointer):
                self.inside = False
            elif PAGE.collidepoint(inputs.pointer) and self.page and self.pages.pointer is not None:
                self.inside = True
        if inputs.pressed("cancel"):
            self.cues.append("back")
            if self.inside:
                self.inside = False
            else:
                self._leave()
        elif self.inside:
            self.pages.pointer = inputs.pointer
            self.list.step(inputs, dt)
        elif self.page and inputs.pressed("right") and not confirmed(inputs):
            self.cues.append("confirm")
            self._enter()
        else:
            before = self.page
            self.pages.step(inputs, dt)
            self.list.pointer = inputs.pointer
            if self.page != before:
                self.message = ""
                self.list.mark = self.list.first = 0
                self.list.show_marked()

    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw the list of pages and the marked page."""
        self.ground.draw(canvas, self.time)
        draw_page(canvas, LIST, "Settings", FOOT)
        self.pages.draw(canvas, not self.inside)
        draw_box(canvas, PAGE)
        if self.page is None:
            return
        self.list.draw(canvas, self.inside)
        color, text = PAPER, self.message
        if self.waiting_for is not None:
            device, action = self.waiting_for
            kind = "key" if device == "keys" else "button"
            old = shown(getattr(self.settings, device)[action][0])
            color, text = GOLD, f"Press the new {kind} for {action}.   Esc keeps {old}."
        elif not text and self.inside and self.list.marked is not None:
            color, text = FOG, self.list.marked.hint
        for number, line in enumerate(wrap(text, PAGE.width - 32)):
            canvas.text(line, PAGE.x + 16, HINT_Y + 12 * number, color)
        foot = BINDING_FOOT if self.page in ("Keyboard", "Controller") else VALUE_FOOT
        canvas.text(foot, PAGE.centerx, PAGE.bottom - 13, FOG, SMALL, 1, "center")
