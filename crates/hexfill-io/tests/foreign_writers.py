"""Files made by other programs.

    foreign_writers.py DIRECTORY    write the mesh of expected.json with every program, list the files

Called by foreign_readers.rs. Each line of the list: the file, whether coordinates are exact or in single precision, whether
tags are in it, and whether it holds quads, hexes or both.
"""

import itertools
import os
import pathlib
import sys

import gmsh
import meshio
import numpy as np
import pyvista
import vtk
from foreign_readers import HEX_EDGES, QUAD_EDGES, load_expected


def write_meshio(directory, due):
    cells = [("quad", np.array(due.quads)), ("hexahedron", np.array(due.hexes))]
    tags = [np.array(due.quad_tags), np.array(due.hex_tags)]
    full = {
        name: meshio.Mesh(due.points, cells, cell_data={key: tags})
        for name, key in [("plain", "tag"), ("medit", "medit:ref")]
    }
    physical = meshio.Mesh(due.points, cells, cell_data={"gmsh:physical": tags, "gmsh:geometrical": tags})
    surface = meshio.Mesh(due.points, cells[:1])
    for version in ("vtk42", "vtk51"):
        for binary in (True, False):
            name = f"meshio-{version}-{'binary' if binary else 'ascii'}.vtk"
            meshio.write(directory / name, full["plain"], file_format=version, binary=binary)
            yield name, "single" if not binary else "exact", "tags", "both"
    for kind, options in [
        ("ascii", {"binary": False}),
        ("zlib", {"binary": True, "compression": "zlib"}),
        ("plain", {"binary": True, "compression": None}),
    ]:
        name = f"meshio-{kind}.vtu"
        meshio.write(directory / name, full["plain"], file_format="vtu", **options)
        yield name, "single" if kind == "ascii" else "exact", "tags", "both"
    meshio.write(directory / "meshio.mesh", full["medit"])
    yield "meshio.mesh", "single", "tags", "both"
    for version in ("gmsh22", "gmsh"):
        for binary in (True, False):
            name = f"meshio-{version}-{'binary' if binary else 'ascii'}.msh"
            # meshio writes 4.1 without $Entities, so the tags are lost there.
            if version == "gmsh":
                physical.point_data["gmsh:dim_tags"] = np.array([[3, 21]] * len(due.points))
            meshio.write(directory / name, physical, file_format=version, binary=binary)
            tags_kept = "tags" if version == "gmsh22" else "notags"
            yield name, "exact" if binary else "single", tags_kept, "both"
    meshio.write(directory / "meshio.inp", full["plain"])
    yield "meshio.inp", "single", "notags", "both"
    meshio.write(directory / "meshio.bdf", full["plain"])
    yield "meshio.bdf", "single", "notags", "both"
    # meshio 5.3.5 fails on cells between commas.
    for kind, cells_as in [("fixed-small", "fixed-small"), ("fixed-large", "fixed-large"), ("free", "fixed-small")]:
        name = f"meshio-{kind}.nas"
        meshio.nastran.write(directory / name, full["plain"], point_format=kind, cell_format=cells_as)
        yield name, "single", "notags", "both"
    meshio.write(directory / "meshio.obj", surface)
    yield "meshio.obj", "single", "notags", "quads"
    for binary in (True, False):
        name = f"meshio-{'binary' if binary else 'ascii'}.ply"
        meshio.write(directory / name, surface, binary=binary)
        yield name, "exact" if binary else "single", "notags", "quads"


def write_quadratic(directory, due):
    """quad8 and hex20, and quad9 and hex27 from Gmsh: read here as their corners."""
    points, middle = [list(p) for p in due.points], {}

    def between(a, b):
        if (min(a, b), max(a, b)) not in middle:
            middle[min(a, b), max(a, b)] = len(points)
            points.append(list((due.points[a] + due.points[b]) / 2))
        return middle[min(a, b), max(a, b)]

    quads = [q + [between(q[a], q[b]) for a, b in QUAD_EDGES] for q in due.quads]
    hexes = [h + [between(h[a], h[b]) for a, b in HEX_EDGES] for h in due.hexes]
    mesh = meshio.Mesh(np.array(points), [("quad8", np.array(quads)), ("hexahedron20", np.array(hexes))])
    for name, file_format in [("vtu", "vtu"), ("vtk", "vtk42"), ("msh", "gmsh22"), ("inp", "abaqus"), ("bdf", "nastran")]:
        name = f"quadratic-meshio.{name}"
        meshio.write(directory / name, mesh, file_format=file_format)
        yield name, "single", "notags", "both"
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.open(str(directory / "quadratic-meshio.msh"))
    try:
        gmsh.model.mesh.setOrder(1)
        gmsh.model.mesh.setOrder(2)
        for version in (2.2, 4.1):
            for binary in (0, 1):
                gmsh.option.setNumber("Mesh.MshFileVersion", version)
                gmsh.option.setNumber("Mesh.Binary", binary)
                name = f"quadratic-gmsh-{version}-{'binary' if binary else 'ascii'}.msh"
                gmsh.write(name)
                yield name, "single", "notags", "both"
        for name in ("quadratic-gmsh.inp", "quadratic-gmsh.bdf"):
            gmsh.write(name)
            yield name, "single", "notags", "both"
    finally:
        gmsh.finalize()


def write_pyvista(directory, due):
    n_quads, n_hexes = len(due.quads), len(due.hexes)
    cells = np.concatenate([np.ravel([[4, *q] for q in due.quads]), np.ravel([[8, *h] for h in due.hexes])])
    grid = pyvista.UnstructuredGrid(cells, [9] * n_quads + [12] * n_hexes, due.points)
    grid.cell_data["tag"] = np.array(due.quad_tags + due.hex_tags)
    grid.cell_data["a vector"] = np.zeros((n_quads + n_hexes, 3))
    grid.point_data["tag"] = np.array(due.point_tags)
    grid.field_data["time"] = [1.5]
    for version in (42, 51):
        for binary in (True, False):
            name = f"vtk-{version}-{'binary' if binary else 'ascii'}.vtk"
            writer = vtk.vtkUnstructuredGridWriter()
            writer.SetFileName(str(directory / name))
            writer.SetInputData(grid)
            writer.SetFileVersion(version)
            writer.SetFileTypeToBinary() if binary else writer.SetFileTypeToASCII()
            assert writer.Write()
            yield name, "exact" if binary else "single", "tags", "both"
    flavours = itertools.product(("ascii", "inline", "raw", "base64"), ("none", "zlib"), (32, 64), ("little", "big"))
    for mode, compressor, header, order in flavours:
        if mode == "ascii" and (compressor, header, order) != ("none", 32, "little"):
            continue
        name = f"vtk-{mode}-{compressor}-{header}-{order}.vtu"
        writer = vtk.vtkXMLUnstructuredGridWriter()
        writer.SetFileName(str(directory / name))
        writer.SetInputData(grid)
        writer.SetDataMode({"ascii": 0, "inline": 1}.get(mode, 2))
        writer.SetEncodeAppendedData(mode == "base64")
        writer.SetCompressorTypeToZLib() if compressor == "zlib" else writer.SetCompressorTypeToNone()
        writer.SetHeaderTypeToUInt32() if header == 32 else writer.SetHeaderTypeToUInt64()
        writer.SetByteOrderToBigEndian() if order == "big" else writer.SetByteOrderToLittleEndian()
        # Several zlib blocks even for a small mesh.
        writer.SetBlockSize(64)
        assert writer.Write()
        yield name, "single" if mode == "ascii" else "exact", "tags", "both"
    surface = pyvista.PolyData(due.points, np.ravel([[4, *q] for q in due.quads]))
    surface.cell_data["tag"] = np.array(due.quad_tags)
    for binary in (True, False):
        kind = "binary" if binary else "ascii"
        surface.save(directory / f"pyvista-{kind}.vtp", binary=binary)
        yield f"pyvista-{kind}.vtp", "exact" if binary else "single", "tags", "quads"
        surface.save(directory / f"pyvista-{kind}.vtk", binary=binary)
        yield f"pyvista-{kind}.vtk", "exact" if binary else "single", "tags", "quads"
        surface.save(directory / f"pyvista-{kind}.ply", binary=binary)
        yield f"pyvista-{kind}.ply", "single", "notags", "quads"
    surface.save(directory / "pyvista.obj")
    yield "pyvista.obj", "single", "notags", "quads"
    voxels = pyvista.UnstructuredGrid(grid)
    swap = [0, 1, 3, 2, 4, 5, 7, 6]
    cells = np.ravel([[8, *[h[i] for i in swap]] for h in due.hexes])
    voxels = pyvista.UnstructuredGrid(cells, [11] * n_hexes, due.points)
    voxels.cell_data["tag"] = np.array(due.hex_tags)
    voxels.save(directory / "voxels.vtu")
    yield "voxels.vtu", "exact", "tags", "hexes"


def write_gmsh(directory, due):
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.model.add("chiral")
    try:
        # Node numbers with gaps, to be sure that numbers are not taken for positions.
        home = gmsh.model.addDiscreteEntity(3)
        numbers = [3 * i + 7 for i in range(len(due.points))]
        gmsh.model.mesh.addNodes(3, home, numbers, due.points.ravel())
        gmsh_element = 100
        for dim, kind, cells, tags in [(2, 3, due.quads, due.quad_tags), (3, 5, due.hexes, due.hex_tags)]:
            for tag in sorted(set(tags)):
                entity = gmsh.model.addDiscreteEntity(dim)
                members = [c for c, t in zip(cells, tags) if t == tag]
                elements = list(range(gmsh_element, gmsh_element + len(members)))
                gmsh_element += len(members)
                gmsh.model.mesh.addElementsByType(entity, kind, elements, [numbers[v] for c in members for v in c])
                gmsh.model.addPhysicalGroup(dim, [entity], tag)
        for version in (2.2, 4.1):
            for binary in (0, 1):
                gmsh.option.setNumber("Mesh.MshFileVersion", version)
                gmsh.option.setNumber("Mesh.Binary", binary)
                name = f"gmsh-{version}-{'binary' if binary else 'ascii'}.msh"
                gmsh.write(name)
                yield name, "exact" if binary else "single", "tags", "both"
        # In these every entity is to be saved, not only what is in a physical group (nothing changes here but the names).
        gmsh.option.setNumber("Mesh.SaveAll", 1)
        for binary in (0, 1):
            gmsh.option.setNumber("Mesh.Binary", binary)
            name = f"gmsh-{'binary' if binary else 'ascii'}.vtk"
            gmsh.write(name)
            yield name, "single", "notags", "both"
        gmsh.option.setNumber("Mesh.Binary", 0)
        for name, cells in [
            ("gmsh.mesh", "both"),
            ("gmsh.inp", "both"),
            ("gmsh.unv", "both"),
            ("gmsh.bdf", "both"),
            ("gmsh.off", "quads"),
        ]:
            gmsh.write(name)
            yield name, "single", "notags", cells
    finally:
        gmsh.finalize()


if __name__ == "__main__":
    folder = pathlib.Path(sys.argv[1])
    expected = load_expected(folder)
    os.chdir(folder)  # Gmsh writes the path it is given into some files
    for writer in (write_meshio, write_quadratic, write_pyvista, write_gmsh):
        for line in writer(folder, expected):
            print(*line)
