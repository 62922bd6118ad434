"""PyVista and meshio: taken, given, and not imported by hexfill itself."""

import subprocess
import sys

import numpy as np
import pytest

import hexfill


def test_nothing_is_imported_before_it_is_used(bar):
    program = (
        "import sys, hexfill; mesh = hexfill.fill(':cube'); repr(mesh); mesh._repr_html_(); "
        "print([m for m in ('pyvista', 'vtk', 'meshio', 'tqdm', 'matplotlib', 'IPython') if m in sys.modules])"
    )
    run = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert run.stdout.strip() == "[]"


def test_pyvista(bar):
    pyvista = pytest.importorskip("pyvista")
    points, quads = bar
    poly = pyvista.PolyData.from_regular_faces(points, quads)
    mesh = hexfill.fill(poly)
    grid = mesh.to_pyvista()
    assert isinstance(grid, pyvista.UnstructuredGrid) and grid.n_cells == 12 and grid.volume == pytest.approx(12)
    assert grid.active_scalars_name == "scaled_jacobian"
    assert hexfill.check(grid, surface=poly).certified
    assert isinstance(mesh.surface.to_pyvista(), pyvista.PolyData)
    assert (mesh.surface.to_pyvista().regular_faces == quads).all()
    assert hexfill.fill(pyvista.UnstructuredGrid({9: quads}, points)).n_hexes == 12
    voxels = pyvista.ImageData(dimensions=(3, 3, 4))
    assert hexfill.check(voxels).certified
    triangles = poly.triangulate()
    with pytest.raises(hexfill.SurfaceError) as caught:
        hexfill.fill(triangles)
    assert caught.value.count == 2 * len(quads)
    with pytest.raises(hexfill.SurfaceError, match="open"):
        hexfill.fill(pyvista.Plane())
    with pytest.raises(hexfill.InputError, match="linear"):
        hexfill.fill(pyvista.UnstructuredGrid({10: np.array([[0, 1, 2, 3]])}, points))


def test_meshio(bar, tmp_path):
    meshio = pytest.importorskip("meshio")
    points, quads = bar
    given = meshio.Mesh(points, [("vertex", [[0]]), ("quad", quads[:10]), ("line", [[0, 1]]), ("quad", quads[10:])])
    mesh = hexfill.fill(given)
    assert (mesh.quads == quads).all() and mesh.n_hexes == 12
    out = mesh.to_meshio()
    assert hexfill.check(out, surface=given).certified
    for name in ("out.vtu", "out.vtk", "out.mesh", "out.inp"):
        out.write(tmp_path / name)
        assert (hexfill.read(tmp_path / name).hexes == mesh.hexes).all(), name
    tagged = hexfill.fill(hexfill.Surface(points, quads, quad_tags=np.arange(len(quads)))).to_meshio()
    assert (tagged.cell_data["tag"][1] == np.arange(len(quads))).all()
    with pytest.raises(hexfill.InputError, match="tetra"):
        hexfill.fill(meshio.Mesh(points, [("tetra", [[0, 1, 2, 3]])]))
    with pytest.raises(hexfill.InputError, match="coordinates"):
        hexfill.HexMesh(None, mesh.hexes).to_meshio()


def test_pyvista_carries_data_tags_and_names(bar):
    pyvista = pytest.importorskip("pyvista")
    points, quads = bar
    n, m = len(points), len(quads)
    poly = pyvista.PolyData.from_regular_faces(points, quads)
    # Cells of another kind come first in VTK, with rows of their own.
    poly.verts = [1, 0, 1, 5]
    poly.cell_data["heat"] = np.arange(m + 2) - 2.0
    poly.cell_data["flux"] = np.arange(3.0 * (m + 2)).reshape(-1, 3) - 6
    poly.cell_data["tag"] = np.array([9, 9, *(np.arange(m) % 3)])
    poly.point_data["height"] = points[:, 2]
    poly.field_data["inlet"] = [[1, 2]]
    poly.field_data["wall"] = [[1, 2], [2, 2]]
    poly.field_data["time"] = [1.5]
    mesh = hexfill.fill(poly)
    assert (mesh.quad_data["heat"] == np.arange(m)).all() and (mesh.quad_tags == np.arange(m) % 3).all()
    assert (mesh.quad_data["flux:2"] == 3 * np.arange(m) + 2).all()
    assert (mesh.point_data["height"][:n] == points[:, 2]).all()
    assert mesh.tag_names == [("quads", 1, "inlet"), ("quads", 1, "wall"), ("quads", 2, "wall"), ("hexes", 1, "volume")]
    back = mesh.surface.to_pyvista()
    assert (back.cell_data["flux"] == np.arange(3.0 * m).reshape(-1, 3)).all()
    assert (back.field_data["wall"] == [[1, 2], [2, 2]]).all() and (back.point_data["height"][:n] == points[:, 2]).all()
    grid = mesh.to_pyvista()
    assert (grid.cell_data["layer"] == mesh.hex_data["layer"]).all() and (grid.field_data["volume"] == [[1, 3]]).all()
    # Quads and hexes in one grid, mixed.
    mixed = pyvista.UnstructuredGrid(
        np.concatenate([np.column_stack([np.full(12, 8), mesh.hexes]).ravel(), np.column_stack([np.full(m, 4), quads]).ravel()]),
        [12] * 12 + [9] * m,
        mesh.points,
    )
    mixed.cell_data["material"] = np.array([7] * 12 + [0] * m)
    mixed.cell_data["load"] = np.array([np.nan] * 12 + list(range(m)))
    mixed.cell_data["certified_positive"] = np.ones(12 + m)
    again = hexfill.embed(mixed)
    assert (again.hex_tags == 7).all() and again.quad_tags is None
    assert (again.quad_data["load"] == np.arange(m)).all() and "load" not in again.hex_data


def test_what_was_judged_is_not_believed_of_others(bar):
    pyvista = pytest.importorskip("pyvista")
    grid = hexfill.fill(bar[0], bar[1]).to_pyvista()
    assert (grid.cell_data["certified_positive"] == 1).all()
    grid.points[:, 2] *= -1
    assert not hexfill.check(grid).certified
    from hexfill.mesh import as_mesh

    assert as_mesh(grid).certified is None and "layer" in as_mesh(grid).hex_data
    with pytest.warns(UserWarning, match="no real numbers"):
        grid.cell_data["words"] = ["a"] * grid.n_cells
        hexfill.check(grid)


def test_meshio_carries_data_tags_and_names(bar, tmp_path):
    meshio = pytest.importorskip("meshio")
    points, quads = bar
    m = len(quads)
    given = meshio.Mesh(
        points,
        [("quad", quads[:10]), ("line", [[0, 1]]), ("quad", quads[10:])],
        point_data={"shift": points * 2},
        cell_data={
            "gmsh:physical": [np.full(10, 4), np.array([9]), np.full(m - 10, 5)],
            "heat": [np.arange(10.0), np.array([99.0]), np.arange(10.0, m)],
        },
        field_data={"inlet": np.array([4, 2]), "edge": np.array([9, 1]), "wall": np.array([5, 2])},
    )
    mesh = hexfill.fill(given)
    assert (mesh.quad_data["heat"] == np.arange(m)).all() and (mesh.quad_tags == [4] * 10 + [5] * (m - 10)).all()
    assert mesh.tag_names[:2] == [("quads", 4, "inlet"), ("quads", 5, "wall")]
    assert (mesh.point_data["shift:1"][: len(points)] == 2 * points[:, 1]).all()
    out = mesh.to_meshio()
    assert (out.cell_data["heat"][1] == np.arange(m)).all() and np.isnan(out.cell_data["heat"][0]).all()
    assert out.point_data["shift"].shape == (len(mesh.points), 3) and (out.field_data["inlet"] == [4, 2]).all()
    out.write(tmp_path / "out.vtu")
    back = hexfill.read(tmp_path / "out.vtu")
    assert (back.quad_data["heat"] == np.arange(m)).all()
    # meshio writes no field data into a VTU; the object has them.
    assert sorted(hexfill.mesh.as_mesh(out).tag_names) == sorted(mesh.tag_names)
    surface = mesh.surface.to_meshio()
    assert (surface.cell_data["heat"][0] == np.arange(m)).all() and (surface.cell_data["tag"][0] == mesh.quad_tags).all()
    # A vector on quads beside a number on hexes of the same name.
    both = hexfill.HexMesh(
        mesh.points, mesh.hexes, quads=quads, hex_data={"v": np.ones(12)}, quad_data={f"v:{k}": np.ones(m) for k in range(3)}
    ).to_meshio()
    assert set(both.cell_data) == {"v", "v:0", "v:1", "v:2"}


def test_sets_of_meshio_come_in_and_go_out(bar):
    meshio = pytest.importorskip("meshio")
    points, quads = bar
    m = len(quads)
    given = meshio.Mesh(
        points,
        [("quad", quads[:10]), ("line", [[0, 1]]), ("quad", quads[10:])],
        cell_data={"gmsh:physical": [np.full(10, 4), np.array([9]), np.full(m - 10, 5)]},
        field_data={"inlet": np.array([4, 2]), "wall": np.array([5, 2])},
        cell_sets={
            "inlet": [np.arange(10), None, []],  # as the name of tag 4 says
            "warm": [[0, 9], [0], [0, 1]],
            "hot": [[9], [], [1]],
            "gmsh:bounding_entities": [np.array([1, -2]), np.array([]), np.array([3])],
        },
        point_sets={"corners": [0, 3], "one": [3]},
    )
    mesh = hexfill.fill(given)
    due = {"inlet": range(10), "wall": range(10, m), "warm": [0, 9, 10, 11], "hot": [9, 11]}
    for _ in range(2):
        for name, members in due.items():
            tags = [tag for kind, tag, other in mesh.tag_names if (kind, other) == ("quads", name)]
            assert np.flatnonzero(np.isin(mesh.quad_tags, tags)).tolist() == list(members), name
        assert "gmsh:bounding_entities" not in {name for _, _, name in mesh.tag_names}
        assert mesh.to_meshio().cell_sets == {} and mesh.to_meshio().point_sets == {}
        out = mesh.to_meshio(sets=True)
        assert {name: of[1].tolist() for name, of in out.cell_sets.items() if len(of[1])} == {n: list(i) for n, i in due.items()}
        assert out.cell_sets["volume"][0].tolist() == list(range(12))
        assert {name: i.tolist() for name, i in out.point_sets.items()} == {"corners": [0, 3], "one": [3]}
        # What comes back says nothing new.
        mesh = hexfill.embed(out)
    surface = hexfill.Surface(points, quads, quad_tags=np.arange(m) % 2, tag_names=[("quads", 1, "odd")]).to_meshio(sets=True)
    assert surface.cell_sets["odd"][0].tolist() == list(range(1, m, 2)) and surface.point_sets == {}


def test_quadratic_cells_are_written(bar, tmp_path):
    pyvista = pytest.importorskip("pyvista")
    mesh = hexfill.fill(bar[0], bar[1])
    mesh.write(tmp_path / "q.vtu", quadratic=True)
    grid = pyvista.read(tmp_path / "q.vtu")
    assert set(grid.celltypes) == {23, 25} and grid.extract_cells(grid.celltypes == 25).volume == pytest.approx(12)
    assert (hexfill.read(tmp_path / "q.vtu", linearise=True).hexes == mesh.hexes).all()
    with pytest.raises(hexfill.FileError, match="second order"):
        hexfill.write(tmp_path / "q.mesh", mesh, quadratic=True)
