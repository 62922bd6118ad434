"""Whatever is given: a typed exception that says what is wrong and where, or the right answer. No panic, no crash."""

import concurrent.futures
import datetime
import math

import numpy as np
import pytest
from conftest import box

import hexfill


@pytest.mark.parametrize("dtype", ["int8", "uint8", "int16", "uint16", "int32", "uint32", "int64", "uint64", ">i4", "intp"])
def test_any_integers(cube, dtype):
    points, quads = cube
    mesh = hexfill.fill(points, quads.astype(dtype))
    assert mesh.n_hexes == 1 and hexfill.check(points, mesh.hexes.astype(dtype)).certified


@pytest.mark.parametrize("dtype", ["float16", "float32", ">f8", "longdouble", "int64", "uint8"])
def test_any_reals(cube, dtype):
    points, quads = cube
    assert hexfill.fill(points.astype(dtype), quads).points.tobytes() == hexfill.fill(points, quads).points.tobytes()


def test_any_layout(bar):
    points, quads = bar
    expected = hexfill.fill(points, quads).points.tobytes()
    wide = np.zeros((2 * len(points), 7))
    wide[::2, 1:6:2] = points
    layouts = [
        (np.asfortranarray(points), np.asfortranarray(quads)),
        (wide[::2, 1:6:2], np.repeat(quads, 2, axis=0)[::2]),
        (points[::-1][::-1], quads[::-1][::-1]),
        (points.tolist(), quads.tolist()),
        (points.view(np.matrix).A, np.ma.masked_array(quads)),
    ]
    for p, q in layouts:
        before = np.array(p).copy()
        assert hexfill.fill(p, q).points.tobytes() == expected
        assert (np.array(p) == before).all()
    frozen = points.copy()
    frozen.flags.writeable = False
    assert hexfill.fill(frozen, quads).points.tobytes() == expected


WRONG_TYPES = [
    ("points", np.zeros((8, 3), complex)),
    ("points", np.full((8, 3), "x")),
    ("points", np.zeros((8, 3), bool)),
    ("points", np.full((8, 3), None)),
    ("quads", np.zeros((6, 4), float)),
    ("quads", np.zeros((6, 4), bool)),
    ("quads", [["a", "b", "c", "d"]]),
    ("quads", np.full((6, 4), None)),
    ("quads", {"a": 1}),
]


@pytest.mark.parametrize("which, value", WRONG_TYPES)
def test_wrong_types(cube, which, value):
    given = dict(zip(("points", "quads"), cube)) | {which: value}
    with pytest.raises(TypeError, match=which):
        hexfill.fill(given["points"], given["quads"])


WRONG_SHAPES = [
    ("points", np.zeros((8, 2))),
    ("points", np.zeros(24)),
    ("points", np.zeros((2, 4, 3))),
    ("points", 5.0),
    ("points", [[0, 0, 0], [1, 1]]),
    ("points", np.ma.masked_array(np.zeros((8, 3)), mask=np.eye(8, 3, dtype=bool))),
    ("quads", np.zeros((6, 3), int)),
    ("quads", np.zeros(24, int)),
    ("quads", np.zeros((6, 5), int)),
    ("quads", [[0, 1, 2, 3], [1, 2, 3]]),
    ("quads", 7),
]


@pytest.mark.parametrize("which, value", WRONG_SHAPES)
def test_wrong_shapes(cube, which, value):
    given = dict(zip(("points", "quads"), cube)) | {which: value}
    with pytest.raises(hexfill.InputError, match=which):
        hexfill.fill(given["points"], given["quads"])


@pytest.mark.parametrize("id", [8, -1, 2**31, 2**32 - 2, 2**32 - 1, 2**32, 2**40, -(2**63), 2**63 - 1])
def test_ids_out_of_range_are_named(cube, id):
    points, quads = cube
    quads = quads.copy()
    quads[4, 2] = id
    with pytest.raises(hexfill.SurfaceError) as caught:
        hexfill.fill(points, quads)
    assert caught.value.quads == [4] and str(id) in str(caught.value)
    if id < 0 or id > 2**32 - 2:
        with pytest.raises(hexfill.SurfaceError):
            hexfill.fill(None, quads)


def test_huge_ids_without_points_are_no_panic(cube):
    """Ids are sizes of tables: a few huge ones without points must not take the machine's memory for nothing."""
    _, quads = cube
    mesh = hexfill.fill(None, quads + 1000)
    assert mesh.n_hexes == 1
    with pytest.raises(hexfill.InputError):
        hexfill.fill(None, quads.astype(np.uint32) + np.uint32(2**31))


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf])
def test_points_that_are_not_finite_are_named(cube, value):
    points, quads = cube
    points[5, 1] = value
    with pytest.raises(hexfill.SurfaceError) as caught:
        hexfill.fill(points, quads)
    assert caught.value.vertices == [5] and caught.value.count == 1
    hexes = [[0, 1, 2, 3, 4, 5, 6, 7]]
    assert not hexfill.check(points, hexes).ok
    for verb in (hexfill.embed, hexfill.HexMesh(points, hexes).write):
        with pytest.raises((hexfill.InputError, TypeError)):
            verb(points, hexes) if verb is hexfill.embed else verb("nan.vtk")


def test_surfaces_that_are_none(cube):
    points, quads = cube
    cases = [
        (quads[:0], "no faces"),
        (np.vstack([quads, quads[:1]]), "same four vertices"),
        (np.vstack([quads[:5], [[0, 0, 1, 2]]]), "twice"),
        (quads[:5], "open"),
    ]
    for wrong, words in cases:
        with pytest.raises(hexfill.SurfaceError, match=words):
            hexfill.fill(points, wrong)
        with pytest.raises(hexfill.SurfaceError):
            hexfill.atlas(points, wrong)
        with pytest.raises(hexfill.SurfaceError):
            hexfill.info(points, wrong)


def test_meshes_that_are_none(cube):
    points, quads = cube
    twice = [[0, 1, 2, 3, 4, 5, 6, 6]]
    far = [[0, 1, 2, 3, 4, 5, 6, 99]]
    three = [[0, 1, 2, 3, 4, 5, 6, 7]] * 3
    for hexes in (twice, far, three):
        assert not hexfill.check(points, hexes).ok
        for verb in (hexfill.embed, hexfill.simplify, hexfill.info):
            with pytest.raises(hexfill.MeshError):
                verb(points, hexes)
        with pytest.raises(hexfill.MeshError):
            hexfill.HexMesh(points, hexes).to_html()
    with pytest.raises(hexfill.InputError, match="no hexes"):
        hexfill.check(hexfill.Surface(points, quads))
    with pytest.raises(hexfill.InputError):
        hexfill.check(points, np.empty((0, 8), int))


@pytest.mark.parametrize(
    "options",
    [
        {"threads": 0},
        {"threads": -1},
        {"threads": 10**6},
        {"threads": 2**70},
        {"seed": -1},
        {"seed": 2**64},
        {"time_limit": -1},
        {"time_limit": math.nan},
        {"strategy": "magic"},
        {"prefer": "beauty"},
        {"effort": "none"},
        {"layers": 0},
        {"layers": 2, "layer_height": 0},
        {"layers": 2, "layer_height": math.inf},
        {"layer_height": 1.0},
        {"growth": 2.0},
        {"layers": 2, "embed": False},
        {"best_of": 0},
        {"best_of": 2, "embed": False},
        {"max_hexes": -5},
    ],
)
def test_options_out_of_range(cube, options):
    with pytest.raises(hexfill.InputError):
        hexfill.fill(*cube, **options)


@pytest.mark.parametrize(
    "options", [{"threads": 1.5}, {"threads": "all"}, {"threads": True}, {"progress": 3}, {"time_limit": "soon"}, {"colour": 1}]
)
def test_options_of_wrong_type(cube, options):
    with pytest.raises(TypeError):
        hexfill.fill(*cube, **options)


@pytest.mark.parametrize("limit", [0, 1e-9, 60, 1e300, math.inf, datetime.timedelta(minutes=1), np.float32(5)])
def test_any_time_limit(cube, limit):
    assert hexfill.fill(*cube, time_limit=limit).n_hexes == 1


@pytest.mark.parametrize("given", [None, 3, object(), b"cube.obj", [1, 2], np.zeros((8, 3))])
def test_what_is_no_mesh(given):
    with pytest.raises(TypeError):
        hexfill.fill(given)


@pytest.mark.parametrize("scale", [1e-300, 1e-160, 1e-30, 1e30, 1e160, 1e300, 1.7e308])
def test_any_scale_is_no_panic(bar, scale):
    points, quads = bar
    try:
        mesh = hexfill.fill(points / 3 * scale, quads, time_limit=20)
    except hexfill.HexfillError as error:
        assert not isinstance(error, hexfill.InternalError), error
    else:
        assert hexfill.check(mesh, surface=mesh.surface).levels["L3"] == "passed"


def test_points_in_one_spot(bar):
    mesh = hexfill.fill(np.zeros_like(bar[0]), bar[1], time_limit=20)
    assert not mesh.certified and hexfill.check(mesh).levels["L3"] == "passed"


def test_many_python_threads_at_once(bar):
    surfaces = [box(1, 1, 1), bar, box(2, 2, 2), ":schneiders-pyramid"] * 4

    def work(surface):
        return hexfill.fill(surface).hexes.tobytes() if isinstance(surface, str) else hexfill.fill(*surface).hexes.tobytes()

    with concurrent.futures.ThreadPoolExecutor(8) as pool:
        together = list(pool.map(work, surfaces))
    assert together == [work(surface) for surface in surfaces[:4]] * 4


def test_a_defect_is_an_exception():
    from hexfill import _native, running

    if hasattr(_native, "panic_for_test"):
        with pytest.raises(hexfill.InternalError, match="provoked"):
            _native.panic_for_test(running.run())


def test_bad_signatures_and_names():
    for spec in (":nope", ":", "Q1:", "Q1:zzzzzzzz", "H1:", "H1:00!", "H1+:0"):
        with pytest.raises(hexfill.InputError):
            hexfill.read(spec)
    for spec in ("a\0b.vtk", "nothing"):
        with pytest.raises((hexfill.InputError, OSError, ValueError)):
            hexfill.read(spec)
    for cubes in (0, 13, -1, 10**30):
        with pytest.raises(hexfill.InputError):
            hexfill.enumerate(cubes)
    for options in ({"key": "nonsense"}, {"rule": "loose"}, {"boundary_quads": (5, 2)}, {"rule": "weill", "nonorientable": True}):
        with pytest.raises(hexfill.InputError):
            hexfill.enumerate(3, **options)
