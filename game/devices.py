"""Keyboard, mouse and controllers as one source of InputFrames, fed by pygame events only.

pygame.key.get_pressed() is not asked: posted events do not change it, and a tap that begins and ends
between two steps would be lost. Pads are keyed by instance id, which never changes and is never reused
while the program runs; device indexes do and are.
"""

import pygame

from game import compat
from game.bindings import AXES, CONTROLLER_BUTTONS, DEAD_ZONE, DEFAULT_KEYS, JOYSTICK_BUTTONS, key_codes
from game.inputs import InputFrame

STICK = {pygame.CONTROLLER_AXIS_LEFTX: AXES[0], pygame.CONTROLLER_AXIS_LEFTY: AXES[1]}
STICK_RANGE = 32767.0      # CONTROLLERAXISMOTION counts in 16 bits


class DeviceSource:
    """`to_canvas(position)` maps the window's pointer to the canvas; `pads` opens controllers (see Pads)."""

    def __init__(self, to_canvas=lambda position: position, keys=None, pads=None):
        self.to_canvas = to_canvas
        self.keys = key_codes(keys or DEFAULT_KEYS)
        self.pads = pads
        self.held = {}             # (device, control) -> actions
        self.tapped = set()        # actions that went down since the last step
        self.pointer = (0, 0)
        self.pointer_down = self.pointer_tapped = False
        self.wheel = 0
        self.changes = []
        self.lost_pad = False      # a pad was pulled out; the app pauses and resets this

    def change(self, name, value):
        """Queue a change of the simulation (panel, keys) for the next step."""
        self.changes.append((name, value))

    def next(self, scene=None):
        """The input of the next step. A tap between two steps counts as held for one."""
        actions = frozenset(self.tapped.union(*self.held.values()) if self.held else self.tapped)
        down = self.pointer_down or self.pointer_tapped
        frame = InputFrame(actions, self.pointer, down, self.wheel, tuple(self.changes))
        self.tapped.clear()
        self.changes.clear()
        self.pointer_tapped, self.wheel = False, 0
        return frame

    def release_all(self):
        """Forget what is held: the window lost focus, or another screen opened."""
        self.held.clear()
        self.tapped.clear()
        self.pointer_down = self.pointer_tapped = False

    def feed(self, event):
        """Take one pygame event."""
        kind = event.type
        if kind == pygame.KEYDOWN:
            self._press(("key", event.key), self.keys.get(event.key, ()))
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

    def _feed_pad(self, event):
        kind = event.type
        if kind in (pygame.CONTROLLERDEVICEADDED, pygame.JOYDEVICEADDED):
            if self.pads is not None:
                self.pads.added(event.device_index)
        elif kind in (pygame.CONTROLLERDEVICEREMOVED, pygame.JOYDEVICEREMOVED):
            self._removed(event.instance_id)
        elif kind == pygame.CONTROLLERBUTTONDOWN:
            self._press((event.instance_id, event.button), CONTROLLER_BUTTONS.get(event.button, ()))
        elif kind == pygame.CONTROLLERBUTTONUP:
            self._release((event.instance_id, event.button))
        elif kind == pygame.CONTROLLERAXISMOTION and event.axis in STICK:
            self._stick(event.instance_id, event.axis, event.value / STICK_RANGE, STICK[event.axis])
        elif kind in (pygame.JOYBUTTONDOWN, pygame.JOYBUTTONUP, pygame.JOYAXISMOTION, pygame.JOYHATMOTION):
            self._feed_joystick(event)

    def _feed_joystick(self, event):
        """A pad without a mapping. A mapped pad sends these too, and is then left to its controller events."""
        if self.pads is not None and self.pads.is_controller(event.instance_id):
            return
        pad = event.instance_id
        if event.type == pygame.JOYBUTTONDOWN:
            self._press((pad, event.button), JOYSTICK_BUTTONS.get(event.button, ()))
        elif event.type == pygame.JOYBUTTONUP:
            self._release((pad, event.button))
        elif event.type == pygame.JOYHATMOTION:
            self._axis(pad, "hat x", event.value[0], AXES[0])
            self._axis(pad, "hat y", -event.value[1], AXES[1])      # a hat's up is +1
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
        """An axis holds one of two actions. It taps only when it enters one: a held stick is not a repeat."""
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


class Pads:
    """Opens pads as they are plugged in; an open pad is what makes SDL send its events."""

    def __init__(self):
        self.controllers, self.joysticks = {}, {}
        self.module = compat.controller_module()
        pygame.joystick.init()
        if self.module is not None:
            self.module.init()

    def added(self, device_index):
        """Open the pad at this moment's device index. A pad both modules announce is opened once."""
        try:
            joystick = pygame.joystick.Joystick(device_index)
            instance = joystick.get_instance_id()
            if self.knows(instance):
                return
            if self.module is not None and self.module.is_controller(device_index):
                self.controllers[instance] = self.module.Controller(device_index)
            else:
                self.joysticks[instance] = joystick
        except pygame.error:
            return      # pulled out again between the event and now; its removal follows

    def removed(self, instance_id):
        """Forget a pad."""
        self.controllers.pop(instance_id, None)
        self.joysticks.pop(instance_id, None)

    def knows(self, instance_id):
        """True if the pad is open."""
        return instance_id in self.controllers or instance_id in self.joysticks

    def is_controller(self, instance_id):
        """True if SDL maps this pad's buttons."""
        return instance_id in self.controllers
