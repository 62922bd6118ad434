#!/usr/bin/env python3
"""Files as people have them: makes them, fills each with `hexfill fill`, and prints a markdown table of what each gave.

    tests/ordinary_files.py HEXFILL [--out FOLDER]

Needs meshio and Gmsh from PyPI (`pip install meshio gmsh`), which write most of the files and read what came out. The exit code is 1 if a
file gave anything but what CASES says: exit code, a word of the message, hexes, and names that must come back.
"""
import argparse
import gzip
import itertools
import pathlib
import random
import subprocess
import sys
import time

import gmsh
import meshio
import numpy as np

from campaign import last_line, table_head

SICK = pathlib.Path(__file__).resolve().parents[1] / "corpus" / "sick"
N = 3


def box(n=N, shift=(0, 0, 0)):
    """Points, quads (outward) and the side of each quad (2 * axis + end) of a box of n^3 unit cells."""
    ids, quads, sides = {}, [], []
    for axis, end in itertools.product(range(3), (0, n)):
        for i, j in itertools.product(range(n), repeat=2):
            ring = [(0, 0), (1, 0), (1, 1), (0, 1)] if end else [(0, 0), (0, 1), (1, 1), (1, 0)]
            quad = []
            for a, b in ring:
                at = [end] * 3
                at[(axis + 1) % 3], at[(axis + 2) % 3] = i + a, j + b
                quad.append(ids.setdefault(tuple(at), len(ids)))
            quads.append(quad)
            sides.append(2 * axis + bool(end))
    return np.array(list(ids), float) + shift, np.array(quads), np.array(sides)


def obj(path, points, faces, heads={}):
    """A Wavefront file; `heads` are lines before faces."""
    lines = ["v " + " ".join(repr(float(x)) for x in p) for p in points]
    for i, face in enumerate(faces):
        lines += heads.get(i, []) + ["f " + " ".join(str(v + 1) for v in face)]
    path.write_text("\n".join(lines) + "\n")


# Makers: each writes one file.

def by_gmsh(path, version, order=1):
    """A box of 3 x 3 x 3 by Gmsh itself, with physical groups on its sides: quads by transfinite surfaces."""
    gmsh.initialize()
    gmsh.option.setNumber("General.Terminal", 0)
    gmsh.option.setNumber("Mesh.MshFileVersion", version)
    gmsh.option.setNumber("Mesh.ElementOrder", order)
    gmsh.option.setNumber("Mesh.SecondOrderIncomplete", 1)
    gmsh.model.occ.addBox(0, 0, 0, 3, 3, 3)
    gmsh.model.occ.synchronize()
    for _, curve in gmsh.model.getEntities(1):
        gmsh.model.mesh.setTransfiniteCurve(curve, N + 1)
    for number, (_, face) in enumerate(gmsh.model.getEntities(2)):
        gmsh.model.mesh.setTransfiniteSurface(face)
        gmsh.model.mesh.setRecombine(2, face)
        gmsh.model.addPhysicalGroup(2, [face], name=["inlet", "outlet", "wall3", "wall4", "wall5", "wall6"][number])
    gmsh.model.mesh.generate(2)
    gmsh.write(str(path))
    gmsh.finalize()


def blender(path):
    """As Blender exports: an object, texture coordinates, normals, a material, and points of its own for every side, 1e-9 off at random."""
    points, quads, sides = box()
    random.seed(1)
    lines, number = ["# Blender v4.2.0", "mtllib box.mtl", "o Box"], 1
    corners = []
    for side in range(6):
        mine = {v: None for quad, s in zip(quads, sides) if s == side for v in quad}
        for v in mine:
            mine[v], number = number, number + 1
            lines.append("v " + " ".join(f"{x + 1e-9 * random.uniform(-1, 1):.12f}" for x in points[v]))
        corners.append(mine)
    lines += ["vt 0.0 0.0", *(f"vn {' '.join(map(str, n))}" for n in np.vstack([np.eye(3), -np.eye(3)])), "s off"]
    for side in range(6):
        lines += [f"g side{side}", "usemtl steel"]
        lines += ["f " + " ".join(f"{corners[side][v]}/1/{side + 1}" for v in quad) for quad, s in zip(quads, sides) if s == side]
    path.write_text("\n".join(lines) + "\n")


def sets(path):
    """Abaqus shells S4 with an element set and a node set."""
    points, quads, _ = box()
    lines = ["*HEADING", "a part", "*NODE"]
    lines += [f"{i + 1}, {p[0]}, {p[1]}, {p[2]}" for i, p in enumerate(points)]
    lines += ["*ELEMENT, TYPE=S4, ELSET=SKIN"]
    lines += [f"{i + 101}, " + ", ".join(str(v + 1) for v in quad) for i, quad in enumerate(quads)]
    path.write_text("\n".join([*lines, "*ELSET, ELSET=INLET, GENERATE", "101, 109, 1", "*NSET, NSET=CORNER", "1, 2"]) + "\n")


def fields(path):
    points, quads, sides = box()
    data = {"T": points[:, 0] + 1, "u": points[:, [1, 2, 0]]}
    meshio.Mesh(points, [("quad", quads)], point_data=data, cell_data={"heat": [sides / 7]}).write(path)


def plain(path, scale=1.0, shift=0.0):
    points, quads, _ = box()
    meshio.Mesh(scale * points + shift, [("quad", quads)]).write(path)


def gzipped(path):
    plain(path.with_suffix(""))
    path.write_bytes(gzip.compress(path.with_suffix("").read_bytes()))


def triangles(path):
    points, quads, _ = box()
    meshio.Mesh(points, [("triangle", np.vstack([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]]))]).write(path)


def regions(path):
    """Two boxes of 2 x 2 x 2 that share a wall."""
    points, quads, _ = box(2)
    ids = {tuple(p): i for i, p in enumerate(points)}
    both = [tuple(q) for q in quads]
    for quad in quads:
        moved = [ids.setdefault(tuple(points[v] + [2, 0, 0]), len(ids)) for v in quad]
        if sorted(moved) not in [sorted(q) for q in both]:
            both.append(tuple(moved))
    obj(path, list(ids), both)


def inside_out(path):
    points, quads, _ = box()
    obj(path, points, quads[:, ::-1])


def pinched(path):
    """Two boxes that have a corner's place in common and no point."""
    (points, quads, _), (others, more, _) = box(), box(shift=(3, 3, 3))
    obj(path, [*points, *others], [*quads, *(more + len(points))])


def cells_round_a_void(path, n=8, least=3, most=5):
    ids, cells = {}, []
    for at in itertools.product(range(n), repeat=3):
        if not all(least <= x < most for x in at):
            ring = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0, 0, 1), (1, 0, 1), (1, 1, 1), (0, 1, 1)]
            cells.append([ids.setdefault(tuple(np.add(at, r)), len(ids)) for r in ring])
    meshio.Mesh(np.array(list(ids), float), [("hexahedron", cells)]).write(path)


def no_number(path):
    points, quads, _ = box()
    points[7, 1] = np.nan
    obj(path, points, quads)


def sick(path):
    path.write_text((SICK / path.name).read_text())


SIDES = ["inlet", "outlet", "wall3", "wall4", "wall5", "wall6"]
# File, its maker, format of the output, flags; exit code, hexes (0: no mesh), a word of the message, names that come back.
CASES = [
    ("groups22.msh", lambda p: by_gmsh(p, 2.2), "msh", [], 0, 27, "", SIDES),
    ("groups41.msh", lambda p: by_gmsh(p, 4.1), "msh4", [], 0, 27, "", SIDES),
    ("groups41.msh", lambda p: by_gmsh(p, 4.1), "inp", [], 0, 27, "", SIDES),
    ("groups.bdf", lambda p: by_gmsh(p, 4.1), "bdf", [], 0, 27, "", []),
    ("groups.unv", lambda p: by_gmsh(p, 4.1), "unv", [], 0, 27, "", []),
    ("quad8.msh", lambda p: by_gmsh(p, 4.1, 2), "vtu", [], 2, 0, "--linearise", []),
    ("quad8.msh", lambda p: by_gmsh(p, 4.1, 2), "vtu", ["--linearise"], 0, 27, "", SIDES),
    ("blender.obj", blender, "msh", [], 2, 0, "welding closes it", []),
    ("blender.obj", blender, "msh", ["--weld", "1e-6"], 0, 27, "merged", ["side0", "side5"]),
    ("triangles.stl", triangles, "vtu", [], 2, 0, "RecombineAll", []),
    ("sets.inp", sets, "inp", [], 0, 27, "", ["INLET", "CORNER"]),
    ("fields.vtu", fields, "vtu", [], 0, 27, "", ["T", "u", "heat"]),
    ("box.ply", plain, "ovm", [], 0, 27, "", []),
    ("box.ply.gz", gzipped, "mesh", [], 0, 27, "", []),
    ("regions.obj", regions, "vtu", [], 0, 16, "the whole: 16 hexes", []),
    ("inside_out.obj", inside_out, "vtk", [], 0, 27, "turned", []),
    ("crossing_boxes.obj", sick, "vtu", [], 0, 16, "overlaps itself", []),
    ("micro.obj", lambda p: plain(p, 1e-6), "vtu", [], 0, 27, "", []),
    ("mega.obj", lambda p: plain(p, 1e6, 3e7), "vtu", [], 0, 27, "", []),
    ("void.vtu", cells_round_a_void, "vtu", [], 0, 512, "", []),
    ("pinched.obj", pinched, "vtu", [], 0, 54, "", []),
    ("odd_ball.obj", sick, "vtu", [], 2, 0, "odd number", []),
    ("mixed_box.obj", sick, "vtu", [], 2, 0, "not quads", []),
    ("open_box.obj", sick, "vtu", [], 2, 0, "open", []),
    ("nan.obj", no_number, "vtu", [], 2, 0, "finite", []),
    ("box.ply", plain, "obj", [], 2, 0, "cannot hold hexahedra", []),
]


def one(hexfill, folder, case):
    """Fills a file: a row of the table, and what is not as it should be."""
    name, make, extension, flags, code, hexes, word, names = case
    path, out = folder / name, folder / f"filled_{name.replace('.', '_')}.{extension}"
    make(path)
    out.unlink(missing_ok=True)
    start = time.monotonic()
    run = subprocess.run([hexfill, "fill", str(path), "-o", str(out), *flags], capture_output=True, text=True)
    seconds = time.monotonic() - start
    wrong = [f"exit code {run.returncode}, not {code}"] if run.returncode != code else []
    wrong += [f"no word of {word!r}"] if word not in run.stderr else []
    wrong += [] if out.exists() == (hexes > 0) else ["a file" if out.exists() else "no file"]
    if out.exists():
        wrong += read_back(hexfill, out, hexes, names)
    geometry = [line for line in run.stderr.splitlines() if line.startswith("geometry")]
    said = geometry[0].removeprefix("geometry: ") if geometry else last_line(run.stderr).replace(str(folder) + "/", "")
    return f"| `{name}`{' ' + ' '.join(flags) if flags else ''} -> .{extension} | {run.returncode} | {seconds:.1f} | {said} |", wrong


def read_back(hexfill, out, hexes, names):
    """What is wrong with a mesh: meshio reads it where it can, and the names stand in the file."""
    text = out.read_bytes().decode(errors="replace")
    wrong = [f"{name} is lost" for name in names if name not in text]
    if out.suffix in (".ovm", ".unv"):
        return wrong
    mesh = meshio.read(out, file_format={".msh4": "gmsh", ".mesh": "medit", ".bdf": "nastran"}.get(out.suffix))
    found = sum(len(block.data) for block in mesh.cells if block.type == "hexahedron")
    return wrong + ([] if found == hexes else [f"{found} hexes by meshio, not {hexes}"])


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("hexfill", help="the program to run")
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("ordinary-files"), help="folder for the files")
    args = parser.parse_args()
    args.out.mkdir(parents=True, exist_ok=True)
    # The table as a whole: Gmsh prints empty lines.
    rows, bad = [table_head(["file -> format", "exit", "s", "what it gave"])], []
    for case in CASES:
        row, wrong = one(args.hexfill, args.out, case)
        rows.append(row)
        bad += [f"{case[0]} -> .{case[2]}: {w}" for w in wrong]
    print("\n".join(rows))
    for line in bad:
        print(line, file=sys.stderr)
    return int(bool(bad))


if __name__ == "__main__":
    sys.exit(main())
