"""Bindings of keys and buttons to actions, stored as readable names that a settings file can contain.

One key may have several actions (Space fires and jumps), as long as no game uses both actions (see `rivals`).
"""

from collections.abc import Iterable, Mapping, Sequence

import pygame

from game.input.inputs import ACTIONS

Table = Mapping[str, Sequence[str]]  # action -> names of keys or buttons

# Bindings that a player may change. The settings show and change the first name of each.
DEFAULT_KEYS = {
    "left": ("left", "a"),
    "right": ("right", "d"),
    "up": ("up", "w"),
    "down": ("down", "s"),
    "fire": ("space", "z"),
    "jump": ("space", "x"),
    "focus": ("left shift", "right shift"),
    "bomb": ("x", "left ctrl"),
}
DEFAULT_BUTTONS = {
    "left": ("dpad left",),
    "right": ("dpad right",),
    "up": ("dpad up",),
    "down": ("dpad down",),
    "fire": ("a", "x"),
    "jump": ("a",),
    "focus": ("left shoulder", "right shoulder", "left trigger"),
    "bomb": ("b", "right trigger"),
}
REBOUND = tuple(DEFAULT_KEYS)
# Fixed bindings, so that menus always work and the way out is never lost.
FIXED_KEYS = {"confirm": ("return", "keypad enter"), "cancel": ("escape", "backspace"), "pause": ("p",)}
SHELL_KEYS = ("tab", "f11", "f12")  # panel, full screen, screenshot
FIXED_BUTTONS = {"confirm": ("a", "start"), "cancel": ("b", "back")}
SHELL_BUTTONS = ("start", "back", "y", "guide")  # pause menu, freeze, panel
# No game uses actions of two of these sets together.
USED_TOGETHER = (
    {"left", "right", "up", "down", "fire", "focus", "bomb"},
    {"left", "right", "up", "down", "jump", "focus"},
)

# Buttons by their place on an Xbox pad, as SDL names them on every pad with a mapping.
CONTROLLER_NAMES = {
    pygame.CONTROLLER_BUTTON_A: "a",
    pygame.CONTROLLER_BUTTON_B: "b",
    pygame.CONTROLLER_BUTTON_X: "x",
    pygame.CONTROLLER_BUTTON_Y: "y",
    pygame.CONTROLLER_BUTTON_BACK: "back",
    pygame.CONTROLLER_BUTTON_START: "start",
    pygame.CONTROLLER_BUTTON_GUIDE: "guide",
    pygame.CONTROLLER_BUTTON_LEFTSTICK: "left stick",
    pygame.CONTROLLER_BUTTON_RIGHTSTICK: "right stick",
    pygame.CONTROLLER_BUTTON_LEFTSHOULDER: "left shoulder",
    pygame.CONTROLLER_BUTTON_RIGHTSHOULDER: "right shoulder",
    pygame.CONTROLLER_BUTTON_DPAD_LEFT: "dpad left",
    pygame.CONTROLLER_BUTTON_DPAD_RIGHT: "dpad right",
    pygame.CONTROLLER_BUTTON_DPAD_UP: "dpad up",
    pygame.CONTROLLER_BUTTON_DPAD_DOWN: "dpad down",
}
TRIGGER_NAMES = {
    pygame.CONTROLLER_AXIS_TRIGGERLEFT: "left trigger",
    pygame.CONTROLLER_AXIS_TRIGGERRIGHT: "right trigger",
}
# A pad without an SDL mapping: most number their buttons in this order.
JOYSTICK_NAMES = {0: "a", 1: "b", 2: "x", 3: "y", 4: "left shoulder", 5: "right shoulder", 6: "back", 7: "start"}
BUTTON_NAMES = (*CONTROLLER_NAMES.values(), *TRIGGER_NAMES.values())
AXES = {0: ("left", "right"), 1: ("up", "down")}  # of the stick, which always steers
DEAD_ZONE = 0.25  # of the stick's travel; Celeste's value: with less, worn sticks drift

# pygame's constants for keys with another name in the settings.
SPELLED = {
    "left shift": "LSHIFT",
    "right shift": "RSHIFT",
    "left ctrl": "LCTRL",
    "right ctrl": "RCTRL",
    "left alt": "LALT",
    "right alt": "RALT",
    "keypad enter": "KP_ENTER",
}
PICTURED = {
    "left": "\u2190",
    "right": "\u2192",
    "up": "\u2191",
    "down": "\u2193",
    "dpad left": "pad \u2190",
    "dpad right": "pad \u2192",
    "dpad up": "pad \u2191",
    "dpad down": "pad \u2193",
    "left shift": "L shift",
    "right shift": "R shift",
    "left ctrl": "L ctrl",
    "right ctrl": "R ctrl",
    "left alt": "L alt",
    "right alt": "R alt",
    "left shoulder": "LB",
    "right shoulder": "RB",
    "left trigger": "LT",
    "right trigger": "RT",
    "left stick": "L stick",
    "right stick": "R stick",
}
# A game's word for an action in its line of keys, if it differs from the action's name.
CALLED = {"line": "bomb", "throw": "focus"}
_NAMES = {}  # key code -> name, filled at the first call


def rivals(action: str, other: str) -> bool:
    """Return whether any game uses both actions. If so, the two actions cannot share a key."""
    return action != other and any(action in game and other in game for game in USED_TOGETHER)


def key_codes(names: Table) -> dict[int, tuple[str, ...]]:
    """Return {key code: actions} of the given bindings and of the keys that cannot be rebound.

    names: {action: names of keys}. Raises ValueError for an unknown name.
    """
    return _turned({**names, **FIXED_KEYS}, _code)


def button_actions(names: Table) -> dict[str, tuple[str, ...]]:
    """Return {button name: actions} of the given bindings and of the buttons that cannot be rebound.

    names: {action: names of buttons}. Raises ValueError for an unknown name.
    """
    return _turned({**names, **FIXED_BUTTONS}, _button)


def _turned(names, read):
    table = {}
    for action, controls in names.items():
        if action not in ACTIONS:
            raise ValueError(f"action must be one of {', '.join(ACTIONS)} (got {action!r})")
        for control in controls:
            table.setdefault(read(control), []).append(action)
    return {control: tuple(actions) for control, actions in table.items()}


def _code(key: str) -> int:
    """Return the key code of a key name. The code is read from pygame's constants, so that no display is needed."""
    name = SPELLED.get(key, key)
    for spelling in (name.upper(), name.lower()):
        code = getattr(pygame, f"K_{spelling}", None)
        if code is not None:
            return code
    raise ValueError(f"no key is called {key!r}; examples: a, space, left shift, f1")


def _button(name):
    if name not in BUTTON_NAMES:
        raise ValueError(f"no button is called {name!r}; valid: {', '.join(BUTTON_NAMES)}")
    return name


def key_name(code: int) -> str | None:
    """Return the name of a key code, as used in the settings; None for a key without such a name."""
    if not _NAMES:
        spelled = {constant: name for name, constant in SPELLED.items()}
        for constant in dir(pygame):
            if constant.startswith("K_") and constant != "K_UNKNOWN":  # K_UNKNOWN is every key without a name
                _NAMES.setdefault(getattr(pygame, constant), spelled.get(constant[2:], constant[2:].lower()))
    return _NAMES.get(code)


def shown(control: str) -> str:
    """Return the text that is displayed for a control, a key or a button."""
    return PICTURED.get(control, control.capitalize())


def help_pairs(actions: Iterable[tuple[str, str]], table: Table) -> list[tuple[str, str]]:
    """Return (control, effect) pairs for the help line, with the controls that the player has bound.

    actions: as Scene.actions; table: {action: names of keys or buttons}.
    """
    pairs = []
    steering = [table[action][0] for action in ("left", "right", "up", "down")]
    for key, what in actions:
        action = CALLED.get(what, what)
        if action in table:
            key = shown(table[action][0])
        elif key.lower() == "arrows" and steering != ["left", "right", "up", "down"]:
            key = " ".join(shown(each) for each in steering)
        pairs.append((key, what))
    return pairs
