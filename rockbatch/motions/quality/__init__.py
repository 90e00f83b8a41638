"""Oddities of a record: faults of recorders, unlikely peaks, the place of the sensor, zero offsets."""
