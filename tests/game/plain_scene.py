"""Common base of the scenes for tests of the shell: their worlds are stepped, with nothing else."""


class Plain:
    """Base class beside game.scene.Scene that steps the worlds on a plain ground, without goals, bot and state."""

    def update(self, inputs):
        for world in self.worlds:
            world.step()

    def draw(self, canvas, alpha):
        canvas.surface.fill((40, 40, 60))

    def check(self):
        return []

    def bot(self):
        return frozenset()

    def state(self):
        return (self.frame,)
