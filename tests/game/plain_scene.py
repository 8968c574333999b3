"""Common base class of the scenes in tests of the shell: it steps the worlds and does nothing else."""


class Plain:
    """Mixin for game.scene.Scene that steps the worlds on a plain background, without goals, bot and state."""

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
