"""What other programs make of our files.

    foreign_readers.py DIRECTORY    read every file there with every program that knows its format

Called by foreign_readers.rs; foreign_writers.py is the other way round. The mesh is chiral, so a wrong node order cannot hide behind a symmetry: hexes are compared
up to the 24 rotations of the cube, never up to reflections, and their volume must be positive.
"""

import itertools
import json
import pathlib
import sys

import gmsh
import meshio
import numpy as np
import pyvista

CORNERS = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]


def rotations():
    """The 24 rotations of the cube as permutations of its corners, from their definition."""
    found = []
    for axes in itertools.permutations(range(3)):
        for signs in itertools.product((1, -1), repeat=3):
            matrix = np.zeros((3, 3))
            for i, (axis, sign) in enumerate(zip(axes, signs)):
                matrix[i, axis] = sign
            if np.linalg.det(matrix) > 0:
                centred = (np.array(CORNERS) * 2 - 1) @ matrix.T
                found.append([CORNERS.index(tuple(int(x) for x in (c + 1) // 2)) for c in centred])
    assert len(found) == 24
    return found


ROTATIONS = rotations()


def hex_key(h):
    return min(tuple(int(h[i]) for i in r) for r in ROTATIONS)


def quad_key(q):
    q = [int(v) for v in q]
    k = q.index(min(q))
    return tuple(q[k:] + q[:k])


def volume(points, h):
    """Six times the sum of the corner tetrahedra: positive for a hex in the right order."""
    total = 0.0
    for i, (a, b, c) in enumerate([(1, 3, 4), (2, 0, 5), (3, 1, 6), (0, 2, 7), (7, 5, 0), (4, 6, 1), (5, 7, 2), (6, 4, 3)]):
        p = points[[h[i], h[a], h[b], h[c]]]
        total += np.linalg.det(p[1:] - p[0])
    return total


class Mesh:
    """Points, quads and hexes with tags (None: the reader has none)."""

    def __init__(self, points, quads, hexes, quad_tags=None, hex_tags=None, point_tags=None):
        self.points = np.asarray(points, dtype=float)[:, :3]
        self.quads = [list(map(int, q)) for q in quads]
        self.hexes = [list(map(int, h)) for h in hexes]
        self.quad_tags, self.hex_tags, self.point_tags = quad_tags, hex_tags, point_tags

    def connectivity(self, order, with_quad_tags, with_hex_tags):
        """Sorted lists of keys; `order` maps point numbers."""
        quads = [
            (quad_key([order[v] for v in q]), int(self.quad_tags[i]) if with_quad_tags else 0)
            for i, q in enumerate(self.quads)
        ]
        hexes = [
            (hex_key([order[v] for v in h]), int(self.hex_tags[i]) if with_hex_tags else 0)
            for i, h in enumerate(self.hexes)
        ]
        return sorted(quads), sorted(hexes)


def load_expected(directory):
    data = json.loads((directory / "expected.json").read_text())
    return Mesh(
        data["points"], data["boundary_quads"], data["hexes"], data["quad_tags"], data["hex_tags"], data["point_tags"]
    )


def compare(found, due, tolerance, has_quads, has_hexes, what):
    """Asserts that both are the same mesh; points are matched by position."""
    assert len(found.points) == len(due.points), f"{what}: {len(found.points)} points"
    order = []
    for p in found.points:
        distance = np.abs(due.points - p).max(axis=1)
        assert distance.min() <= tolerance, f"{what}: {p} is no point"
        order.append(int(distance.argmin()))
    assert sorted(order) == list(range(len(order))), what
    reference = Mesh(due.points, due.quads if has_quads else [], due.hexes if has_hexes else [], due.quad_tags, due.hex_tags)
    tags = (found.quad_tags is not None, found.hex_tags is not None)
    got = found.connectivity(order, *tags)
    want = reference.connectivity(range(len(order)), *tags)
    assert got == want, f"{what}:\n{got}\n{want}"
    for h in found.hexes:
        assert volume(found.points, h) > 0, what
    if found.point_tags is not None:
        assert [int(t) for t in np.ravel(found.point_tags)] == [due.point_tags[k] for k in order], f"{what}: tags of points"


def gather(blocks, tags):
    """All cells of a kind and their tags from meshio's blocks."""
    cells, values = [], []
    for data, t in blocks:
        cells += list(data)
        if t is not None:
            values += list(np.ravel(t))
    return cells, (values if tags else None)


def by_meshio(path):
    m = meshio.gmsh.read(path) if path.suffix == ".msh" else meshio.read(path)
    name = next((n for n in ("tag", "gmsh:physical", "medit:ref", "nastran:ref") if n in m.cell_data), None)
    sets = {}
    if path.suffix == ".inp":
        # Element sets TAG_n: for each block the positions of its members.
        for set_name, blocks in m.cell_sets.items():
            if not set_name.startswith("TAG_"):
                continue
            for k, members in enumerate(blocks):
                for i in [] if members is None else members:
                    sets[(k, int(i))] = int(set_name.split("_")[1])
    result = {}
    for kind in ("quad", "hexahedron"):
        blocks = []
        for k, block in enumerate(m.cells):
            if block.type == kind:
                tags = m.cell_data[name][k] if name else None
                if sets:
                    tags = [sets.get((k, i), 0) for i in range(len(block.data))]
                blocks.append((block.data, tags))
        result[kind] = gather(blocks, name is not None or bool(sets))
    point_name = next((n for n in ("tag", "medit:ref") if n in m.point_data), None)
    point_tags = m.point_data[point_name] if point_name else None
    (quads, quad_tags), (hexes, hex_tags) = result["quad"], result["hexahedron"]
    return Mesh(m.points, quads, hexes, quad_tags, hex_tags, point_tags)


def by_pyvista(path):
    p = pyvista.read(path)
    if isinstance(p, pyvista.PolyData):
        return Mesh(p.points, p.faces.reshape(-1, 5)[:, 1:], [], p.cell_data.get("tag"), None, p.point_data.get("tag"))
    tags = p.cell_data.get("tag")
    select = {t: np.flatnonzero(p.celltypes == t) for t in (9, 12)}
    cells = {t: p.cells_dict.get(t, []) for t in (9, 12)}
    assert len(cells[9]) + len(cells[12]) == p.n_cells
    pick = lambda t: None if tags is None else tags[select[t]]
    return Mesh(p.points, cells[9], cells[12], pick(9), pick(12), p.point_data.get("tag"))


def gmsh_open(path):
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.open(str(path))


def by_gmsh(path):
    gmsh_open(path)
    try:
        numbers, coordinates, _ = gmsh.model.mesh.getNodes()
        where = {int(n): i for i, n in enumerate(numbers)}
        cells, tags = {3: [], 5: []}, {3: [], 5: []}
        for dim in (2, 3):
            for _, entity in gmsh.model.getEntities(dim):
                groups = gmsh.model.getPhysicalGroupsForEntity(dim, entity)
                # MEDIT references become entities; in MSH the physical group is the tag.
                tag = (int(groups[0]) if len(groups) else 0) if path.suffix == ".msh" else entity
                for kind, _, nodes in zip(*gmsh.model.mesh.getElements(dim, entity)):
                    size = {3: 4, 5: 8}[int(kind)]
                    for cell in np.reshape(nodes, (-1, size)):
                        cells[int(kind)].append([where[int(n)] for n in cell])
                        tags[int(kind)].append(tag)
        carried = path.suffix in (".msh", ".mesh", ".bdf")
        points = np.reshape(coordinates, (-1, 3))
        return Mesh(points, cells[3], cells[5], tags[3] if carried else None, tags[5] if carried else None)
    finally:
        gmsh.finalize()


def by_json(path):
    data = json.loads(path.read_text())
    return Mesh(
        data["points"],
        data["boundary_quads"],
        data["hexes"],
        data.get("quad_tags"),
        data.get("hex_tags"),
        data.get("point_tags"),
    )


def by_definition_of_ovm(path):
    """There is no OVM reader on PyPI: half-faces are followed here from the definition of the format."""
    words = [w for line in path.read_text().splitlines() if not line.startswith("#") for w in line.split()]
    assert words[:3] == ["OVM", "ASCII", "Vertices"]
    at = 3

    def take(n):
        nonlocal at
        at += n
        return words[at - n : at]

    n = int(take(1)[0])
    points = np.array(take(3 * n), dtype=float).reshape(-1, 3)
    name, n = take(2)
    assert name == "Edges"
    edges = [tuple(map(int, take(2))) for _ in range(int(n))]
    lists = {}
    for section in ("Faces", "Polyhedra"):
        name, n = take(2)
        assert name == section
        lists[section] = [list(map(int, take(int(take(1)[0])))) for _ in range(int(n))]

    def cycle(half_face):
        half_edges = lists["Faces"][half_face // 2]
        ends = [edges[e // 2][:: -1 if e % 2 else 1] for e in half_edges]
        assert all(ends[k][1] == ends[(k + 1) % len(ends)][0] for k in range(len(ends)))
        start = [a for a, _ in ends]
        return start[::-1] if half_face % 2 else start

    hexes, uses = [], {}
    for half_faces in lists["Polyhedra"]:
        cycles = [cycle(f) for f in half_faces]
        for f in half_faces:
            assert uses.setdefault(f, 0) == 0, "each half-face bounds one cell"
            uses[f] = 1
        # As `add_cell` orders them, 0 and 1 are opposite; each is seen counter-clockwise from inside.
        bottom, top = cycles[0], cycles[1]
        above = {}
        for side in cycles[2:]:
            for k in range(4):
                a, b = side[k], side[(k + 1) % 4]
                if a in bottom and b in top:
                    above[a] = b
        hexes.append(bottom + [above[v] for v in bottom])
        # Opposite pairs share no vertex.
        assert not set(cycles[2]) & set(cycles[3]) and not set(cycles[4]) & set(cycles[5])
    quads = [cycle(2 * f) for f in range(len(lists["Faces"])) if uses.get(2 * f, 0) + uses.get(2 * f + 1, 0) <= 1]
    return Mesh(points, quads, hexes)


READERS = {
    ".obj": [by_meshio, by_pyvista, by_gmsh],
    ".off": [by_gmsh],  # meshio reads triangles only
    ".ply": [by_meshio, by_pyvista],
    ".vtk": [by_meshio, by_pyvista, by_gmsh],
    ".vtu": [by_meshio, by_pyvista],
    ".mesh": [by_meshio, by_gmsh],
    ".msh": [by_meshio, by_gmsh],
    ".inp": [by_meshio],  # Gmsh writes it only
    ".bdf": [by_meshio, by_gmsh],
    ".unv": [by_gmsh],
    ".ovm": [by_definition_of_ovm],
    ".json": [by_json],
}


def check(directory):
    due = load_expected(directory)
    for path in sorted(directory.glob("*.*")):
        if path.name.startswith("quadratic-"):
            check_quadratic(path, due)
            continue
        for reader in READERS[path.suffix]:
            binary = "-binary" in path.name
            if reader is by_meshio and binary and path.suffix == ".ply":
                continue  # meshio 5.3.5 fails on binary lists followed by another property (the tag)
            if reader is by_gmsh and binary:
                continue  # Gmsh reads no binary VTK of version 3.0
            # meshio and PyVista keep PLY (and VTK keeps OBJ) in single precision in some versions.
            tolerance = 1e-6 if path.suffix in (".ply", ".obj") else 0.0
            if path.suffix == ".bdf":
                tolerance = 1e-11  # fields of 16 characters
            found = reader(path)
            surface_format = path.suffix in (".obj", ".off", ".ply")
            if path.name.startswith("named-"):
                # Other tags: the names are looked at.
                found.quad_tags = found.hex_tags = found.point_tags = None
                compare_names(path, reader)
            if path.name.startswith("numbered-"):
                compare_numbers(path, reader, due)
            if path.name.startswith("partly-"):
                found.quad_tags = found.hex_tags = None
            has_hexes = "-surface" not in path.name and not surface_format
            # Abaqus has quads on hexes as faces of these, which meshio does not know.
            has_quads = path.suffix != ".inp" or "-surface" in path.name
            compare(found, due, tolerance, has_quads, has_hexes, f"{path.name} {reader.__name__}")
            compare_data(path, reader)
            tags = "with tags" if found.quad_tags is not None else "without tags"
            print(f"ok {path.name} {reader.__name__} {tags}")


QUAD_EDGES = [(0, 1), (1, 2), (2, 3), (3, 0)]
HEX_EDGES = QUAD_EDGES + [(4, 5), (5, 6), (6, 7), (7, 4)] + [(k, k + 4) for k in range(4)]


def cells_of_second_order(path, reader):
    """Points and the 8-node quads and 20-node hexes a program finds, and the edges of its middle nodes."""
    if reader is by_meshio:
        m = meshio.gmsh.read(path) if path.suffix == ".msh" else meshio.read(path)
        assert {block.type for block in m.cells} <= {"quad8", "hexahedron20"}, (path, m)
        of = lambda kind: [c for block in m.cells if block.type == kind for c in block.data]
        return m.points, of("quad8"), of("hexahedron20"), HEX_EDGES
    if reader is by_pyvista:
        p = pyvista.read(path)
        assert set(p.celltypes) <= {23, 25}, (path, p.celltypes)
        return p.points, p.cells_dict.get(23, []), p.cells_dict.get(25, []), HEX_EDGES
    gmsh_open(path)
    try:
        numbers, coordinates, _ = gmsh.model.mesh.getNodes()
        where = {int(n): i for i, n in enumerate(numbers)}
        of = lambda kind, n: [[where[int(v)] for v in c] for c in np.reshape(gmsh.model.mesh.getElementsByType(kind)[1], (-1, n))]
        points, quads, hexes = np.reshape(coordinates, (-1, 3)), of(16, 8), of(17, 20)
        jacobians = gmsh.model.mesh.getJacobians(17, [0.3, -0.2, 0.6])[1] if hexes else []
        assert all(j > 0 for j in jacobians), (path, jacobians)
        return points, quads, hexes, sorted(tuple(sorted(e)) for e in HEX_EDGES)
    finally:
        gmsh.finalize()


def check_quadratic(path, due):
    """Corners as in the straight mesh; each middle node at the mean of the ends of the edge it is on by that program's order."""
    for reader in READERS[path.suffix]:
        if reader is by_gmsh and path.suffix == ".vtk":
            continue  # Gmsh 4.15 takes the nodes of VTK_QUADRATIC_HEXAHEDRON for its own order
        points, quads, hexes, hex_edges = cells_of_second_order(path, reader)
        points = np.asarray(points)[:, :3]
        tolerance = 1e-9 if path.suffix == ".bdf" else 1e-15
        for cells, corners, edges in [(quads, 4, QUAD_EDGES), (hexes, 8, hex_edges)]:
            for cell in cells:
                for node, (a, b) in zip(cell[corners:], edges):
                    mean = (points[cell[a]] + points[cell[b]]) / 2
                    assert np.abs(points[node] - mean).max() <= tolerance, (path, reader, node, points[node], mean)
        straight = Mesh(points, [q[:4] for q in quads], [h[:8] for h in hexes])
        used = sorted({v for cell in straight.quads + straight.hexes for v in cell})
        assert len(points) == len(due.points) + 20, (path, reader, len(points))
        number = {v: i for i, v in enumerate(used)}
        renumber = lambda cells: [[number[v] for v in cell] for cell in cells]
        straight = Mesh(points[used], renumber(straight.quads), renumber(straight.hexes))
        compare(straight, due, tolerance, path.suffix != ".inp", True, f"{path.name} {reader.__name__}")
        print(f"ok {path.name} {reader.__name__}")


def compare_data(path, reader):
    """The numbers on hexes, quads and points, in the formats that carry them."""
    if path.suffix not in (".vtk", ".vtu", ".msh") or "-surface" in path.name:
        return
    if reader is by_gmsh:
        if path.suffix == ".msh":
            compare_views(path)
        return
    if path.name.endswith("msh22.msh"):
        # meshio 5.3.5 cannot tell where the data of a kind of elements ends, and passes over data on their nodes.
        assert not [name for name in meshio.gmsh.read(path).cell_data if not name.startswith("gmsh:")]
        return
    if reader is by_meshio:
        m = meshio.gmsh.read(path) if path.suffix == ".msh" else meshio.read(path)
        name = next(n for n in m.cell_data if n.startswith("scaled"))
        hexes = np.concatenate([d for d, c in zip(m.cell_data[name], m.cells) if c.type == "hexahedron"])
        quads = np.concatenate([d for d, c in zip(m.cell_data["load"], m.cells) if c.type == "quad"])
        flux = np.concatenate([d for d, c in zip(m.cell_data["flux"], m.cells) if c.type == "hexahedron"])
        heights, shift = m.point_data["height"], m.point_data["shift"]
    else:
        p = pyvista.read(path)
        hexes, heights = p.cell_data["scaled Jacobian"][p.celltypes == 12], p.point_data["height"]
        quads, flux = p.cell_data["load"][p.celltypes == 9], p.cell_data["flux"][p.celltypes == 12]
        shift = p.point_data["shift"]
    assert list(hexes) == [0.75, -1e-300], (path, hexes)
    assert list(heights) == [i / 7 for i in range(12)], (path, heights)
    assert list(quads) == [i / 3 for i in range(10)], (path, quads)
    assert np.array_equal(flux, -1.5 * np.arange(6).reshape(2, 3)), (path, flux)
    assert np.array_equal(shift, 0.1 * np.arange(36).reshape(12, 3)), (path, shift)


def compare_views(path):
    """What Gmsh shows: numbers on the hexes, on the quads, vectors."""
    gmsh_open(path)
    try:
        found = {}
        for view in gmsh.view.getTags():
            name = gmsh.view.option.getString(view, "Name")
            kind, numbers, values, _, components = gmsh.view.getModelData(view, 0)
            found[name] = kind, numbers, values, components
        assert set(found) == {"tag", "height", "shift", "scaled Jacobian", "flux", "load"}, (path, set(found))
        for name, of_kind, due in [("scaled Jacobian", 5, [0.75, -1e-300]), ("load", 3, [i / 3 for i in range(10)])]:
            elements, _ = gmsh.model.mesh.getElementsByType(of_kind)
            got = {int(n): v for n, v in zip(found[name][1], found[name][2])}
            values = [got[n] for n in sorted(int(n) for n in elements)]
            assert all(set(v) == {d} for v, d in zip(values, due)), (path, name, values)
        assert found["flux"][3] == 3 and found["shift"][3] == 3, path
    finally:
        gmsh.finalize()


def compare_numbers(path, reader, due):
    """The numbers of nodes as Gmsh sees them; meshio has no place for them."""
    if reader is not by_gmsh:
        return
    gmsh_open(path)
    try:
        numbers, coordinates, _ = gmsh.model.mesh.getNodes()
        found = {int(n): p for n, p in zip(numbers, np.reshape(coordinates, (-1, 3)))}
        assert set(found) == {7 + 13 * i for i in range(12)}, (path, set(found))
        assert all(np.abs(found[7 + 13 * (5 * i % 12)] - p).max() <= 1e-11 for i, p in enumerate(due.points)), (path, found)
    finally:
        gmsh.finalize()


def compare_names(path, reader):
    """The names of groups, where a reader has a place for them."""
    quads_of = {"inlet": 4, "outlet": 3, "wall": 4, "roof": 1}
    if reader is by_gmsh and path.suffix == ".msh":
        gmsh_open(path)
        try:
            found = {}
            for dim, group in gmsh.model.getPhysicalGroups():
                name = gmsh.model.getPhysicalName(dim, group)
                entities = gmsh.model.getEntitiesForPhysicalGroup(dim, group)
                found[name] = sum(len(n) for e in entities for n in gmsh.model.mesh.getElements(dim, e)[1])
        finally:
            gmsh.finalize()
        if "msh22" in path.name:
            quads_of = {"inlet": 2, "outlet": 3, "wall": 2, "roof": 1, "inlet+wall": 2}
        hexes_of = {} if "-surface" in path.name else {"steel": 1, "rubber": 1}
        assert found == {**quads_of, **hexes_of}, (path, found)
    elif reader is by_meshio and path.suffix in (".vtu", ".msh"):
        m = meshio.gmsh.read(path) if path.suffix == ".msh" else meshio.read(path)
        assert list(np.ravel(m.field_data["outlet"])) == [2, 2], (path, m.field_data)
        assert {"roof", "steel", "rubber"} <= set(m.field_data), (path, m.field_data)
    elif reader is by_pyvista and path.suffix in (".vtk", ".vtu"):
        fields = pyvista.read(path).field_data
        assert list(np.ravel(fields["outlet"])) == [2, 2], (path, fields)
        assert np.array_equal(fields["wall"], [[3, 2], [5, 2]]), (path, fields["wall"])
    elif reader is by_meshio and path.suffix == ".inp":
        m = meshio.read(path)
        assert {"steel", "rubber"} <= set(m.cell_sets) and {"fixed", "loaded"} <= set(m.point_sets), path


if __name__ == "__main__":
    check(pathlib.Path(sys.argv[1]))
