"""All scenes in the order of the menu. SCENES is {name: "module:Class"}; a class is imported at its first use.

A scene that is not listed here is not in the game. tests/scenes/test_registry.py fails if a scene of the folder is not
listed.
"""

PLACES = {  # name -> ".module:Class" in this package
    "shooter": ".shooter.scene:Shooter",
    "platformer": ".platformer.scene:Platformer",
    "lander": ".lander.scene:Lander",
    # hard cases of all kinds
    "lab/gallery": ".lab.gallery.scene:Gallery",
    # effects of a scene
    "lab/effects": ".lab.effects:EffectsLab",
    # broad phase
    "lab/broadphases": ".lab.broadphases:Broadphases",
    "lab/masks": ".lab.masks:Masks",
    "lab/ladder": ".lab.ladder:Ladder",
    "lab/disagreement": ".lab.disagreement:Disagreement",
    "lab/shapes": ".lab.shapes:Shapes",
    "lab/queries": ".lab.queries:Queries",
    "lab/filters": ".lab.filters:Filters",
    "lab/sensors": ".lab.sensors:Sensors",
    # stacking
    "lab/stacks": ".lab.stacks:Stacks",
    "lab/pyramid": ".lab.pyramid:Pyramid",
    "lab/card_house": ".lab.card_house:CardHouse",
    "lab/dominoes": ".lab.dominoes:Dominoes",
    "lab/tumbler": ".lab.tumbler:Tumbler",
    "lab/sleeping": ".lab.sleeping:Sleeping",
    "lab/mask_stack": ".lab.mask_stack:MaskStack",
    "lab/carving": ".lab.carving:Carving",
    # joints
    "lab/joints": ".lab.joints:Joints",
    # collisions and bounces
    "lab/cradle": ".lab.cradle:Cradle",
    "lab/billiards": ".lab.billiards:Billiards",
    "lab/tunnelling": ".lab.tunnelling:Tunnelling",
    "lab/mask_sweep": ".lab.mask_sweep:MaskSweep",
    # ground
    "lab/conveyor": ".lab.conveyor:Conveyor",
    "lab/one_way": ".lab.one_way:OneWay",
    "lab/ghost_bumps": ".lab.ghost_bumps:GhostBumps",
}

SCENES = {name: f"{__name__}{place}" for name, place in PLACES.items()}
