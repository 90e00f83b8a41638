"""What lies on the disk: files, archives, station metadata and lists beside records."""
