"""Keyboard, mouse and controllers as one source of InputFrames, fed by pygame events only.

pygame.key.get_pressed() is not used: posted events do not change it, and a tap that begins and ends between two steps
would be lost. Pads are keyed by instance id, which is unique while the program runs. Device indexes change and are
reused.
"""

from collections.abc import Callable

import pygame

from game.input.bindings import (
    AXES,
    CONTROLLER_NAMES,
    DEAD_ZONE,
    DEFAULT_BUTTONS,
    DEFAULT_KEYS,
    JOYSTICK_NAMES,
    TRIGGER_NAMES,
    Table,
    button_actions,
    key_codes,
)
from game.input.inputs import InputFrame
from game.input.pads import Pads

STICK = {pygame.CONTROLLER_AXIS_LEFTX: AXES[0], pygame.CONTROLLER_AXIS_LEFTY: AXES[1]}
STICK_RANGE = 32767.0  # CONTROLLERAXISMOTION has 16 bits
PULLED = 0.5  # of a trigger's travel, from which it counts as a button


class DeviceSource:
    """Source of the input of all devices: keyboard, mouse and controllers.

    to_canvas(position): function that maps a window position of the pointer to the canvas. pads: object that opens the
    controllers (see Pads), or None.
    """

    def __init__(
        self,
        to_canvas: Callable[[tuple[int, int]], tuple[float, float]] = lambda position: position,
        keys: Table | None = None,
        pads: Pads | None = None,
        buttons: Table | None = None,
    ) -> None:
        self.to_canvas = to_canvas
        self.bind(keys or DEFAULT_KEYS, buttons or DEFAULT_BUTTONS)
        self.menus = False  # True: menus use the default keys and buttons, whatever was rebound
        self.pads = pads
        self.held = {}  # (device, control) -> actions
        self.tapped = set()  # actions that went down since the last step
        self.pointer = (0, 0)
        self.pointer_down = self.pointer_tapped = False
        self.wheel = 0
        self.changes = []
        self.lost_pad = False  # a pad was pulled out; the app pauses and resets this

    def bind(self, keys: Table, buttons: Table) -> None:
        """Replace the bindings of the keys and of the buttons.

        keys, buttons: tables {action: names of keys or buttons}.
        """
        self.keys, self.buttons = key_codes(keys), button_actions(buttons)
        self.menu_keys = {**self.keys, **key_codes(DEFAULT_KEYS)}
        self.menu_buttons = {**self.buttons, **button_actions(DEFAULT_BUTTONS)}

    def change(self, name: str, value: object) -> None:
        """Queue a change of the simulation, made in the panel or with a key, for the next step."""
        self.changes.append((name, value))

    def next(self, scene: object | None = None) -> InputFrame:
        """Return the InputFrame of the next step. scene: not used.

        An action that was pressed and released between two steps counts as held in the next step.
        """
        actions = frozenset(self.tapped.union(*self.held.values()) if self.held else self.tapped)
        down = self.pointer_down or self.pointer_tapped
        frame = InputFrame(actions, self.pointer, down, self.wheel, tuple(self.changes))
        self.tapped.clear()
        self.changes.clear()
        self.pointer_tapped, self.wheel = False, 0
        return frame

    def release_all(self) -> None:
        """Clear all held actions. This is called when the window loses focus or another screen opens."""
        self.held.clear()
        self.tapped.clear()
        self.pointer_down = self.pointer_tapped = False

    def feed(self, event: pygame.event.Event) -> None:
        """Process one pygame event."""
        kind = event.type
        if kind == pygame.KEYDOWN:
            keys = self.menu_keys if self.menus else self.keys
            self._press(("key", event.key), keys.get(event.key, ()))
        elif kind == pygame.KEYUP:
            self._release(("key", event.key))
        elif kind == pygame.MOUSEMOTION:
            self.pointer = tuple(int(v) for v in self.to_canvas(event.pos))
        elif kind == pygame.MOUSEBUTTONDOWN and event.button == 1:
            self.pointer = tuple(int(v) for v in self.to_canvas(event.pos))
            self.pointer_down = self.pointer_tapped = True
        elif kind == pygame.MOUSEBUTTONUP and event.button == 1:
            self.pointer_down = False
        elif kind == pygame.MOUSEWHEEL:
            self.wheel += event.y
        elif kind == pygame.WINDOWFOCUSLOST:
            self.release_all()
        else:
            self._feed_pad(event)

    def button_of(self, event: pygame.event.Event) -> tuple[int, str, bool] | None:
        """Return (pad id, name of the button, whether the button is down) of a button event; None for other events.

        A trigger counts as a button. It is down beyond the fraction PULLED of its travel.
        """
        kind = event.type
        if kind in (pygame.CONTROLLERBUTTONDOWN, pygame.CONTROLLERBUTTONUP) and event.button in CONTROLLER_NAMES:
            return event.instance_id, CONTROLLER_NAMES[event.button], kind == pygame.CONTROLLERBUTTONDOWN
        if kind == pygame.CONTROLLERAXISMOTION and event.axis in TRIGGER_NAMES:
            return event.instance_id, TRIGGER_NAMES[event.axis], event.value > PULLED * STICK_RANGE
        if kind in (pygame.JOYBUTTONDOWN, pygame.JOYBUTTONUP) and event.button in JOYSTICK_NAMES:
            if not self._is_mapped(event.instance_id):
                return event.instance_id, JOYSTICK_NAMES[event.button], kind == pygame.JOYBUTTONDOWN
        return None

    def pressed_button(self, event: pygame.event.Event) -> str | None:
        """Return the name of the button that this event presses; None if it presses none."""
        found = self.button_of(event)
        if found is None or not found[2] or found[:2] in self.held:
            return None
        return found[1]

    def _is_mapped(self, instance_id):
        """Return whether SDL has a mapping of the buttons of the pad with this id.

        For such a pad, SDL also sends joystick events, which are ignored.
        """
        return self.pads is not None and self.pads.is_controller(instance_id)

    def _feed_pad(self, event):
        kind = event.type
        button = self.button_of(event)
        if button is not None:
            self._button(*button)
        elif kind in (pygame.CONTROLLERDEVICEADDED, pygame.JOYDEVICEADDED):
            if self.pads is not None:
                self.pads.added(event.device_index)
        elif kind in (pygame.CONTROLLERDEVICEREMOVED, pygame.JOYDEVICEREMOVED):
            self._removed(event.instance_id)
        elif kind == pygame.CONTROLLERAXISMOTION and event.axis in STICK:
            self._stick(event.instance_id, event.axis, event.value / STICK_RANGE, STICK[event.axis])
        elif kind in (pygame.JOYAXISMOTION, pygame.JOYHATMOTION) and not self._is_mapped(event.instance_id):
            self._feed_joystick(event)

    def _button(self, pad, name, down):
        control = (pad, name)
        if not down:
            self._release(control)
        elif control not in self.held:  # a trigger sends many events while it moves
            self._press(control, (self.menu_buttons if self.menus else self.buttons).get(name, ()))

    def _feed_joystick(self, event):
        """Process an event of the stick or the hat of a pad that has no SDL mapping."""
        pad = event.instance_id
        if event.type == pygame.JOYHATMOTION:
            self._axis(pad, "hat x", event.value[0], AXES[0])
            self._axis(pad, "hat y", -event.value[1], AXES[1])  # up is +1 on a hat
        elif event.axis in AXES:
            self._stick(pad, event.axis, event.value, AXES[event.axis])

    def _press(self, control, actions):
        if actions:
            self.held[control] = actions
            self.tapped.update(actions)

    def _release(self, control):
        self.held.pop(control, None)

    def _stick(self, pad, axis, value, actions):
        self._axis(pad, f"axis {axis}", 0 if abs(value) < DEAD_ZONE else value, actions)

    def _axis(self, pad, axis, value, actions):
        """Set the held action of an axis: actions[0] for a negative `value`, actions[1] for a positive one.

        For 0, no action is held. The action is pressed only when the value changes its sign, so that holding the stick
        does not repeat the action.
        """
        control = (pad, axis)
        action = () if value == 0 else (actions[1],) if value > 0 else (actions[0],)
        if self.held.get(control, ()) != action:
            self._release(control)
            self._press(control, action)

    def _removed(self, instance_id):
        if any(device == instance_id for device, _ in self.held) or (self.pads and self.pads.knows(instance_id)):
            self.lost_pad = True
        for control in [c for c in self.held if c[0] == instance_id]:
            del self.held[control]
        if self.pads is not None:
            self.pads.removed(instance_id)
