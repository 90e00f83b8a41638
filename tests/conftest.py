"""What holds for all tests."""

import gc

# Compiled kernels leave hundreds of megabytes of objects that live on: with Python's own thresholds a tenth of the time of
# tests, and more of a compilation's, goes into looking through them.
gc.set_threshold(50_000, 20, 100)
