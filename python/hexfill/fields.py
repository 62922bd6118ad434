"""Numbers, tags and names that PyVista and meshio meshes carry, taken and given.

The same rules as for files: an array called ``tag`` (or as other programs call it) with whole numbers is the tags, columns of an array of vectors are
fields ``name:0``, ``name:1``, ..., and names of tags are field data of pairs: a tag, and 0, 2 or 3 for points, quads and hexes.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterable, Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from .mesh import HexMesh, Surface

#: Names of arrays of tags, the earlier one wins (as in ``assembly.rs`` of hexfill-io).
TAGS = ["tag", "tags", "gmsh:physical", "medit:ref", "CellEntityIds", "MaterialIds", "material", "label", "attribute"]
#: What hexfill said of positions that others may have moved since: judged again where it is asked for.
JUDGED = {"certified_positive", "scaled_jacobian"}
#: What a tag is on, by dimension.
DIMENSIONS = {0: "points", 2: "quads", 3: "hexes"}
ONE = {"points": "point", "quads": "quad", "hexes": "hex"}


#: Of a kind (``"points"``, ``"quads"``, ``"hexes"``), by the name of a set: whether each is in it.
Sets = Mapping[str, Mapping[str, "NDArray[np.bool_]"]]


def taken(
    point_data: Any, cell_data: Mapping[str, Callable[[str], Any]], field_data: Any, sets: Sets | None = None
) -> dict[str, Any]:
    """``point_tags``, ``quad_data``, ``tag_names`` and the rest, for :func:`mesh._data`.

    ``cell_data`` gives, by the name of an array, a function from ``"quads"`` or ``"hexes"`` to its rows.
    """
    found: dict[str, Any] = {"tag_names": _names(field_data)}
    found["point_tags"], found["point_data"] = _split({name: np.asarray(point_data[name]) for name in point_data.keys()})
    for kind in ("quads", "hexes"):
        rows = {name: np.asarray(of(kind)) for name, of in cell_data.items()}
        tags, data = _split({name: array for name, array in rows.items() if len(array)})
        # An array on hexes alone is NaN on quads, and the other way round.
        kept = {name: numbers for name, numbers in data.items() if name not in JUDGED and not np.isnan(numbers).all()}
        found[f"{ONE[kind]}_tags"], found[f"{ONE[kind]}_data"] = tags, kept
    for kind, masks in (sets or {}).items():
        key = f"{ONE[kind]}_tags"
        found[key], found["tag_names"] = _with_sets(found[key], found["tag_names"], kind, masks)
    return found


def _with_sets(
    tags: NDArray[np.int64] | None, names: list[tuple[str, int, str]], kind: str, masks: Mapping[str, NDArray[np.bool_]]
) -> tuple[NDArray[np.int64] | None, list[tuple[str, int, str]]]:
    """Tags and names with sets, which may overlap: a new tag for every combination of a tag and sets that occurs. A set that is what
    a name of tags says already adds nothing."""
    n = len(next(iter(masks.values()), []))
    old = np.zeros(n, np.int64) if tags is None else tags
    named = {name: np.isin(old, [tag for of, tag, other in names if (of, other) == (kind, name)]) for name in masks}
    new = {name: mask for name, mask in masks.items() if mask.any() and not (mask == named[name]).all()}
    if not new:
        return tags, names
    rows, which = np.unique(np.column_stack([old, *new.values()]), axis=0, return_inverse=True)
    is_in = rows[:, 1:].astype(bool)
    numbers = np.where(is_in.any(axis=1), np.cumsum(is_in.any(axis=1)) + max(old.max(), 0), rows[:, 0])
    kept = [(of, tag, name) for of, tag, name in names if of != kind or tag in numbers]
    for number, (before, *_), row in zip(numbers.tolist(), rows.tolist(), is_in):
        if row.any():
            inherited = [name for of, tag, name in names if (of, tag) == (kind, before)]
            kept += [(kind, number, name) for name in dict.fromkeys([*inherited, *(name for name, i in zip(new, row) if i)])]
    return numbers[which.reshape(-1)], kept


def _split(arrays: Mapping[str, NDArray[Any]]) -> tuple[NDArray[np.int64] | None, dict[str, NDArray[np.float64]]]:
    """Tags, and columns of numbers."""
    tags: NDArray[np.int64] | None = None
    data: dict[str, NDArray[np.float64]] = {}
    found = [name for name in TAGS if name in arrays and _whole(arrays[name])]
    for name, array in arrays.items():
        if found and name == found[0]:
            tags = array.reshape(-1).astype(np.int64)
        elif array.dtype.kind not in "fiub":
            warnings.warn(f"the array {name!r} holds no real numbers ({array.dtype}): not kept", stacklevel=6)
        elif array.ndim == 1:
            data[name] = array.astype(np.float64)
        else:
            columns = array.reshape(len(array), -1).astype(np.float64).T
            data.update({name if len(columns) == 1 else f"{name}:{k}": column for k, column in enumerate(columns)})
    return (tags if tags is not None and tags.any() else None), data


def _whole(array: NDArray[Any]) -> bool:
    """Whether these are numbers that can be tags."""
    if array.dtype.kind not in "fiu" or array.size != len(array):
        return False
    return array.dtype.kind != "f" or bool(np.isfinite(array).all() and (array == np.floor(array)).all())


def _names(field_data: Any) -> list[tuple[str, int, str]]:
    """Field data of pairs: a tag and a dimension."""
    names = []
    for name in field_data.keys():
        rows = np.asarray(field_data[name])
        if rows.dtype.kind in "iu" and rows.size and (rows.ndim == 2 and rows.shape[1] == 2 or rows.shape == (2,)):
            pairs = rows.reshape(-1, 2).tolist()
            if all(dimension in DIMENSIONS for _, dimension in pairs):
                names += [(DIMENSIONS[dimension], tag, name) for tag, dimension in pairs if tag != 0]
    return names


def joined(data: Mapping[str, NDArray[np.float64]]) -> dict[str, NDArray[np.float64]]:
    """Columns ``name:0``, ``name:1``, ... side by side again, in arrays of one's own."""
    arrays: dict[str, NDArray[np.float64]] = {}
    for name, numbers in data.items():
        base, colon, number = name.rpartition(":")
        if not colon or not number.isdigit() or f"{base}:1" not in data or f"{base}:0" not in data:
            arrays[name] = np.array(numbers)
        elif number == "0":
            columns = [numbers]
            while (column := data.get(f"{base}:{len(columns)}")) is not None:
                columns.append(column)
            arrays[base] = np.column_stack(columns)
    return arrays


def on_both(mesh: HexMesh) -> dict[str, list[NDArray[Any]]]:
    """Data of hexes and of quads, by the name of the array; NaN where there is none."""
    hexes, quads = joined(mesh.hex_data), joined(mesh.quad_data)
    if any(hexes[name].shape[1:] != quads[name].shape[1:] for name in hexes.keys() & quads.keys()):
        # A vector on one and a number on the other: columns have names of their own.
        hexes, quads = dict(mesh.hex_data), dict(mesh.quad_data)
    both: dict[str, list[NDArray[Any]]] = {}
    for name in [*hexes, *(name for name in quads if name not in hexes)]:
        shape = (hexes if name in hexes else quads)[name].shape[1:]
        none = [np.full((n, *shape), np.nan) for n in (mesh.n_hexes, mesh.n_quads)]
        both[name] = [np.array(hexes.get(name, none[0])), np.array(quads.get(name, none[1]))]
    return both


def names(mesh: Surface | HexMesh, kinds: Iterable[str]) -> dict[str, NDArray[np.int64]]:
    """Names of tags on these kinds as field data: a pair (2,), or several (k, 2)."""
    dimension = {kind: d for d, kind in DIMENSIONS.items() if kind in kinds}
    rows: dict[str, list[list[int]]] = {}
    for kind, tag, name in mesh.tag_names:
        if kind in dimension:
            rows.setdefault(name, []).append([tag, dimension[kind]])
    return {name: np.array(pairs[0] if len(pairs) == 1 else pairs) for name, pairs in rows.items()}


def sets(mesh: Surface | HexMesh, kind: str, tags: NDArray[np.int64] | None) -> dict[str, NDArray[np.int64]]:
    """The points, quads or hexes of every name of a tag on them."""
    found: dict[str, list[int]] = {}
    for of, tag, name in mesh.tag_names if tags is not None else []:
        if of == kind:
            found.setdefault(name, []).append(tag)
    return {name: np.flatnonzero(np.isin(tags, numbers)) for name, numbers in found.items()}  # type: ignore[arg-type]


def point_data(mesh: Surface | HexMesh) -> dict[str, Any]:
    """Data and tags of points."""
    tags = {} if mesh.point_tags is None else {"tag": np.array(mesh.point_tags)}
    return {**joined(mesh.point_data), **tags}
