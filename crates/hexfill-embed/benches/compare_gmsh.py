#!/usr/bin/env python3
"""Gmsh's untangler on the meshes of this crate, for comparison.

Usage: compare_gmsh.py EMBED_JSON FILE...   (needs `pip install gmsh`; Gmsh is a separate program, nothing of it is used here)

EMBED_JSON is the built example `embed_json`. Each FILE has `hexes` and `boundary_points`, and perhaps `start`. Both programs start from
the `start`, else from the graph-Laplacian positions, with the boundary fixed; printed are the least corner scaled Jacobian, the number of hexes with a
corner that is not positive, and the time of the untangling itself.
"""
import json
import subprocess
import sys
import time

import gmsh

FACETS = [(0, 4, 7, 3), (1, 2, 6, 5), (0, 1, 5, 4), (3, 7, 6, 2), (0, 3, 2, 1), (4, 5, 6, 7)]
NEIGHBOURS = [(1, 3, 4), (2, 0, 5), (3, 1, 6), (0, 2, 7), (7, 5, 0), (4, 6, 1), (5, 7, 2), (6, 4, 3)]
EDGES = [(a, b) for a in range(8) for b in NEIGHBOURS[a] if a < b]


def corner_scaled_jacobians(hexes, points):
    for hexa in hexes:
        worst = 1.0
        for corner, ends in enumerate(NEIGHBOURS):
            o = points[hexa[corner]]
            e = [[points[hexa[k]][c] - o[c] for c in range(3)] for k in ends]
            length = 1.0
            for v in e:
                length *= sum(x * x for x in v) ** 0.5
            d = (
                e[0][0] * (e[1][1] * e[2][2] - e[1][2] * e[2][1])
                - e[0][1] * (e[1][0] * e[2][2] - e[1][2] * e[2][0])
                + e[0][2] * (e[1][0] * e[2][1] - e[1][1] * e[2][0])
            )
            worst = min(worst, d / length if length > 0 else -1.0)
        yield worst


def boundary(hexes):
    seen = {}
    for hexa in hexes:
        for facet in FACETS:
            quad = [hexa[k] for k in facet]
            seen.setdefault(tuple(sorted(quad)), []).append(quad)
    return [quads[0] for quads in seen.values() if len(quads) == 1]


def laplacian_start(hexes, boundary_points, fixed):
    n = max(max(h) for h in hexes) + 1
    neighbours = [set() for _ in range(n)]
    for hexa in hexes:
        for a, b in EDGES:
            neighbours[hexa[a]].add(hexa[b])
            neighbours[hexa[b]].add(hexa[a])
    points = [list(boundary_points[v]) if v in fixed else [0.0, 0.0, 0.0] for v in range(n)]
    for _ in range(5000):
        for v in range(n):
            if v not in fixed:
                near = neighbours[v]
                points[v] = [sum(points[w][c] for w in near) / len(near) for c in range(3)]
    return points


def untangle_with_gmsh(hexes, quads, points, fixed):
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.model.add("mesh")
    surface = gmsh.model.addDiscreteEntity(2)
    volume = gmsh.model.addDiscreteEntity(3, -1, [surface])
    on = sorted(fixed)
    inside = [v for v in range(len(points)) if v not in fixed]
    gmsh.model.mesh.addNodes(2, surface, [v + 1 for v in on], [x for v in on for x in points[v]])
    gmsh.model.mesh.addNodes(3, volume, [v + 1 for v in inside], [x for v in inside for x in points[v]])
    gmsh.model.mesh.addElementsByType(surface, 3, [], [v + 1 for quad in quads for v in quad])
    gmsh.model.mesh.addElementsByType(volume, 5, [], [v + 1 for hexa in hexes for v in hexa])
    before = time.perf_counter()
    gmsh.model.mesh.optimize("UntangleMeshGeometry", True)
    seconds = time.perf_counter() - before
    tags, coordinates, _ = gmsh.model.mesh.getNodes()
    out = [None] * len(points)
    for i, tag in enumerate(tags):
        out[int(tag) - 1] = list(coordinates[3 * i : 3 * i + 3])
    gmsh.finalize()
    return out, seconds


def main():
    embed, files = sys.argv[1], sys.argv[2:]
    for path in files:
        data = json.load(open(path))
        hexes, given = data["hexes"], data["boundary_points"]
        quads = boundary(hexes)
        fixed = {v for quad in quads for v in quad}
        start = data.get("start") or laplacian_start(hexes, given, fixed)
        points, seconds = untangle_with_gmsh(hexes, quads, start, fixed)
        moved = max(abs(points[v][c] - given[v][c]) for v in fixed for c in range(3))
        values = list(corner_scaled_jacobians(hexes, points))
        tangled = sum(v <= 0 for v in corner_scaled_jacobians(hexes, start))
        print(f"{path}: {len(hexes)} hexes, {tangled} bad at the start")
        bad = sum(v <= 0 for v in values)
        print(f"  gmsh {gmsh.__version__}: least {min(values):.6f}, {bad} bad, {seconds:.3f} s, boundary moved {moved:g}")
        for objective in ["untangle-only", "scaled-jacobian"]:
            done = subprocess.run([embed, path, objective, "1"], capture_output=True, text=True, check=True)
            report = json.loads(done.stdout)
            print(
                f"  hexfill {objective}: least {report['scaled_jacobian']:.6f} (whole cells), "
                f"{report['n_invalid']} bad, {done.stderr.split()[0]} s"
            )


main()
