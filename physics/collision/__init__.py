"""The narrow phase: contacts of candidate pairs."""
