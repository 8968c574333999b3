"""The machines of lab/joints, in their order."""

from scenes.lab.machines.bridge import Bridge
from scenes.lab.machines.car import Car
from scenes.lab.machines.crane import Crane
from scenes.lab.machines.doll import Doll
from scenes.lab.machines.gears import Gears
from scenes.lab.machines.machine import Machine
from scenes.lab.machines.walker import Walker

MACHINES: tuple[type[Machine], ...] = (Bridge, Doll, Car, Walker, Gears, Crane)
