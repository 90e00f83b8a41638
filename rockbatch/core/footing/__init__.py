"""The pier on a footing: a rigid foot on a bed of strips that push and never pull."""
