"""Joints of a world: their anchors, axes, forces, and limits with the present values."""

from math import atan2, ceil, cos, hypot, inf, pi, sin

import numpy as np
import pygame

from game.drawing.canvas import SMALL
from game.drawing.colors import FOG, GREEN, INK, ORANGE, PAPER, RED, SKY, SLATE, YELLOW, Color
from game.drawing.presenter import Frame, Lens
from game.overlays.layer import Layer, LegendLine
from game.overlays.layer_impulses import arrow, short, step_of
from physics import DYNAMIC, World, debug
from physics.tables.joint import ANGLE, FREE, GEARED, LENGTH, NO_COORDINATE, ON_AXIS, SLUNG, TOOTHED, WORLD

JOINT_BUDGET = 400  # joints per picture; the note says how many there are
LABEL_BUDGET = 40  # values written out per picture
REFERENCE = 8.0  # [canvas px] length of an arrow for the force that the legend names
TYPICAL = 0.9  # quantile of the forces that sets the scale
FADE = 0.95  # factor per picture by which the scale decays after a peak
ARC, NEEDLE = 9.0, 11.0  # [canvas px] radius of the arc between two limits, length of the present value's needle
ARC_STEP = 0.2  # [rad] at most between two points of an arc
OPEN = 14.0  # [canvas px] half of an axis without limits
BAR = (12.0, 2.0)  # [canvas px] frame for the share of the breaking force
CROSS = 5.0  # [canvas px] half of the cross over a broken joint
MOST_SHARE = 10.0  # greatest share of the breaking force that is written as a number
HIGH = 0.8  # share of the breaking force from which its bar is red
COLUMNS = (
    "ax", "ay", "bx", "by", "axis_x", "axis_y", "value", "lower", "upper", "force_x", "force_y", "coordinate", "hold",
    "ground_ax", "ground_ay", "ground_bx", "ground_by",
)  # fmt: skip


class Joints(Layer):
    """Overlay that shows the anchors of each joint with a line between them, its axis, its limits, and its force.

    The present value of the joint is marked between its limits. Joints that the direct solver solves (trees) are green,
    those that are solved iteratively are blue, and sleeping or disabled ones are grey. An arrow shows the force on body
    B. A bar shows the force as a share of the breaking force. A joint that broke in the last stage of an inspected step
    is red, with a cross.

    only: id of the only joint that is drawn, None for all; reference: length [canvas px] of the arrow of the force that
    the legend names.
    """

    name, title, key, color = "joints", "Joints", "q", GREEN

    def __init__(self, only: int | None = None, reference: float = REFERENCE) -> None:
        self.only, self.reference = only, reference
        self.level = 0.0  # the current quantile of the forces, decaying
        self.begin()

    def begin(self, views: int = 1) -> None:
        """Start a new picture with `views` views. The limit on drawn objects is divided evenly among the views."""
        self.drawn = self.total = self.direct = self.asleep = self.breakable = 0
        self.found = False  # whether any world has the effect joints
        self.room = JOINT_BUDGET // views
        self.labels = []  # (text, x, y, colour), drawn after all fixed text is placed
        self.unit = step_of(self.level)
        self.level *= FADE

    def draw(self, frame: Frame, lens: Lens, world: World) -> None:
        """Draw the joints of a world. lens: maps world to frame coordinates."""
        self.found |= world.effects.joints
        if not len(world.joints):
            return
        rows, drawn = world.joints, anchored(world)
        active = is_awake(world) & rows["enabled"]
        if self.only is not None:
            mine = rows["id"] == self.only
            rows, drawn, active = rows[mine], drawn[mine], active[mine]
        self.total += len(rows)
        self.direct += int(np.count_nonzero(active & rows["direct"]))
        self.asleep += int(np.count_nonzero(~active))
        self.breakable += int(np.count_nonzero(np.isfinite(rows["break_force"]) | np.isfinite(rows["break_torque"])))
        force = np.hypot(drawn["force_x"], drawn["force_y"])
        if active.any():
            self.level = max(self.level, float(np.quantile(force[active], TYPICAL)))
            self.unit = max(self.unit, step_of(self.level))
        seen = np.flatnonzero(lens.seen(boxes_of(drawn)))[: self.room]
        self.drawn += len(seen)
        share = np.maximum(force / rows["break_force"], np.abs(drawn["torque"]) / rows["break_torque"])
        share[~np.isfinite(rows["break_force"]) & ~np.isfinite(rows["break_torque"])] = -1.0
        self._draw_spokes(frame, lens, world, drawn[seen])
        columns = [drawn[name][seen].tolist() for name in COLUMNS]
        flags = (each[seen].tolist() for each in (active, rows["direct"], rows["broken"], share))
        for awake, direct, broken, part, *values in zip(*flags, *columns, strict=True):
            joint = dict(zip(COLUMNS, values, strict=True))
            tone = frame.tone(RED if broken else GREEN if direct else SKY) if awake else frame.tone(SLATE)
            self._draw_line(frame, lens, joint, tone)
            self._draw_limits(frame, lens, joint, frame.tone(YELLOW) if awake else tone)
            self._draw_force(frame, lens, joint, part if awake else min(part, 0.0), awake)
            draw_anchors(frame, lens, joint, tone)
            if broken:
                self._draw_cross(frame, lens, joint, tone)

    def _draw_cross(self, frame, lens, joint, tone):
        """Draw a cross over the middle of a broken joint, in the colour `tone`."""
        x, y = lens.points(0.5 * (joint["ax"] + joint["bx"]), 0.5 * (joint["ay"] + joint["by"]))
        arm = CROSS * frame.scale
        for color, width in ((INK, frame.scale + 2), (tone, frame.scale)):
            for way in (-1, 1):
                pygame.draw.line(frame.surface, color, (x - arm, y - way * arm), (x + arm, y + way * arm), width)

    def _draw_spokes(self, frame, lens, world, rows):
        """Draw a faint line from each anchor to the centre of mass of its body, which shows the connected bodies."""
        for side in ("a", "b"):
            held = rows[(rows[f"body_{side}"] != WORLD) & (rows["hold"] != GEARED)]
            bodies = world.bodies[world.rows(held[f"body_{side}"])]
            starts = np.column_stack(lens.points(bodies["center_x"], bodies["center_y"])).tolist()
            ends = np.column_stack(lens.points(held[f"{side}x"], held[f"{side}y"])).tolist()
            for start, end in zip(starts, ends, strict=True):
                pygame.draw.line(frame.surface, frame.tone(FOG), start, end)

    def _draw_line(self, frame, lens, joint, tone):
        """Draw the line between the anchors of a joint in the colour `tone`. A slack rope is thin.

        The line of a pulley joint runs over its wheels.
        """
        slack = joint["coordinate"] == LENGTH and joint["value"] < joint["upper"] - 0.01 and joint["upper"] < inf
        width = 1 if slack or joint["hold"] in (GEARED, FREE) else max(1, frame.scale - 1)
        names = [("ax", "ay"), ("bx", "by")]
        if joint["hold"] == SLUNG:
            names[1:1] = [("ground_ax", "ground_ay"), ("ground_bx", "ground_by")]
        points = [lens.points(joint[x], joint[y]) for x, y in names]
        pygame.draw.lines(frame.surface, tone, False, points, width)
        for x, y in points[1:-1]:
            pygame.draw.circle(frame.surface, tone, (x, y), 3 * frame.scale, max(1, frame.scale - 1))

    def _draw_limits(self, frame, lens, joint, tone):
        """Draw the axis of a joint, the limits of its coordinate, and the present value, in the colour `tone`."""
        lower, upper = joint["lower"], joint["upper"]
        limited = lower > -inf or upper < inf
        if joint["coordinate"] == ANGLE and limited:
            self._draw_arc(frame, lens, joint, tone)
        elif joint["hold"] == ON_AXIS or (joint["coordinate"] == LENGTH and limited and lower < upper):
            self._draw_range(frame, lens, joint, tone)

    def _draw_arc(self, frame, lens, joint, tone):
        x, y = lens.points(joint["ax"], joint["ay"])
        zero, radius = atan2(joint["axis_y"], joint["axis_x"]), ARC * frame.scale
        lower, upper = joint["lower"], joint["upper"]
        ends = [each for each in (lower, upper) if abs(each) < inf]
        if len(ends) == 2 and 0.0 < upper - lower < 2 * pi:
            count = max(2, ceil((upper - lower) / ARC_STEP) + 1)
            turns = [zero + lower + (upper - lower) * k / (count - 1) for k in range(count)]
            points = [(x + radius * cos(a), y + radius * sin(a)) for a in turns]
            pygame.draw.lines(frame.surface, tone, False, points, max(1, frame.scale - 1))
        for each in ends:
            c, s = cos(zero + each), sin(zero + each)
            inner = 0.5 * radius
            pygame.draw.line(
                frame.surface, tone, (x + inner * c, y + inner * s), (x + radius * c, y + radius * s), frame.edge
            )
        reach, now = NEEDLE * frame.scale, zero + joint["value"]
        tip = (x + reach * cos(now), y + reach * sin(now))
        pygame.draw.line(frame.surface, frame.tone(PAPER), (x, y), tip, max(1, frame.scale - 1))
        self._label(f"{round(joint['value'], 2) + 0.0:.2f}", tip[0], tip[1], YELLOW)

    def _draw_range(self, frame, lens, joint, tone):
        """Draw the range of a joint's coordinate, with a mark at its present value.

        The coordinate is a translation along the axis, or the length of the joint measured from A's anchor.
        """
        along = joint["coordinate"] == LENGTH
        free = OPEN * frame.scale / lens.scale
        low = max(joint["lower"], joint["value"] - free) if joint["lower"] == -inf else joint["lower"]
        high = min(joint["upper"], joint["value"] + free) if joint["upper"] == inf else joint["upper"]
        nx, ny = joint["axis_x"], joint["axis_y"]

        def place(value):
            return lens.points(joint["ax"] + nx * value, joint["ay"] + ny * value)

        if not along:
            pygame.draw.line(frame.surface, tone, place(low), place(high), 1)
        tick = 3 * frame.scale
        for end, limit in ((low, joint["lower"]), (high, joint["upper"])):
            if abs(limit) < inf and not (along and end == 0.0):
                x, y = place(end)
                dx, dy = tick * ny, -tick * nx
                pygame.draw.line(frame.surface, tone, (x - dx, y - dy), (x + dx, y + dy), frame.edge)
        x, y = place(joint["value"])
        pygame.draw.circle(frame.surface, frame.tone(PAPER), (x, y), max(1, frame.scale))
        self._label(f"{round(joint['value'], 1) + 0.0:.1f}", x + tick, y, YELLOW)

    def _draw_force(self, frame, lens, joint, share, awake):
        """Draw the force on body B as an arrow, and `share` as a bar.

        share: force divided by breaking force, negative if the joint is unbreakable; awake: whether the arrow is drawn.
        """
        x, y = lens.points(joint["bx"], joint["by"])
        if self.unit and awake:
            scale = self.reference * frame.scale / self.unit
            arrow(frame, x, y, joint["force_x"] * scale, joint["force_y"] * scale, ORANGE)
        if share < 0.0:
            return
        width, height = BAR[0] * frame.scale, BAR[1] * frame.scale
        frame_of_bar = pygame.Rect(x - width / 2, y - 5 * frame.scale - height, width, height)
        pygame.draw.rect(frame.surface, INK, frame_of_bar.inflate(2, 2))
        color = RED if share >= HIGH else ORANGE
        frame.surface.fill(frame.tone(color), (*frame_of_bar.topleft, round(width * min(share, 1.0)), height))
        pygame.draw.rect(frame.surface, frame.tone(PAPER), frame_of_bar.inflate(2, 2), 1)
        self._label(
            f"{100 * share:.0f} %" if share <= 10.0 else "over 1,000 %",
            frame_of_bar.right + 2 * frame.scale,
            frame_of_bar.top,
            color,
        )

    def _label(self, text, x, y, color):
        if len(self.labels) < LABEL_BUDGET:
            self.labels.append((text, x, y, color))

    def draw_labels(self, frame: Frame) -> None:
        """Write the values of limited joints and the shares of breaking forces, where they cover no other text."""
        for text, x, y, color in self.labels:
            frame.text_if_free(text, x, y, frame.tone(color), SMALL, frame.text_scale, "left", True)

    def notes(self) -> list[LegendLine]:
        """Return the lines of the layer for the legend, a list of (color, text)."""
        if not self.found:
            return [(FOG, "no joints: joints is not declared")]
        iterative = self.total - self.asleep - self.direct
        lines: list[LegendLine] = [
            (self.color, f"joints {self.drawn} of {self.total}, {self.direct} direct"),
            (SKY, f"{iterative} iterative"),
            (YELLOW, "axis, limits, value in px or rad"),
        ]
        if self.unit:
            lines.append((ORANGE, f"force, {self.reference:.0f} px is {short(self.unit)}"))
        if self.breakable:
            lines.append((RED, "bar: share of the breaking force"))
        return [*lines, (SLATE, f"{self.asleep} asleep or disabled")]


def anchored(world: World) -> np.ndarray:
    """Return the rows of debug.joints(world), with anchors added to the joints that have none.

    These joints act on angles alone, or only prevent contacts. Their anchors are set to the centres of mass of the
    bodies.
    """
    rows, bodies = debug.joints(world), world.bodies
    loose = ((rows["hold"] == FREE) & (rows["coordinate"] != LENGTH)) | (rows["hold"] == TOOTHED)
    for side, other in (("a", "b"), ("b", "a")):
        mine = np.flatnonzero(loose & (rows[f"body_{side}"] != WORLD))
        at = world.rows(rows[f"body_{side}"][mine])
        for axis in ("x", "y"):
            centers = bodies["center_x"] if axis == "x" else bodies["center_y"]
            rows[side + axis][mine] = centers[at]
            alone = mine[rows[f"body_{other}"][mine] == WORLD]
            rows[other + axis][alone] = rows[side + axis][alone]
    return rows


def is_awake(world: World) -> np.ndarray:
    """Return (n,) bool: whether a dynamic body of each joint is awake, in the order of world.joints."""
    found, bodies = np.zeros(len(world.joints), bool), world.bodies
    for ids in (world.joints["body_a"], world.joints["body_b"]):
        mine = np.flatnonzero(ids != WORLD)
        at = world.rows(ids[mine])
        found[mine] |= bodies["awake"][at] & (bodies["kind"][at] == DYNAMIC)
    return found


def boxes_of(rows: np.ndarray) -> np.ndarray:
    """Return the (n, 4) AABBs [px] of the anchors and pulley wheels of joints. rows: (n,) DRAWN_JOINT."""
    x, y = (np.stack([rows["a" + axis], rows["b" + axis]]) for axis in ("x", "y"))
    hung = rows["hold"] == SLUNG
    if hung.any():
        x, y = (
            np.concatenate([c, [np.where(hung, rows[f"ground_{s}{a}"], rows["a" + a]) for s in "ab"]])
            for c, a in ((x, "x"), (y, "y"))
        )
    return np.column_stack((x.min(axis=0), y.min(axis=0), x.max(axis=0), y.max(axis=0)))


def draw_anchors(frame: Frame, lens: Lens, joint: dict, tone: Color) -> None:
    """Draw a ring at A's anchor and a dot at B's anchor. joint: a row of debug.joints() as a dict."""
    a, b = lens.points(joint["ax"], joint["ay"]), lens.points(joint["bx"], joint["by"])
    radius = frame.scale + 1
    if joint["coordinate"] == NO_COORDINATE and joint["hold"] == FREE:  # it has no forces
        for x, y in (a, b):
            pygame.draw.circle(frame.surface, tone, (x, y), radius, 1)
        return
    pygame.draw.circle(frame.surface, INK, b, radius + 1)
    pygame.draw.circle(frame.surface, tone, b, radius)
    pygame.draw.circle(frame.surface, tone, a, radius + 2, 1)
    if hypot(a[0] - b[0], a[1] - b[1]) > radius:
        pygame.draw.circle(frame.surface, INK, a, radius - 1)
