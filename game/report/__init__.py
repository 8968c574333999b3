"""`--report DIR`: what accuracy costs in time, measured job by job and written as one page."""
