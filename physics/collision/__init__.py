"""From candidate pairs to contacts."""
