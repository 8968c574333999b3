"""Scene: one class per file in scenes/. The same scene is played, tested headless, and measured.

update() is one fixed step of 1/60 s: rules, world.step(), events. It is deterministic, touches no display
and reads no clock. draw() changes nothing: not the state, not the random numbers. What is only seen
(particles, curves, camera shake) lives outside state() and uses random numbers of its own.
"""

import gc
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from random import Random
from typing import Any

from game.drawing.camera import Camera
from game.drawing.canvas import Canvas
from game.drawing.flash import Flash
from game.drawing.number_text import plain_name
from game.drawing.particles import Particles
from game.drawing.presenter import Frame
from game.files.accessibility import Accessibility
from game.input.drag import Drag
from game.input.inputs import CHANGES, InputFrame, InputState
from game.invariants.lights import Lights
from game.invariants.watch import WatchedWorld
from game.places import OUTLINES
from game.wishes import Lanes, Sprites
from physics import BROADPHASES, SOLVERS, Effects
from physics.outline import kept

kept.use(OUTLINES)
STEP_SECONDS = 1.0 / 60.0
SUBSTEPS = (1, 2, 4, 8, 16, 32, "auto")  # that a player may choose from
ASSISTS = {"invincible": False, "hit_stop": True}  # name -> how a game starts; they change it, so they come as input


@dataclass(frozen=True)
class Goal:
    """One thing a scene must reach. `due`: the frame by which it must be met. `detail`: what is so far."""

    name: str
    due: int
    met: bool
    detail: str = ""


@dataclass(frozen=True)
class Result:
    """How a game ended. `lines`: what more there is to say of it."""

    won: bool
    points: int
    seconds: float
    lines: tuple = ()

    def ranks(self, ranked_by: str | None) -> bool:
        """True if a run that ended so belongs into a table at all; ranked_by as in Scene."""
        if ranked_by == "seconds":
            return self.won
        return ranked_by == "points" and self.points > 0


@dataclass(frozen=True)
class Slider:
    """A value the player may turn. `choices` names the whole numbers low, low + 1, ... when given."""

    name: str
    low: float
    high: float
    start: float
    unit: str = ""
    step: float = 1
    choices: tuple = ()

    def clamp(self, value: float) -> float:
        """The nearest allowed value; whole when the step is whole."""
        steps = round((min(max(value, self.low), self.high) - self.low) / self.step)
        value = min(self.low + steps * self.step, self.high)
        return int(value) if float(self.step).is_integer() and float(self.low).is_integer() else value

    def show(self, value: float) -> str:
        """The value as text."""
        if self.choices:
            return plain_name(self.choices[int(value) - int(self.low)])
        return f"{value:g}{' ' + self.unit if self.unit else ''}"


class Scene:
    """One level of subclasses, which set the class attributes and define each of DEFINED:

    build(): make the worlds (add_world); called at the start and on every restart.
    update(inputs): one fixed step.
    draw(canvas, alpha): draw on the canvas, alpha 0..1 between the step before and the last.
    check(): the scene's goals, a list of Goal.
    bot(): the actions held in the next step, a frozenset of names, or a whole InputFrame.
    state(): the scene's own state for the digest, a flat tuple of ints, floats, bools and strings.
    """

    DEFINED = ("build", "update", "draw", "check", "bot", "state")
    build: Callable[[], None]
    update: Callable[[InputState], None]
    draw: Callable[[Canvas, float], None]
    check: Callable[[], list[Goal]]
    bot: Callable[[], frozenset[str] | InputFrame]
    state: Callable[[], tuple]

    name = ""  # as in scenes/__init__.py
    title = ""
    about = ""  # one sentence for the menu
    effects = Effects()
    other_effects: tuple[Effects, ...] = ()  # that its worlds may be put under: compiled before the start
    broadphase = "hash"
    solver: str | None = None  # None: the World's own choice
    keeps: dict[str, str] = {}  # what --advise would set otherwise -> why it stays as it is: see docs/advice.json
    solvers: tuple[str, ...] = ()  # all that its worlds may use, where there are several: compiled before the start
    features: tuple[str, ...] = ()  # short phrases for the menu and --list
    # Of physics.warmup: what its bodies meet and it asks, compiled before the start; None: all.
    pieces: tuple[str, ...] | None = None
    sliders: tuple[Slider, ...] = ()
    # Slider, or "substeps" -> its value until the physics is compiled, where frames would take over 0.1 s.
    lighter: dict[str, int | float] = {}
    actions: tuple[tuple[str, str], ...] = ()  # (what to press, what it does) pairs for the help line
    tiers: tuple[str, ...] = ()  # names of the tiers the scene's sprites can be tested at; the first is the start
    overlays: tuple[str, ...] = ()  # overlay layers on from the start
    filter_names: dict[int, str] = {}  # membership bit -> what it stands for, for the legend of the filters
    legend_at: tuple[int, int] | None = None  # canvas (x, y) where the overlays' legend goes if it is free
    head = 0  # canvas px of the line on top that holds the title: the line of the keys goes beside it. 0: there is none
    hides_pointer = True
    draggable = False  # True: dynamic bodies follow the mouse; the pointer is then shown
    switches_broadphase = True  # False: the scene's worlds have their own
    music = "lab"  # the tune; a scene may set another on itself, mid-game
    ranked_by: str | None = None  # what high scores are ordered by: "points", most first, or "seconds", fewest first
    assists: tuple[str, ...] = ()  # those of ASSISTS that it offers
    takes_level = False  # True: `level` may name a file to play instead of the scene's own
    level_suffix = ""  # of such files, ".tmj" or ".json": which of the player's own the menu lists

    def __init_subclass__(cls):
        missing = [name for name in cls.DEFINED if not hasattr(cls, name)]
        if missing:
            raise TypeError(f"scene {cls.__name__} must define {', '.join(missing)}")

    def __init__(
        self,
        seed: int = 0,
        broadphase: str | None = None,
        solver: str | None = None,
        tier: str | None = None,
        level: Path | None = None,
    ) -> None:
        self.seed = seed
        self.level_file = level  # None: the scene's own
        self.broadphase = broadphase or type(self).broadphase
        self.solver = solver or type(self).solver
        self.tier = tier or (self.tiers[0] if self.tiers else None)
        self.narrowphase = self.effects.narrowphase
        self.figures: dict[Any, Any] = {}  # of what is measured(), as far as somebody has
        self.substeps: int | str | None = None  # None: what each world was made with
        self.values: dict[str, float] = {slider.name: slider.start for slider in self.sliders}
        self.assist: dict[str, bool] = {name: ASSISTS[name] for name in self.assists}
        self.accessibility = Accessibility()
        self.ghost: list[tuple] | None = None  # the trail of an earlier run, seen beside this one; set from outside
        self.best = 0  # points of the best run so far, to be shown; set from outside too
        self.particles = Particles(seed)
        self.drag = Drag()
        self.pointer = (0, 0)  # of the last step, where a drag is drawn to
        self.lights: Lights | None = None  # of the invariants of its worlds; None: nobody watches
        self.built: set[str] = set()  # names of the attributes that build() made
        self.restart()

    def restart(self) -> None:
        """Back to the first frame with the same seed. Sliders and switches keep what was chosen."""
        self.drag.release()
        self._drop_last_run()
        self.frame = 0
        self.random = Random(self.seed)
        self.cues: list[
            tuple[str, float | None, float]
        ] = []  # (sound, canvas x, volume) of this step; the app plays them
        self.worlds: list[WatchedWorld] = []
        if self.lights is not None:
            self.lights = Lights(self.lights.strict)
        self.camera = Camera()
        self.camera.shake_share = self.accessibility.shake
        self.flash = Flash()
        self.result: Result | None = None  # a Result when the game has ended; who plays it decides what comes then
        self.trail: list[tuple] = []  # rows of where the player was in each step, for a ghost in later runs
        self.particles.clear()
        before = set(vars(self))
        self.build()
        self.built = set(vars(self)) - before

    def _drop_last_run(self):
        """Let go of what build() made: two runs at once would be the most memory that a game ever takes."""
        if self.built:
            for name in self.built:
                vars(self).pop(name, None)
            self.worlds = []
            set_loaded_aside()

    def add_world(
        self, effects: Effects | None = None, broadphase: str | None = None, solver: str | None = None, **settings: Any
    ) -> WatchedWorld:
        """Make a world with the scene's effects, broad phase, solver and seed, and list it in self.worlds.

        settings: what else World takes: gravity, drag, substeps, pixels_per_meter ...
        """
        effects = (effects or self.effects).with_(narrowphase=self.narrowphase)
        strategy = BROADPHASES[broadphase or self.broadphase]()
        settings.setdefault("seed", self.seed + len(self.worlds))
        if self.substeps is not None:
            settings["substeps"] = self.substeps
        world = WatchedWorld(effects, strategy, solver or self.solver, **settings)
        if self.lights is not None:
            self.lights.take(world)
        self.worlds.append(world)
        return world

    @property
    def world(self) -> WatchedWorld:
        """The first world."""
        return self.worlds[0]

    def step(self, inputs: InputState) -> None:
        """One fixed step: changes from the panel first, then the mouse's pull, then the scene's own update."""
        self.cues.clear()
        for name, value in inputs.now.changes:
            self.change(name, value)
        for camera in self._cameras():
            camera.begin_step(STEP_SECONDS)
        if self.draggable:
            self.pointer = inputs.pointer
            self.drag.step(inputs, self.views())
        self.update(inputs)
        self.particles.step(STEP_SECONDS)
        self.flash.step()
        self.frame += 1
        if self.lights is not None:
            self.lights.note(self.frame, self.worlds)

    def watch_invariants(self, on: bool = True, strict: bool = False) -> None:
        """Look at every step of its worlds from now on, or no longer. strict: see Lights."""
        self.lights = Lights(strict) if on else None
        for world in self.worlds:
            world.watch = None
            if self.lights is not None:
                self.lights.take(world)

    def _cameras(self):
        """Each camera once: the scene's own, and those of all its pictures."""
        return {id(camera): camera for camera in (self.camera, *(each for _, each in self.views()))}.values()

    def change(self, name: str, value: Any) -> None:
        """Apply one change that came with the input. An unknown name or value raises ValueError."""
        if name.startswith("slider:") and name[7:] in self.values:
            self.change_slider(name[7:], value)
        elif name == "broadphase" and value in BROADPHASES:
            self.set_broadphase(value)
        elif name == "solver" and value in self.solver_choices():
            self.set_solver(value)
        elif name == "substeps" and self.effects.stacking and value in SUBSTEPS and not isinstance(value, bool):
            self.set_substeps(value)
        elif name == "narrowphase" and isinstance(value, bool):
            self.set_narrowphase(value)
        elif name == "tier" and value in self.tiers:
            self.set_tier(value)
        elif name.startswith("assist:") and name[7:] in self.assist and isinstance(value, bool):
            self.assist[name[7:]] = value
        elif name == "restart":
            self.restart()
        else:
            valid = ", ".join((*CHANGES, *(f"slider:{n}" for n in self.values), *(f"assist:{n}" for n in self.assist)))
            raise ValueError(f"change {name!r} to {value!r} is not possible here; changes: {valid}")

    def change_slider(self, name: str, value: float) -> None:
        """Set a slider. A scene whose worlds depend on it overrides this and calls super first."""
        slider = next(s for s in self.sliders if s.name == name)
        self.values[name] = slider.clamp(value)
        if name == "substeps":
            self.substeps = None  # the slider's from now on

    def set_broadphase(self, name: str) -> None:
        """Switch the broad phase of every world, mid-game."""
        self.broadphase = name
        if self.switches_broadphase:
            for world in self.worlds:
                world.broadphase = BROADPHASES[name]()

    def solver_choices(self) -> tuple[str, ...]:
        """The solvers that the player may switch between: none where nothing is pushed, or each world has its own."""
        return () if self.solvers or not self.effects.response else self.valid_solvers()

    @classmethod
    def valid_solvers(cls) -> tuple[str, ...]:
        """The solvers that the scene's effects allow."""
        return tuple(SOLVERS) if cls.effects.stacking else ("blocking", "projection")

    @classmethod
    def level_suffixes(cls) -> tuple[str, ...]:
        """Of the files that it can play as levels: () where it takes none."""
        if not cls.takes_level:
            return ()
        return (cls.level_suffix,) if cls.level_suffix else (".tmj", ".json")

    def set_solver(self, name: str) -> None:
        """Switch the solver of every world, mid-game."""
        self.solver = name
        for world in self.worlds:
            world.solver = name

    def set_substeps(self, count: Any) -> None:
        """Solve every world with so many substeps, "auto" for as many as its loads ask for, mid-game."""
        self.substeps = count
        for slider in self.sliders:
            if slider.name == "substeps" and count != "auto" and slider.low <= count <= slider.high:
                self.values["substeps"] = count
        for world in self.worlds:
            world.substeps = count

    def set_narrowphase(self, on: bool) -> None:
        """Stop at boxes, or do not, mid-game."""
        self.narrowphase = on
        for world in self.worlds:
            world.set_narrowphase(on)

    def set_tier(self, name: str) -> None:
        """Test the bodies that have a tier at another one, mid-game; new ones are to be added with self.tier."""
        self.tier = name
        for world in self.worlds:
            for identity in world.bodies["id"].tolist():
                body = world.body(identity)
                if body.tier is not None:
                    body.tier = name

    @property
    def own_body(self) -> int | None:
        """Id of the body, in the first world, that the player must keep from being hit; None where there is none."""
        return None

    def set_accessibility(self, accessibility: Accessibility) -> None:
        """Take what the player wants of the picture."""
        self.accessibility = accessibility
        self.camera.shake_share = accessibility.shake

    def play(self, sound: str, x: float | None = None, volume: float = 1.0) -> None:
        """Ask for a sound effect. x: canvas position for the pan; None: the middle."""
        self.cues.append((sound, x, volume))

    @property
    def offer(self) -> str:
        """What another run begins with, "" while this one goes on by itself; while there is one the keys stay in sight.

        (R begins it in every scene; a scene says what will happen.)
        """
        return ""

    def views(self) -> list[tuple[WatchedWorld, Camera]]:
        """(world, camera) of each picture on the canvas: overlays look through them, step() begins their steps."""
        return [(self.world, self.camera)]

    @property
    def chosen(self) -> tuple:
        """All that a player has chosen here, sliders and switches: what a lane that depends on it is named after."""
        return *self.values.values(), self.broadphase, self.solver, self.substeps, self.narrowphase

    def measured(self) -> Sprites | Lanes | None:
        """What is to be measured for `figures`, beside the game; None: nothing now."""
        return None

    def finding(self) -> str:
        """What it has found, one sentence with numbers that it measured in this run, as they are now; before that "not
        yet: " and what it still needs. "" where nothing is to be found."""
        return ""

    def draw_on_frame(self, frame: Frame) -> None:
        """Draw at window resolution, under the overlays (curves, thin lines). Most scenes have nothing here."""

    def observe(self) -> None:
        """Note timings after a step, for curves. Never part of the state."""


def set_loaded_aside() -> None:
    """Collect what is garbage now, and count everything else as here to stay until the next call.

    A full collection with numba and a scene loaded takes 40 ms, two frames and a half; of what a game makes as it goes,
    less than one. Call it when a scene is ready to begin.
    """
    gc.unfreeze()
    gc.collect()
    gc.freeze()
