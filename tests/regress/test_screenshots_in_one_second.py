"""Two screenshots in one second are two files; the second once overwrote the first."""

import pygame as K


def test_each_is_a_file(drive, tmp_path):
    d = drive("--scene", "arena")
    d.turns(2)
    d.key(K.K_F12, K.K_F12, K.K_F12)
    assert len(list((tmp_path / "screenshots").glob("*.png"))) == 3
