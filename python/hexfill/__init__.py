"""hexfill fills a closed surface of quads with hexahedra and leaves the surface exactly as it is.

>>> import hexfill
>>> mesh = hexfill.fill(":schneiders-pyramid")
>>> mesh.n_hexes, mesh.certified
(36, True)

The verbs are :func:`fill`, :func:`check`, :func:`embed`, :func:`simplify`, :func:`info`, :func:`doctor`, :func:`mend`, :func:`regions`, :func:`atlas`, :func:`catalog`,
:func:`enumerate`, :func:`read`, :func:`write` and :func:`view`; what they share is said in :mod:`hexfill.verbs`.
"""

from ._native import VERSION as __version__
from .errors import (
    Cancelled,
    FileError,
    HexfillError,
    InputError,
    InternalError,
    MeshError,
    NoMeshExists,
    NoMeshFound,
    SurfaceError,
)
from .mesh import HexMesh, Surface
from .verbs import (
    CatalogEntry,
    Enumeration,
    Region,
    Verdict,
    atlas,
    catalog,
    check,
    embed,
    enumerate,
    fill,
    doctor,
    info,
    mend,
    read,
    regions,
    simplify,
    view,
    write,
)

# `enumerate` stays out, so that a star import does not hide the built-in.
__all__ = [
    "Cancelled",
    "CatalogEntry",
    "Enumeration",
    "FileError",
    "HexMesh",
    "HexfillError",
    "InputError",
    "InternalError",
    "MeshError",
    "NoMeshExists",
    "NoMeshFound",
    "Region",
    "Surface",
    "SurfaceError",
    "Verdict",
    "__version__",
    "atlas",
    "catalog",
    "check",
    "embed",
    "fill",
    "doctor",
    "info",
    "mend",
    "read",
    "regions",
    "simplify",
    "view",
    "write",
]
