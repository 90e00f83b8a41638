"""Pictures as SVG: shapes, axes, and the drawings of the report."""
