"""All objects of a level (platforms, crates, enemies, pick-ups, bombs, ...), and the code that steps them."""

from scenes.platformer.blasting import CARRIED, BlastWall, Bomb, Rubble, shove
from scenes.platformer.bridge import Bridge
from scenes.platformer.enemies import Bat, Walker
from scenes.platformer.things import TRIGGERS, Belt, Crate, Crumble, Platform, Trigger

NEARBY = (400.0, 300.0)  # [px] from the hero within which enemies move: the picture's size and some more
ENEMIES = ("walker", "hedgehog", "bat")
BELOW = 64  # [px] things that fall farther than this below the map are lost


class Contents:
    """The objects of a level, in lists by kind and in dictionaries {body id: object}.

    Pick-ups that are taken and enemies that are flattened are removed from these tables and from the world.
    """

    def __init__(self, world, level, random):
        self.world, self.level = world, level
        found = [Trigger(world, thing) for thing in level.map.things if thing.kind in TRIGGERS]
        self.triggers = {trigger.body.id: trigger for trigger in found}
        self.platforms = [Platform(world, thing) for thing in level.map.things_of("platform")]
        self.belts = [Belt(world, thing) for thing in level.map.things_of("belt")]
        self.crumbles = [Crumble(world, thing) for thing in level.map.things_of("crumble")]
        self.crates = [Crate(world, thing) for thing in level.map.things_of("crate")]
        self.walls = [BlastWall(world, thing) for thing in level.map.things_of("blast_wall")]
        self.bridges = [Bridge(world, thing) for thing in level.map.things_of("bridge")]
        self.bombs = [Bomb(world, thing) for thing in level.map.things_of("bomb")]
        self.rubble: list[Rubble] = []
        # The seed decides the first direction of each walker, and nothing else.
        enemies = [
            Bat(world, thing) if thing.kind == "bat" else Walker(world, thing, random.choice((-1, 1)))
            for thing in level.map.things
            if thing.kind in ENEMIES
        ]
        self.enemies = {enemy.body.id: enemy for enemy in enemies}
        self.lairs = {enemy.lair.id: enemy for enemy in enemies if isinstance(enemy, Bat)}
        self.crate_ids = {crate.body.id: crate for crate in self.crates}
        self.decks = {one.body.id: self._deck_under(one) for one in (*self.crates, *enemies)}
        self.coins_in_all, self.secrets_in_all = len(self.of("coin")), len(self.of("secret"))

    def _deck_under(self, one):
        """Return the Platform on which an object starts, or None if it starts elsewhere. one: a crate or an enemy."""
        x = one.home[0] if one.kind == "crate" else one.start[0]
        bottom = one.home[1] + one.size[1] / 2 if one.kind == "crate" else one.bottom
        for platform in self.platforms:
            left, top, right, _ = platform.box
            if left <= x <= right and abs(bottom - top) < 2.0:
                return platform
        return None

    def of(self, kind):
        """Return the list of Triggers of a kind, such as "coin", in the order of the map."""
        return [trigger for trigger in self.triggers.values() if trigger.kind == kind]

    @property
    def solid_boxes(self):
        """Boxes (left, top, right, bottom) [px] of all objects that are solid for the hero. Tiles are not included."""
        groups = (self.crates, self.platforms, self.belts, self.crumbles, self.walls)
        return tuple(one.box for group in groups for one in group)

    def step(self, tick, seen):
        """Make one step of the platforms, crumbling stones, bombs, enemies and crates.

        tick: number of the step; seen: the hero's position (x, y) [px], to which enemies react. Return a list of
        events (name, object), such as ("break", stone) or ("wake", bat).
        """
        news = []
        for platform in self.platforms:
            platform.aim(tick)
        for crumble in self.crumbles:
            word = crumble.step()
            if word:
                news.append((word, crumble))
        places, lost = self.places(), self.level.size[1] + BELOW
        for bomb in self.bombs:
            word = bomb.step(lost)
            if word:
                news.append((word, bomb))
        for identity, enemy in list(self.enemies.items()):
            x, y = places[identity]
            if abs(x - seen[0]) > NEARBY[0] or abs(y - seen[1]) > NEARBY[1]:
                enemy.rest(x)
            elif enemy.step(seen):
                news.append(("wake", enemy))
            if enemy.squeezed:
                news.append(("squeezed", enemy))
            elif y > lost:
                self.remove(enemy)
        for crate in self.crates:
            if places[crate.body.id][1] > lost:
                self._send_home(crate)
        for piece in [piece for piece in self.rubble if places[piece.body.id][1] > lost]:
            self.world.remove_body(piece.body)
            self.rubble.remove(piece)
        return news

    def places(self):
        """Return {body id: position (x, y) [px]} of all bodies of the world."""
        rows = self.world.bodies
        return dict(zip(rows["id"].tolist(), zip(rows["x"].tolist(), rows["y"].tolist(), strict=True), strict=True))

    @property
    def carried(self):
        """The Bomb that the hero carries, or None."""
        return next((bomb for bomb in self.bombs if bomb.phase == CARRIED), None)

    def blast(self, x, y):
        """Apply an explosion at (x, y) [px] to walls, rubble and crates.

        Return (list of the Rubble that has come loose, whether any wall was hit).
        """
        loose, hit = [], False
        for wall in self.walls:
            pieces, struck = wall.blast(x, y)
            loose += pieces
            hit = hit or struck
        self.rubble += loose
        for one in (*self.rubble, *self.crates):
            shove(one.body, x, y)
        return loose, hit

    def press_stones(self, riding, begun):
        """Start to shake each crumbling stone that carries the hero, an enemy or a crate.

        riding: body under the hero, or None; begun: the step's begin events, which include the landings of crates.
        """
        pressed = {enemy.riding for enemy in self.enemies.values()} | ({riding.id} if riding is not None else set())
        for a, b in zip(begun["body_a"].tolist(), begun["body_b"].tolist(), strict=True):
            if a in self.crate_ids or b in self.crate_ids:
                pressed |= {a, b}
        for crumble in self.crumbles:
            if crumble.body is not None and crumble.body.id in pressed:
                crumble.press()

    def take(self, trigger):
        """Remove the coin or gem of a Trigger from the world, after the hero has taken it."""
        self.world.remove_body(trigger.body)
        del self.triggers[trigger.body.id]

    def remove(self, enemy):
        """Remove an enemy from the world."""
        del self.enemies[enemy.body.id]
        if enemy.kind == "bat":
            del self.lairs[enemy.lair.id]
        enemy.remove()

    def go_home(self):
        """Move crates, enemies and bombs to their starts, and restore crumbling stones, for a new life of the hero.

        Pick-ups that were taken and enemies that were flattened do not return.
        """
        for one in (*self.crates, *self.enemies.values()):
            self._send_home(one)
        for crumble in self.crumbles:
            crumble.stand()
        for bomb in self.bombs:
            bomb.go_home()

    def _send_home(self, one):
        deck = self.decks[one.body.id]
        moved = (0.0, 0.0)
        if deck is not None:
            x, y = deck.body.position
            moved = (x - deck.start[0], y - deck.start[1])
        one.go_home(moved)

    def state(self):
        """Return the part of Scene.state() that describes all objects outside the physics world, a flat tuple."""
        out: list = [trigger.lit for trigger in self.of("checkpoint")]
        for enemy in self.enemies.values():
            out += enemy.state()
        for crumble in self.crumbles:
            out += (crumble.count, crumble.shaking, crumble.body is None, *(age for _, age in crumble.bits))
        for bomb in self.bombs:
            out += bomb.state()
        for piece in self.rubble:
            out += (piece.body.id, piece.left, piece.top)
        return tuple(out)
