"""Surfaces to fill."""

import itertools
import pathlib

import numpy as np
import pytest

REPOSITORY = pathlib.Path(__file__).resolve().parents[2]


def box(nx: int, ny: int, nz: int):
    """Points and quads of a box of unit cubes, quads outward."""
    ids: dict[tuple[int, int, int], int] = {}
    size, quads = (nx, ny, nz), []
    for axis in range(3):
        u, v = (axis + 1) % 3, (axis + 2) % 3
        for end in (0, size[axis]):
            for i, j in itertools.product(range(size[u]), range(size[v])):
                corners = [(0, 0), (1, 0), (1, 1), (0, 1)] if end else [(0, 0), (0, 1), (1, 1), (1, 0)]
                quad = []
                for a, b in corners:
                    at = [0, 0, 0]
                    at[axis], at[u], at[v] = end, i + a, j + b
                    quad.append(ids.setdefault(tuple(at), len(ids)))
                quads.append(quad)
    return np.array(list(ids), dtype=float), np.array(quads)


@pytest.fixture
def cube():
    return box(1, 1, 1)


@pytest.fixture
def bar():
    return box(2, 2, 3)
