"""Checks of the text in a picture: lines must not overlap or leave the picture, and must contrast with their
background.
"""

from itertools import combinations

import numpy as np
import pygame

from game.drawing.canvas import Canvas

LEAST_CONTRAST = 4.5  # WCAG 2.1, 1.4.3
SHARE = 0.9  # of the pixels around a text's letters that must be so far from it
LUMINANCE = np.array([0.2126, 0.7152, 0.0722])


def assert_text_is_apart(boxes, picture):
    """Assert that each box is inside the picture and that no two boxes overlap. boxes: (rectangle, text) pairs."""
    for rect, text in boxes:
        assert picture.contains(rect), f"{text!r} at {rect} leaves {picture}"
    for (a, text_a), (b, text_b) in combinations(boxes, 2):
        assert not a.colliderect(b), f"{text_a!r} at {a} overlaps {text_b!r} at {b}"


def luminance(colors):
    """Return the relative luminance 0..1 of RGB colours 0..255 (WCAG)."""
    share = np.asarray(colors, float)[..., :3] / 255
    return np.where(share <= 0.04045, share / 12.92, ((share + 0.055) / 1.055) ** 2.4) @ LUMINANCE


def contrast(a, b):
    """Return the contrast ratio of two luminances, 1..21 (WCAG)."""
    return (np.maximum(a, b) + 0.05) / (np.minimum(a, b) + 0.05)


class Reader:
    """Recorder of every line of text that is drawn in its with block: `with Reader() as reader:`."""

    def __enter__(self):
        self.lines, self.before = [], (Canvas.text, Canvas.text_if_free)
        text, free = self.before

        def noted(canvas, line, x, y, color=(236, 236, 244), *more, **named):
            rect = text(canvas, line, x, y, color, *more, **named)
            self.lines.append((canvas, rect, line, color))
            return rect

        def noted_if_free(canvas, line, x, y, color=(236, 236, 244), *more, **named):
            drawn = free(canvas, line, x, y, color, *more, **named)
            if drawn:
                self.lines.append((canvas, canvas.boxes[-1][0], line, color))
            return drawn

        Canvas.text, Canvas.text_if_free = noted, noted_if_free
        return self

    def __exit__(self, *error):
        Canvas.text, Canvas.text_if_free = self.before

    def assert_readable(self):
        """Assert that each recorded line is still visible and contrasts with its background."""
        for canvas, rect, line, color in self.lines:
            if any(box == rect and text == line for box, text in canvas.boxes) and line.strip():
                share = share_that_stands_out(canvas.surface, rect, color)
                assert share >= SHARE, (
                    f"{line!r} at {rect}: only {share:.0%} of its ground is {LEAST_CONTRAST}:1 from {color}"
                )


def share_that_stands_out(surface, rect, color):
    """Return the share of pixels near the letters that contrast enough with the letters'
    colour; 0 if they are covered.
    """
    around = rect.inflate(2, 2).clip(surface.get_rect())
    pixels = pygame.surfarray.array3d(surface.subsurface(around)).astype(int)
    letters = (pixels == np.array(color[:3])).all(axis=2)
    if not letters.any():
        return 0.0
    wide = np.pad(letters, 1)
    near = np.zeros_like(letters)
    for dx in range(3):
        for dy in range(3):
            near |= wide[dx : dx + letters.shape[0], dy : dy + letters.shape[1]]
    ground = pixels[near & ~letters]
    return float((contrast(luminance(ground), luminance(np.array(color))) >= LEAST_CONTRAST).mean())
