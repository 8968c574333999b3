"""`--report DIR`: accuracy against time, measured job by job and written as one page."""
