"""Which keys and buttons mean which actions. A key may mean several: Space fires, jumps and confirms nothing."""

import pygame

from game.inputs import ACTIONS

DEFAULT_KEYS = {
    "left": ("left", "a"), "right": ("right", "d"), "up": ("up", "w"), "down": ("down", "s"),
    "fire": ("space", "z"), "jump": ("space", "x"), "focus": ("left shift", "right shift"),
    "confirm": ("return", "keypad enter"), "cancel": ("escape", "backspace"), "pause": ("p",),
}
# Buttons by their place on an Xbox pad, as SDL names them on every pad it knows.
CONTROLLER_BUTTONS = {
    pygame.CONTROLLER_BUTTON_A: ("fire", "jump", "confirm"),
    pygame.CONTROLLER_BUTTON_B: ("cancel",),
    pygame.CONTROLLER_BUTTON_X: ("fire",),
    pygame.CONTROLLER_BUTTON_LEFTSHOULDER: ("focus",),
    pygame.CONTROLLER_BUTTON_RIGHTSHOULDER: ("focus",),
    pygame.CONTROLLER_BUTTON_START: ("pause",),
    pygame.CONTROLLER_BUTTON_DPAD_LEFT: ("left",),
    pygame.CONTROLLER_BUTTON_DPAD_RIGHT: ("right",),
    pygame.CONTROLLER_BUTTON_DPAD_UP: ("up",),
    pygame.CONTROLLER_BUTTON_DPAD_DOWN: ("down",),
}
# A pad that SDL has no mapping for: the first four buttons and the first stick.
JOYSTICK_BUTTONS = {0: ("fire", "jump", "confirm"), 1: ("cancel",), 2: ("fire",), 3: ("focus",), 7: ("pause",)}
AXES = {0: ("left", "right"), 1: ("up", "down")}
DEAD_ZONE = 0.25        # of the stick's travel; Celeste's value: less and worn sticks drift


def key_codes(names):
    """{action: names} -> {key code: actions}. An unknown key name or action raises ValueError naming it."""
    table = {}
    for action, keys in names.items():
        if action not in ACTIONS:
            raise ValueError(f"action must be one of {', '.join(ACTIONS)} (got {action!r})")
        for key in keys:
            table.setdefault(_code(key), []).append(action)
    return {code: tuple(actions) for code, actions in table.items()}


def _code(key):
    """The key code of a pygame key name. The table is pygame's constants, so that no display is needed."""
    name = {"left shift": "LSHIFT", "right shift": "RSHIFT", "keypad enter": "KP_ENTER"}.get(key, key)
    for spelling in (name.upper(), name.lower()):
        code = getattr(pygame, f"K_{spelling}", None)
        if code is not None:
            return code
    raise ValueError(f"no key is called {key!r}; examples: a, space, left shift, f1")
