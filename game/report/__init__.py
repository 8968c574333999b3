"""`--report DIR`: measure accuracy against time in jobs, store their results, and write a page of charts."""
