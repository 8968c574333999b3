"""What accuracy costs: times of named work and errors against references, measured off the frame."""
