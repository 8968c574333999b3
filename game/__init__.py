"""The arcade program around the physics: window, input, drawing, sound, overlays and the command line."""

VERSION = "0.1.0"
