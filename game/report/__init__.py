"""`--report DIR`: measure accuracy against time, and write one page of charts. Each measurement is a job, stored at
once.
"""
