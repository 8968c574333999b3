"""When moving shapes first meet: continuous collision detection."""
