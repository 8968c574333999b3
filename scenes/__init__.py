"""Every scene in menu order: name -> "module:Class", imported when first asked for.

A scene that is not listed here is not in the game; tests/scenes/test_registry.py compares the list with the
folder, so a forgotten line fails.
"""

SCENES = {
    "shooter": "scenes.shooter.scene:Shooter",
    "platformer": "scenes.platformer.scene:Platformer",
    "lander": "scenes.lander.scene:Lander",
    # hard cases of all kinds
    "lab/gallery": "scenes.lab.gallery.scene:Gallery",
    # what a scene asks for
    "lab/effects": "scenes.lab.effects:EffectsLab",
    # finding what touches
    "lab/broadphases": "scenes.lab.broadphases:Broadphases",
    "lab/masks": "scenes.lab.masks:Masks",
    "lab/ladder": "scenes.lab.ladder:Ladder",
    "lab/disagreement": "scenes.lab.disagreement:Disagreement",
    "lab/shapes": "scenes.lab.shapes:Shapes",
    "lab/queries": "scenes.lab.queries:Queries",
    "lab/filters": "scenes.lab.filters:Filters",
    "lab/sensors": "scenes.lab.sensors:Sensors",
    # what leans and piles up
    "lab/stacks": "scenes.lab.stacks:Stacks",
    "lab/pyramid": "scenes.lab.pyramid:Pyramid",
    "lab/card_house": "scenes.lab.card_house:CardHouse",
    "lab/dominoes": "scenes.lab.dominoes:Dominoes",
    "lab/tumbler": "scenes.lab.tumbler:Tumbler",
    "lab/sleeping": "scenes.lab.sleeping:Sleeping",
    "lab/mask_stack": "scenes.lab.mask_stack:MaskStack",
    "lab/carving": "scenes.lab.carving:Carving",
    # what collides and bounces
    "lab/cradle": "scenes.lab.cradle:Cradle",
    "lab/billiards": "scenes.lab.billiards:Billiards",
    "lab/tunnelling": "scenes.lab.tunnelling:Tunnelling",
    "lab/mask_sweep": "scenes.lab.mask_sweep:MaskSweep",
    # what things stand on
    "lab/conveyor": "scenes.lab.conveyor:Conveyor",
    "lab/one_way": "scenes.lab.one_way:OneWay",
    "lab/ghost_bumps": "scenes.lab.ghost_bumps:GhostBumps",
}
