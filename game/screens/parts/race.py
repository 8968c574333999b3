"""A race between the played scene and a rival: the same scene under another setting, with the same seed and input."""

from collections import deque
from collections.abc import Sequence
from dataclasses import replace
from time import perf_counter

import numpy as np
import pygame

from game.drawing.canvas import SMALL, wrap
from game.drawing.colors import GOLD, INK, ORANGE, PAPER, SKY, SLATE
from game.drawing.presenter import Frame
from game.drawing.typical import Typical
from game.input.inputs import InputState
from game.measure.errors import VISIBLE
from game.measure.moment import here_of
from game.overlays.layer_bounds import draw_boxes
from game.overlays.outlines import draw_outline
from game.run.replay import chosen_before
from game.run.session import Session
from game.scene import Scene
from physics import debug
from physics.jit import tiers
from physics.tables.shape import MASK

# Changes that each of the two scenes has for itself; all other input goes to both.
OWN = ("broadphase", "solver", "substeps", "tier", "narrowphase", "slider:solver", "slider:substeps")
MOST = 400  # outlines drawn at most; the figures count all bodies
STEPS_TIMED = 30  # steps with compiled kernels before a time is shown, the median of them
KEPT = 600  # steps for which the distance of the two scenes is kept


class Race:
    """A race between the played `scene` and its `rival`, another instance of the same scene with different settings.

    changes: (name, value) pairs for Scene.change(), applied only to the rival. Raises ValueError for an invalid change.
    The rival starts at frame 0, so the caller must restart `scene` in the next step. The caller then calls
    step(session) after each step of the scene.
    """

    def __init__(self, scene: Scene, changes: Sequence[tuple[str, object]]) -> None:
        self.scene = scene
        self.rival = type(scene)(scene.seed, scene.broadphase, scene.solver, scene.tier, scene.level_file)
        for name, value in [*chosen_before(scene), *changes]:
            self.rival.change(name, value)
        self.rival.restart()
        self.inputs = InputState()
        self.times = Typical(), Typical()  # [s] of a step: of the scene, of the rival
        self.compiling = False  # whether a kernel ran as plain Python in the last step
        self.steps = 0
        self.same = np.zeros(0, np.int64)  # ids of bodies created in the same step at the same place in both
        self.seen = np.zeros(0, np.int64)  # ids of all bodies that either had
        self.apart: deque[float] = deque(maxlen=KEPT)  # [px] RMS distance over the common bodies, of the last steps

    def step(self, session: Session) -> None:
        """Step the rival with the input of the scene's last step, and record the distance between both scenes' bodies.

        session: session of the played scene. Changes of the settings named in OWN are not passed on to the rival.
        """
        frame = session.inputs.now
        self.inputs.set(replace(frame, changes=tuple(each for each in frame.changes if each[0] not in OWN)))
        started = perf_counter()
        self.rival.step(self.inputs)
        self._note_times(session.report.last or 0.0, perf_counter() - started)
        self.rival.observe()
        self.steps += 1
        self._pair(session.inputs.now)
        gaps = self.distances()
        self.apart.append(float(np.sqrt((gaps * gaps).mean())) if len(gaps) else 0.0)

    def _note_times(self, ours, theirs):
        """Record the times [s] of a step of the scene (`ours`) and of the rival (`theirs`).

        Nothing is recorded, and earlier times are dropped, while a kernel is not compiled yet and runs as plain Python.
        The two scenes may wait for different kernels.
        """
        self.compiling = tiers.background and bool(tiers.wanted)
        if self.compiling:
            self.times = Typical(), Typical()
            return
        for times, seconds in zip(self.times, (ours, theirs), strict=True):
            times.note(seconds)

    @property
    def seconds(self) -> tuple[float, float] | None:
        """Times [s] of a step of (the scene, the rival); None before STEPS_TIMED steps with compiled kernels."""
        ours, theirs = self.times
        return (ours.value, theirs.value) if len(ours.last) >= STEPS_TIMED else None

    def _time_texts(self):
        """Return the step times of the scene and of the rival as two texts.

        If the times are not known yet, the texts give the reason.
        """
        if self.seconds is not None:
            return [f"{1e6 * seconds:,.0f} us a step" for seconds in self.seconds]
        waits = f"measuring, {len(self.times[0].last)} of {STEPS_TIMED} steps"
        return ["not timed while kernels compile" if self.compiling else waits] * 2

    def _pair(self, frame):
        """Update `same`, the ids of the bodies that both scenes have. frame: input of this step.

        Ids follow the order of creation. Once the scenes differ, the same id may denote different bodies. Therefore two
        bodies with the same id are paired only if they were created in the same step at the same position.
        """
        if any(name == "restart" for name, _ in frame.changes):
            self.same = self.seen = np.zeros(0, np.int64)
        ours, theirs = (each.world.bodies for each in (self.scene, self.rival))
        both, mine, other = np.intersect1d(ours["id"], theirs["id"], return_indices=True)
        near = np.hypot(ours["x"][mine] - theirs["x"][other], ours["y"][mine] - theirs["y"][other]) <= VISIBLE
        came = near & ~np.isin(both, self.seen)
        self.same = both[came | np.isin(both, self.same)]
        self.seen = np.union1d(self.seen, np.union1d(ours["id"], theirs["id"]))

    def gaps(self) -> tuple[np.ndarray, np.ndarray]:
        """Return the positions of the paired bodies: (n, 2) in the scene and (n, 2) in the rival [px]."""
        ours, theirs = self.scene.world.bodies, self.rival.world.bodies
        mine, other = (np.flatnonzero(np.isin(rows["id"], self.same)) for rows in (ours, theirs))
        mine, other = mine[np.argsort(ours["id"][mine])], other[np.argsort(theirs["id"][other])]
        return np.column_stack([ours["x"], ours["y"]])[mine], np.column_stack([theirs["x"], theirs["y"]])[other]

    def distances(self) -> np.ndarray:
        """Return the (n,) distances [px] between the two positions of each paired body."""
        ours, theirs = self.gaps()
        return np.hypot(*(ours - theirs).T)

    def report_lines(self) -> list[str]:
        """Return three lines: setting and time of the scene, setting and time of the rival, and their distance."""
        now, other = (here_of(each.world, each.tier) for each in (self.scene, self.rival))
        mine, theirs = self._time_texts()
        apart = self.distances()
        rms = self.apart[-1] if self.apart else 0.0
        seen = int((apart > VISIBLE).sum())
        alone = len(self.scene.world.bodies) + len(self.rival.world.bodies) - 2 * len(apart)
        return [
            f"{now.label(other)}: {mine}",
            f"{other.label(now)}: {theirs}",
            f"after {self.steps / 60:.1f} s {distance_text(rms)} apart, {seen} of {len(apart)} bodies by over a pixel"
            + (f", {alone} without a twin" if alone else ""),
        ]

    def draw(self, frame: Frame) -> None:
        """Draw the rival's outlines, lines between the positions of paired bodies, and the figures of the race."""
        world, camera = self.scene.views()[0]
        lens = frame.lens(camera)
        frame.surface.set_clip(lens.clip)
        if world is self.scene.world:
            self._draw_rival(frame, lens)
        self.draw_gaps(frame, self.scene)
        self._draw_figures(frame)

    def draw_gaps(self, frame: Frame, scene: Scene) -> None:
        """Draw a line between the two positions of each paired body, if they are visibly apart.

        scene: the scene that this frame shows: the played scene or the rival.
        """
        world, camera = scene.views()[0]
        if world is scene.world:
            lens = frame.lens(camera)
            frame.surface.set_clip(lens.clip)
            ours, theirs = self.gaps()
            far = np.hypot(*(ours - theirs).T) > VISIBLE
            for start, end in zip(ours[far].tolist(), theirs[far].tolist(), strict=True):
                ends = lens.points(*start), lens.points(*end)
                pygame.draw.line(frame.surface, frame.tone(ORANGE), *ends, frame.scale)
        frame.surface.set_clip(None)

    def _draw_rival(self, frame, lens):
        """Draw the outlines of the rival's shapes. Masks and tile grids are drawn as boxes.

        lens: maps world to frame coordinates.
        """
        color, world = frame.tone(SKY), self.rival.world
        seen = np.flatnonzero(lens.seen(debug.bounds(world)))[:MOST]
        for outline in debug.outlines(world, seen):
            if outline[0] not in ("mask", "tiles"):
                draw_outline(frame.surface, lens, outline, color, 1, frame.scale)
        masks = seen[world.shapes["kind"][seen] == MASK]
        draw_boxes(frame, lens, debug.bounds(world)[masks], (SKY,), np.zeros(len(masks), int))

    def _draw_figures(self, frame):
        scale, area = frame.text_scale, frame.area.clip(frame.rect)
        rows = []
        for line, color in zip(self.report_lines(), (GOLD, SKY, ORANGE), strict=True):
            wrapped = wrap(line, area.width - 16 * scale, SMALL, scale)
            rows += [(text, color if text is wrapped[0] else INK) for text in wrapped]
        width = max(frame.measure(text, SMALL, scale)[0] for text, _ in rows) + 14 * scale
        size = (width, (8 * len(rows) + 4) * scale)
        left, lowest = area.centerx - size[0] // 2, area.bottom - size[1] - 4 * scale
        place = frame.free_place(size, [(left, y) for y in range(lowest, area.top + 16 * scale, -8 * scale)])
        rect = pygame.Rect(place or (left, lowest), size)
        frame.boxes[:] = [each for each in frame.boxes if not rect.colliderect(each[0])]
        frame.surface.fill(INK, rect)
        pygame.draw.rect(frame.surface, SLATE, rect, 1)
        for number, (text, color) in enumerate(rows):
            y = rect.y + (3 + 8 * number) * scale
            frame.surface.fill(frame.tone(color), (rect.x + 4 * scale, y + scale, 3 * scale, 3 * scale))
            frame.text(text, rect.x + 10 * scale, y, PAPER, SMALL, scale)
        frame.reserve(rect)


def distance_text(pixels: float) -> str:
    """Return a distance [px] as text: two significant figures below 100 px, whole pixels from 100 px on."""
    return f"{pixels:,.0f} px" if pixels >= 100.0 else f"{pixels:.2g} px"
