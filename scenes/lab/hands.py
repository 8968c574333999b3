"""Poses of two objects that the player drags, rotates and moves."""

from math import pi

TURN_NOTCH = 2 * pi / 64  # [rad] per wheel notch
TURN_SPEED = 1.2  # [rad/s] with the keys
MOVE_SPEED = 70.0  # [px/s] with the keys


class Hands:
    """The poses of two objects that the player moves with pointer, wheel and keys.

    poses: a list [x [px], y [px], angle [rad]] for each object; chosen: index of the object that wheel and keys move;
    room: Rect to which the position of the chosen object is limited.
    """

    def __init__(self, poses, chosen, room):
        self.poses = [list(pose) for pose in poses]
        self.chosen, self.room = chosen, room
        self.dragged, self.grip = None, (0.0, 0.0)

    def take(self, which, x, y):
        """Begin to drag object number `which`, and choose it. (x, y): position of the pointer [px]."""
        self.chosen = self.dragged = which
        self.grip = (self.poses[which][0] - x, self.poses[which][1] - y)

    def move(self, inputs):
        """Move and rotate the chosen object by one step's input of pointer, wheel and keys. The fire key chooses the
        other.
        """
        if not inputs.pointer_down:
            self.dragged = None
        pose = self.poses[self.chosen]
        if self.dragged is not None:
            pose[0], pose[1] = inputs.pointer[0] + self.grip[0], inputs.pointer[1] + self.grip[1]
        pose[2] += inputs.wheel * TURN_NOTCH
        if inputs.pressed("fire"):
            self.chosen = 1 - self.chosen
        side, rise = inputs.held("right") - inputs.held("left"), inputs.held("down") - inputs.held("up")
        if inputs.held("focus"):
            pose[2] += side * TURN_SPEED / 60
        else:
            pose[0] += side * MOVE_SPEED / 60
            pose[1] += rise * MOVE_SPEED / 60
        pose[0] = min(max(pose[0], float(self.room.left)), float(self.room.right))
        pose[1] = min(max(pose[1], float(self.room.top)), float(self.room.bottom))
