"""`--report DIR`: measure accuracy against time in jobs, whose results are kept, and write one page of charts."""
