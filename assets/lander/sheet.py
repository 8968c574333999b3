"""The sprite sheet "lander": the ship, its shots and flame, and the things on the moon."""

from assets.craft.atlas import Sheet
from assets.craft.shading import glow
from assets.lander import craft, stations
from assets.lander.landscape import plan


def lander_files():
    """Return {path relative to assets/: bytes} of the sprite sheet "lander"."""
    sheet = Sheet("lander")
    sheet.add("ship", craft.ship())
    sheet.add_sequence("flame", [craft.flame(i) for i in range(4)], 24)
    sheet.add_sequence("shell", [craft.shell(i) for i in range(2)], 12)
    sheet.add("hook", craft.hook())
    for station in plan()["pads"]:
        sheet.add(f"pad_{station['name']}", stations.pad(station["width"]))
    sheet.add_sequence("mast", [stations.mast(lit) for lit in (False, True)], 2)
    sheet.add("crate", stations.crate())
    sheet.add("drum", stations.drum())
    for number, size in enumerate((22, 26, 20)):
        sheet.add(f"rock_{number}", stations.rock(number, size))
    sheet.add_sequence("can", [stations.can(i) for i in range(4)], 6)
    for name, pixels in craft.icons().items():
        sheet.add(name, pixels)
    sheet.add("glow_flame", glow(96, "orange", 0.6))
    sheet.add("glow_lamp", glow(40, "red", 0.7))
    sheet.add("glow_goal", glow(56, "teal", 0.6))
    sheet.add("glow_ship", glow(190, "rock", 0.26))
    return sheet.files()
