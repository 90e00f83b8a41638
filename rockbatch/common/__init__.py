"""Tools of all packages: checked arguments, files, figures, groups, lazy imports, display of objects, units."""
