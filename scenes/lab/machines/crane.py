"""A crane: a trolley on a rail, a chain, and a heavy claw that holds a crate; one of the machines of lab/joints."""

from physics import Drive, Polygon, Prismatic, Revolute, Weld
from scenes.lab.machines.machine import GRAVITY, STEEL, TEAL, VIOLET, WOOD, Machine

RAIL = -178.0  # [px] its height
LINKS, LONG, THICK = 9, 13.0, 4.0
HEAVY = 60.0  # links: mass of the claw; the crate has as much
ROOM = 150.0  # [px] from the middle: there the trolley turns back
SPEED = 80.0  # [px/s] of the trolley
PULL = 0.15  # of the whole weight: greatest force of its motor
GRIP = 60.0  # times the crate's weight: breaking force of the claw's hold


class Crane(Machine):
    """A claw on a chain under a trolley. The claw and the crate that it holds have the mass of 120 links."""

    name = "crane"
    seen = "A grapple on a chain: its load has 120 links' mass."
    starts = "drives the trolley to and fro"
    breaks = "drops the crate"

    def build(self):
        """Build the rail, the trolley on it, the chain, the claw and the crate."""
        self.trolley = self.add(Polygon.box(44, 12), 0.0, RAIL, VIOLET, mass=4000.0)
        self.slide = self.world.add_joint(
            Prismatic(None, self.trolley, at=(0.0, RAIL), axis=(1, 0), limits=(-ROOM - 30, ROOM + 30))
        )
        before, y = self.trolley, RAIL + 6.0
        for _ in range(LINKS):
            link = self.add(Polygon.box(THICK, LONG - 1.0), 0.0, y + LONG / 2, STEEL)
            self.world.add_joint(Revolute(before, link, at=(0.0, y)))
            before, y = link, y + LONG
        weight = HEAVY * before.mass
        self.claw = self.add(Polygon([(-14, -8), (14, -8), (20, 8), (-20, 8)]), 0.0, y + 8, TEAL, mass=weight)
        self.world.add_joint(Revolute(before, self.claw, at=(0.0, y)))
        self.crate = self.add(Polygon.box(30, 30), 0.0, y + 16 + 15, WOOD, mass=weight)
        self.hold = self.world.add_joint(Weld(self.claw, self.crate, at=(0.0, y + 16)))
        self.weak = [self.hold]
        self.hold.breaks = (GRIP * weight * GRAVITY, None)
        self.way, self.load, self.carried = 1, 2.0 * weight + 4000.0, 0.0

    def drive(self):
        """Drive the trolley in its current direction, or brake it if the machine does not run."""
        speed = self.way * SPEED if self.running else 0.0
        self.slide.motor = Drive(speed, max=PULL * self.load * GRAVITY)

    def control(self):
        """Reverse the trolley's direction when it reaches an end of its route on the rail."""
        x = self.trolley.center.x
        if x * self.way > ROOM:
            self.way = -self.way
            self.drive()

    def measure(self):
        """Add the crate's horizontal motion in this step to the distance [px] over which the claw has carried it."""
        if not self.broken:
            self.carried += abs(self.crate.velocity.x) * self.world.dt

    def figure(self):
        """Return the distance over which the crate was carried, or "let go" if the claw has lost it, as text."""
        return "let go" if self.broken else f"carried {self.carried:.0f} px"

    def figures(self):
        """Return (distance over which the crate was carried [px],)."""
        return (self.carried,)

    def handle(self):
        """Return the centre (x, y) [px] of the crate, at which the bot drags the crane."""
        return tuple(self.crate.center)

    def draw_behind(self, canvas, camera, alpha):
        """Draw the trolley's rail. alpha: position (0..1) between the last two steps."""
        x, y = camera.to_canvas(-240.0, RAIL, alpha)
        surface = canvas.surface
        for dy, color in (
            (-3, (32, 28, 48)),
            (-2, (92, 96, 124)),
            (-1, (190, 196, 216)),
            (0, (92, 96, 124)),
            (1, (32, 28, 48)),
        ):
            surface.fill(color, (round(x), round(y) + dy, 480, 1))

    @classmethod
    def goals(cls, iterative, direct):
        """Return the machine's goals, a list of (text, whether it is met, measured value as text).

        Exact pins hold the load, iterative pins come apart, and the claw loses the crate. iterative, direct: results
        (widest gap [px], broken joints, *figures()) with each joint solver, or None.
        """
        tight, broken, carried = direct or (9.0, 0, 0.0)
        loose = 0.0 if iterative is None else iterative[0]
        return [
            ("the crate is carried", carried > 150.0, f"{carried:.0f} px"),
            ("exact pins hold the load", tight < 0.2, f"{tight:.4f} px"),
            ("iterative pins come apart", loose > 4 * tight, f"{loose:.4f} px"),
            ("the claw lets go", broken == 1, f"{broken} joints"),
        ]
