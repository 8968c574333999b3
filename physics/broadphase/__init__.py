"""The broad phases: they find the pairs of shapes whose boxes overlap."""
