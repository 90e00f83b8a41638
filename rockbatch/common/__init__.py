"""What every package may use: checked arguments, files, styles of pictures, groups, lazy imports, display of objects, units."""
