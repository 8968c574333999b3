"""Scene: base class of the scenes. The same scene is played, tested headless, and measured.

update() is one fixed step of 1/60 s: rules, world.step(), events. update() is deterministic, uses no display and reads
no clock. draw() changes neither the state nor the random numbers. Purely visual data (particles, curves, camera shake)
are not part of state() and use their own random numbers.
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
from game.drawing.headline import Headline
from game.drawing.number_text import plain_name
from game.drawing.particles import Particles
from game.drawing.presenter import Frame
from game.files.accessibility import Accessibility
from game.input.drag import Drag
from game.input.inputs import CHANGES, InputFrame, InputState
from game.invariants.monitor import InvariantMonitor
from game.invariants.watch import WatchedWorld
from game.measurement_requests import MeasurementRequest
from game.places import OUTLINES
from physics import BROADPHASES, SOLVERS, Effects
from physics.annotations import SolverName, TierName
from physics.outline import kept

kept.use(OUTLINES)
STEP_SECONDS = 1.0 / 60.0
SOLVERS_OF_JOINTS: tuple[SolverName, ...] = ("sequential_impulse", "soft_step")
SUBSTEPS = (1, 2, 4, 8, 16, 32, "auto")  # the player's choices
# Questions of the labs, in the order of the menu.
FAIR, STANDS, FAST, COSTS = "Which hits are fair?", "What stands?", "What is fast?", "What does it cost?"
QUESTIONS = (FAIR, STANDS, FAST, COSTS)
ASSISTS = {"invincible": False, "hit_stop": True}  # name -> initial value; they affect the game, so they are input


@dataclass(frozen=True)
class Goal:
    """Goal that a scene must reach by frame `due`. met: whether it is reached; detail: the progress, as text.

    measured: False as long as the scene has nothing to judge the goal by, for example before a key is pressed. Such a
    goal has not failed, even after frame `due`.
    """

    name: str
    due: int
    met: bool
    detail: str = ""
    measured: bool = True

    def waits(self, frame: int) -> bool:
        """Return whether the goal may still be reached at frame `frame`: it is not due yet, or not measured."""
        return not self.met and (frame < self.due or not self.measured)

    @property
    def text(self) -> str:
        """The name of the goal, and its progress: "not yet" before anything is measured."""
        detail = self.detail if self.measured else "not yet"
        return f"{self.name}: {detail}" if detail else self.name


@dataclass(frozen=True)
class Result:
    """Result of a game. points: the score; seconds: time of the game; lines: further lines of text for the player."""

    won: bool
    points: int
    seconds: float
    lines: tuple = ()

    def ranks(self, ranked_by: str | None) -> bool:
        """Return whether a run with this result may enter a high-score table.

        ranked_by: "seconds", "points" or None, as in Scene.
        """
        if ranked_by == "seconds":
            return self.won
        return ranked_by == "points" and self.points > 0


@dataclass(frozen=True)
class Slider:
    """Value that the player can change with a slider.

    choices: names of the values low, low + 1, ...; () for numbers.
    """

    name: str
    low: float
    high: float
    start: float
    unit: str = ""
    step: float = 1
    choices: tuple = ()

    def clamp(self, value: float) -> float:
        """Return the valid value of the slider that is nearest to `value`.

        The result is an int if `low` and `step` are whole numbers.
        """
        steps = round((min(max(value, self.low), self.high) - self.low) / self.step)
        value = min(self.low + steps * self.step, self.high)
        return int(value) if float(self.step).is_integer() and float(self.low).is_integer() else value

    def show(self, value: float) -> str:
        """Return a value of the slider as text: the number with its unit, or the name of the choice."""
        if self.choices:
            return plain_name(self.choices[int(value) - int(self.low)])
        return f"{value:g}{' ' + self.unit if self.unit else ''}"


class Scene:
    """Base class of scenes. A scene is a direct subclass. It sets class attributes and defines the methods in DEFINED:

    build(): make the worlds with add_world(). It is called at the start and on every restart.
    update(inputs): run one fixed step.
    draw(canvas, alpha): draw on the canvas. alpha: position between the last two steps, 0..1, for interpolation.
    check(): return the scene's goals, a list of Goal.
    bot(): return the actions held in the next step, a frozenset of names, or a whole InputFrame.
    state(): return the scene's own state for the digest, a flat tuple of ints, floats, bools and strings.
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
    question = ""  # the heading in the menu under which a lab stands, one of QUESTIONS; "": a game
    effects = Effects()
    other_effects: tuple[Effects, ...] = ()  # that worlds may switch to; compiled before the start
    broadphase = "hash"
    solver: SolverName | None = None  # None: the default of World
    keeps: dict[str, str] = {}  # setting that --advise would change -> reason to keep it: see docs/advice.json
    solvers: tuple[SolverName, ...] = ()  # all solvers of the worlds, if there are several; compiled before the start
    features: tuple[str, ...] = ()  # short phrases for the menu and --list
    # Names for physics.warmup: the shape pairs and queries to compile before the start; None: all.
    pieces: tuple[str, ...] | None = None
    sliders: tuple[Slider, ...] = ()
    # Name of a slider, or "substeps" -> value used until the kernels are compiled, if frames would take over 0.1 s.
    lighter: dict[str, int | float] = {}
    actions: tuple[tuple[str, str], ...] = ()  # (key, effect) pairs for the help line
    tiers: tuple[TierName, ...] = ()  # collision tiers of the scene's sprites; the scene starts with the first
    overlays: tuple[str, ...] = ()  # overlay layers on from the start
    filter_names: dict[int, str] = {}  # membership bit -> its meaning, for the legend of the filters
    legend_at: tuple[int, int] | None = None  # canvas (x, y) where the overlays' legend goes if it is free
    head = 0  # canvas px of the title line at the top. 0: no title line
    hides_pointer = True
    weighs_effects = False  # True: the costs of its choice of effects are measured, and stored in `totals`
    draggable = False  # True: dynamic bodies follow the mouse; the pointer is then shown
    switches_broadphase = True  # False: the scene's worlds have their own broad phases
    music = "lab"  # the tune; a scene may set another on itself during a game
    ranked_by: str | None = None  # order of the high scores: "points", most first, or "seconds", fewest first
    assists: tuple[str, ...] = ()  # the names in ASSISTS that the scene offers
    takes_level = False  # True: `level` may name a file to play instead of the scene's own
    level_suffix = ""  # suffix of such files, ".tmj" or ".json": selects the player's own levels for the menu

    def __init_subclass__(cls):
        missing = [name for name in cls.DEFINED if not hasattr(cls, name)]
        if missing:
            raise TypeError(f"scene {cls.__name__} must define {', '.join(missing)}")

    def __init__(
        self,
        seed: int = 0,
        broadphase: str | None = None,
        solver: SolverName | None = None,
        tier: TierName | None = None,
        level: Path | None = None,
    ) -> None:
        self.seed = seed
        self.level_file = level  # None: the scene's own
        self.broadphase = broadphase or type(self).broadphase
        self.solver = solver or type(self).solver
        self.tier: TierName | None = tier or (self.tiers[0] if self.tiers else None)
        self.narrowphase = self.effects.narrowphase
        self.figures: dict[Any, Any] = {}  # results of the requests in measured(), as far as available
        self.totals: dict[str, Any] = {}  # costs of the choices of effects, if `weighs_effects`, as far as available
        self.substeps: int | str | None = None  # None: the world's own setting
        self.values: dict[str, float] = {slider.name: slider.start for slider in self.sliders}
        self.assist: dict[str, bool] = {name: ASSISTS[name] for name in self.assists}
        self.accessibility = Accessibility()
        self.ghost: list[tuple] | None = None  # trail of an earlier run, drawn beside this one; set from outside
        self.best = 0  # points of the best run so far, for display; set from outside
        self.particles = Particles(seed)
        self.drag = Drag()
        self.pointer = (0, 0)  # canvas position at the last step; the drag line ends here
        self.monitor: InvariantMonitor | None = None  # monitor of all worlds; None: invariants are not checked
        self.built: set[str] = set()  # names of the attributes that build() made
        self.restart()

    def restart(self) -> None:
        """Return to the first frame with the same seed. Sliders and switches keep their values."""
        self.drag.release()
        self._drop_last_run()
        self.frame = 0
        self.random = Random(self.seed)
        self.cues: list[
            tuple[str, float | None, float]
        ] = []  # (sound, canvas x, volume) of this step; the app plays them
        self.worlds: list[WatchedWorld] = []
        if self.monitor is not None:
            self.monitor = InvariantMonitor(self.monitor.strict)
        self.camera = Camera()
        self.camera.shake_share = self.accessibility.shake
        self.flash = Flash()
        self.result: Result | None = None  # set when the game has ended; the player's session decides how it continues
        self.trail: list[tuple] = []  # rows of the player's positions, one per step, for a ghost in later runs
        self.particles.clear()
        before = set(vars(self))
        self.build()
        self.built = set(vars(self)) - before

    def _drop_last_run(self):
        """Release the objects that the last build() made, so that memory never contains the objects of two runs."""
        if self.built:
            for name in self.built:
                vars(self).pop(name, None)
            self.worlds = []
            set_loaded_aside()

    def add_world(
        self,
        effects: Effects | None = None,
        broadphase: str | None = None,
        solver: SolverName | None = None,
        **settings: Any,
    ) -> WatchedWorld:
        """Create a world with the scene's effects, broad phase, solver and seed.

        Append the world to self.worlds and return it. effects, broadphase, solver: values to use instead of the
        scene's, or None. settings: further arguments of World: gravity, drag, substeps, pixels_per_meter ... An
        argument gravity, drag or wind is ignored if the world does not have the effect of that name. So a scene can be
        measured without one of its effects.
        """
        effects = (effects or self.effects).with_(narrowphase=self.narrowphase)
        for name, acts in (
            ("gravity", effects.gravity),
            ("drag", effects.drag or effects.wind),
            ("wind", effects.wind),
        ):
            if not acts:
                settings.pop(name, None)
        strategy = BROADPHASES[broadphase or self.broadphase]()
        settings.setdefault("seed", self.seed + len(self.worlds))
        if self.substeps is not None:
            settings["substeps"] = self.substeps
        world = WatchedWorld(effects, strategy, solver or self.solver, **settings)
        if self.monitor is not None:
            self.monitor.take(world)
        self.worlds.append(world)
        return world

    @property
    def world(self) -> WatchedWorld:
        """The first world."""
        return self.worlds[0]

    @property
    def weighed_world(self) -> WatchedWorld:
        """The world whose choice of effects is measured, if `weighs_effects`: that of the first view."""
        return self.views()[0][0]

    def step(self, inputs: InputState) -> None:
        """Run one fixed step: first the changes from the panel, then the mouse drag, then the scene's own update()."""
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
        if self.monitor is not None:
            self.monitor.note(self.frame, self.worlds)

    def watch_invariants(self, on: bool = True, strict: bool = False) -> None:
        """Start to check the invariants of all worlds after every step, or stop the checks if `on` is False.

        strict: see InvariantMonitor.
        """
        self.monitor = InvariantMonitor(strict) if on else None
        for world in self.worlds:
            world.watch = None
            if self.monitor is not None:
                self.monitor.take(world)

    def _cameras(self):
        """Return the scene's own camera and the cameras of its views, each camera once."""
        return {id(camera): camera for camera in (self.camera, *(each for _, each in self.views()))}.values()

    def change(self, name: str, value: Any) -> None:
        """Apply one change of a setting, given by name, that is part of a step's input.

        Raises ValueError for an unknown name or value.
        """
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
        """Set the slider `name` to `value`.

        A scene whose worlds depend on a slider overrides this method and calls super() first.
        """
        slider = next(s for s in self.sliders if s.name == name)
        self.values[name] = slider.clamp(value)
        if name == "substeps":
            self.substeps = None  # the slider's value from now on

    def set_broadphase(self, name: str) -> None:
        """Switch the broad phase of every world during a game.

        If switches_broadphase is False, the worlds keep their own broad phases.
        """
        self.broadphase = name
        if self.switches_broadphase:
            for world in self.worlds:
                world.broadphase = BROADPHASES[name]()

    def solver_choices(self) -> tuple[SolverName, ...]:
        """Return the names of the solvers that the player may switch between.

        The result is () without the effect `response`, or if each world has its own solver.
        """
        return () if self.solvers or not self.effects.response else self.valid_solvers()

    @classmethod
    def valid_solvers(cls) -> tuple[SolverName, ...]:
        """Return the names of the solvers that the scene's effects allow."""
        if cls.effects.joints:
            return SOLVERS_OF_JOINTS
        return tuple(SOLVERS) if cls.effects.stacking else ("blocking", "projection")

    @classmethod
    def level_suffixes(cls) -> tuple[str, ...]:
        """Return the suffixes of the level files that the scene can load; () if it loads none."""
        if not cls.takes_level:
            return ()
        return (cls.level_suffix,) if cls.level_suffix else (".tmj", ".json")

    def set_solver(self, name: SolverName) -> None:
        """Switch the solver of every world during a game."""
        self.solver = name
        for world in self.worlds:
            world.solver = name

    def set_substeps(self, count: Any) -> None:
        """Set the number of substeps of every world during a game.

        count: a number, or "auto", which adapts the number to the loads.
        """
        self.substeps = count
        for slider in self.sliders:
            if slider.name == "substeps" and count != "auto" and slider.low <= count <= slider.high:
                self.values["substeps"] = count
        for world in self.worlds:
            world.substeps = count

    def set_narrowphase(self, on: bool) -> None:
        """Switch the narrow phase on or off during a game.

        Without a narrow phase, contacts are between bounding boxes.
        """
        self.narrowphase = on
        for world in self.worlds:
            world.set_narrowphase(on)

    def set_tier(self, name: TierName) -> None:
        """Switch the collision tier (kind of collision shape) of all sprite bodies during a game.

        The scene must use self.tier for bodies that it adds later.
        """
        self.tier = name
        for world in self.worlds:
            for identity in world.bodies["id"].tolist():
                body = world.body(identity)
                if body.tier is not None:
                    body.tier = name

    @property
    def own_hits(self) -> dict[str, int]:
        """{part of the player's body: number of hits of this part in this run}; {} if the scene does not count hits.

        "box" is the bounding box, and "hull" the collision shape of the sprite. "core" is a small disc in the middle of
        the sprite, if the scene has one. The scene's picture, the plot of costs and the CSV file show these numbers.
        """
        return {}

    @property
    def own_body(self) -> int | None:
        """Id of the player's body in the first world; None if there is none."""
        return None

    def set_accessibility(self, accessibility: Accessibility) -> None:
        """Store the player's accessibility settings, and apply them to the camera."""
        self.accessibility = accessibility
        self.camera.shake_share = accessibility.shake

    def play(self, sound: str, x: float | None = None, volume: float = 1.0) -> None:
        """Queue a sound effect. x: canvas position of its source; None for the middle. volume: 0..1."""
        self.cues.append((sound, x, volume))

    @property
    def offer(self) -> str:
        """Text that offers a new run after the end of a run; "" during a run.

        The help line is visible while this text is shown. R restarts every scene, and the text describes the new run.
        """
        return ""

    def views(self) -> list[tuple[WatchedWorld, Camera]]:
        """Return a list of (world, camera), one for each view of a world on the canvas.

        Overlays use these cameras, and step() calls begin_step() of each. Most scenes have one world, which is seen by
        self.camera.
        """
        return [(self.world, self.camera)]

    @property
    def chosen(self) -> tuple:
        """Values of all sliders and switches, as a tuple.

        A measured run whose cost depends on them has this tuple in its name.
        """
        return *self.values.values(), self.broadphase, self.solver, self.substeps, self.narrowphase

    def measured(self) -> MeasurementRequest | None:
        """Return the measurements that the measuring process shall make during the game; None for no measurements.

        The results are stored in `figures`.
        """
        return None

    def finding(self) -> str:
        """Return the scene's finding: one sentence with the numbers measured in this run so far.

        Until all numbers are measured, the sentence begins with "not yet: " and names the missing ones. The result is
        "" for a scene without a finding.
        """
        return ""

    def headline(self) -> Headline | None:
        """Return the Headline of a lab: the sentence and the live number in its title line.

        Return None for other scenes.
        """
        return None

    def draw_on_frame(self, frame: Frame) -> None:
        """Draw at window resolution, below the overlays (curves, thin lines). Most scenes draw nothing here."""

    def observe(self) -> None:
        """Record timings after a step, for curves that the scene draws. Timings are never part of the state."""


def set_loaded_aside() -> None:
    """Run a full garbage collection, and exempt the remaining objects from collection until the next call.

    Call this function when a scene is ready to start. A full collection with numba and a scene loaded takes 40 ms, or
    two and a half frames. After this call, a collection of the objects made during a game takes less than one frame.
    """
    gc.unfreeze()
    gc.collect()
    gc.freeze()
