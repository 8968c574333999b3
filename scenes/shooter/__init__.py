"""The plane shooter: every hit is pixel against pixel."""
