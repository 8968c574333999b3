"""The sprite sheet "planes": the player, the enemies and bosses, pick-ups, and two large planes for the lab."""

from assets.craft.atlas import Sheet
from assets.craft.shading import flashed
from assets.shooter import bosses, enemies, large_planes, pickups, planes, raiders


def planes_files():
    """Return {path relative to assets/: bytes} of the sprite sheet "planes".

    A frame whose name ends in _flash is a white silhouette, which is shown after a hit.
    """
    sheet = Sheet("planes")
    for bank in planes.BANKS:
        sheet.add(bank, planes.player(bank))
    sheet.add_sequence("exhaust", [planes.exhaust(i) for i in range(4)], 24)
    sheet.add_sequence("dart", [enemies.dart(i) for i in range(2)], 16)
    sheet.add_sequence("saucer", [enemies.saucer(i) for i in range(4)], 10)
    sheet.add_sequence("gunship", [enemies.gunship(i) for i in range(4)], 24)
    sheet.add_sequence("powerup", [pickups.powerup(i) for i in range(4)], 8)
    for name in ("player", "dart_0", "saucer_0", "gunship_0"):
        sheet.add(f"{name.removesuffix('_0')}_flash", flashed(sheet.frames[name]))
    sheet.add("large_plane_a", large_planes.jet())
    sheet.add("large_plane_b", large_planes.bomber())
    sheet.add_sequence("hornet", [raiders.hornet(i) for i in range(2)], 16)
    sheet.add_sequence("turret", [raiders.gun_platform(i) for i in range(2)], 3)
    sheet.add_sequence("midboss", [bosses.midboss(i) for i in range(2)], 12)
    for look in bosses.LOOKS:
        sheet.add_sequence(f"boss_{look}", [bosses.boss(look, i) for i in range(2)], 8)
    sheet.add_sequence("core", [planes.marked_core(i) for i in range(2)], 8)
    sheet.add_sequence("bomb_item", [pickups.bomb_item(i) for i in range(4)], 8)
    sheet.add_sequence("life_item", [pickups.life_item(i) for i in range(4)], 8)
    return sheet.files()
