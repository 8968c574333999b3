"""A ball falls on a floor; the goal is a bounce as high as restitution squared times its height."""

import pygame

from game.scene import Goal, Scene, Slider
from physics import Circle, Effects, Material, Polygon

RADIUS, START, FLOOR = 8.0, 40.0, 232.0  # [px] the ball, where its centre starts, where it touches the floor


class Bounce(Scene):
    name, title, features = "example/bounce", "Bounce", ("restitution",)
    about = "A ball on a floor: does it come up as high as its restitution says?"
    effects = Effects(response=True, gravity=True, restitution=True)
    sliders = (Slider("restitution", 0.4, 0.9, 0.7, step=0.1),)  # a change holds from the next restart on

    def build(self):
        world, ball = self.add_world(gravity=(0, 320)), Material(restitution=self.values["restitution"])
        world.add_body(Polygon.box(400, 20), position=(240, FLOOR + RADIUS + 10), kind="static")
        self.ball, self.top = world.add_body(Circle(RADIUS), position=(240, START), material=ball), FLOOR

    def update(self, inputs):
        self.world.step()
        if self.ball.velocity[1] < 0:  # on its way up, never higher than after its first bounce
            self.top = min(self.top, self.ball.position[1])

    def draw(self, canvas, alpha):
        canvas.surface.fill("navy")
        pygame.draw.rect(canvas.surface, "white", (40, FLOOR + RADIUS, 400, 20))
        pygame.draw.circle(canvas.surface, "gold", self.ball.position, RADIUS)

    def check(self):
        share, due = (FLOOR - self.top) / (FLOOR - START), self.values["restitution"] ** 2
        return [Goal("comes up as high as it must", 240, abs(share - due) < 0.02, f"{share:.3f}, must be {due:.3f}")]

    def bot(self):
        return frozenset()

    def state(self):
        return (self.top,)
