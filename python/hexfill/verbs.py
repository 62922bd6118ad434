"""What hexfill does. Lengths are in the unit of the points; ids are 0-based.

Keywords that the long verbs share:

``threads``
    How many to use, 1 to 1024; None: one a core. Results do not depend on it.
``time_limit``
    Seconds (or a timedelta) after which the best so far is returned, ``mesh.report["stopped"]`` being ``"time-limit"``; None: none.
``seed``
    Where every pseudo-random choice starts; 0 to 2**64 - 1.
``progress``
    A function that is called, from the calling thread and at most twenty times a second, with a dictionary of the latest ``stage``,
    ``done``, ``total`` (or None) and ``message``. If it returns ``False`` the work stops and the best so far is returned; if it
    raises, the work stops and the exception goes on. ``True``: a bar if tqdm is installed, else a line every few seconds.

Python's lock is released during the work. Ctrl-C stops it and raises :class:`~hexfill.Cancelled`, a KeyboardInterrupt whose ``mesh`` is
the best so far; a second one leaves at once.
"""

from __future__ import annotations

import builtins
import json
import warnings
from collections.abc import Mapping
from os import PathLike, fspath
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

import numpy as np

from . import _given, _native, arrays
from .errors import Cancelled, FileError, InputError
from .mesh import HexMesh, MeshLike, Surface, SurfaceLike, as_mesh, as_surface, loaded, made
from .running import Progress, Time, run

if TYPE_CHECKING:
    from numpy.typing import ArrayLike, NDArray


def _finished(outcome: tuple[_native.Data, str, bool], name: str) -> HexMesh:
    data, report, interrupted = outcome
    mesh = made(data, name, report)
    assert isinstance(mesh, HexMesh)
    if interrupted:
        raise Cancelled("stopped by Ctrl-C; the best mesh so far is in .mesh of this exception", mesh) from None
    return mesh


def fill(
    surface: SurfaceLike,
    quads: ArrayLike | None = None,
    *,
    strategy: Literal["auto", "shell", "atlas", "construct"] = "auto",
    prefer: Literal["balance", "hexes", "quality"] = "balance",
    effort: Literal["fast", "normal", "best"] = "normal",
    layers: int | None = None,
    layer_height: float | None = None,
    growth: float = 1.0,
    max_hexes: int | None = None,
    best_of: int = 1,
    embed: bool = True,
    embed_limit: Time = None,
    simplify: bool = False,
    weld: float | None = None,
    linearise: bool = False,
    threads: int | None = None,
    time_limit: Time = None,
    seed: int = 0,
    progress: Progress = None,
) -> HexMesh:
    """Fills a closed surface of quads with hexahedra and leaves the surface exactly as it is.

    Parameters
    ----------
    surface : Surface, path, name, PyVista or meshio mesh, or (n, 3) points
        What to fill; with ``quads``, its points (None: connectivity alone).
    quads : (m, 4) integers, optional
        The quads, if ``surface`` is an array of points.
    strategy : "auto", "shell", "atlas", "construct"
        "auto" asks all engines and keeps the best mesh; the others are the engines.
    prefer : "balance", "hexes", "quality"
        Among certified meshes of a worst scaled Jacobian of at least 0.2: fewest hexes by the cube of the worst scaled Jacobian,
        fewest hexes, or the largest worst scaled Jacobian.
    effort : "fast", "normal", "best"
        The first certified mesh; until one is good; or more candidates though one is good already, many times the time.
    layers : int, optional
        So many layers of hexes, 1 to 1000, under the whole surface: boundary layers for flow.
    layer_height : float, optional
        Height of the first of them, in the unit of the points; None: all layers of one place are equally high.
    growth : float
        Each layer is so many times as high as the one before; needs ``layer_height``.
    max_hexes : int, optional
        Accept only meshes of at most so many.
    best_of : int
        Look for so many meshes that are not isomorphic, 1 to 10000, and keep the one with the largest worst scaled Jacobian.
    embed : bool
        Move the interior vertices until every hex is proved valid. False: start positions only, and nothing is said of them.
    embed_limit : float, optional
        Seconds that the embedding of one mesh may take (of all, with ``best_of``); None: as long as its bounded work takes.
    simplify : bool
        Make a constructed mesh smaller (see :func:`simplify`); harder to embed then.
    weld : float, optional
        First merge points that are at most so far apart (0: at the same place), as exporters leave them at seams.
    linearise : bool
        Take cells of higher order (quad8, hex20, ...) of a file as their corners.
    threads, time_limit, seed, progress
        See :mod:`hexfill.verbs`.

    Returns
    -------
    HexMesh
        The first n of ``points`` are those given, bit for bit; ``quads`` are those given, in order (turned outward where they were
        not). Its connectivity was judged. ``mesh.certified`` says whether det J > 0 was proved everywhere in every hex:
        where it is False, ``mesh.hex_data["certified_positive"]`` flags the hexes. ``mesh.report`` says how it was made.
        Tags of quads and points, their names and data are carried over.

        Walls between several regions, and voids among hexes of a mesh, are filled region by region (:func:`regions`): the mesh is the whole,
        ``mesh.hex_tags`` has the number of the region, from 1 (where there are several), and ``mesh.report["regions"]`` says how each was made.

    Raises
    ------
    SurfaceError
        The faces are no closed quad surface; with the ids.
    NoMeshExists
        None exists: an odd number of quads, quads that share too much, or an odd cycle that bounds inside.
    NoMeshFound
        None was found within the bounds given.
    InputError, TypeError
        Other arguments that cannot be used.
    """
    given = _prepared(as_surface(surface, quads), weld, linearise)
    how = run(threads, time_limit, seed, progress)
    if layers is not None and (best_of != 1 or not embed):
        raise InputError("layers are cut into one mesh with positions: leave out best_of and embed=False")
    if layer_height is not None and layers is None:
        raise InputError("layer_height needs layers")
    if growth != 1.0 and layer_height is None:
        raise InputError("growth needs layer_height")
    if best_of != 1 and not embed:
        raise InputError("best_of compares positions: leave out embed=False")
    options: _given.Filling = {
        "strategy": strategy,
        "prefer": prefer,
        "effort": effort,
        "layers": None if layers is None else arrays.whole(layers, "layers", 1, 1000),
        "layer_height": None if layer_height is None else arrays.real(layer_height, "layer_height"),
        "growth": arrays.real(growth, "growth"),
        "max_hexes": None if max_hexes is None else arrays.whole(max_hexes, "max_hexes", 0, 2**32 - 1),
        "best_of": arrays.whole(best_of, "best_of", 1, 10_000),
        "embed": bool(embed),
        "embed_limit": None if embed_limit is None else arrays.real(embed_limit, "embed_limit", zero=True),
        "simplify": bool(simplify),
    }
    return _finished(_native.fill(given._data, given.name, options, how["time_limit"], how), given.name)


class Region(NamedTuple):
    """One of several solids that share walls, or a void among hexes."""

    #: Its boundary, outward from it.
    surface: Surface
    #: Per point of it, the point of the whole.
    points: NDArray[np.int64]


def regions(surface: SurfaceLike, quads: ArrayLike | None = None) -> list[Region]:
    """The regions that quads bound and no hexes fill, in the order of their first quad: one for a plain closed surface, several where walls are shared (an edge
    is in three quads or more), the voids of a mesh with hexes. What :func:`fill` fills one by one. Quads keep their tags."""
    given = as_surface(surface, quads)
    found = _native.regions(given._data, given.name, run())
    parts = [(made(data, f"region {i} of {given.name}"), np.frombuffer(ids, np.int64)) for i, (data, ids) in builtins.enumerate(found, 1)]
    return [Region(part, ids) for part, ids in parts if isinstance(part, Surface)]


def _prepared(given: Surface | HexMesh, weld: float | None, linearise: bool) -> Surface | HexMesh:
    """With seams welded and cells straight, if that is asked for."""
    if weld is None and not linearise:
        return given
    tolerance = None if weld is None else arrays.real(weld, "weld", zero=True)
    return made(_native.prepared(given._data, given.name, tolerance, bool(linearise), run()), given.name)


class Verdict:
    """What the judge says of a mesh; printed, it is the report of ``hexfill check``."""

    def __init__(
        self, report: Mapping[str, Any], text: str, certified: bool, numbers: Mapping[str, bytes] | None
    ) -> None:
        #: The report as a dictionary: ``levels``, ``failures`` with the first offenders, ``facts``, ``geometry``.
        self.report = dict(report)
        #: Whether all five levels passed: the mesh is proper, fills the surface, and det J > 0 everywhere in every hex.
        self.certified = certified
        #: Numbers (k,) a hex: ``certified`` (0 or 1), ``scaled_jacobian`` (certified bound), ``corner_scaled_jacobian``,
        #: ``verdict_scaled_jacobian``, ``condition``, ``edge_ratio``, ``volume`` (unit of the points cubed). Empty without positions.
        self.hex_data: dict[str, NDArray[np.float64]] = {
            name: np.frombuffer(raw, np.float64) for name, raw in (numbers or {}).items()
        }
        self._text = text

    @property
    def ok(self) -> bool:
        """Whether no rule is broken (levels that could not be judged break none)."""
        return not self.failures

    @property
    def levels(self) -> dict[str, str]:
        """``"L1"`` to ``"L5"``: ``"passed"``, ``"failed"`` or ``"not-judged"``."""
        return {level["level"]: level["outcome"] for level in self.report["levels"]}

    @property
    def failures(self) -> list[dict[str, Any]]:
        """The rules that are broken: ``rule``, ``level``, ``count``, and the ``first`` ten offenders with their ids."""
        return self.report["failures"]

    def __str__(self) -> str:
        return self._text.rstrip()

    def __repr__(self) -> str:
        return f"<hexfill.Verdict: {', '.join(f'{level} {outcome}' for level, outcome in self.levels.items())}>"


def check(
    mesh: MeshLike,
    hexes: ArrayLike | None = None,
    *,
    surface: SurfaceLike = None,
    rules: Literal["strict", "weill"] = "strict",
    overlap: bool = False,
    threads: int | None = None,
    time_limit: Time = None,
    progress: Progress = None,
) -> Verdict:
    """Judges a hex mesh: L1 indices and hex shape, L2 proper intersection, L3 manifold and boundary = surface, L4 positions finite and
    bit-identical on the surface, L5 det J > 0 certified everywhere in every hex.

    Parameters
    ----------
    mesh : HexMesh, path, PyVista or meshio mesh, or (n, 3) points
    hexes : (k, 8) integers, optional
        If ``mesh`` is an array of points.
    surface : anything that :func:`fill` takes (points and quads as a Surface), optional
        The surface that it must fill; None: its own boundary.
    rules : "strict", "weill"
        Which definition of a legal complex to judge by.
    overlap : bool
        Also test that the boundary does not touch or cross itself.
    threads, time_limit, progress
        See :mod:`hexfill.verbs`.
    """
    judged = as_mesh(mesh, hexes)
    against = None if surface is None else as_surface(surface)._data
    how = run(threads, time_limit, 0, progress)
    report, text, certified, numbers = _native.check(judged._data, against, rules, bool(overlap), how)
    return Verdict(json.loads(report), text, certified, numbers)


def embed(
    mesh: MeshLike,
    hexes: ArrayLike | None = None,
    *,
    objective: Literal["sj", "balanced", "untangle"] = "sj",
    starts: int = 0,
    fresh: bool = False,
    symmetric: bool = False,
    threads: int | None = None,
    time_limit: Time = None,
    seed: int = 0,
    progress: Progress = None,
) -> HexMesh:
    """Moves the interior vertices of a mesh until every hex is valid and good; boundary vertices keep their bits.

    Parameters
    ----------
    mesh : HexMesh, path, PyVista or meshio mesh, or (n, 3) points
    hexes : (k, 8) integers, optional
        If ``mesh`` is an array of points.
    objective : "sj", "balanced", "untangle"
        The largest worst scaled Jacobian; the smallest condition number with 95 % of it; or valid hexes, no more.
    starts : int
        Starts at most; 0 chooses by size.
    fresh : bool
        Do not begin with the interior positions that are there.
    symmetric : bool
        Keep the symmetries of the boundary that the mesh has, too.
    threads, time_limit, seed, progress
        See :mod:`hexfill.verbs`.

    Returns
    -------
    HexMesh
        With ``certified`` and ``hex_data`` judged anew; ``report["geometry"]`` has the details.
    """
    given = as_mesh(mesh, hexes)
    how = run(threads, time_limit, seed, progress)
    n_starts = arrays.whole(starts, "starts", 0, 1_000_000)
    outcome = _native.embed(given._data, objective, n_starts, bool(fresh), bool(symmetric), how)
    return _finished(outcome, given.name)


def simplify(
    mesh: MeshLike,
    hexes: ArrayLike | None = None,
    *,
    balls: int | None = None,
    collapse_only: Literal["all", "inside"] | None = None,
    heat: int | None = None,
    threads: int | None = None,
    time_limit: Time = None,
    seed: int = 0,
    progress: Progress = None,
) -> HexMesh:
    """A mesh with fewer hexes and the same boundary, positions of it bit for bit. :func:`embed` it afterwards: new interior vertices lie
    at means of their neighbours.

    Parameters
    ----------
    mesh : HexMesh, path, PyVista or meshio mesh, or (n, 3) points
    hexes : (k, 8) integers, optional
        If ``mesh`` is an array of points.
    balls : int, optional
        How many balls of hexes to try; None: ten for each hex, at least 20,000, or with ``time_limit`` as many as it allows.
    collapse_only : "all", "inside", optional
        Only collapse closed sheets and columns, without balls; "inside": none with a hex at the boundary.
    heat : int, optional
        The chance, in thousandths, of taking one more hex to leave a local minimum, 0 to 999; None: 970.
    threads, time_limit, seed, progress
        See :mod:`hexfill.verbs`.

    Returns
    -------
    HexMesh
        Judged; the mesh as it was if nothing smaller was found. Points that no hex uses any more are gone, so ids change.
    """
    given = as_mesh(mesh, hexes)
    how = run(threads, time_limit, seed, progress)
    n_balls = None if balls is None else arrays.whole(balls, "balls", 0, 2**63)
    warmth = None if heat is None else arrays.whole(heat, "heat", 0, 999)
    outcome = _native.simplify(given._data, n_balls, collapse_only, warmth, how["time_limit"], how)
    return _finished(outcome, given.name)


def info(mesh: SurfaceLike, cells: ArrayLike | None = None) -> dict[str, Any]:
    """What a surface or a mesh is, as a dictionary: ``kind``, sizes, ``genus``, ``chords`` or ``sheets``, ``key``, canonical
    ``signature``, and for surfaces ``hex_mesh`` (``"exists"``, ``"none"``, ``"unknown"``) with ``because``, and ``limits``: what its
    positions allow any mesh to reach, with the vertices, edges and corners in the way.

    ``mesh`` is whatever :func:`fill` and :func:`check` take; ``cells`` (m, 4) are quads, (k, 8) hexes, if ``mesh`` is an array of points.
    """
    return loaded(mesh, cells, None).info()


def doctor(surface: SurfaceLike, quads: ArrayLike | None = None) -> dict[str, Any]:
    """Everything that is wrong with a surface, at once, as a dictionary: ``findings`` with ``kind``, ``severity`` (``"remark"``, ``"poor"``, ``"fatal"``),
    the ``first`` ten places, ``text`` and ``remedy``; the smallest ``parity_changes`` where the number of quads is odd; ``existence``; ``limits``; and
    ``can_be_filled``: whether :func:`fill` takes it as it is. Whatever the surface, it raises nothing for it.
    """
    given = as_surface(surface, quads)
    return json.loads(_native.doctor(given._data, given.name, run()))


def mend(surface: SurfaceLike, quads: ArrayLike | None = None, *, refine: bool = False) -> tuple[Surface, list[str]]:
    """The surface after the smallest changes, and what they were: seams that only rounding keeps open are welded, faces that are flat or come twice go, triangles
    are merged in pairs, an odd number of quads becomes even, quads are turned outward. With ``refine`` every face of n sides is cut into n quads.

    Points keep their order, new ones follow; faces keep the tags of those they come from. What needs you stays: ask :func:`doctor` again.
    """
    given = as_surface(surface, quads)
    data, done = _native.mend(given._data, given.name, bool(refine), run())
    mended = made(data, given.name)
    assert isinstance(mended, Surface)
    return mended, done


def atlas(surface: SurfaceLike, quads: ArrayLike | None = None) -> list[dict[str, int]]:
    """What the atlas of smallest known fillings has for a sphere of at most 24 quads: ``hexes``, ``interior_vertices`` and
    ``blocked_pairs`` of each; an empty list proves nothing. Positions do not matter."""
    given = as_surface(surface, quads)
    return json.loads(_native.atlas(given._data, given.name, run()))


class CatalogEntry:
    """A named problem."""

    def __init__(self, entry: Mapping[str, Any]) -> None:
        #: Its name, with the colon: accepted wherever a surface is.
        self.name: str = entry["name"]
        #: What it is.
        self.title: str = entry["title"]
        #: Where it comes from.
        self.source: str = entry["source"]
        #: Fewest hexes of any mesh known for it, and who found it.
        self.best: str = entry["best"]
        #: Quads of the surface.
        self.n_quads: int = entry["quads"]
        #: Hexes of the mesh that is shipped; None if none is.
        self.mesh_hexes: int | None = entry["mesh_hexes"]
        #: Canonical signature of the surface.
        self.signature: str = entry["signature"]

    def surface(self) -> Surface:
        """The surface."""
        found = loaded(self.name, None, None)
        assert isinstance(found, Surface)
        return found

    def mesh(self) -> HexMesh | None:
        """The smallest mesh known, over the vertices of the surface (interior ones follow), connectivity only; None if none is shipped."""
        data = _native.catalog_mesh(self.name.removeprefix(":"), run())
        return None if data is None else made(data, self.name)  # type: ignore[return-value]

    def __repr__(self) -> str:
        return f"<hexfill.CatalogEntry {self.name}: {self.n_quads} quads, {self.best}>"


def catalog() -> dict[str, CatalogEntry]:
    """The named problems by their names (with the colon), in order of size."""
    return {entry["name"]: CatalogEntry(entry) for entry in json.loads(_native.catalog(run()))}


class Enumeration:
    """The hex meshes of n cubes, one of each isomorphism class (mirror images are the same)."""

    def __init__(self, cubes: int, report: Mapping[str, Any], signatures: list[str]) -> None:
        #: Number of cubes.
        self.cubes = cubes
        #: Signatures of the meshes that were listed: :func:`hexfill.read` makes meshes of them.
        self.signatures = signatures
        #: Counts of every level that was enumerated, as ``hexfill enumerate --json`` prints them.
        self.levels: list[dict[str, Any]] = report["levels"]

    @property
    def counts(self) -> dict[str, Any]:
        """Counts of all classes of ``cubes`` cubes, selected or not: ``classes``, ``balls``, ``chiral``, ``selected``, histograms."""
        return self.levels[-1]["counts"]

    def meshes(self) -> list[HexMesh]:
        """The meshes that were listed, connectivity only."""
        return [loaded(signature, None, None) for signature in self.signatures]  # type: ignore[misc]

    def __len__(self) -> int:
        return len(self.signatures)

    def __repr__(self) -> str:
        classes, balls = self.counts["classes"], self.counts["balls"]
        return f"<hexfill.Enumeration of {self.cubes} cubes: {classes} classes, {balls} balls, {len(self)} listed>"


def enumerate(
    cubes: int,
    *,
    rule: Literal["strict", "weill"] = "strict",
    nonorientable: bool = False,
    balls: bool = False,
    boundary_quads: tuple[int, int] | int | None = None,
    max_chords: int | None = None,
    filter_from: int = 8,
    key: str | None = None,
    list: bool = True,
    threads: int | None = None,
    time_limit: Time = None,
    progress: Progress = None,
) -> Enumeration:
    """Every hex mesh of so many cubes, without isomorphic copies.

    Parameters
    ----------
    cubes : int
        1 to 12; 7 takes a second or two, each more about twenty times as long.
    rule : "strict", "weill"
        Proper intersection, or the rule of the BruteBuilder's published table.
    nonorientable : bool
        Also glue so that the mesh becomes non-orientable (rule "strict").
    balls : bool
        List only balls.
    boundary_quads : (least, most) or int, optional
        List only meshes with so many boundary quads.
    max_chords : int, optional
        From ``filter_from`` cubes on, extend only meshes with at most so many chords, and list only those.
    key : str, optional
        List only meshes whose boundary has this key.
    list : bool
        False: count only.
    threads, time_limit, progress
        See :mod:`hexfill.verbs`. Counts that are not complete are of no use: stopped, it raises NoMeshFound.
    """
    span = (boundary_quads, boundary_quads) if isinstance(boundary_quads, int) else boundary_quads
    if span is not None and (len(span) != 2 or span[0] > span[1]):
        raise InputError(f"boundary_quads={boundary_quads!r}: give (least, most)")
    what: _given.Enumeration = {
        "cubes": arrays.whole(cubes, "cubes", 1, 12),
        "rule": rule,
        "nonorientable": bool(nonorientable),
        "max_chords": None if max_chords is None else arrays.whole(max_chords, "max_chords", 0, 255),
        "filter_from": arrays.whole(filter_from, "filter_from", 1, 12),
        "boundary_quads": None
        if span is None
        else (arrays.whole(span[0], "boundary_quads", 0, 10**6), arrays.whole(span[1], "boundary_quads", 0, 10**6)),
        "balls": bool(balls),
        "key": key,
        "list": bool(list),
    }
    report, signatures = _native.enumerate(what, run(threads, time_limit, 0, progress))
    return Enumeration(cubes, json.loads(report), signatures)


def read(
    path: str | PathLike[str], *, format: str | None = None, weld: float | None = None, linearise: bool = False
) -> Surface | HexMesh:
    """Reads a file: a :class:`HexMesh` if it holds hexes, else a :class:`Surface`.

    OBJ, OFF, PLY, VTK, VTU, VTP, MEDIT, Gmsh MSH, Abaqus INP, Nastran BDF, I-DEAS UNV, OVM and JSON, each also ``.gz`` or ``.zst``; ``format`` names one if the
    extension does not. A catalogue name (``":schneiders-pyramid"``) and a signature are taken, too. ``weld`` and ``linearise`` as for :func:`fill`.
    """
    name = _text(path)
    return _prepared(made(_native.load(name, format, run()), name), weld, linearise)


def write(
    path: str | PathLike[str], mesh: SurfaceLike, *, format: str | None = None, quadratic: bool = False
) -> None:
    """Writes a surface or a mesh, whole or not at all; the extension, or ``format``, decides how. Numbers read back bit for bit.

    ``quadratic``: as cells of second order on straight edges, 20-node hexes and 8-node quads (VTK, VTU, Gmsh, Abaqus, Nastran, universal);
    the nodes of edges come after all points.

    What the format does not carry (tags, data) is named in a warning; what it cannot hold (hexes in OBJ) is a :class:`FileError`.
    """
    written(path, loaded(mesh, None, None), format, quadratic, stacklevel=3)


def written(
    path: str | PathLike[str], mesh: Surface | HexMesh, format: str | None, quadratic: bool, stacklevel: int
) -> None:
    """:func:`write`; the warnings belong to the caller so many levels up."""
    for loss in _native.write(mesh._data, _text(path), format, bool(quadratic), run()):
        warnings.warn(loss, stacklevel=stacklevel)


def _text(path: str | PathLike[str]) -> str:
    name = fspath(path)
    if not isinstance(name, str):
        raise TypeError("give the path as text, not as bytes")
    return name


def view(mesh: MeshLike, path: str | PathLike[str], *, title: str | None = None) -> None:
    """Writes the viewer's page (``.html``), which opens from disk without network, or a picture (``.png``). In a notebook a mesh shows
    itself."""
    shown, target = as_mesh(mesh), Path(path)
    kind = target.suffix.lower()
    if kind not in (".html", ".htm", ".png"):
        raise FileError(f"{target}: give a name that ends in .html or .png", path=str(target))
    content = shown.to_png() if kind == ".png" else shown.to_html(title).encode()
    target.write_bytes(content)
