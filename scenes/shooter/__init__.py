"""The plane shooter: hits are decided by exact pixel masks."""
