"""Rebinding of actions to other keys and buttons (controls).

A fixed control is rejected. If another action has the control, the two actions exchange controls.
"""

from string import ascii_lowercase

from game.input.bindings import (
    BUTTON_NAMES,
    DEFAULT_BUTTONS,
    DEFAULT_KEYS,
    FIXED_KEYS,
    SHELL_BUTTONS,
    SHELL_KEYS,
    Table,
    rivals,
    shown,
)

FIXED = {"keys": {*SHELL_KEYS, *(key for keys in FIXED_KEYS.values() for key in keys)}, "buttons": set(SHELL_BUTTONS)}
DEFAULTS = {"keys": DEFAULT_KEYS, "buttons": DEFAULT_BUTTONS}
SPARE = {"keys": tuple(ascii_lowercase), "buttons": BUTTON_NAMES}


def rebind(table: dict[str, list[str]], device: str, action: str, control: str | None) -> str:
    """Make `control` the first control of `action` in a table {action: controls}. Return a line of text for the player.

    device: "keys" or "buttons"; control: None for a key without a name. If another action has `control` and cannot
    share it (see bindings.rivals), that action gets the former first control of `action` instead. The table is not
    changed if an action would have no control.
    """
    if control is None:
        return "That key has no name here. Choose another."
    if control in FIXED[device]:
        return f"{shown(control)} always does the same and cannot be taken."
    own = table[action]
    if control in own:
        table[action] = [control, *(each for each in own if each != control)]
        return f"{action}: {shown(control)}"
    given_up = own[0]
    new = {name: list(controls) for name, controls in table.items()}
    new[action] = [control, *own[1:]]
    said = [f"{action}: {shown(control)}."]
    for other in table:
        if rivals(action, other) and control in table[other]:
            line = _make_room(new, device, other, control, given_up)
            if line is None:
                return f"{shown(control)} is all that {other} has, and nothing else is free."
            said.append(line)
    table.update(new)
    return " ".join(said)


def _make_room(table, device, other, control, given_up):
    """Take `control` away from the action `other` in a table {action: controls}, and give the action another control.

    given_up: control that is no longer used, because its action gets `control`. It is tried first. If `other` has
    further controls, no other replacement is tried. device: "keys" or "buttons". Return the line for the player; None
    if `other` would have no control.
    """
    place = table[other].index(control)
    rest = [each for each in table[other] if each != control]
    choices = (given_up,) if rest else (given_up, *DEFAULTS[device][other], *SPARE[device])
    instead = next((each for each in choices if _is_free(table, device, other, each)), None)
    if instead is None and not rest:
        return None
    table[other] = rest
    if instead is None:
        return f"{other} keeps {shown(rest[0])}."
    table[other].insert(place, instead)
    return f"{other} now has {shown(instead)}."


def _is_free(table, device, action, control):
    """Return whether `control` can be assigned to `action` in a table {action: controls}. device: "keys" or "buttons".

    False if the control is fixed, already belongs to the action, or belongs to an action that cannot share it (see
    bindings.rivals).
    """
    taken = FIXED[device].union(*(controls for name, controls in table.items() if rivals(action, name)), table[action])
    return control not in taken


def clash(table: Table) -> tuple[str, str, str] | None:
    """Return (action, other action, control) of the first conflict in a table {action: controls}, or None.

    A conflict is a control of two actions that the same game uses.
    """
    for action in table:
        for other in table:
            if rivals(action, other):
                for control in table[action]:
                    if control in table[other]:
                        return action, other, control
    return None


def default_table(device: str) -> dict[str, list[str]]:
    """Return a new copy of the default bindings {action: controls} of a device, "keys" or "buttons"."""
    return {action: list(controls) for action, controls in DEFAULTS[device].items()}


def completed(table: Table, device: str) -> dict[str, list[str]]:
    """Return a copy of a table {action: controls} in which every action has a control. device: "keys" or "buttons".

    The table may lack an action, for example if it was read from an older file. Such an action gets its default
    controls, without those that conflict with another action. If all of them conflict, it gets one spare control.
    """
    full = {}
    for action in DEFAULTS[device]:
        full[action] = list(table[action]) if action in table else []
    for action, controls in full.items():
        if not controls:
            wanted = [
                each for each in (*DEFAULTS[device][action], *SPARE[device]) if _is_free(full, device, action, each)
            ]
            known = [each for each in wanted if each in DEFAULTS[device][action]]
            full[action] = known or wanted[:1]
    return full
