"""The catalogue of quantities: what a row of peaks.csv says, and what checks may ask of it. Knows no study and no run."""
