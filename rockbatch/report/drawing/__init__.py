"""Pictures as SVG: shapes, axes, and what the report draws with them."""
