"""Contact cache: contacts that are kept and updated from step to step."""
