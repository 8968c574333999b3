"""A scene being run: its steps, its recording and replay, its digest, its measurements and its finished picture."""
