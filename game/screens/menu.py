"""The scene menu: games and labs with a picture, a description, and the best result so far."""

import pygame

from game.drawing.canvas import SMALL, TEXT, Canvas, shorten, wrap
from game.drawing.colors import FOG, GOLD, PAPER, SKY
from game.drawing.nine_slice import draw_box
from game.drawing.number_text import clock, points_text
from game.drawing.thumbnails import SIZE, draw_picture
from game.errors import FileError
from game.files.own_levels import own_levels
from game.files.records import Records, table_of
from game.input.inputs import InputState
from game.registry import Registry
from game.scene import QUESTIONS
from game.screens.parts.background import MARGIN, DuskBackground, draw_page
from game.screens.parts.rows import Row, RowList
from game.screens.screen import CanvasScreen

LIST = pygame.Rect(MARGIN, MARGIN, 184, 254)
ABOUT = pygame.Rect(LIST.right + MARGIN, MARGIN, 272, 254)
HEADINGS = {"": "GAMES"} | {question: question for question in QUESTIONS}  # by Scene.question
FOOT = "\u2191 \u2193 choose   Enter plays   Esc back"


class Menu(CanvasScreen):
    """Menu of scenes.

    `outcome`, the request for the next screen, becomes ("play", name, level file or None) or ("back",).
    """

    tune = "title"

    def __init__(self, registry: Registry, records: Records | None = None, chosen: str | None = None) -> None:
        super().__init__()
        self.registry, self.records = registry, records
        self.ground = DuskBackground()
        self.tables = {}  # (scene class, level file) -> key of its high-score table; cached, since it needs the file
        self.entries = self._entries()  # (scene class or None for Back, level file or None) of each row
        inside = LIST.inflate(-32, 0)
        self.list = RowList(lambda: self.rows, (inside.x, LIST.y + 36, inside.width, 192), self.cues)
        names = [getattr(each[0], "name", None) for each in self.entries]
        if chosen in names:
            self.list.mark = names.index(chosen)
        self.list.show_marked()
        self.time = 0.0

    def _entries(self):
        """Rebuild self.rows, and return (scene class or None, level file or None) of each row, as a list."""
        entries, self.rows, group = [], [], None
        order = list(HEADINGS)
        for scene_class in sorted(self.registry.all_classes(), key=lambda each: order.index(each.question)):
            if scene_class.question != group:
                self._put(entries, Row(HEADINGS[scene_class.question], head=True), None, None)
            group = scene_class.question
            self._put(entries, Row(scene_class.title, press=self._play), scene_class, None)
            for path in own_levels(scene_class.level_suffixes()):
                self._put(entries, Row(f"  {path.stem}", press=self._play, color=SKY), scene_class, path)
        self._put(entries, Row("Back", press=self._back), None, None)
        return entries

    def _put(self, entries, row, scene_class, level):
        self.rows.append(row)
        entries.append((scene_class, level))

    def _play(self):
        scene_class, level = self.entries[self.list.mark]
        self.outcome = ("play", scene_class.name, level)

    def _back(self):
        self.outcome = ("back",)

    def resume(self) -> None:
        """Rebuild the list when the screen is shown again, because the level folder may have new files."""
        mark = self.list.mark
        self.tables.clear()
        self.entries = self._entries()
        self.list.mark = min(mark, len(self.entries) - 1)
        self.list.show_marked()

    def step(self, inputs: InputState, dt: float) -> None:
        """Process the player's input of a step of `dt` [s], and advance the background."""
        self.time += dt
        if inputs.pressed("cancel"):
            self.cues.append("back")
            self.outcome = ("back",)
        self.list.step(inputs, dt)

    def draw(self, canvas: Canvas, alpha: float) -> None:
        """Draw the list, and a description of the marked scene."""
        self.ground.draw(canvas, self.time)
        draw_page(canvas, LIST, "Play", FOOT)
        self.list.draw(canvas)
        scene_class, level = self.entries[self.list.mark]
        if scene_class is not None:
            self._draw_about(canvas, scene_class, level)

    def _draw_about(self, canvas, scene_class, level):
        draw_box(canvas, ABOUT)
        x, y = ABOUT.x + 16, ABOUT.y + 14
        width = ABOUT.width - 32
        picture = draw_picture(canvas, scene_class.name, scene_class.title, x + 2, y)
        self._draw_best(canvas, scene_class, level, picture.right + 10, y)
        y += SIZE[1] + 10
        lines = [(scene_class.title if level is None else level.name, GOLD, TEXT, 13)]
        lines += [(line, PAPER, TEXT, 11) for line in wrap(scene_class.about, width)]
        lines += [("", FOG, SMALL, 4)]
        for feature in scene_class.features:
            first, *rest = wrap(feature, width - 8, SMALL)
            lines += [(f"- {first}", PAPER, SMALL, 8), *((f"  {line}", PAPER, SMALL, 8) for line in rest)]
        lines += [("", FOG, SMALL, 4)] if scene_class.features else []
        effects = "effects: " + (", ".join(scene_class.effects.names()) or "none")
        lines += [(line, SKY, SMALL, 8) for line in wrap(effects, width, SMALL)]
        for text, color, font, height in lines:
            if text:
                canvas.text(shorten(text, width, font), x, y, color, font)
            y += height

    def _table(self, scene_class, level):
        """Return the key of a scene's high-score table, or of a level's table if `level` is given.

        Return None for an unreadable level file. Its error is shown when the player starts the level.
        """
        if (scene_class, level) not in self.tables:
            try:
                self.tables[scene_class, level] = table_of(scene_class.name, level)
            except FileError:
                self.tables[scene_class, level] = None
        return self.tables[scene_class, level]

    def _draw_best(self, canvas, scene_class, level, x, y):
        """Draw the best entry in the high-score table of a scene or level, beside the scene's picture."""
        if scene_class.ranked_by is None or self.records is None:
            return
        best = self.records.best(self._table(scene_class, level))
        canvas.text("BEST", x, y, GOLD, SMALL)
        if best is None:
            canvas.text("nobody yet", x, y + 12, FOG, SMALL)
            return
        canvas.text(best.name, x, y + 12, PAPER, TEXT)
        first, second = points_text(best.points), clock(best.seconds)
        if scene_class.ranked_by == "seconds":
            first, second = second, first
        canvas.text(first, x, y + 26, SKY, TEXT)
        canvas.text(second, x, y + 39, FOG, SMALL)
        if best.assisted:
            canvas.text("assisted", x, y + 50, FOG, SMALL)
