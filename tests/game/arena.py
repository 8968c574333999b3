"""A small scene for the shell's tests: two discs pushed about, one counter, one random number a step."""

from game.scene import Goal, Scene, Slider
from physics import Circle, Effects


class Arena(Scene):
    """Two discs; the first is steered, the second rests in its way."""

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
        canvas.text(f"met {self.met}", 4, 4)

    def check(self):
        return [Goal("they meet", 120, self.met > 0, f"{self.met} times"),
                Goal("they meet twice", 10_000, self.met > 1)]

    def bot(self):
        return frozenset({"right"})

    def state(self):
        return (self.frame, self.met, self.drawn)


LISTING = {"arena": "tests.game.arena:Arena"}
