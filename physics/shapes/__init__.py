"""What bodies are made of: shapes as values, and the flat geometry that kernels read of them."""
