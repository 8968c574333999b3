"""Palettes: overlay colours differ for colour-blind viewers, by simulation, and have enough contrast where required."""

from itertools import combinations

import numpy as np
import pygame
import pytest

from game.drawing.colors import SERIES, toned
from game.files.accessibility import PALETTES, Accessibility
from game.overlays.stack import Overlays, layer_names
from game.run.picture import Picture
from tests.game.test_overlays import Crowd, stepped

# Machado, Oliveira and Fernandes, "A Physiologically-based Model for Simulation of Color Vision Deficiency", 2009,
# severity 1, for linear RGB.
EYES = {
    "all cones": np.eye(3),
    "protanopia": [[0.152286, 1.052583, -0.204868], [0.114503, 0.786281, 0.099216], [-0.003882, -0.048116, 1.051998]],
    "deuteranopia": [[0.367322, 0.860646, -0.227968], [0.280085, 0.672501, 0.047413], [-0.011820, 0.042940, 0.968881]],
    "tritanopia": [[1.255528, -0.076749, -0.178779], [-0.078411, 0.930809, 0.147602], [0.004733, 0.691367, 0.303900]],
}
TO_XYZ = np.array(
    [[0.4124564, 0.3575761, 0.1804375], [0.2126729, 0.7151522, 0.0721750], [0.0193339, 0.1191920, 0.9503041]]
)
LUMINANCE = np.array([0.2126, 0.7152, 0.0722])


def linear(color):
    share = np.asarray(color[:3], float) / 255
    return np.where(share <= 0.04045, share / 12.92, ((share + 0.055) / 1.055) ** 2.4)


def lab(light):
    xyz = TO_XYZ @ np.clip(light, 0, 1) / np.array([0.95047, 1.0, 1.08883])
    f = np.where(xyz > 0.008856, np.cbrt(xyz), 7.787 * xyz + 16 / 116)
    return np.array([116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])])


def nearest(palette):
    """Return the least difference (CIE 1976) between two hues of the overlays, over all kinds of colour blindness."""
    seen = [[lab(np.asarray(eye) @ linear(toned(color, palette))) for color in SERIES] for eye in EYES.values()]
    return min(np.linalg.norm(a - b) for hues in seen for a, b in combinations(hues, 2))


def test_safe_hues_stay_apart_for_every_kind_of_eyes():
    assert nearest("safe") > 1.4 * nearest("standard")
    assert nearest("contrast") > nearest("safe") > 15


def test_contrast_hues_are_bright():
    for color in SERIES:
        assert linear(toned(color, "contrast")) @ LUMINANCE > 0.29


def drawn(palette, layers):
    scene = stepped(Crowd())
    scene.set_accessibility(Accessibility(palette=palette))
    overlays = Overlays(layers)
    overlays.note(scene)
    stepped(scene, 1)  # invariants are watched from the step after the one that shows them
    return pygame.surfarray.array3d(Picture().draw_scene(scene, overlays).surface).astype(int)


@pytest.mark.parametrize(
    "layer", [name for name in layer_names() if name not in ("impulses", "colors", "ghosts", "islands", "joints")]
)
def test_a_palette_is_seen_in_each_layer(layer):
    plain = drawn("standard", ())
    seen = {palette: drawn(palette, (layer,)) for palette in PALETTES}
    assert (seen["standard"] != plain).any()
    if layer not in ("motion", "centers", "contacts"):  # these have hues that both palettes share
        assert (seen["safe"] != seen["standard"]).any()
    assert (seen["contrast"] != seen["safe"]).any()


def test_contrast_darkens_the_picture_under_overlays_only():
    assert np.array_equal(drawn("contrast", ()), drawn("standard", ()))
    dark, plain = drawn("contrast", ("pairs",)), drawn("standard", ())
    assert dark.mean() < 0.6 * plain.mean()


def test_alpha_is_kept():
    assert toned((1, 2, 3, 77), "safe")[3] == 77
