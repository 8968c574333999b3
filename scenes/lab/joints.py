"""Six machines of joints, solved twice: what is gained by an exact solver, and what does it cost?

In short: in orange, joints are solved one by one; in green, all of a tree at once. The numbers are the widest gap of
the last second.

What to see: one machine in two worlds. In one its joints are solved one after another, in the other each tree of joints
at once. The large numbers are the widest gap of a joint.

Why it matters: Heavy loads on light parts pull iterative joints apart.

To try: change the solver on the bridge; drag it, and break it.

Source: Baraff, Linear-Time Dynamics using Lagrange Multipliers, 1996.
"""

from collections import deque

import pygame

from game.drawing.camera import Camera
from game.drawing.canvas import SMALL
from game.drawing.colors import FOG, GOLD, GREEN, INK, ORANGE, PAPER, RED, SKY, SLATE
from game.drawing.headline import Headline
from game.input.drag import Drag
from game.input.inputs import InputFrame
from game.measure.timing import UNSURE
from game.measurement_requests import MeasuredRun, Recipe, RunRequest
from game.scene import STANDS, Goal, Scene, Slider
from physics import Effects, World
from scenes.lab.costs import cost_of, cost_text, difference_of
from scenes.lab.looks import Looks
from scenes.lab.machines.earth import earth_picture
from scenes.lab.machines.kinds import MACHINES
from scenes.lab.machines.machine import HALF
from scenes.lab.yard import HEAD, Yard, plate

NAMES = tuple(machine.name for machine in MACHINES)
TIERS = ("iterative", "direct", "auto")
COLORS = {"iterative": ORANGE, "direct": GREEN, "auto": SKY}
FLOOR = 216  # [canvas px]
STRIP = (0, 226, 480, 44)
BOXES = ((226, 228, 124, 40), (352, 228, 124, 40))  # of the two tiers in the strip
KEPT = 60  # steps of the shown gap
SUBSTEPS = 4  # of both worlds: the number is what the iterative tier converges by
HOLDS = 0.2  # [px] widest gap of a joint that holds
FINE = 0.01  # [px] smaller gaps are not compared
RUN_AFTER, RUN_STEPS = 60, 120  # steps of a measured run: the first of them are not measured
TURN = 400  # the bot's steps with each machine
BREAK_AT = 330  # the bot's step with a machine at which it breaks it
DRAG_AT, DRAG_FOR = 270, 40
PHASES = 5  # moments at which bots of different seeds drag and break


class Joints(Scene):
    """Scene with two worlds that hold the same machine. Each world has another solver for joints."""

    name = "lab/joints"
    title = "Joints"
    question = STANDS
    about = "A bridge, a doll, a car, a walker, gears and a crane to drag, start and break; joints solved two ways."
    effects = Effects(response=True, gravity=True, rotation=True, friction=True, stacking=True, joints=True)
    features = (
        "hinges, limits, motors, springs, gears, ropes, breaking forces",
        "joints solved iteratively and directly: gap and microseconds",
        "Theo Jansen's walker; a ball of a hundred planks on a bridge",
    )
    sliders = (
        Slider("machine", 0, len(NAMES) - 1, 0, choices=NAMES),
        Slider("joints", 0, len(TIERS) - 1, 0, choices=TIERS),
    )
    actions = (("left right", "machine"), ("up down", "solver"), ("Space", "motor"), ("X", "break"))
    draggable = True
    head = HEAD
    legend_at = (4, 20)

    def build(self):
        """Create the background and the camera, then call open() to build the selected machine."""
        self.yard = Yard(FLOOR, 60)
        self.camera = Camera((0, HEAD, 480, STRIP[1] - HEAD), 1.0, x=-HALF, y=float(HEAD - FLOOR))
        self.results = {}  # (machine, tier) -> (widest gap [px], joints broken, *figures) of its first run
        self.done = set()  # names of machines that were opened, started, broken, and left
        self.machines = []
        self.mirror = Drag()  # of the world that is not shown
        self.open()

    def open(self):
        """Replace both worlds by new ones, and build the selected machine in each of them."""
        self.done |= {machine.name for machine in self.machines if machine.broken}
        self.worlds = []
        for _ in range(2):
            self.add_world(substeps=SUBSTEPS, seed=self.seed)
        self._set_tiers()
        self.machines = [MACHINES[int(self.values["machine"])](world) for world in self.worlds]
        self.earth = None
        self.looks = [Looks(world, self.camera) for world in self.worlds]
        self.gaps = [deque(maxlen=KEPT) for _ in self.worlds]
        self.since = 0

    def _set_tiers(self):
        """Set the joint solvers: "iterative" in the first world, the selected solver in the second.

        If "iterative" is selected, the second world has "direct".
        """
        chosen = TIERS[int(self.values["joints"])]
        self.tiers_shown = ("iterative", "auto" if chosen == "auto" else "direct")
        for world, tier in zip(self.worlds, self.tiers_shown, strict=True):
            world.joint_solver = tier

    @property
    def shown(self):
        """Index of the world that is drawn and that the player drags."""
        return int(self.values["joints"] > 0)

    @property
    def machine(self):
        """The machine in the world that is drawn."""
        return self.machines[self.shown]

    def change_slider(self, name, value):
        """Set the slider `name` to `value`.

        A change of the machine builds it in both worlds. A change of the joint solver also selects the world that is
        drawn.
        """
        super().change_slider(name, value)
        if name == "machine":
            self.open()
        else:
            self._set_tiers()

    def update(self, inputs):
        """Process keys, and step the drawn world and the hidden one, each with its own copy of the machine.

        The player's drag is repeated in the hidden world. The widest gap of a joint is recorded for each copy.
        """
        turn = inputs.pressed("right") - inputs.pressed("left")
        if turn:
            self.change_slider("machine", (self.values["machine"] + turn) % len(NAMES))
        turn = inputs.pressed("up") - inputs.pressed("down")
        if turn:
            self.change_slider("joints", (self.values["joints"] + turn) % len(TIERS))
        if inputs.pressed("fire"):
            on = not self.machine.running
            for machine in self.machines:
                machine.run(on)
            self.play("blip")
        if inputs.pressed("bomb"):
            for machine in self.machines:
                machine.smash()
            self.play("hit", None, 0.6)
        self.mirror.step(inputs, [(self.worlds[1 - self.shown], self.camera)])
        for machine, gaps, tier in zip(self.machines, self.gaps, self.tiers_shown, strict=True):
            machine.disturbed |= self.drag.holds or self.mirror.holds
            machine.step()
            gaps.append(machine.recent)
            if machine.name not in self.done:
                self.results[machine.name, tier] = (machine.worst, machine.broken, *machine.figures())
        self.since += 1

    def views(self):
        """Return a list with the shown (world, camera)."""
        return [(self.worlds[self.shown], self.camera)]

    def measured(self):
        """Return a RunRequest: the current machine with each of the three joint solvers, timed during the game."""
        return RunRequest([self._run_name(tier) for tier in TIERS], self._make)

    def _run_name(self, tier):
        return NAMES[int(self.values["machine"])], tier, self.broadphase, self.world.solver, self.world.substeps

    def _make(self, name):
        machine, tier, broadphase, solver, substeps = name
        effects = [each for each in self.effects.names() if getattr(self.effects, each)]
        made = Recipe(f"{__name__}:running", (machine, tier, solver, substeps, effects))
        return MeasuredRun([made], broadphase, RUN_STEPS)

    def draw(self, canvas, alpha):
        """Draw the background, the machine of the visible world, and a strip with the machine's name and figures.

        alpha: position (0..1) between the last two steps.
        """
        self.yard.draw(canvas)
        looks = self.looks[self.shown]
        for identity, paint in self.machine.paints.items():
            if identity not in looks.known and (looks.world.bodies["id"] == identity).any():
                looks.known[identity] = (looks.world.body(identity).shapes, paint, False)
        for picture, place in self._earth():
            canvas.surface.blit(picture, place)
        self.machine.draw_behind(canvas, self.camera, alpha)
        looks.draw(canvas, alpha)
        self.machine.draw(canvas, self.camera, alpha)
        canvas.text(self.sentence(), 240, FLOOR + 4, PAPER, SMALL, align="center", outline=True)
        self._draw_strip(canvas)

    def sentence(self):
        """Return a sentence that compares the widest gaps of the two joint solvers, and the time of a step if it is
        known.
        """
        loose, tight = (machine.worst for machine in self.machines)
        exact = self.tiers_shown[1]
        if self.since < 2 or max(loose, tight) < FINE:
            return "no joint has been apart by a hundredth of a pixel so far"
        more = difference_of(self, self._run_name(exact), self._run_name("iterative"))
        costs = "" if more is None or not more.counts else f", for {1e6 * more.seconds:,.0f} us more a step"
        if loose > 2.0 * tight:
            gain = f"{loose / tight:,.0f} times" if tight > 0.001 * loose else "over 1,000 times"
            return f"widest gap so far {gap_text(loose)} px iteratively: {exact}, it is {gain} smaller{costs}"
        return f"widest gap so far {gap_text(loose)} px iteratively, {gap_text(tight)} {exact}: alike{costs}"

    def _earth(self):
        """Return a list of (picture, position [canvas px]) of the machine's static bodies.

        The pictures are made at the first call and cached.
        """
        if self.earth is None:
            world, looks = self.worlds[self.shown], self.looks
            bodies = [world.body(identity) for identity in self.machine.grounds]
            for look in looks:
                look.known |= {body.id: ((), None, False) for body in bodies}  # drawn here
            self.earth = [
                earth_picture(body.shapes[0], self.camera.to_canvas(*body.position)) for body in reversed(bodies)
            ]
        return self.earth

    def _draw_strip(self, canvas):
        plate(canvas, STRIP, (20, 16, 32, 230))
        machine = self.machine
        canvas.text(machine.name.upper(), 6, 229, GOLD)
        canvas.text(machine.figure(), 218, 230, PAPER, SMALL, align="right")
        canvas.text(machine.seen, 6, 240, PAPER, SMALL)
        canvas.text(f"Space {machine.starts}", 6, 249, GOLD if machine.running else FOG, SMALL)
        canvas.text(f"X {machine.breaks}", 6, 258, RED if machine.broken else FOG, SMALL)
        if machine.broken:
            canvas.text(f"{machine.broken} broken", 218, 258, RED, SMALL, align="right")
        for number, (tier, rect) in enumerate(zip(self.tiers_shown, BOXES, strict=True)):
            self._draw_tier(canvas, tier, rect, number)

    def _draw_tier(self, canvas, tier, rect, number):
        """Draw the widest gap of the last second and the cost of a step for one of the two worlds.

        tier: the world's joint solver; rect: canvas rectangle; number: index of the world.
        """
        x, y, width, _ = rect
        shown = number == self.shown
        pygame.draw.rect(canvas.surface, INK, rect)
        pygame.draw.rect(canvas.surface, COLORS[tier] if shown else SLATE, rect, 1)
        canvas.text(f"{tier}{', shown' if shown else ''}", x + 4, y + 3, COLORS[tier], SMALL)
        canvas.text(cost_text(self, self._run_name(tier)), x + width - 4, y + 3, PAPER, SMALL, align="right")
        canvas.text(f"{gap_text(self.gap(number))} px", x + width // 2, y + 12, COLORS[tier], scale=2, align="center")
        canvas.text("widest gap of the last second", x + width // 2, y + 31, FOG, SMALL, align="center")

    def gap(self, number):
        """Return the widest gap of a joint in the last second [px]. number: index of the world."""
        return max(self.gaps[number], default=0.0)

    def draw_on_frame(self, frame):
        """Draw the small parts, rods, ropes and pins of the visible machine. A gap between a joint's anchors is red."""
        looks = self.looks[self.shown]
        looks.draw_on_frame(frame)
        lens = frame.lens(self.camera)
        frame.surface.set_clip(lens.clip)
        self.machine.draw_on_frame(frame, lens)
        frame.surface.set_clip(None)

    def headline(self):
        """Return the Headline: the sentence and the number in the scene's title line."""
        loose, tight = (machine.worst for machine in self.machines)
        name, exact = self.machine.name.capitalize(), self.tiers_shown[1]
        sentence = f"{name}: solved iteratively, loaded joints gape; {exact}, they close."
        number, unit = f"{gap_text(loose)} px", f"widest gap; {exact} {gap_text(tight)} px"
        if self.shown:
            sentence = f"{name}: {exact}, loaded joints gape too."
            number, unit = f"{gap_text(tight)} px", f"widest gap; iterative {gap_text(loose)} px"
        good, how = (loose, tight)[self.shown] < HOLDS, ("solved iteratively", exact)[self.shown]
        headline = Headline(sentence, "up: solver", number, unit, self.since, KEPT, "steps", good)
        return headline.asks(f"{name}: do loaded joints hold if they are {how}?")

    def finding(self):
        """Return a sentence with two figures for each joint solver: the widest gap of a joint, and the time of a step.

        The gaps count from the time at which the machine was built.
        """
        if self.since < KEPT:
            return "not yet: the machine has to run for a second"
        words = []
        for number, tier in enumerate(self.tiers_shown):
            machine, cost = self.machines[number], cost_of(self, self._run_name(tier))
            time = "" if cost is None else f" ({cost_text(self, self._run_name(tier))} a step)"
            words.append(f"{tier} {gap_text(machine.worst)} px{time}")
        more = difference_of(self, self._run_name(self.tiers_shown[1]), self._run_name("iterative"))
        costs = ""
        if more is not None:
            costs = f"; exactness costs {more.text()} us" if more.counts else f"; the cost of exactness {UNSURE}"
        return f"{self.machine.name}: widest gap of a joint, {', '.join(words)}{costs}"

    def check(self):
        """Return the goals of all machines, a list of Goal, checked with the results for both joint solvers."""
        return [
            Goal(f"{machine.name}: {name}", (number + 1) * TURN, met, detail, (machine.name, "direct") in self.results)
            for number, machine in enumerate(MACHINES)
            for name, met, detail in machine.goals(
                *(self.results.get((machine.name, tier)) for tier in ("iterative", "direct"))
            )
        ]

    def bot(self):
        """Return the bot's input for the next step.

        The bot opens each machine in turn, drags it, and breaks it. The seed shifts the steps at which it drags and
        breaks.
        """
        number, step = divmod(self.frame, TURN)
        number %= len(NAMES)
        if step == 0 and self.values["machine"] != number:
            return InputFrame(changes=(("slider:machine", number),))
        step -= self.seed % PHASES * 4
        if step == BREAK_AT:
            return InputFrame(frozenset(("bomb",)))
        if DRAG_AT <= step < DRAG_AT + DRAG_FOR:
            x, y = self.pointer
            if step == DRAG_AT:
                x, y = (round(each) for each in lens_of(self.camera, self.machine.handle()))
            return InputFrame(pointer=(x, y - (step > DRAG_AT)), pointer_down=True)
        return InputFrame()

    def state(self):
        """Return the scene's part of the state hash, a flat tuple: the measurements. The worlds are hashed
        separately.
        """
        machines = (
            value
            for machine in self.machines
            for value in (machine.steps, machine.broken, machine.running, machine.disturbed, machine.worst)
        )
        figures = (value for key in sorted(self.results) for value in (*key, *self.results[key]))
        return (self.frame, self.since, len(self.done), *self.values.values(), *machines, *figures)


def lens_of(camera, point):
    """Return the position (x, y) [canvas px] of a world point (x, y) [px]."""
    return tuple(float(each) for each in camera.to_canvas(*point, 1.0))


def gap_text(gap):
    """Return a gap [px] as short text, with three decimals below 0.1 px, and "0" below 1e-6 px."""
    if gap < 0.001:
        return "0" if gap < 1e-6 else "<0.001"
    return f"{gap:.3f}" if gap < 0.1 else f"{gap:.2f}" if gap < 10 else f"{gap:.0f}"


def running(machine, tier, solver, substeps, effects):
    """Return the snapshot of a world in which a machine has run for a second, for the measuring process.

    machine: name of the machine; tier: solver of its joints; effects: list of the names of the world's effects.
    """
    declared = Effects(**dict.fromkeys(effects, True))
    world = World(declared, solver=solver, substeps=substeps)
    world.joint_solver = tier
    made = next(each for each in MACHINES if each.name == machine)(world)
    for _ in range(RUN_AFTER):
        made.step()
    return world.snapshot()
