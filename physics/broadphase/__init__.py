"""The broad phases: pairs of shapes whose boxes overlap."""
