"""Options: window, sound, shake and keys. Every change is saved when the screen is left."""

import pygame

from game.backdrop import Backdrop
from game.bindings import DEFAULT_KEYS
from game.boxes import draw_box
from game.colors import DUSK, FOG, GOLD, PAPER, SKY
from game.draw import SMALL, TEXT
from game.menu import Repeat

REBOUND = ("left", "right", "up", "down", "fire", "jump", "focus")     # the rest stays, so that menus always work
TOP, LINE, LEFT, WIDTH = 42, 15, 100, 280


class Options:
    """Works on a Settings object. `outcome` becomes ("menu", "options"); the app saves and applies."""

    shows_pointer = True

    def __init__(self, settings):
        self.settings = settings
        self.backdrop = Backdrop()
        self.vertical, self.sideways = Repeat(("up", "down")), Repeat(("left", "right"))
        self.mark = 0
        self.waiting_for = None        # the action whose next key press is its new key
        self.pointer = None
        self.time = 0.0
        self.outcome = None

    def rows(self):
        """(label, value, what turning it by -1 or +1 does)."""
        s = self.settings
        scale = "fit" if s.window_scale == 0 else f"x{s.window_scale}"
        rows = [
            ("Window size", scale, lambda way: setattr(s, "window_scale", (s.window_scale + way) % 9)),
            ("Full screen", "on" if s.fullscreen else "off", lambda way: setattr(s, "fullscreen", not s.fullscreen)),
            ("Sound", f"{s.volume:.0%}", self._turn_volume),
            ("Screen shake", "on" if s.shake else "off", lambda way: setattr(s, "shake", not s.shake)),
            ("Show frame rate", "on" if s.show_fps else "off", lambda way: setattr(s, "show_fps", not s.show_fps)),
        ]
        for action in REBOUND:
            value = "press a key" if self.waiting_for == action else s.keys[action][0]
            rows.append((f"Key: {action}", value, lambda way, action=action: self._wait(action)))
        rows.append(("All keys as they were", "", lambda way: s.keys.update(
            {action: list(keys) for action, keys in DEFAULT_KEYS.items()})))
        rows.append(("Back", "", lambda way: self._leave()))
        return rows

    def _turn_volume(self, way):
        self.settings.volume = round(min(1.0, max(0.0, self.settings.volume + way / 10)), 1)

    def _wait(self, action):
        self.waiting_for = action

    def _leave(self):
        self.outcome = ("menu", "options")

    def feed(self, event):
        """Catch the key that an action is waiting for; True if the event is used up."""
        if self.waiting_for is None or event.type != pygame.KEYDOWN:
            return False
        action, self.waiting_for = self.waiting_for, None
        if event.key not in (pygame.K_ESCAPE, pygame.K_TAB):
            self._bind(action, key_spelling(event.key))
        return True

    def _bind(self, action, key):
        """Give the key to the action. Who had it takes over the old one, so that no action is left without."""
        if key is None:
            return
        keys = self.settings.keys
        old = keys[action][0]
        for other in REBOUND:
            shared = key in DEFAULT_KEYS[other] and key in DEFAULT_KEYS[action]      # Space fires and jumps
            if other != action and keys[other][0] == key and not shared:
                keys[other] = [old, *[k for k in keys[other][1:] if k != old]]
        keys[action] = [key, *[k for k in keys[action][1:] if k != key]]

    def step(self, inputs, dt):
        """One fixed step."""
        self.time += dt
        if self.waiting_for is not None:
            return
        rows = self.rows()
        self.mark = (self.mark + self.vertical.move(inputs, dt)) % len(rows)
        under = next((i for i in range(len(rows)) if self._place(i).collidepoint(inputs.pointer)), None)
        if inputs.pointer != self.pointer and under is not None:
            self.mark = under
        self.pointer = inputs.pointer
        way = self.sideways.move(inputs, dt)
        pressed = inputs.pressed("confirm") or (inputs.pointer_pressed and under == self.mark)
        if inputs.pressed("cancel"):
            self._leave()
        elif pressed or (way and rows[self.mark][1]):
            rows[self.mark][2](way or 1)

    def _place(self, index):
        return pygame.Rect(LEFT, TOP + index * LINE, WIDTH, LINE - 1)

    def draw(self, canvas, alpha):
        """Draw the picture."""
        self.backdrop.draw(canvas, self.time * 20.0, dim=40)
        draw_box(canvas, (LEFT - 14, 8, WIDTH + 28, 250))
        canvas.text("OPTIONS", canvas.rect.centerx, 18, GOLD, TEXT, 2, "center")
        for index, (name, value, _) in enumerate(self.rows()):
            rect = self._place(index)
            if index == self.mark:
                canvas.surface.fill(DUSK, rect)
                canvas.surface.fill(GOLD, (rect.x, rect.y, 2, rect.height))
            color = PAPER if index == self.mark else FOG
            canvas.text(name, rect.x + 8, rect.y + 3, color, TEXT)
            if value:
                canvas.text(value, rect.right - 8, rect.y + 3, SKY, TEXT, 1, "right")
        canvas.text("left and right change, Esc saves and goes back", canvas.rect.centerx, 260, FOG, SMALL, 1, "center",
                    True)


def key_spelling(code):
    """A key code as settings spell it, or None for a key without a plain name."""
    for name in dir(pygame):
        if name.startswith("K_") and getattr(pygame, name) == code:
            spelled = name[2:].lower()
            return {"lshift": "left shift", "rshift": "right shift", "kp_enter": "keypad enter"}.get(spelled, spelled)
    return None
