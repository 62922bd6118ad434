"""Dictionaries that go to the compiled half."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, TypedDict

if TYPE_CHECKING:
    from numpy.typing import NDArray


class Run(TypedDict):
    """What every long verb takes."""

    threads: int | None
    time_limit: float | None
    seed: int
    progress: Callable[[dict[str, Any]], object] | None


class Given(TypedDict):
    """Arrays for a ``_native.Data``, in C order and of the right types."""

    points: NDArray[Any] | None
    quads: NDArray[Any]
    other_faces: list[tuple[int, list[int]]]
    hexes: NDArray[Any]
    point_tags: NDArray[Any] | None
    quad_tags: NDArray[Any] | None
    hex_tags: NDArray[Any] | None
    point_data: list[tuple[str, NDArray[Any]]]
    quad_data: list[tuple[str, NDArray[Any]]]
    hex_data: list[tuple[str, NDArray[Any]]]
    tag_names: list[tuple[str, int, str]]


class Filling(TypedDict):
    """Options of ``_native.fill``."""

    strategy: str
    prefer: str
    effort: str
    layers: int | None
    layer_height: float | None
    growth: float
    max_hexes: int | None
    best_of: int
    embed: bool
    embed_limit: float | None
    simplify: bool


class Enumeration(TypedDict):
    """Options of ``_native.enumerate``."""

    cubes: int
    rule: str
    nonorientable: bool
    max_chords: int | None
    filter_from: int
    boundary_quads: tuple[int, int] | None
    balls: bool
    key: str | None
    list: bool
