"""Who compiles which kernel where several processes share the work; alone, nobody asks."""

from collections.abc import Callable

# claim(path): waits for the right to make what goes there; returns what lets it go. Set where processes share work.
claim: Callable[[str], Callable[[], object]] | None = None
claimed: dict[str, Callable[[], object]] = {}  # path -> what lets it go, of all that is being compiled here
