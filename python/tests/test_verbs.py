"""Each verb once, as a user would."""

import pickle
from pathlib import Path

import numpy as np
import pytest
from conftest import box

import hexfill


def test_the_surface_stays_as_it_is(bar):
    points, quads = bar
    points = points + np.random.default_rng(1).uniform(-0.1, 0.1, points.shape)
    mesh = hexfill.fill(points, quads)
    assert mesh.hexes.shape == (12, 8) and mesh.hexes.dtype == np.int64
    assert mesh.points[: len(points)].tobytes() == points.tobytes()
    assert (mesh.quads == quads).all()
    assert mesh.certified and mesh.worst > 0.5 and mesh.report["stopped"] == "finished"
    assert "12 hexes" in repr(mesh)


def test_options_of_fill(bar):
    layered = hexfill.fill(*bar, layers=2, layer_height=0.1, growth=1.5)
    assert layered.certified and layered.n_hexes > 40
    assert hexfill.fill(*bar, strategy="construct", embed=False).certified is None
    assert hexfill.fill(*bar, effort="fast").certified and hexfill.fill(*bar, effort="best").certified
    with pytest.raises(hexfill.NoMeshFound) as caught:
        hexfill.fill(":geode", max_hexes=3, strategy="shell")
    assert caught.value.stopped == "finished"


def test_any_number_of_threads_gives_the_same_bytes():
    points, quads = box(3, 4, 2)
    points += np.random.default_rng(2).uniform(-0.2, 0.2, points.shape)
    meshes = [hexfill.fill(points, quads, threads=n, prefer="quality") for n in (1, 3, None)]
    assert len({(m.points.tobytes(), m.hexes.tobytes()) for m in meshes}) == 1


def test_no_mesh_exists(bar):
    points, quads = box(1, 1, 1)
    # A vertex in the middle of one quad of a box of ten: 12 quads; without one of them the number is odd.
    with pytest.raises(hexfill.SurfaceError) as caught:
        hexfill.fill(points, quads[1:])
    assert len(caught.value.edges) == caught.value.count == 4
    a, b, c, d = quads[0]
    new = len(points)
    inner = points[[a, b, c, d]].mean(axis=0) * 0.5 + points[[a, b, c, d]].mean(axis=0) * 0.5
    ring = inner + 0.5 * (points[[a, b, c, d]] - inner)
    split = [[a, b, new + 1, new], [b, c, new + 2, new + 1], [c, d, new + 3, new + 2], [d, a, new, new + 3]]
    split.append([new, new + 1, new + 2, new + 3])
    odd_points = np.vstack([points, ring])
    assert hexfill.fill(odd_points, np.vstack([quads[1:], split])).n_quads == 10
    # The ring with its inner square cut into three around a point: 12 + ... one quad more than an even number.
    corner = len(odd_points)
    three = [[new, new + 1, new + 2, corner], [new + 2, new + 3, new, corner]]
    odd = np.vstack([quads[1:], split[:-1], three])
    with pytest.raises(hexfill.NoMeshExists):
        hexfill.fill(np.vstack([odd_points, inner]), odd)


def test_check(cube):
    points, quads = cube
    mesh = hexfill.fill(points, quads)
    verdict = hexfill.check(mesh, surface=hexfill.Surface(points, quads))
    assert verdict.ok and verdict.certified and set(verdict.levels.values()) == {"passed"}
    assert verdict.hex_data["volume"] == pytest.approx([1.0])
    inside_out = hexfill.check(points, mesh.hexes[:, [4, 5, 6, 7, 0, 1, 2, 3]])
    assert not inside_out.ok and inside_out.failures[0]["level"] == "L5" and "L5" in str(inside_out)
    moved = points.copy()
    moved[0, 0] -= 1e-9
    assert hexfill.check(mesh, surface=hexfill.Surface(moved, quads)).levels["L4"] == "failed"
    assert hexfill.check(None, mesh.hexes).levels["L4"] == "not-judged"


def test_embed_and_simplify():
    mesh = hexfill.fill(":schneiders-pyramid")
    shaken = mesh.points.copy()
    shaken[mesh.surface.quads.max() + 1 :] *= 1.05
    again = hexfill.embed(shaken, mesh.hexes, seed=3)
    assert again.certified and again.worst == pytest.approx(mesh.worst, abs=1e-3)
    large = hexfill.fill(":cube", strategy="construct", time_limit=60)
    small = large.simplify(collapse_only="all")
    assert small.n_hexes < large.n_hexes and small.report["hexes_before"] == large.n_hexes
    assert hexfill.check(small, surface=large.surface).levels["L3"] == "passed"


def test_info_atlas_catalog_enumerate():
    assert hexfill.info(":schneiders-pyramid")["hex_mesh"] == "exists"
    entries = hexfill.catalog()
    pyramid = entries[":schneiders-pyramid"]
    assert pyramid.mesh().n_hexes == pyramid.mesh_hexes == 36
    assert hexfill.info(pyramid.surface())["signature"] == pyramid.signature
    assert [f["hexes"] for f in hexfill.atlas(pyramid.signature)] == [36]
    assert entries[":cube"].mesh() is None
    five = hexfill.enumerate(5)
    assert (five.counts["classes"], five.counts["balls"], len(five)) == (240, 60, 240)
    assert len(hexfill.enumerate(4, balls=True, boundary_quads=16)) < len(hexfill.enumerate(4))
    assert all(mesh.n_hexes == 3 for mesh in hexfill.enumerate(3, rule="weill", threads=2).meshes())


def test_files(tmp_path, bar):
    mesh = hexfill.fill(hexfill.Surface(*bar, quad_tags=np.arange(len(bar[1]), dtype=np.uint8)))
    for name in ("bar.vtk", "bar.vtu.gz", "bar.mesh", "bar.json"):
        path = tmp_path / name
        mesh.write(path)
        back = hexfill.read(path)
        assert back.points.tobytes() == mesh.points.tobytes() and (back.hexes == mesh.hexes).all(), name
        assert (back.quad_tags == mesh.quad_tags).all(), name
    assert isinstance(hexfill.read(":cube"), hexfill.Surface)
    with pytest.raises(hexfill.FileError, match="cannot hold"):
        mesh.write(tmp_path / "bar.obj")
    with pytest.warns(UserWarning, match="does not carry tags of quads"):
        mesh.surface.write(tmp_path / "bar.surface", format="off")
    (tmp_path / "bad.off").write_text("OFF\n4 1 0\n0 0 zero\n")
    with pytest.raises(hexfill.FileError) as caught:
        hexfill.read(tmp_path / "bad.off")
    assert caught.value.line == 3 and caught.value.path.endswith("bad.off")
    with pytest.raises(FileNotFoundError):
        hexfill.read(tmp_path / "nothing.vtk")
    with pytest.raises(IsADirectoryError):
        hexfill.read(tmp_path, format="vtk")
    with pytest.raises(OSError):
        mesh.write(tmp_path / "no" / "such" / "folder.vtk")


def test_view(tmp_path, cube):
    mesh = hexfill.fill(*cube)
    hexfill.view(mesh, tmp_path / "cube.html", title="a <cube> & more")
    assert (tmp_path / "cube.html").read_text(encoding="utf-8").rstrip().endswith("</html>")
    mesh.view(tmp_path / "cube.png")
    assert (tmp_path / "cube.png").read_bytes().startswith(b"\x89PNG")
    shown = mesh._repr_html_()
    assert shown.startswith("<iframe") and "srcdoc=" in shown and shown.count('"') == 6
    with pytest.raises(hexfill.FileError):
        mesh.view(tmp_path / "cube.gif")
    with pytest.raises(hexfill.InputError, match="coordinates"):
        hexfill.HexMesh(None, mesh.hexes).to_html()


def test_a_mesh_stays_as_it_was_judged(cube):
    mesh = hexfill.fill(*cube)
    for array in (mesh.points, mesh.hexes, mesh.quads, mesh.hex_data["scaled_jacobian"]):
        with pytest.raises(ValueError):
            array[0] = 0
    back = pickle.loads(pickle.dumps(mesh))
    assert back.points.tobytes() == mesh.points.tobytes() and back.report == mesh.report and back.certified


def test_doctor_says_all_and_mend_mends():
    corpus = Path(__file__).parents[2] / "corpus" / "sick"
    sick = hexfill.doctor(corpus / "mixed_box.obj")
    assert [f["kind"] for f in sick["findings"]] == ["triangles"]
    assert not sick["can_be_filled"]
    surface, done = hexfill.mend(corpus / "mixed_box.obj")
    assert done == ["5 pairs of triangles merged"]
    assert hexfill.doctor(surface)["can_be_filled"]
    assert hexfill.fill(surface).n_hexes == 8
    fine, _ = hexfill.mend(corpus / "odd_ball.obj", refine=True)
    assert fine.n_quads == 4 * 97
    assert hexfill.doctor(corpus / "open_box.obj")["findings"][0]["kind"] == "open-edges"
