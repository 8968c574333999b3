"""python -m tests.stability: write docs/stability.md; measures nothing."""

from tests.stability.page import PAGE, page

if __name__ == "__main__":
    PAGE.write_text(page(), encoding="utf-8")
