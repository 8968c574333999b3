"""From contacts to impulses."""
