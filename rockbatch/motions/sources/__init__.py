"""Sources of records: files, archives, station metadata, and lists beside records."""
