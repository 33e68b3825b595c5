"""A part of a scene, by which others refer to it."""

from __future__ import annotations


class Part(str):
    """The name of a part. Its places are texts as scenes have them: `line.end` is "line.end"."""

    __slots__ = ()

    @property
    def start(self) -> str:
        """The first end of a cable."""
        return f"{self}.start"

    @property
    def end(self) -> str:
        """The other end of a cable."""
        return f"{self}.end"

    @property
    def com(self) -> str:
        """The centre of mass of a body."""
        return f"{self}.com"

    def at(self, place: str | float) -> str:
        """A place along a cable: a length from its start such as "12.5 m", a share such as "50%", or metres."""
        if isinstance(place, str):
            return f"{self}@{place.replace(' ', '')}"
        return f"{self}@{place!r}m"

    def point(self, name: str) -> str:
        """A named point of a body."""
        return f"{self}.{name}"
