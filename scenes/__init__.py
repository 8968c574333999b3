"""Every scene in menu order: name -> "module:Class", imported when first asked for.

A scene that is not listed here is not in the game; tests/scenes/test_registry.py compares the list with the
folder, so a forgotten line fails.
"""

SCENES = {
    "shooter": "scenes.shooter.scene:Shooter",
    "platformer": "scenes.platformer.scene:Platformer",
    "lab/broadphases": "scenes.lab.broadphases:Broadphases",
    "lab/masks": "scenes.lab.masks:Masks",
    "lab/filters": "scenes.lab.filters:Filters",
    "lab/tunnelling": "scenes.lab.tunnelling:Tunnelling",
}
