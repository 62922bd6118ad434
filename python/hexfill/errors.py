"""Exceptions. All but :class:`Cancelled` are :class:`HexfillError`; ids are 0-based, and at most ten are listed (``count`` counts all)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .mesh import HexMesh

__all__ = [
    "Cancelled",
    "FileError",
    "HexfillError",
    "InputError",
    "InternalError",
    "MeshError",
    "NoMeshExists",
    "NoMeshFound",
    "SurfaceError",
]


class HexfillError(Exception):
    """Whatever hexfill raises, Ctrl-C excepted."""


class InputError(HexfillError, ValueError):
    """Something given cannot be used; the message says what, where and what to do."""


class SurfaceError(InputError):
    """The faces are no closed, orientable surface of quads, or their positions cannot be used.

    Attributes: ``vertices`` (ids), ``edges`` (pairs of vertex ids), ``quads`` (rows of the quads, or of all faces where some are no
    quads): the first ten offenders. ``count``: how many there are.
    """

    def __init__(
        self,
        message: str,
        *,
        vertices: Sequence[int] = (),
        edges: Sequence[tuple[int, int]] = (),
        quads: Sequence[int] = (),
        count: int | None = None,
    ) -> None:
        super().__init__(message)
        self.vertices = list(vertices)
        self.edges = list(edges)
        self.quads = list(quads)
        self.count = count if count is not None else max(len(self.vertices), len(self.edges), len(self.quads))


class MeshError(InputError):
    """The hexes are no mesh that can be worked on.

    Attributes: ``hexes`` (rows of the hexes), ``vertices`` (ids): the first ten offenders. ``count``: how many there are.
    """

    def __init__(
        self, message: str, *, hexes: Sequence[int] = (), vertices: Sequence[int] = (), count: int | None = None
    ) -> None:
        super().__init__(message)
        self.hexes = list(hexes)
        self.vertices = list(vertices)
        self.count = count if count is not None else max(len(self.hexes), len(self.vertices))


class FileError(InputError):
    """A file cannot be read as its format, or a format cannot hold a mesh. (What the system refuses is an :class:`OSError`.)

    Attributes: ``path``, and ``line`` (from 1) where it is known.
    """

    def __init__(self, message: str, *, path: str | None = None, line: int | None = None) -> None:
        super().__init__(message)
        self.path = path
        self.line = line


class NoMeshExists(HexfillError):
    """No hex mesh of this surface exists, for the reason in the message.

    Attributes: ``pairs`` (pairs of quads that share too much), ``edges`` (of an odd cycle that bounds inside). Empty: the number of
    quads is odd.
    """

    def __init__(
        self,
        message: str,
        *,
        pairs: Sequence[tuple[int, int]] = (),
        edges: Sequence[tuple[int, int]] = (),
        count: int | None = None,
    ) -> None:
        super().__init__(message)
        self.pairs = list(pairs)
        self.edges = list(edges)
        self.count = count if count is not None else max(len(self.pairs), len(self.edges))


class NoMeshFound(HexfillError):
    """None was found within the bounds given, which proves nothing.

    Attribute ``stopped``: ``"finished"``, ``"cancelled"``, ``"time-limit"`` or ``"memory-limit"``.
    """

    def __init__(self, message: str, *, stopped: str = "finished") -> None:
        super().__init__(message)
        self.stopped = stopped


class InternalError(HexfillError):
    """A defect of hexfill. Please report the input."""


class Cancelled(KeyboardInterrupt):
    """Ctrl-C. Like every ``KeyboardInterrupt`` it is no :class:`Exception`.

    Attribute ``mesh``: the best mesh so far; None if there is none.
    """

    def __init__(self, message: str = "", mesh: HexMesh | None = None) -> None:
        super().__init__(message)
        self.mesh = mesh
