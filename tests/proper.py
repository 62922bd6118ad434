#!/usr/bin/env python3
"""Is a hex mesh proper, and its boundary the quads of the file? Shares nothing with hexfill: reads a legacy VTK file (ASCII) with hexes and quads.

    python3 tests/proper.py MESH.vtk

Asked of it: facets pair in one cyclic order, the boundary is the quads listed, any two hexes share nothing, a vertex, an edge of both or a facet
of both, and every vertex link is a sphere (inside) or a disk (on the boundary). The first that fails ends the program; improper pairs are counted.
"""
import sys
from collections import Counter, defaultdict
from itertools import combinations

# The cube in VTK's order of corners.
FACETS = [(0, 4, 7, 3), (1, 2, 6, 5), (0, 1, 5, 4), (3, 7, 6, 2), (0, 3, 2, 1), (4, 5, 6, 7)]
EDGES = [(0, 1), (1, 2), (2, 3), (3, 0), (4, 5), (5, 6), (6, 7), (7, 4), (0, 4), (1, 5), (2, 6), (3, 7)]
NEIGHBOURS = [(1, 3, 4), (0, 2, 5), (1, 3, 6), (0, 2, 7), (0, 5, 7), (1, 4, 6), (2, 5, 7), (3, 4, 6)]


def read_cells(path):
    """The cells of a file, each the list of its vertices."""
    with open(path) as file:
        words = file.read().split()
    at = words.index("CELLS")
    n_cells, at = int(words[at + 1]), at + 3
    cells = []
    for _ in range(n_cells):
        size = int(words[at])
        cells.append([int(word) for word in words[at + 1 : at + 1 + size]])
        at += size + 1
    return cells


def cyclic(quad):
    """The same for a quad from any corner on, in either direction."""
    first = quad.index(min(quad))
    forth = quad[first:] + quad[:first]
    return min(tuple(forth), (forth[0], *forth[:0:-1]))


def facets_of(hexes):
    """Per vertex set the facets that have it, as their cycles; at most two, in one cyclic order."""
    facets = defaultdict(list)
    for hexa in hexes:
        for facet in FACETS:
            quad = [hexa[k] for k in facet]
            facets[frozenset(quad)].append(cyclic(quad))
    for same in facets.values():
        assert len(same) <= 2, "a quad in three hexes"
        assert len(set(same)) == 1, "a twisted quad"
    return facets


def count_improper(hexes):
    """Pairs of hexes that share more than a vertex, an edge of both or a facet of both."""
    faces = [
        {frozenset([v]) for v in hexa}
        | {frozenset((hexa[a], hexa[b])) for a, b in EDGES}
        | {frozenset(hexa[k] for k in facet) for facet in FACETS}
        for hexa in hexes
    ]
    improper = 0
    for i, j in combinations(range(len(hexes)), 2):
        common = frozenset(hexes[i]) & frozenset(hexes[j])
        improper += bool(common) and not (common in faces[i] and common in faces[j])
    return improper


def check_link(v, hexes, is_boundary):
    """The link of a vertex, one triangle a hex, is a connected surface, and a disk or a sphere."""
    triangles = [tuple(hexa[k] for k in NEIGHBOURS[hexa.index(v)]) for hexa in hexes if v in hexa]
    sides = Counter(frozenset(pair) for triangle in triangles for pair in combinations(triangle, 2))
    corners = {x for triangle in triangles for x in triangle}
    assert max(sides.values()) <= 2, ("a side in three triangles", v)

    seen, stack = {triangles[0]}, [triangles[0]]
    while stack:
        here = stack.pop()
        for other in triangles:
            if other not in seen and len(set(here) & set(other)) == 2:
                seen.add(other)
                stack.append(other)
    assert len(seen) == len(triangles), ("a link in pieces", v)

    # Round each corner of the link the triangles form a path or a cycle.
    for corner in corners:
        opposite = [tuple(y for y in triangle if y != corner) for triangle in triangles if corner in triangle]
        degree = Counter(y for pair in opposite for y in pair)
        ends = sum(n == 1 for n in degree.values())
        assert max(degree.values()) <= 2 and ends in (0, 2), ("a corner with several fans", v)
        assert len(degree) == len(opposite) + (ends == 2), ("a corner with several fans", v)

    euler = len(corners) - len(sides) + len(triangles)
    has_border = any(n == 1 for n in sides.values())
    assert (euler, has_border) == ((1, True) if is_boundary else (2, False)), (v, euler)


def main(path):
    cells = read_cells(path)
    hexes = [cell for cell in cells if len(cell) == 8]
    quads = [cell for cell in cells if len(cell) == 4]
    print(len(hexes), "hexes", len(quads), "quads")
    assert all(len(set(hexa)) == 8 for hexa in hexes), "a hex uses a vertex twice"

    facets = facets_of(hexes)
    boundary = {same[0] for same in facets.values() if len(same) == 1}
    assert boundary == {cyclic(quad) for quad in quads} and len(boundary) == len(quads), "boundary"
    print("improper pairs", count_improper(hexes))

    on_boundary = {v for quad in boundary for v in quad}
    used = sorted({v for hexa in hexes for v in hexa})
    for v in used:
        check_link(v, hexes, v in on_boundary)
    print("all vertex links are spheres or disks; vertices", len(used))

    edges = {frozenset((hexa[a], hexa[b])) for hexa in hexes for a, b in EDGES}
    print("euler", len(used) - len(edges) + len(facets) - len(hexes))


if __name__ == "__main__":
    main(sys.argv[1])
