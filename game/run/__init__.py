"""Running a scene: its steps, recording and replay, state digest, measurements, and the drawn picture."""
