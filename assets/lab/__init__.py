"""What the lab's scenes push about."""
