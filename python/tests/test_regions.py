"""Several regions, what files carry, what made each hex, and texts that name arguments of Python."""

import re

import numpy as np
import pytest
from conftest import REPOSITORY, box

import hexfill

THREE = REPOSITORY / "corpus" / "surfaces" / "three_regions.obj"


def two_cubes():
    """12 points and 11 quads: two cubes with a wall between them."""
    points = np.array([(v % 3, v // 3 % 2, v // 6) for v in range(12)], float)
    quads = [[0, 3, 9, 6], [1, 4, 10, 7], [2, 5, 11, 8]]
    for a in (0, 1):
        b = a + 1
        quads += [[a, b, b + 3, a + 3], [a + 6, b + 6, b + 9, a + 9], [a, b, b + 6, a + 6], [a + 3, b + 3, b + 9, a + 9]]
    return points, np.array(quads)


def test_regions_with_shared_walls_are_filled_and_tagged():
    mesh = hexfill.fill(THREE)
    assert mesh.certified and mesh.n_hexes == 24
    assert sorted(np.unique(mesh.hex_tags, return_counts=True)[1]) == [8, 8, 8]
    assert [region["hexes"] for region in mesh.report["regions"]] == [8, 8, 8]
    found = hexfill.regions(THREE)
    assert [region.surface.n_quads for region in found] == [region["quads"] for region in mesh.report["regions"]]
    for region in found:
        assert (region.surface.points == mesh.points[region.points]).all()
    assert [r.surface.n_quads for r in hexfill.regions(*box(2, 2, 2))] == [24]
    with pytest.raises(hexfill.InputError, match="3 regions; best_of is for one surface"):
        hexfill.fill(THREE, best_of=3)


def test_a_void_among_hexes_is_filled():
    whole = hexfill.fill(*box(4, 4, 4))
    centres = whole.points[whole.hexes].mean(axis=1)
    shell = ((centres < 1) | (centres > 3)).any(axis=1)
    holed = hexfill.HexMesh(whole.points, whole.hexes[shell], quads=whole.quads)
    assert holed.n_hexes == 56
    again = hexfill.fill(holed)
    assert again.n_hexes == 64 and again.certified and (again.hexes[:56] == holed.hexes).all()
    assert list(np.unique(again.engines[:56])) == ["given"] and (again.hex_data["layer"][:56] == 0).all()


def test_tags_their_names_and_data_are_carried():
    points, quads = two_cubes()
    tags = np.where(np.arange(11) < 3, np.arange(11), 7)
    surface = hexfill.Surface(
        points,
        quads,
        quad_tags=tags,
        quad_data={"pressure": np.arange(11.0)},
        point_data={"height": points[:, 2]},
        tag_names=[("quads", 7, "wall"), ("quads", 1, "between")],
    )
    mesh = hexfill.fill(surface)
    assert list(mesh.hex_tags) == [1, 2] and (mesh.quad_tags == tags).all()
    assert (mesh.quad_data["pressure"] == np.arange(11)).all() and (mesh.point_data["height"] == points[:, 2]).all()
    assert ("quads", 7, "wall") in mesh.tag_names and ("quads", 1, "between") in mesh.tag_names
    assert mesh.surface.tag_names[0] == ("quads", 1, "between")
    with pytest.raises(hexfill.InputError, match="'faces' is not"):
        hexfill.Surface(points, quads, tag_names=[("faces", 1, "x")])
    with pytest.raises(hexfill.InputError, match=r"quad_data\['p'\] must have shape \(11,\)"):
        hexfill.Surface(points, quads, quad_data={"p": [1.0]})


def test_walls_that_end_are_named():
    points, quads = two_cubes()
    with pytest.raises(hexfill.SurfaceError, match="walls end") as caught:
        hexfill.fill(points, quads[1:])
    assert caught.value.count == len(caught.value.edges) == 4


@pytest.mark.parametrize("options", [{}, {"layers": 2}, {"strategy": "construct", "embed": False}, {"strategy": "shell"}])
def test_what_made_each_hex_and_its_layer(options):
    mesh = hexfill.fill(":schneiders-pyramid" if "strategy" not in options else ":cube", **options)
    names, counts = np.unique(mesh.engines, return_counts=True)
    assert dict(zip(names, counts, strict=True)) == dict(mesh.report["stages"])
    layers = mesh.hex_data["layer"]
    assert layers.min() == 1
    if "layers" in options:
        assert ((mesh.engines == "boundary layers") == (layers <= 2)).all()
    assert hexfill.HexMesh(mesh.points, mesh.hexes).engines is None


def seams():
    """A box whose quads share no points."""
    points, quads = box(2, 2, 2)
    return points[quads].reshape(-1, 3), np.arange(4 * len(quads)).reshape(-1, 4)


def test_seams_are_welded():
    points, quads = seams()
    with pytest.raises(hexfill.SurfaceError, match=r"\(weld=0(\.0)?\)"):
        hexfill.fill(points, quads)
    mesh = hexfill.fill(points, quads, weld=0)
    assert mesh.n_hexes == 8 and len(mesh.points) == 27
    with pytest.raises(hexfill.InputError, match="weld=5"):
        hexfill.fill(points, quads, weld=5)
    with pytest.raises(hexfill.InputError, match="weld=-1"):
        hexfill.fill(points, quads, weld=-1)


def test_curved_cells_are_straightened(tmp_path):
    points, quads = box(1, 1, 1)
    middles = {}
    rows = []
    for quad in quads:
        row = list(quad)
        for a, b in zip(quad, np.roll(quad, -1), strict=True):
            middles.setdefault((min(a, b), max(a, b)), len(points) + len(middles))
            row.append(middles[min(a, b), max(a, b)])
        rows.append(row)
    between = [points[list(edge)].mean(axis=0) for edge in middles]
    lines = ["*NODE", *(f"{i + 1}, {x}, {y}, {z}" for i, (x, y, z) in enumerate([*points, *between]))]
    lines += ["*ELEMENT, TYPE=S8", *(", ".join(str(v + 1) for v in [i, *row]) for i, row in enumerate(rows))]
    (tmp_path / "curved.inp").write_text("\n".join(lines))
    with pytest.raises(hexfill.InputError, match="linearise=True"):
        hexfill.fill(tmp_path / "curved.inp")
    assert hexfill.fill(tmp_path / "curved.inp", linearise=True).n_hexes == 1
    assert len(hexfill.read(tmp_path / "curved.inp", linearise=True).points) == 8


FLAG = re.compile(r"--[a-z]|`hexfill ")


def test_no_text_names_a_flag():
    seen = 0
    for path in sorted((REPOSITORY / "corpus" / "sick").iterdir()):
        try:
            surface = hexfill.read(path)
        except (hexfill.InputError, OSError) as error:
            assert not FLAG.search(str(error)), error
            continue
        findings = str(hexfill.doctor(surface)) + str(hexfill.mend(surface)[1])
        assert not FLAG.search(findings), FLAG.search(findings)
        seen += 1
        try:
            mesh = hexfill.fill(surface, effort="fast", time_limit=1)
        except (hexfill.HexfillError, ValueError) as error:
            assert not FLAG.search(str(error)), error
        else:
            assert not FLAG.search(str(mesh.report)), mesh.report
    assert seen > 3
    # Whatever text of the libraries has a flag, the compiled half knows what Python calls it.
    known = (REPOSITORY / "python" / "src" / "words.rs").read_text()
    for source in (REPOSITORY / "crates").glob("hexfill*/src/**/*.rs"):
        room = source.relative_to(REPOSITORY / "crates").parts[0]
        if room in ("hexfill-cli", "hexfill-mpi") or source.name.endswith("tests.rs"):
            continue
        code = source.read_text().split("#[cfg(test)]")[0]
        code = "\n".join(line for line in code.splitlines() if not line.lstrip().startswith("//"))
        for flag in re.findall(r"(?<![\w-])--[a-z][a-z-]+", code):
            assert flag in known, f"{source}: {flag}"
