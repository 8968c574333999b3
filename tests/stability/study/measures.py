"""Functions that compute one figure of a run: lengths in mm, angles in degrees, shares in %; NaN if the run is too
short.
"""

import math

import numpy as np

from tests.stability.study.motions import BALL, DROP, PLATE_SPIN, ROOM, SEAM_FRICTION, SLOPE, SPIN, oblique_pairs
from tests.stability.study.overlap import Overlaps
from tests.stability.study.scene import GRAVITY, STEP

MM = 1e3
SETTLED = 30  # [steps] after which a box has settled on its plate
SLIPPED, TIPPED = 0.002, 0.02  # [m], [rad] against the plate


def depths(run, first=1, every=5):
    """Return the deepest overlap [m] in some steps, as an array.

    The steps are every `every`-th one, counted from the last step back to step `first`.
    """
    overlaps = Overlaps(run.scene)
    return np.array([overlaps.deepest(run.poses[k]) for k in range(len(run.poses) - 1, first - 1, -every)])


def overlap_at_end(run):
    """Return the deepest overlap in the last tenth of the run [mm]."""
    return MM * depths(run, first=len(run.poses) - max(1, len(run.poses) // 10)).max()


def overlap_share(run, share):
    """Return a percentile of the deepest overlap per step [mm]. share: the percentile, 0 to 100."""
    return MM * np.percentile(depths(run), share)


def sway(run):
    """Return the greatest horizontal distance of any dynamic body from its start position during the run [mm]."""
    return MM * np.nanmax(np.abs(run.moving[:, :, 0] - run.moving[0, :, 0]))


def lean(run):
    """Return the greatest horizontal distance of any dynamic body from its start position at the end [mm]."""
    return MM * np.nanmax(np.abs(run.moving[-1, :, 0] - run.moving[0, :, 0]))


def fall_over_theory(run, theory):
    """Return the time until a body has turned by 0.1 rad, divided by `theory`; inf if none has.

    theory: time that the rigid upper part of the tower takes [s].
    """
    return math.inf if run.fell is None else run.fell / theory


def rise(run, index):
    """Return how far the body `index` rises above its start height [mm], after the scene's first removal."""
    gone = run.scene.removals[0][0]
    return MM * -(run.poses[gone:, index, 1] - run.poses[0, index, 1]).min() if len(run.poses) > gone else math.nan


def asleep_after(run):
    """Return the time from which on all bodies sleep [s]; inf if some are awake at the end."""
    awake = run.awake[:, run.scene.dynamic].any(axis=1)
    return math.inf if awake[-1] else (np.flatnonzero(awake)[-1] + 1) * STEP if awake.any() else 0.0


def milliseconds(run):
    """Return the median computing time of a step in the second half of the run [ms]."""
    return 1e3 * float(np.median(run.times[len(run.times) // 2 :]))


def _on_plate(run):
    """Return (position along the plate [m], angle relative to the plate [rad]) of the box, one value per step."""
    plate, box = run.poses[:, 0], run.poses[:, 1]
    dx, dy = box[:, 0] - plate[:, 0], box[:, 1] - plate[:, 1]
    return dx * np.cos(plate[:, 2]) + dy * np.sin(plate[:, 2]), box[:, 2] - plate[:, 2]


def _angle_when(changed):
    """Return the plate's angle at the first step marked True, minus atan(1/2) [degrees]; inf if no step is marked."""
    when = np.flatnonzero(changed)
    theory = math.degrees(math.atan(0.5))
    return math.degrees(PLATE_SPIN) * when[0] * STEP - theory if len(when) else math.inf


def slips_late(run):
    """Return how many degrees beyond atan(friction) the plate turns before the box slides."""
    along, _ = _on_plate(run)
    return _angle_when(np.abs(along - along[min(SETTLED, len(along) - 1)]) > SLIPPED)


def tips_late(run):
    """Return how many degrees beyond atan(width / height) the plate turns before the box tips."""
    _, turn = _on_plate(run)
    return _angle_when(np.abs(turn - turn[min(SETTLED, len(turn) - 1)]) > TIPPED)


def _down(run, first):
    """Return the component of body 1's position or velocity down the slope, one value per step.

    first: pose column of x or vx; that of y or vy follows it.
    """
    return run.poses[:, 1, first] * math.cos(SLOPE) + run.poses[:, 1, first + 1] * math.sin(SLOPE)


def slide_error(run, share):
    """Return the error of the acceleration down a slope after the first two seconds [%].

    The exact value is g (sin - friction cos). share: friction divided by the least friction that holds the box.
    """
    speed, start = _down(run, 3), 120
    if len(speed) <= start + 1:
        return math.nan
    found = (speed[-1] - speed[start]) / ((len(speed) - 1 - start) * STEP)
    return 100.0 * (found / (GRAVITY * math.sin(SLOPE) * (1.0 - share)) - 1.0)


def creep(run):
    """Return the distance that the box moves down the slope after the first second [mm]."""
    way = _down(run, 0)
    return MM * (way[-1] - way[min(60, len(way) - 1)])


def apexes(heights):
    """Return the apex heights of a flight: the vertex of the parabola through the three samples around each maximum."""
    found = []
    for before, top, after in zip(heights, heights[1:], heights[2:], strict=False):
        if top > before and top >= after:
            bend = before - 2.0 * top + after
            found.append(top - (after - before) ** 2 / (8.0 * bend))
    return found


def bounce_error(run, restitution, count=17):
    """Return the worst error of the first `count` apexes against the theory: drop height times e^(2 k) [%].

    Only apexes that the theory places within the run count.
    """
    found = apexes((-run.poses[:, 1, 1] - BALL).tolist())
    fall, time, errors = math.sqrt(2.0 * DROP / GRAVITY), 0.0, []
    for k in range(1, count + 1):
        time += fall * (restitution ** (k - 1) + restitution**k)
        if time < (len(run.poses) - 2) * STEP:
            height = DROP * restitution ** (2 * k)
            errors.append((found[k - 1] / height if k <= len(found) else 0.0) - 1.0)
    return 100.0 * max(errors, key=abs) if errors else math.nan


def oblique_errors(run):
    """Return an array with the velocity error of each moving disc after its impact, divided by its speed.

    The contact normal is (sqrt(1 - b²), b) for an offset of b diameters; equal masses exchange the velocity along it.
    """
    errors = []
    for k, (offset, speed, _) in enumerate(oblique_pairs()):
        nx, ny = math.sqrt(1.0 - offset * offset), offset
        vx, vy = speed - speed * nx * nx, -speed * nx * ny
        errors.append(math.hypot(run.poses[-1, 2 * k, 3] - vx, run.poses[-1, 2 * k, 4] - vy) / speed)
    return np.array(errors)


def oblique_worst(run):
    return oblique_errors(run).max()


def oblique_mean(run):
    return oblique_errors(run).mean()


def stop_error(run):
    """Return the error of the last body's stopping distance against v² / (2 friction g) [%]."""
    found = run.poses[-1, -1, 0] - run.poses[0, -1, 0]
    return 100.0 * (found * 2.0 * SEAM_FRICTION * GRAVITY / run.poses[0, -1, 3] ** 2 - 1.0)


def hop(run):
    """Return the greatest height of the last body above its start height [mm]."""
    return MM * max(0.0, -(run.poses[:, -1, 1] - run.poses[0, -1, 1]).min())


def out_of_room(run):
    """Return the number of bodies outside the drum of the tumbler at the end."""
    (x, y, angle), others = run.poses[-1, 0, :3], run.moving[-1]
    dx, dy = others[:, 0] - x, others[:, 1] - y
    across = np.abs(dx * math.cos(angle) + dy * math.sin(angle))
    along = np.abs(dy * math.cos(angle) - dx * math.sin(angle))
    return float((np.maximum(across, along) > 0.5 * ROOM).sum())


def spin_error(run):
    """Return the error of a free body's rotation angle against spin times time [%]."""
    time = (len(run.poses) - 1) * STEP
    return 100.0 * (run.poses[-1, 0, 2] / (SPIN * time) - 1.0)
