"""Comparison of Carom with PyBullet: the same scenarios run on both, and the series must agree.

`scenarios/` holds small functions that use nothing but the `pybullet` module they are given and
return named series. `record` runs them under real PyBullet and writes `golden/`; `test_golden`
runs them under Carom and compares; `live` does both at once; `report` writes a table and plots.
"""
