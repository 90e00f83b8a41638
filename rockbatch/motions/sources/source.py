"""Where a component comes from: its file, and the part of it."""

from rockbatch.common.errors import WrongType


class Source(str):
    """The text for people, "x.V1 (NS)", of a ``file`` and a ``part`` of it, such as a channel; a plain text is a whole file."""

    file: str
    part: str

    def __new__(cls, file: str, part: str) -> "Source":
        source = super().__new__(cls, f"{file} ({part})")
        source.file, source.part = file, part
        return source

    def __reduce__(self) -> tuple[type["Source"], tuple[str, str]]:
        return Source, (self.file, self.part)


def file_of(*sources: str) -> str:
    """Return the file of the first of ``sources``; "" without any."""
    return next((source.file if isinstance(source, Source) else source for source in sources), "")


class Sourced:
    """A component, or a file that is not used, by its sources."""

    sources: tuple[str, ...]

    def __post_init__(self) -> None:
        if isinstance(self.sources, str):  # which would be a tuple of its letters
            raise WrongType(f"sources = {self.sources!r}: must be a tuple of texts; write ({self.sources!r},)")

    @property
    def source(self) -> str:
        """Return its sources in words, "a.AT2, a-UP.AT2"."""
        return ", ".join(self.sources)

    @property
    def file(self) -> str:
        """Return the file of its first source."""
        return file_of(*self.sources)
