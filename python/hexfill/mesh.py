""":class:`Surface` and :class:`HexMesh`: what is filled, and what fills it."""

from __future__ import annotations

import html
import json
from collections.abc import Iterable, Mapping
from functools import cached_property
from os import PathLike, fspath
from typing import TYPE_CHECKING, Any

import numpy as np

from . import _given, _native, arrays, foreign, running
from .errors import InputError

if TYPE_CHECKING:
    import meshio
    import pyvista
    from numpy.typing import ArrayLike, NDArray

#: Anything that holds a surface: :class:`Surface`, :class:`HexMesh` (its boundary quads), a path, a catalogue name such as ``":cube"``,
#: a signature, a PyVista or meshio mesh, or an array of points beside an array of cells.
SurfaceLike = Any
#: Anything that holds a hex mesh, likewise.
MeshLike = Any

#: Meshes of more hexes are shown as a picture in a notebook, not as a page.
MOST_SHOWN = 50_000

#: Without points, the largest id says how many vertices there are, and tables have that size: so many are allowed for each corner
#: of a cell, and besides.
SPARSE, SMALL = 16, 1_000_000


class _Arrays:
    """Arrays that are never changed: a mesh that was judged stays as it was judged. Copy one to work on it."""

    def __init__(self, data: _native.Data, name: str, report: Mapping[str, Any] | None = None) -> None:
        self._data = data
        self.name = name
        #: What is known of how it came about: a dictionary as the command line's ``--json`` prints it.
        self.report: dict[str, Any] = dict(report or {})

    @staticmethod
    def _numbers(raw: bytes | None, dtype: type, columns: int | None = None) -> Any:
        if raw is None:
            return None
        flat: NDArray[Any] = np.frombuffer(raw, dtype)
        return flat if columns is None else flat.reshape(-1, columns)

    def _fields(self, raw: Mapping[str, bytes]) -> dict[str, NDArray[np.float64]]:
        return {name: self._numbers(numbers, np.float64) for name, numbers in raw.items()}

    @cached_property
    def points(self) -> NDArray[np.float64] | None:
        """Positions (n, 3), in the unit of the input; ``None`` for connectivity alone."""
        return self._numbers(self._data.points, np.float64, 3)

    @cached_property
    def quads(self) -> NDArray[np.int64]:
        """Quads (m, 4) of vertex ids, each in cyclic order: the surface, in the order of the input."""
        return self._numbers(self._data.quads, np.int64, 4)

    @cached_property
    def point_tags(self) -> NDArray[np.int64] | None:
        """A number (n,) a point, 0 for none; ``None`` if there are no tags."""
        return self._numbers(self._data.point_tags, np.int64)

    @cached_property
    def quad_tags(self) -> NDArray[np.int64] | None:
        """A number (m,) a quad, such as a boundary condition, 0 for none; ``None`` if there are no tags."""
        return self._numbers(self._data.quad_tags, np.int64)

    @cached_property
    def quad_data(self) -> dict[str, NDArray[np.float64]]:
        """Named numbers (m,) a quad, as they were given; NaN where there is none."""
        return self._fields(self._data.quad_data)

    @cached_property
    def point_data(self) -> dict[str, NDArray[np.float64]]:
        """Named numbers (n,) a point, as they were given; NaN where there is none, as at points that :func:`hexfill.fill` makes."""
        return self._fields(self._data.point_data)

    @property
    def tag_names(self) -> list[tuple[str, int, str]]:
        """Names of tags: ``"points"``, ``"quads"`` or ``"hexes"``, the tag, the name. A tag that stands for several groups has several
        names, and a group that overlaps others several tags."""
        return self._data.tag_names

    @property
    def n_quads(self) -> int:
        """Number of quads of the surface."""
        return len(self.quads)

    @property
    def notes(self) -> list[str]:
        """What was recognised, repaired or passed over on reading."""
        return self._data.notes

    def info(self) -> dict[str, Any]:
        """What it is: see :func:`hexfill.info`."""
        return json.loads(_native.info(self._data, self.name, running.run()))

    def write(self, path: str | PathLike[str], *, format: str | None = None, quadratic: bool = False) -> None:
        """Writes a file: see :func:`hexfill.write`."""
        from .verbs import written

        written(path, self, format, quadratic, stacklevel=3)  # type: ignore[arg-type]

    def _given(self) -> _given.Given:
        return {
            "points": self.points,
            "quads": self.quads.astype(np.uint32),
            "other_faces": self._data.other_faces,
            "hexes": np.empty((0, 8), np.uint32),
            "point_tags": self.point_tags,
            "quad_tags": self.quad_tags,
            "hex_tags": None,
            "point_data": list(self.point_data.items()),
            "quad_data": list(self.quad_data.items()),
            "hex_data": [],
            "tag_names": self.tag_names,
        }

    def __reduce__(self) -> Any:
        return _restored, (type(self), self._given(), self.name, self.report)


class Surface(_Arrays):
    """A surface to fill: positions and quads. That it closes up is judged when it is used.

    Parameters
    ----------
    points : (n, 3) real numbers, or None
        Positions, in any unit; None: connectivity alone.
    quads : (m, 4) integers
        Vertex ids, 0-based, in cyclic order. Orientation is repaired where it is mixed.
    point_tags, quad_tags : (n,) and (m,) integers, optional
        Numbers to carry over to the mesh.
    point_data, quad_data : dictionaries of (n,) and (m,) real numbers, optional
        Fields to carry over to the mesh.
    tag_names : list of (what, tag, name), optional
        Names of tags to carry over; what is ``"points"`` or ``"quads"``.
    name : str
        What to call it in messages.
    """

    def __init__(
        self,
        points: ArrayLike | None,
        quads: ArrayLike,
        *,
        point_tags: ArrayLike | None = None,
        quad_tags: ArrayLike | None = None,
        point_data: Mapping[str, ArrayLike] | None = None,
        quad_data: Mapping[str, ArrayLike] | None = None,
        tag_names: Iterable[tuple[str, int, str]] = (),
        name: str = "surface",
    ) -> None:
        data = _data(
            points,
            quads,
            None,
            point_tags=point_tags,
            quad_tags=quad_tags,
            point_data=point_data,
            quad_data=quad_data,
            tag_names=tag_names,
        )
        super().__init__(data, name)

    def to_pyvista(self) -> pyvista.PolyData:
        """As a PyVista mesh with its tags, data, and names of tags as field data."""
        return foreign.surface_to_pyvista(self)

    def to_meshio(self, *, sets: bool = False) -> meshio.Mesh:
        """As a meshio mesh with its tags, data, and names of tags as field data. ``sets``: the groups by name as ``cell_sets`` and
        ``point_sets``, too."""
        return foreign.surface_to_meshio(self, sets)

    def __repr__(self) -> str:
        n = "no coordinates" if self.points is None else f"{len(self.points)} points"
        return f"<hexfill.Surface {self.name!r}: {self.n_quads} quads, {n}>"


class HexMesh(_Arrays):
    """A hex mesh.

    One that :func:`hexfill.fill` made begins with the points of the surface, bit for bit and in order, has its quads in their order,
    and was judged.

    Parameters
    ----------
    points : (n, 3) real numbers, or None
        Positions, in any unit; None: connectivity alone.
    hexes : (k, 8) integers
        Vertex ids, 0-based, in the order of VTK_HEXAHEDRON: a bottom quad, then the quad above it.
    quads : (m, 4) integers, optional
        The quads of its surface, if they are known.
    point_tags, quad_tags, hex_tags : (n,), (m,) and (k,) integers, optional
        Numbers to carry along.
    point_data, quad_data, hex_data : dictionaries of (n,), (m,) and (k,) real numbers, optional
        Fields to carry along.
    tag_names : list of (what, tag, name), optional
        Names of tags; what is ``"points"``, ``"quads"`` or ``"hexes"``.
    name : str
        What to call it in messages and titles.
    """

    def __init__(
        self,
        points: ArrayLike | None,
        hexes: ArrayLike,
        *,
        quads: ArrayLike | None = None,
        point_tags: ArrayLike | None = None,
        quad_tags: ArrayLike | None = None,
        hex_tags: ArrayLike | None = None,
        point_data: Mapping[str, ArrayLike] | None = None,
        quad_data: Mapping[str, ArrayLike] | None = None,
        hex_data: Mapping[str, ArrayLike] | None = None,
        tag_names: Iterable[tuple[str, int, str]] = (),
        name: str = "mesh",
    ) -> None:
        data = _data(
            points,
            quads,
            hexes,
            point_tags=point_tags,
            quad_tags=quad_tags,
            hex_tags=hex_tags,
            point_data=point_data,
            quad_data=quad_data,
            hex_data=hex_data,
            tag_names=tag_names,
        )
        super().__init__(data, name)

    @cached_property
    def hexes(self) -> NDArray[np.int64]:
        """Hexahedra (k, 8) of vertex ids, in the order of VTK_HEXAHEDRON."""
        return self._numbers(self._data.hexes, np.int64, 8)

    @property
    def n_hexes(self) -> int:
        """Number of hexahedra."""
        return len(self.hexes)

    @cached_property
    def hex_tags(self) -> NDArray[np.int64] | None:
        """A number (k,) a hex, such as a material, 0 for none; ``None`` if there are no tags."""
        return self._numbers(self._data.hex_tags, np.int64)

    @cached_property
    def hex_data(self) -> dict[str, NDArray[np.float64]]:
        """Named numbers (k,) a hex. After fill and embed: ``certified_positive`` (1: det J > 0 everywhere in it, 0: that was not
        shown) and ``scaled_jacobian`` (a certified lower bound of it); after fill also ``engine`` (what made it, a number: :attr:`engines` has the
        words) and ``layer`` (1: with a facet on the surface, 2: next to such a one, and so on)."""
        return self._fields(self._data.hex_data)

    @property
    def engines(self) -> NDArray[np.str_] | None:
        """What made each hex (k,), in the words of ``report["stages"]``, which counts them; ``None`` if that is not known."""
        numbers, words = self.hex_data.get("engine"), np.array(_native.engines())
        if numbers is None or not np.isin(numbers, np.arange(len(words))).all():
            return None
        return words[numbers.astype(int)]

    @property
    def certified(self) -> bool | None:
        """Whether det J > 0 is certified everywhere in every hex; ``None`` if that was not judged: :meth:`check` does."""
        flags = self.hex_data.get("certified_positive")
        return None if flags is None else bool((flags == 1).all())

    @property
    def worst(self) -> float | None:
        """The least certified scaled Jacobian; ``None`` if it was not judged."""
        numbers = self.hex_data.get("scaled_jacobian")
        return None if numbers is None or not len(numbers) else float(numbers.min())

    @property
    def surface(self) -> Surface:
        """Its surface, as it was given: the same points and quads (interior points belong to no quad)."""
        made = Surface.__new__(Surface)
        _Arrays.__init__(made, _native.Data(super()._given()), self.name)
        return made

    def _given(self) -> _given.Given:
        return {
            **super()._given(),
            "hexes": self.hexes.astype(np.uint32),
            "hex_tags": self.hex_tags,
            "hex_data": list(self.hex_data.items()),
        }

    def check(self, surface: SurfaceLike = None, **options: Any) -> Any:
        """Judges it: see :func:`hexfill.check`."""
        from .verbs import check

        return check(self, surface=surface, **options)

    def embed(self, **options: Any) -> HexMesh:
        """With better positions inside: see :func:`hexfill.embed`."""
        from .verbs import embed

        return embed(self, **options)

    def simplify(self, **options: Any) -> HexMesh:
        """With fewer hexes: see :func:`hexfill.simplify`."""
        from .verbs import simplify

        return simplify(self, **options)

    def to_pyvista(self) -> pyvista.UnstructuredGrid:
        """As a PyVista mesh with the data and tags of its hexes and points; ``plot()`` colours by the scaled Jacobian. What quads carry is on
        ``surface.to_pyvista()``."""
        return foreign.mesh_to_pyvista(self)

    def to_meshio(self, *, sets: bool = False) -> meshio.Mesh:
        """As a meshio mesh: the hexahedra, then the quads of the surface, with data, tags, and names of tags as field data.

        ``sets``: the groups by name as ``cell_sets`` and ``point_sets``, too. Not asked for, there are none: to formats without sets meshio
        writes these as one array in which a later set covers an earlier one.
        """
        return foreign.mesh_to_meshio(self, sets)

    def to_html(self, title: str | None = None) -> str:
        """The viewer's page: one HTML file (UTF-8) that needs no network; about 0.7 MB and 45 to 100 bytes a hex."""
        facts = [("made by", self.report["route"])] if "route" in self.report else []
        return _native.html(self._data, self.name if title is None else title, facts, running.run())

    def to_png(self, width: int = 1200, height: int = 640) -> bytes:
        """A picture: the surface, and the mesh cut open, beside each other. No display and no graphics card is needed."""
        across, down = arrays.whole(width, "width", 16, 16_384), arrays.whole(height, "height", 16, 16_384)
        return _native.png(self._data, across, down, running.run())

    def view(self, path: str | PathLike[str]) -> None:
        """Writes the page (``.html``) or the picture (``.png``): see :func:`hexfill.view`."""
        from .verbs import view

        view(self, path)

    def __repr__(self) -> str:
        words = [f"{self.n_hexes} hexes", "no coordinates" if self.points is None else f"{len(self.points)} points"]
        if self.certified is not None:
            bad = int((self.hex_data["certified_positive"] != 1).sum())
            words.append(f"scaled Jacobian at least {self.worst:.3f}" if not bad else f"{bad} hexes not certified")
        if "route" in self.report:
            words.append(f"by {self.report['route']}")
        return f"<hexfill.HexMesh {self.name!r}: {', '.join(words)}>"

    def _repr_html_(self) -> str | None:
        """The viewer in a notebook; a picture where the page would be large."""
        if self.points is None or not self.n_hexes:
            return None
        words = html.escape(repr(self))
        if self.n_hexes > MOST_SHOWN:
            import base64

            picture = base64.b64encode(self.to_png()).decode()
            return f'<p>{words}</p><img alt="{words}" style="max-width:100%" src="data:image/png;base64,{picture}">'
        page = html.escape(self.to_html(), quote=True)
        style = "width:100%;height:540px;border:1px solid #8884"
        return f'<iframe title="{words}" style="{style}" srcdoc="{page}"></iframe>'


def _restored(kind: type[_Arrays], given: _given.Given, name: str, report: dict[str, Any]) -> _Arrays:
    """A mesh that was pickled."""
    made = kind.__new__(kind)
    _Arrays.__init__(made, _native.Data(given), name, report)
    return made


def _data(
    points: ArrayLike | None,
    quads: ArrayLike | None,
    hexes: ArrayLike | None,
    *,
    other_faces: list[tuple[int, list[int]]] | None = None,
    point_tags: ArrayLike | None = None,
    quad_tags: ArrayLike | None = None,
    hex_tags: ArrayLike | None = None,
    point_data: Mapping[str, ArrayLike] | None = None,
    quad_data: Mapping[str, ArrayLike] | None = None,
    hex_data: Mapping[str, ArrayLike] | None = None,
    tag_names: Iterable[tuple[str, int, str]] = (),
) -> _native.Data:
    """Arrays as the compiled half takes them."""
    positions = None if points is None else arrays.points(points)
    quad_ids = arrays.cells([] if quads is None else quads, "quads")
    hex_ids = arrays.cells([] if hexes is None else hexes, "hexes")
    largest = max((int(ids.max()) for ids in (quad_ids, hex_ids) if ids.size), default=-1)
    n = largest + 1 if positions is None else len(positions)
    if positions is None and n > SPARSE * (quad_ids.size + hex_ids.size) + SMALL:
        raise InputError(f"ids reach {largest}, far more than there are vertices; number them from 0, or give points")
    return _native.Data(
        {
            "points": positions,
            "quads": quad_ids,
            "other_faces": other_faces or [],
            "hexes": hex_ids,
            "point_tags": arrays.tags(point_tags, n, "point_tags"),
            "quad_tags": arrays.tags(quad_tags, len(quad_ids), "quad_tags"),
            "hex_tags": arrays.tags(hex_tags, len(hex_ids), "hex_tags"),
            "point_data": arrays.fields(point_data, n, "point_data"),
            "quad_data": arrays.fields(quad_data, len(quad_ids), "quad_data"),
            "hex_data": arrays.fields(hex_data, len(hex_ids), "hex_data"),
            "tag_names": arrays.names(tag_names),
        }
    )


def made(data: _native.Data, name: str, report: str | None = None) -> Surface | HexMesh:
    """What the compiled half gave: a mesh if it has hexes, else a surface."""
    kind: type[_Arrays] = HexMesh if len(data.hexes) else Surface
    result = kind.__new__(kind)
    _Arrays.__init__(result, data, name, None if report is None else json.loads(report))
    return result  # type: ignore[return-value]


def loaded(given: Any, cells: ArrayLike | None, kind: arrays.Kind | None) -> Surface | HexMesh:
    """Whatever :data:`SurfaceLike` and :data:`MeshLike` allow. ``kind`` says what an array of cells holds; None: its width does."""
    if cells is not None:
        if isinstance(given, _Arrays):
            raise TypeError("give a mesh, or points and cells, not both")
        if kind is None:
            kind = "hexes" if np.ndim(cells) == 2 and np.shape(cells)[1] == 8 else "quads"
        return Surface(given, cells) if kind == "quads" else HexMesh(given, cells)
    if isinstance(given, (Surface, HexMesh)):
        return given
    if isinstance(given, (str, PathLike)):
        name = fspath(given)
        if not isinstance(name, str):
            raise TypeError("give the path as text, not as bytes")
        return made(_native.load(name, None, running.run()), name)
    found = foreign.arrays_of(given)
    if found is not None:
        parts = [found.pop(part) for part in ("points", "quads", "hexes")]
        data = _data(*parts, **found)
        return made(data, f"the {type(given).__name__}")
    if isinstance(given, (np.ndarray, list, tuple)) or given is None:
        raise TypeError("points alone are no mesh; give the cells, too: (points, quads) or (points, hexes)")
    raise TypeError(f"{type(given).__name__} is no mesh; give arrays, a path, a name, or a PyVista or meshio mesh")


def as_surface(given: SurfaceLike, quads: ArrayLike | None = None) -> Surface | HexMesh:
    """The argument as something with quads."""
    found = loaded(given, quads, "quads")
    if isinstance(found, HexMesh) and not found.n_quads:
        raise InputError(f"{found.name} is a hex mesh without quads of its surface; give a closed surface of quads")
    return found


def as_mesh(given: MeshLike, hexes: ArrayLike | None = None) -> HexMesh:
    """The argument as something with hexes."""
    found = loaded(given, hexes, "hexes")
    if not isinstance(found, HexMesh) or not found.n_hexes:
        raise InputError(f"{found.name} has no hexes; give a hex mesh (hexfill.fill makes one from a surface)")
    return found
