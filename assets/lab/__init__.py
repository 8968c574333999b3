"""Pictures of the bodies in the lab's scenes."""
