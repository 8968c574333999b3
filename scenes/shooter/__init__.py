"""The plane shooter, a game in which exact pixel masks decide what hits."""
