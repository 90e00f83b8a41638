"""The catalogue of quantities: columns of peaks.csv, and demands that checks may make of them. Knows no study and no run."""
