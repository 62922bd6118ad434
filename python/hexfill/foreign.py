"""Meshes of PyVista and meshio, taken and given. Neither is imported before one is asked for."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING, Any

import numpy as np

from . import fields
from .errors import InputError

if TYPE_CHECKING:
    import meshio
    import pyvista

    from .mesh import HexMesh, Surface

#: Kinds of cells: VTK's number, meshio's name.
QUAD, HEX = (9, "quad"), (12, "hexahedron")
#: VTK's pixel and voxel: the same cells in the order of a grid.
PIXEL, VOXEL = 8, 11
PIXEL_ORDER, VOXEL_ORDER = [0, 1, 3, 2], [0, 1, 3, 2, 4, 5, 7, 6]
#: Cells without a meaning here: vertices and lines.
IGNORED = {1, 2, 3, 4, 21, "vertex", "line", "line3"}


def arrays_of(given: Any) -> dict[str, Any] | None:
    """``points``, ``quads``, ``hexes``, ``other_faces`` of a PyVista or meshio mesh, and what it carries as :func:`fields.taken` has it; ``None``
    if it is neither."""
    if not hasattr(given, "points"):
        return None
    if hasattr(given, "cells_dict"):
        return _grid(given)
    if hasattr(given, "faces") and hasattr(given, "n_cells"):
        return _poly_data(given)
    if hasattr(given, "cast_to_unstructured_grid"):
        return _grid(given.cast_to_unstructured_grid())
    return None


def _grid(grid: Any) -> dict[str, Any]:
    """A PyVista UnstructuredGrid (kinds are numbers) or a meshio mesh (kinds are names)."""
    quads, hexes, others = [], [], []
    # meshio keeps blocks, so one kind may come in several; cells_dict joins them in order.
    for kind, cells in grid.cells_dict.items():
        cells = np.asarray(cells)
        if kind in QUAD:
            quads.append(cells)
        elif kind in HEX:
            hexes.append(cells)
        elif kind == PIXEL:
            quads.append(cells[:, PIXEL_ORDER])
        elif kind == VOXEL:
            hexes.append(cells[:, VOXEL_ORDER])
        elif kind in (5, "triangle"):
            others.extend(cells.tolist())
        elif kind not in IGNORED:
            raise InputError(f"{len(cells)} cells are of kind {kind!r}; quads (linear) and hexahedra (linear) are taken")
    n_quads = sum(map(len, quads))
    return {
        "points": _three(grid.points),
        "quads": np.concatenate(quads) if quads else np.empty((0, 4), int),
        "hexes": np.concatenate(hexes) if hexes else np.empty((0, 8), int),
        "other_faces": [(n_quads + i, face) for i, face in enumerate(others)],
        **_carried(grid),
    }


#: The kinds of cells that carry numbers, in both words.
KINDS: dict[str, tuple[Any, ...]] = {"quads": (*QUAD, PIXEL), "hexes": (*HEX, VOXEL)}


def _carried(grid: Any) -> dict[str, Any]:
    """Data, tags and names of tags; arrays on cells in the order in which ``cells_dict`` joins these."""
    kinds = list(grid.cells_dict)
    places = {what: [kind for kind in kinds if kind in of] for what, of in KINDS.items()}

    def rows(array: Any, what: str) -> Any:
        if hasattr(grid, "celltypes"):
            parts = [np.asarray(array)[grid.celltypes == kind] for kind in places[what]]
        else:
            parts = [np.asarray(a) for kind in places[what] for a, b in zip(array, grid.cells) if b.type == kind]
        return np.concatenate(parts) if parts else np.empty(0)

    cell_data = {name: partial(rows, grid.cell_data[name]) for name in grid.cell_data.keys()}
    return fields.taken(grid.point_data, cell_data, grid.field_data, _sets(grid, rows))


#: Sets of meshio that are no groups.
NO_GROUPS = {"gmsh:bounding_entities"}


def _sets(grid: Any, rows: Callable[[Any, str], Any]) -> fields.Sets:
    """Sets of a meshio mesh: indices in each block of cells, and of points. PyVista has none."""

    def mask(n: int, indices: Any) -> Any:
        found = np.zeros(n, bool)
        found[np.asarray([] if indices is None else indices, int)] = True
        return found

    of_cells = {name: of for name, of in getattr(grid, "cell_sets", {}).items() if name not in NO_GROUPS}
    masks = {name: [mask(len(block.data), i) for block, i in zip(grid.cells, of)] for name, of in of_cells.items()}
    found: dict[str, Any] = {kind: {name: rows(of, kind) for name, of in masks.items()} for kind in KINDS}
    found["points"] = {name: mask(len(grid.points), i) for name, i in getattr(grid, "point_sets", {}).items()}
    return found


def _poly_data(surface: Any) -> dict[str, Any]:
    """A PyVista PolyData."""
    quads, others, sides = _faces(np.asarray(surface.faces))
    # Vertices and lines come before the faces.
    is_quad = np.concatenate([np.zeros(surface.n_verts + surface.n_lines, bool), np.asarray(sides, int) == 4])

    def rows(array: Any, what: str) -> Any:
        return np.asarray(array)[: len(is_quad)][is_quad] if what == "quads" else np.empty(0)

    cell_data = {name: partial(rows, surface.cell_data[name]) for name in surface.cell_data.keys()}
    return {
        "points": surface.points,
        "quads": quads,
        "hexes": None,
        "other_faces": others,
        **fields.taken(surface.point_data, cell_data, surface.field_data),
    }


def _faces(flat: Any) -> tuple[Any, list[tuple[int, list[int]]], Any]:
    """The quads of a flat list of faces, each with its number of vertices before it; the other faces with their places; the sides of each."""
    if len(flat) and len(flat) % 5 == 0 and (flat[::5] == 4).all():
        return flat.reshape(-1, 5)[:, 1:], [], flat[::5]
    quads: list[list[int]] = []
    others: list[tuple[int, list[int]]] = []
    sides: list[int] = []
    at = 0
    while at < len(flat):
        n = int(flat[at])
        vertices = flat[at + 1 : at + 1 + n].tolist()
        quads.append(vertices) if n == 4 else others.append((len(sides), vertices))
        sides.append(n)
        at += 1 + n
    return np.array(quads, int).reshape(-1, 4), others, sides


def _three(points: Any) -> Any:
    """meshio allows flat points."""
    points = np.asarray(points)
    if points.ndim == 2 and points.shape[1] == 2:
        return np.column_stack([points, np.zeros(len(points))])
    return points


def _positions(mesh: Surface | HexMesh) -> Any:
    if mesh.points is None:
        raise InputError("there are no coordinates; PyVista and meshio need some")
    return np.array(mesh.points)


def surface_to_pyvista(surface: Surface) -> pyvista.PolyData:
    """A surface with its tags and data."""
    import pyvista

    poly = pyvista.PolyData.from_regular_faces(_positions(surface), np.array(surface.quads))  # type: ignore[arg-type]
    _carry(poly, surface, surface.quad_data, surface.quad_tags, ["points", "quads"])
    return poly


def _carry(grid: Any, mesh: Surface | HexMesh, data: Any, tags: Any, kinds: list[str]) -> None:
    """Gives a PyVista mesh numbers of its cells and points, their tags, and the names of these."""
    grid.cell_data.update(fields.joined(data))
    if tags is not None:
        grid.cell_data["tag"] = tags
    grid.point_data.update(fields.point_data(mesh))
    for name, pairs in fields.names(mesh, kinds).items():
        grid.field_data[name] = pairs.reshape(-1, 2)


def mesh_to_pyvista(mesh: HexMesh) -> pyvista.UnstructuredGrid:
    """A mesh with its tags and the data of its hexes and points."""
    import pyvista

    grid = pyvista.UnstructuredGrid({HEX[0]: np.array(mesh.hexes)}, _positions(mesh))
    _carry(grid, mesh, mesh.hex_data, mesh.hex_tags, ["points", "hexes"])
    if "scaled_jacobian" in mesh.hex_data:
        # What plot() colours by.
        grid.set_active_scalars("scaled_jacobian", preference="cell")
    return grid


def surface_to_meshio(surface: Surface, sets: bool) -> meshio.Mesh:
    """A block of quads with their tags and data; groups by name as sets, if asked for."""
    import meshio

    cell_data = {name: [numbers] for name, numbers in fields.joined(surface.quad_data).items()}
    if surface.quad_tags is not None:
        cell_data["tag"] = [np.array(surface.quad_tags)]
    return meshio.Mesh(
        _positions(surface),
        [("quad", np.array(surface.quads))],
        point_data=fields.point_data(surface),
        cell_data=cell_data,
        field_data=fields.names(surface, ["points", "quads"]),
        **(_as_sets(surface, [("quads", surface.quad_tags)]) if sets else {}),
    )


def _as_sets(mesh: Surface | HexMesh, blocks: list[tuple[str, Any]]) -> dict[str, Any]:
    """The groups of points and of blocks of cells, by name: indices in each block."""
    of_blocks = [fields.sets(mesh, kind, tags) for kind, tags in blocks]
    names = dict.fromkeys(name for of in of_blocks for name in of)
    none = np.empty(0, np.int64)
    return {
        "cell_sets": {name: [of.get(name, none) for of in of_blocks] for name in names},
        "point_sets": fields.sets(mesh, "points", mesh.point_tags),
    }


def mesh_to_meshio(mesh: HexMesh, sets: bool) -> meshio.Mesh:
    """A block of hexahedra with their data, and the block of the surface's quads with theirs. Every array is on both: quads have no quality (NaN)."""
    import meshio

    n_quads, n_hexes = len(mesh.quads), len(mesh.hexes)
    cell_data = fields.on_both(mesh)
    if mesh.quad_tags is not None or mesh.hex_tags is not None:
        cell_data["tag"] = [_tags(mesh.hex_tags, n_hexes), _tags(mesh.quad_tags, n_quads)]
    blocks = [("hexahedron", np.array(mesh.hexes)), ("quad", np.array(mesh.quads))]
    return meshio.Mesh(
        _positions(mesh),
        blocks,
        point_data=fields.point_data(mesh),
        cell_data=cell_data,
        field_data=fields.names(mesh, ["points", "quads", "hexes"]),
        **(_as_sets(mesh, [("hexes", mesh.hex_tags), ("quads", mesh.quad_tags)]) if sets else {}),
    )


def _tags(tags: Any, n: int) -> Any:
    return np.zeros(n, np.int64) if tags is None else np.array(tags)
