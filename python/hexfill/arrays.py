"""What people give, as arrays of the right type: checked, with the rows that are wrong named, and never changed in place."""

from __future__ import annotations

import math
import operator
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from .errors import InputError, MeshError, SurfaceError

if TYPE_CHECKING:
    from numpy.typing import NDArray

    Ids = NDArray[np.uint32]
    Floats = NDArray[np.float64]

#: Vertices of a cell, by what it is called; where to look for mistakes.
Kind = Literal["quads", "hexes"]
COLUMNS: dict[Kind, int] = {"quads": 4, "hexes": 8}
LARGEST = 2**32 - 2


def _array(given: Any, name: str) -> NDArray[Any]:
    if np.ma.isMaskedArray(given) and np.ma.getmaskarray(given).any():
        raise InputError(f"{name}: {int(np.ma.getmaskarray(given).sum())} entries are masked; fill or remove them")
    try:
        return np.asarray(given)
    except ValueError as error:
        raise InputError(f"{name}: the rows have different lengths ({error})") from None


def points(given: Any, name: str = "points") -> Floats:
    """Positions: (n, 3), any real type, as float64.

    Values that are not finite are refused later, with their ids, and only where vertices are used as a surface.
    """
    array = _array(given, name)
    if array.dtype.kind not in "fiu" and array.size:
        raise TypeError(f"{name} must be real numbers of shape (n, 3), not {array.dtype}")
    if array.ndim != 2 or array.shape[1] != 3:
        hint = "; append a column of zeros for a flat set" if array.ndim == 2 and array.shape[1] == 2 else ""
        raise InputError(f"{name} must have shape (n, 3), not {array.shape}{hint}")
    with np.errstate(over="ignore"):
        return np.ascontiguousarray(array, dtype=np.float64)


def finite(array: Floats) -> Floats:
    """The positions, if all are finite."""
    bad = np.flatnonzero(~np.isfinite(array).all(axis=1))
    if bad.size:
        raise SurfaceError(
            f"{bad.size} points are not finite: {_some('v', bad)}; repair or remove them",
            vertices=bad[:10].tolist(),
            count=int(bad.size),
        )
    return array


def cells(given: Any, kind: Kind, name: str | None = None) -> Ids:
    """Cells: (m, 4) quads or (k, 8) hexes, any integer type, as uint32."""
    name = name or kind
    columns = COLUMNS[kind]
    array = _array(given, name)
    if array.size == 0:
        return np.empty((0, columns), dtype=np.uint32)
    if array.dtype.kind not in "iu":
        hint = f"; use {name}.astype(int)" if array.dtype.kind == "f" else ""
        raise TypeError(f"{name} must be integer ids of shape (m, {columns}), not {array.dtype}{hint}")
    if array.ndim != 2 or array.shape[1] != columns:
        hint = ""
        if array.ndim == 1:
            hint = "; a flat VTK list is reshaped like faces.reshape(-1, 5)[:, 1:], or give the PyVista object itself"
        elif array.ndim == 2 and array.shape[1] == 3:
            hint = "; hexahedra need a surface of quads, not triangles"
        raise InputError(f"{name} must have shape (m, {columns}), not {array.shape}{hint}")
    wrong = (array < 0) | (array > LARGEST)
    if wrong.any():
        rows = np.flatnonzero(wrong.any(axis=1))
        first = array[wrong].flat[0]
        message = f"{len(rows)} {name} have ids below 0 or above {LARGEST}, such as {first}: {_some(kind[0], rows)}"
        if kind == "quads":
            raise SurfaceError(message, quads=rows[:10].tolist(), count=len(rows))
        raise MeshError(message, hexes=rows[:10].tolist(), count=len(rows))
    return np.ascontiguousarray(array, dtype=np.uint32)


def tags(given: Any, n: int, name: str) -> NDArray[np.int64] | None:
    """One integer a point or cell."""
    if given is None:
        return None
    array = _array(given, name)
    if array.dtype.kind not in "iu":
        raise TypeError(f"{name} must be integers, not {array.dtype}")
    if array.shape != (n,):
        raise InputError(f"{name} must have shape ({n},), not {array.shape}")
    if array.dtype.kind == "u" and array.size and int(array.max()) > np.iinfo(np.int64).max:
        raise InputError(f"{name}: {int(array.max())} does not fit into 64 bits with a sign")
    return np.ascontiguousarray(array, dtype=np.int64)


def fields(given: Mapping[str, Any] | None, n: int, name: str) -> list[tuple[str, Floats]]:
    """Named numbers, one a point or cell."""
    found = []
    for field, numbers in (given or {}).items():
        array = _array(numbers, f"{name}[{field!r}]")
        if array.dtype.kind not in "fiub":
            raise TypeError(f"{name}[{field!r}] must be real numbers, not {array.dtype}")
        if array.shape != (n,):
            raise InputError(f"{name}[{field!r}] must have shape ({n},), not {array.shape}")
        found.append((str(field), np.ascontiguousarray(array, dtype=np.float64)))
    return found


def names(given: Iterable[tuple[str, int, str]]) -> list[tuple[str, int, str]]:
    """Names of tags."""
    found = []
    for entry in given:
        try:
            what, tag, name = entry
        except (TypeError, ValueError):
            raise InputError(f"tag_names: {entry!r} is not (what, tag, name)") from None
        if what not in ("points", "quads", "hexes"):
            raise InputError(f"tag_names: {what!r} is not 'points', 'quads' or 'hexes'")
        found.append((what, whole(tag, "tag", -(2**63), 2**63 - 1), str(name)))
    return found


def _some(letter: str, ids: NDArray[Any]) -> str:
    shown = " ".join(f"{letter}{i}" for i in ids[:10])
    return shown + (f" and {len(ids) - 10} more" if len(ids) > 10 else "")


def whole(given: Any, name: str, least: int, most: int) -> int:
    """A whole number from ``least`` to ``most``."""
    if isinstance(given, (bool, np.bool_)):
        raise TypeError(f"{name} must be a whole number, not {given}")
    try:
        number = operator.index(given)
    except TypeError:
        raise TypeError(f"{name} must be a whole number, not {type(given).__name__}") from None
    if not least <= number <= most:
        raise InputError(f"{name}={number}: give {least} to {most}")
    return number


def real(given: Any, name: str, *, zero: bool = False) -> float:
    """A positive finite number; with ``zero`` also 0 and infinity."""
    try:
        number = float(given.total_seconds()) if hasattr(given, "total_seconds") else float(given)
    except (TypeError, ValueError):
        raise TypeError(f"{name} must be a number, not {type(given).__name__}") from None
    if math.isnan(number) or number < 0 or not zero and (number == 0 or math.isinf(number)):
        raise InputError(f"{name}={number}: give a {'number of at least 0' if zero else 'positive number'}")
    return number
