"""Small scenes for the shell's tests: two discs, of which one is steered, a counter, and one random number a step."""

from game.errors import FileError
from game.scene import Goal, Result, Scene, Slider
from physics import Circle, Effects


class Arena(Scene):
    """Scene with two discs; the first one is steered, the second one rests in its path."""

    name = "arena"
    title = "Arena"
    about = "A scene for tests."
    effects = Effects.detection()
    sliders = (Slider("speed", 10, 200, 60, "px/s", step=10),)

    def build(self):
        self.add_world()
        self.disc = self.world.add_body(Circle(8.0), position=(100.0, 100.0))
        self.world.add_body(Circle(8.0), position=(160.0, 100.0))
        self.met = 0
        self.drawn = 0.0

    def update(self, inputs):
        way = inputs.held("right") - inputs.held("left")
        self.disc.velocity = (way * self.values["speed"], 0.0)
        self.world.step()
        self.met += len(self.world.events.begin)
        self.drawn = self.random.random()
        self.play("hit", 240.0)

    def draw(self, canvas, alpha):
        canvas.surface.fill((24, 30, 44))
        canvas.text(f"met {self.met}", 4, 4)

    def check(self):
        return [
            Goal("they meet", 120, self.met > 0, f"{self.met} times"),
            Goal("they meet twice", 10_000, self.met > 1),
        ]

    def bot(self):
        return frozenset({"right"})

    def state(self):
        return (self.frame, self.met, self.drawn)


class Race(Arena):
    """A game that is won when the discs meet and lost after LAST frames; each steered frame gives a point."""

    name = "race"
    title = "Race"
    ranked_by = "points"
    assists = ("invincible", "hit_stop")
    actions = (("arrows", "drive"), ("Space", "jump"))
    takes_level = True
    level_suffix = ".json"
    LAST = 240

    def build(self):
        if self.level_file is not None and "mistake" in self.level_file.read_text():
            raise FileError(self.level_file, "line 1", "has a mistake in it")
        super().build()
        self.points = 0

    def update(self, inputs):
        if self.result is not None:
            return
        super().update(inputs)
        self.points += inputs.held("right")
        x, y = self.disc.position
        self.trail.append((float(x), float(y), "run_0", 1))
        if self.met or self.frame >= self.LAST:
            self.result = Result(bool(self.met), self.points, self.frame / 60, ("a line about it",))

    def state(self):
        return (*super().state(), self.points)


class Dash(Race):
    """The game Race, ranked by time."""

    name = "dash"
    title = "Dash"
    ranked_by = "seconds"


LISTING = {"arena": "tests.game.arena:Arena"}
GAMES = {**LISTING, "race": "tests.game.arena:Race", "dash": "tests.game.arena:Dash"}
