"""Meshes of PyVista and meshio, taken and given. Neither is imported before one is asked for."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

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
    """``points``, ``quads``, ``hexes`` and ``other_faces`` of a PyVista or meshio mesh; ``None`` if it is neither."""
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
    }


def _poly_data(surface: Any) -> dict[str, Any]:
    """A PyVista PolyData: a flat list of faces, each with its number of vertices before it."""
    flat = np.asarray(surface.faces)
    quads, others, at, face = [], [], 0, 0
    if len(flat) and len(flat) % 5 == 0 and (flat[::5] == 4).all():
        return {"points": surface.points, "quads": flat.reshape(-1, 5)[:, 1:], "hexes": None, "other_faces": []}
    while at < len(flat):
        n = int(flat[at])
        vertices = flat[at + 1 : at + 1 + n].tolist()
        quads.append(vertices) if n == 4 else others.append((face, vertices))
        at, face = at + 1 + n, face + 1
    return {"points": surface.points, "quads": np.array(quads, int).reshape(-1, 4), "hexes": None, "other_faces": others}


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
    """A surface with its tags."""
    import pyvista

    poly = pyvista.PolyData.from_regular_faces(_positions(surface), np.array(surface.quads))  # type: ignore[arg-type]
    if surface.quad_tags is not None:
        poly.cell_data["tag"] = surface.quad_tags
    return poly


def mesh_to_pyvista(mesh: HexMesh) -> pyvista.UnstructuredGrid:
    """A mesh with its tags and the data of its hexes."""
    import pyvista

    grid = pyvista.UnstructuredGrid({HEX[0]: np.array(mesh.hexes)}, _positions(mesh))
    for name, numbers in mesh.hex_data.items():
        grid.cell_data[name] = numbers
    if mesh.hex_tags is not None:
        grid.cell_data["tag"] = mesh.hex_tags
    if mesh.point_tags is not None:
        grid.point_data["tag"] = mesh.point_tags
    if "scaled_jacobian" in mesh.hex_data:
        # What plot() colours by.
        grid.set_active_scalars("scaled_jacobian", preference="cell")
    return grid


def surface_to_meshio(surface: Surface) -> meshio.Mesh:
    """A block of quads with their tags."""
    import meshio

    cell_data = {} if surface.quad_tags is None else {"tag": [np.array(surface.quad_tags)]}
    quads = [("quad", np.array(surface.quads))]
    return meshio.Mesh(_positions(surface), quads, point_data=_point_data(surface), cell_data=cell_data)


def mesh_to_meshio(mesh: HexMesh) -> meshio.Mesh:
    """A block of hexahedra with their data, and the block of the surface's quads. Every array is on both: quads have no quality (NaN)."""
    import meshio

    n_quads, n_hexes = len(mesh.quads), len(mesh.hexes)
    cell_data = {name: [np.array(numbers), np.full(n_quads, np.nan)] for name, numbers in mesh.hex_data.items()}
    if mesh.quad_tags is not None or mesh.hex_tags is not None:
        cell_data["tag"] = [_tags(mesh.hex_tags, n_hexes), _tags(mesh.quad_tags, n_quads)]
    blocks = [("hexahedron", np.array(mesh.hexes)), ("quad", np.array(mesh.quads))]
    return meshio.Mesh(_positions(mesh), blocks, point_data=_point_data(mesh), cell_data=cell_data)


def _tags(tags: Any, n: int) -> Any:
    return np.zeros(n, np.int64) if tags is None else np.array(tags)


def _point_data(mesh: Surface | HexMesh) -> dict[str, Any]:
    return {} if mesh.point_tags is None else {"tag": np.array(mesh.point_tags)}
