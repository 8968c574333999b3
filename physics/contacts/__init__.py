"""Contacts as they are kept from step to step, and sensors."""
