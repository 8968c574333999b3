"""InputState and its sources (events, scripts, pads): all input goes through one interface."""

from types import SimpleNamespace

import pygame
import pytest

from game.input.bindings import DEFAULT_KEYS, key_codes
from game.input.devices import DeviceSource
from game.input.inputs import InputFrame, InputState
from game.run.sources import ScriptSource


def event(kind, **values):
    return pygame.event.Event(kind, **values)


def key(code, down=True):
    return event(pygame.KEYDOWN if down else pygame.KEYUP, key=code)


def test_pressed_and_released_last_one_step():
    inputs = InputState()
    inputs.set(InputFrame(frozenset({"fire"})))
    assert inputs.held("fire") and inputs.pressed("fire")
    inputs.set(InputFrame(frozenset({"fire"})))
    assert inputs.held("fire") and not inputs.pressed("fire")
    inputs.set(InputFrame())
    assert inputs.released("fire") and not inputs.held("fire")


def test_unknown_action_is_refused():
    with pytest.raises(ValueError, match="'fier'.*|got 'fier'"):
        InputState().held("fier")


def test_a_tap_between_two_steps_is_not_lost():
    devices = DeviceSource()
    devices.feed(key(pygame.K_SPACE))
    devices.feed(key(pygame.K_SPACE, down=False))
    assert {"fire", "jump"} <= devices.next().actions
    assert not devices.next().actions


def test_two_keys_of_one_action_hold_until_both_are_up():
    devices = DeviceSource()
    devices.feed(key(pygame.K_LEFT))
    devices.feed(key(pygame.K_a))
    devices.feed(key(pygame.K_LEFT, down=False))
    devices.next()
    assert "left" in devices.next().actions
    devices.feed(key(pygame.K_a, down=False))
    assert not devices.next().actions


def test_losing_focus_lets_go():
    devices = DeviceSource()
    devices.feed(key(pygame.K_LEFT))
    devices.feed(event(pygame.WINDOWFOCUSLOST))
    assert not devices.next().actions


def test_pointer_is_mapped_and_a_click_is_not_lost():
    devices = DeviceSource(lambda position: (position[0] // 3, position[1] // 3))
    devices.feed(event(pygame.MOUSEBUTTONDOWN, button=1, pos=(30, 60)))
    devices.feed(event(pygame.MOUSEBUTTONUP, button=1, pos=(30, 60)))
    devices.feed(event(pygame.MOUSEWHEEL, x=0, y=2))
    frame = devices.next()
    assert frame.pointer == (10, 20) and frame.pointer_down and frame.wheel == 2
    frame = devices.next()
    assert not frame.pointer_down and frame.wheel == 0


def test_changes_travel_once():
    devices = DeviceSource()
    devices.change("broadphase", "tree")
    assert devices.next().changes == (("broadphase", "tree"),)
    assert devices.next().changes == ()


class FakePads:
    """Replacement of game.input.devices.Pads with two pads; pad 7 has a mapping and pad 9 has none."""

    def __init__(self):
        self.open = set()

    def added(self, device_index):
        self.open.add((7, 9)[device_index])

    def removed(self, instance_id):
        self.open.discard(instance_id)

    def knows(self, instance_id):
        return instance_id in self.open

    def is_controller(self, instance_id):
        return instance_id == 7 and 7 in self.open


def test_controller_hot_plug():
    devices = DeviceSource(pads=FakePads())
    devices.feed(event(pygame.CONTROLLERDEVICEADDED, device_index=0))
    devices.feed(event(pygame.CONTROLLERBUTTONDOWN, instance_id=7, button=pygame.CONTROLLER_BUTTON_A))
    assert "fire" in devices.next().actions
    devices.feed(event(pygame.CONTROLLERDEVICEREMOVED, instance_id=7))
    assert devices.lost_pad and not devices.next().actions
    devices.feed(event(pygame.CONTROLLERDEVICEADDED, device_index=0))
    devices.feed(event(pygame.CONTROLLERBUTTONDOWN, instance_id=7, button=pygame.CONTROLLER_BUTTON_DPAD_LEFT))
    assert devices.next().actions == {"left"}


def test_a_mapped_pad_is_not_heard_twice():
    devices = DeviceSource(pads=FakePads())
    devices.feed(event(pygame.CONTROLLERDEVICEADDED, device_index=0))
    devices.feed(event(pygame.JOYBUTTONDOWN, instance_id=7, button=1))
    assert not devices.next().actions


def test_an_unmapped_pad_works_by_joystick_events():
    devices = DeviceSource(pads=FakePads())
    devices.feed(event(pygame.JOYDEVICEADDED, device_index=1))
    devices.feed(event(pygame.JOYHATMOTION, instance_id=9, hat=0, value=(1, 1)))
    assert devices.next().actions == {"right", "up"}
    devices.feed(event(pygame.JOYHATMOTION, instance_id=9, hat=0, value=(0, 0)))
    devices.feed(event(pygame.JOYAXISMOTION, instance_id=9, axis=0, value=-0.9))
    assert devices.next().actions == {"left"}


def test_the_stick_has_a_dead_zone():
    devices = DeviceSource(pads=FakePads())
    for value, expected in ((6000, set()), (20000, {"right"}), (-20000, {"left"}), (0, set())):
        devices.feed(event(pygame.CONTROLLERAXISMOTION, instance_id=7, axis=pygame.CONTROLLER_AXIS_LEFTX, value=value))
        devices.next()
        assert devices.next().actions == expected


def test_two_pads_do_not_release_each_other():
    devices = DeviceSource(pads=FakePads())
    for pad in (7, 8):
        devices.feed(event(pygame.CONTROLLERBUTTONDOWN, instance_id=pad, button=pygame.CONTROLLER_BUTTON_A))
    devices.feed(event(pygame.CONTROLLERBUTTONUP, instance_id=7, button=pygame.CONTROLLER_BUTTON_A))
    devices.next()
    assert "fire" in devices.next().actions


def test_script_plays_and_then_rests():
    script = ScriptSource([{"left"}, InputFrame(frozenset({"jump"}), wheel=1)])
    scene = SimpleNamespace()
    assert script.next(scene).actions == {"left"}
    assert script.next(scene).wheel == 1
    assert script.next(scene) == InputFrame()


def test_bindings_name_what_is_wrong():
    with pytest.raises(ValueError, match="no key is called 'spcae'"):
        key_codes({"fire": ["spcae"]})
    with pytest.raises(ValueError, match="got 'shoot'"):
        key_codes({"shoot": ["a"]})
    assert key_codes(DEFAULT_KEYS)[pygame.K_SPACE] == ("fire", "jump")
