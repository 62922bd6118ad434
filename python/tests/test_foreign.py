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
