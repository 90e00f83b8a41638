"""A figure that notebooks show as it is. Loads matplotlib: imported where one is drawn."""

from io import BytesIO

from matplotlib.figure import Figure


class ShownFigure(Figure):
    """A matplotlib Figure that is not pyplot's, and shows itself in a notebook nevertheless, also without ``%matplotlib``."""

    def _repr_png_(self) -> bytes:
        picture = BytesIO()
        self.savefig(picture, format="png")
        return picture.getvalue()
