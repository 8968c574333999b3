"""Who compiles which kernel where several processes share the work; alone, nobody asks."""

from collections.abc import Callable

claim: Callable[[str], Callable[[], object]] | None = (
    None  # waits for the right to make a file; returns what lets it go
)
claimed: dict[str, Callable[[], object]] = {}  # path -> what lets it go, of all that is being compiled here
