"""Command `python -m tests.stability`: write docs/stability.md from the stored measurements,
without new measurements.
"""

from tests.stability.page import PAGE, page

if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
