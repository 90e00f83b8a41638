"""The physics, in numbers only: floats and arrays in SI units, compiled by Numba.

Nothing here knows of files, units or tables. The scalar functions (springs, equations, impact, events) take and
return plain numbers and tuples and allocate nothing, so that any integrator or target can share them.
"""
