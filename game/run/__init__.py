"""The run of a scene: its steps, recording, replay, digest, measurements and finished picture."""
