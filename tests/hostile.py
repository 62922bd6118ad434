#!/usr/bin/env python3
"""Makes hostile surfaces and runs `hexfill fill`, `check` and `doctor` over each; prints a markdown table by family.

    tests/hostile.py HEXFILL [--count N] [--first I] [--seed S] [--only FAMILY] [--jobs N] [--limit SECONDS] [--quick]
                     [--out FOLDER] [--json FILE] [--make-only] [-- FLAGS OF FILL]

Surface I of seed S is always the same: a shape (FAMILIES) of 6 to some 150 quads, and in most families what was done to
its points (DEFORMATIONS, SCALES). `--quick` is the part that ./test.sh runs: small surfaces only. Outcomes:

    certified  exit code 0, and `check --surface` passes levels 1 to 5
    invalid    a mesh that passes level 3, without valid coordinates; exit code 1
    none       no mesh and a reason, exit code 1
    refused    exit code 2: the input has no hex mesh, or is no closed quad surface
    WRONG      fill claims more than check finds, check finds less than level 3, or another exit code
    PANIC      exit code 70 or 101, a signal, or words about a panic, by any of the three commands
    TIMEOUT    killed after --limit (60 s of CPU time; seconds in the table are seconds of CPU time, too)

The last three make the exit code 1.
"""
import argparse
import concurrent.futures
import json
import math
import os
import pathlib
import random
import resource
import signal
import subprocess
import sys
import tempfile
import threading
from collections import Counter

from campaign import last_line, panicked, parsed, table_head

BAD = ("WRONG", "PANIC", "TIMEOUT")
OUTCOMES = ("certified", "invalid", "none", "refused", *BAD)


# Shapes: (points, quads), quads outward; with hexes, if it has any.

def voxels(filled, points_of_own=False):
    """The boundary of a set of cells; vertices at one spot are one point unless each cell has points of its own."""
    ids, quads = {}, []
    for cell in sorted(filled):
        for axis in range(3):
            u, v = (axis + 1) % 3, (axis + 2) % 3
            for side in (0, 1):
                beside = list(cell)
                beside[axis] += 2 * side - 1
                if tuple(beside) in filled:
                    continue
                ring = [(0, 0), (1, 0), (1, 1), (0, 1)] if side else [(0, 0), (0, 1), (1, 1), (1, 0)]
                quad = []
                for du, dv in ring:
                    corner = list(cell)
                    corner[axis] += side
                    corner[u] += du
                    corner[v] += dv
                    key = (tuple(corner), cell if points_of_own else None)
                    quad.append(ids.setdefault(key, len(ids)))
                quads.append(quad)
    return [[float(x) for x in key[0]] for key in ids], quads


def cells(nx, ny, nz):
    return {(x, y, z) for x in range(nx) for y in range(ny) for z in range(nz)}


def is_surface(quads):
    """Whether every edge has two quads and every vertex one fan of them."""
    edges = Counter(frozenset(edge) for quad in quads for edge in zip(quad, quad[1:] + quad[:1]))
    if any(n != 2 for n in edges.values()):
        return False
    links = {}
    for quad in quads:
        for i, v in enumerate(quad):
            links.setdefault(v, []).append((quad[i - 1], quad[(i + 1) % 4]))
    for link in links.values():
        after = dict(link)
        at, seen = link[0][0], 0
        while at in after and seen <= len(link):
            at, seen = after.pop(at), seen + 1
        if seen != len(link):
            return False
    return True


def box(rng, most=4):
    return voxels(cells(*(rng.randint(1, most) for _ in range(3))))


def voxel_solid(rng):
    """Cells taken out of a box and put on it, with cavities and tunnels, as long as it stays a surface of one to some parts."""
    size = [rng.randint(2, 4) for _ in range(3)]
    solid = cells(*size)
    for _ in range(rng.randint(1, 12)):
        changed = solid ^ {tuple(rng.randint(0, n - 1) for n in size)}
        if changed and is_surface(voxels(changed)[1]) and len(voxels(changed)[1]) <= 150:
            solid = changed
    return voxels(solid)


def cavity(rng):
    """A box with one or two cavities, sometimes with a tunnel through."""
    solid = cells(5 if rng.random() < 0.4 else 3, 3, 3)
    solid -= {(1, 1, 1)}
    if (4, 0, 0) in solid:
        solid -= {(3, 1, 1)}
    if rng.random() < 0.3:
        solid -= {(1, 1, 0), (1, 1, 2)}
    return voxels(solid)


def torus(rng):
    """m x n quads round a ring, twisted by some steps; also with 3 x 3 quads, and thick or thin."""
    m, n = rng.choice([(3, 3), (4, 3), (3, 4), (8, 3), (6, 4), (4, 4), (12, 4), (5, 5), (16, 8)])
    twist, tube = rng.randint(0, n - 1), rng.choice([0.1, 0.3, 0.5, 0.9])
    points = []
    for i in range(m):
        for j in range(n):
            a, b = 2 * math.pi * i / m, 2 * math.pi * (j + twist * i / m) / n
            r = 1 + tube * math.cos(b)
            points.append([r * math.cos(a), r * math.sin(a), tube * math.sin(b)])
    at = lambda i, j: (i % m) * n + (j + (twist if i >= m else 0)) % n
    return points, [[at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)] for i in range(m) for j in range(n)]


def joined(*parts):
    points, quads = [], []
    for more, faces in parts:
        quads += [[v + len(points) for v in quad] for quad in faces]
        points += more
    return points, quads


def moved(part, scale, shift):
    points, quads = part
    return [[scale * x + s for x, s in zip(p, shift)] for p in points], quads


def nested(rng):
    """Two to four boxes in each other, of 6 quads or more, facing any way."""
    parts = []
    for depth in range(rng.randint(2, 4)):
        points, quads = moved(box(rng, rng.choice([1, 1, 2])), 1.0, [0, 0, 0])
        top = max(x for p in points for x in p)
        # Into the box from depth to 10 - depth.
        points = [[depth + (10 - 2 * depth) * x / top * (0.5 if top > 1 else 1) for x in p] for p in points]
        parts.append((points, [quad[::-1] for quad in quads] if rng.random() < 0.5 else quads))
    return joined(*parts)


def crossing(rng):
    """Two or three boxes through each other, or one in the place of the other."""
    shift = lambda: [rng.choice([0.0, 0.0, 0.5, rng.uniform(-1, 1)]) for _ in range(3)]
    return joined(*(moved(box(rng, 2), rng.choice([1.0, 1.0, 0.7]), shift()) for _ in range(rng.randint(2, 3))))


def bricks(rng):
    """Touching cells that do not share their points: walls twice."""
    return voxels(cells(rng.randint(2, 3), rng.randint(1, 2), 1), points_of_own=True)


def sphere(rng):
    """A cube grown by insets and vertex splits to some quads; any points."""
    points, quads = box(rng, 1)
    points = [[x - 0.5 for x in p] for p in points]
    for _ in range(rng.randint(0, 12)):
        if rng.random() < 0.8:
            inset(points, quads, rng)
        else:
            split_vertex(points, quads, rng)
    if len(quads) % 2 and rng.random() < 0.9:
        split_vertex(points, quads, rng)
    if rng.random() < 0.5:
        points = [[rng.uniform(-1, 1) for _ in range(3)] for _ in points]
    else:
        points = [[x / (math.sqrt(sum(y * y for y in p)) or 1) for x in p] for p in points]
    return points, quads


def inset(points, quads, rng):
    """One quad becomes five."""
    quad = quads.pop(rng.randrange(len(quads)))
    centre = [sum(points[v][k] for v in quad) / 4 for k in range(3)]
    inner = []
    for v in quad:
        inner.append(len(points))
        points.append([1.2 * (0.5 * c + 0.5 * x) for c, x in zip(centre, points[v])])
    quads.append(inner)
    quads += [[quad[i], quad[(i + 1) % 4], inner[(i + 1) % 4], inner[i]] for i in range(4)]


def split_vertex(points, quads, rng):
    """A vertex becomes two with a quad between them: one more quad, and the parity changes. Where it can, no vertex of two quads comes."""
    degrees = Counter(v for quad in quads for v in quad)
    v = rng.choice([v for v in degrees if degrees[v] >= 4] or list(degrees))
    after = {quad[(i + 1) % 4]: (quad[i - 1], q) for q, quad in enumerate(quads) for i in range(4) if quad[i] == v}
    ring, fan = [next(iter(after))], []
    while len(ring) <= len(after):
        far, q = after[ring[-1]]
        fan.append(q)
        ring.append(far)
    n = len(fan)
    k = rng.randint(2, n - 2) if n >= 4 else 1
    new = len(points)
    points.append([1.1 * x for x in points[v]])
    for q in fan[:k]:
        quads[q] = [new if w == v else w for w in quads[q]]
    quads.append([new, ring[k], v, ring[0]])


def walls(rng):
    """Regions that share walls: boxes cut by quads inside, some of them pierced."""
    size = [rng.randint(2, 3), rng.randint(1, 2), 1]
    lattice, quads = {}, {}
    part = {cell: rng.randint(0, 2) for cell in cells(*size)}
    for cell in sorted(part):
        points, faces = voxels({cell})
        for axis_face in faces:
            corners = [tuple(points[v]) for v in axis_face]
            key = frozenset(corners)
            quads.setdefault(key, []).append((cell, corners))
    out = []
    for owners in quads.values():
        if len(owners) == 1 or part[owners[0][0]] != part[owners[1][0]]:
            out.append([lattice.setdefault(c, len(lattice)) for c in owners[0][1]])
    return [list(p) for p in lattice], out


def void(rng):
    """Hexes with a void to fill: a box of cells some of which are missing, closed by the quads round the box."""
    size = [rng.randint(2, 4), rng.randint(1, 3), rng.randint(1, 3)]
    box = cells(*size)
    missing = set(rng.sample(sorted(box), rng.randint(1, max(1, len(box) // 3))))
    points, quads = voxels(box)
    ids = {tuple(p): i for i, p in enumerate(points)}
    hexes = []
    for x, y, z in sorted(box - missing):
        ring = [(0, 0), (1, 0), (1, 1), (0, 1)]
        hexes.append([ids.setdefault((x + a, y + b, z + c), len(ids)) for c in (0, 1) for a, b in ring])
    return [[float(x) for x in p] for p in ids], quads, hexes


def open_surface(rng):
    points, quads = voxel_solid(rng)
    for _ in range(rng.randint(1, 3)):
        quads.pop(rng.randrange(len(quads)))
    return points, quads


def non_manifold(rng):
    """Cells that touch in edges and vertices, doubled quads, quads with a vertex twice, ids out of range."""
    solid = {tuple(rng.randint(0, 2) for _ in range(3)) for _ in range(rng.randint(2, 8))}
    points, quads = voxels(solid)
    what = rng.randint(0, 4)
    if what == 0:
        quads.append(list(rng.choice(quads)))
    elif what == 1:
        quad = rng.choice(quads)
        quad[0] = quad[2]
    elif what == 2:
        rng.choice(quads)[1] = rng.randrange(len(points))
    elif what == 3:
        rng.choice(quads).pop()
    return points, quads


def inside_out(rng):
    points, quads = rng.choice([voxel_solid, torus, cavity])(rng)
    if rng.random() < 0.5:
        return points, [quad[::-1] for quad in quads]
    return points, [quad[::-1] if rng.random() < 0.5 else quad for quad in quads]


def pinched(rng):
    """Every component with a neck of no width: the points of a ring in one spot."""
    points, quads = torus(rng)
    for i in range(rng.randint(1, 4)):
        points[i] = list(points[0])
    return points, quads


FAMILIES = {
    "box": box, "voxels": voxel_solid, "cavity": cavity, "torus": torus, "nested": nested, "crossing": crossing,
    "bricks": bricks, "sphere": sphere, "pinched": pinched, "inside-out": inside_out, "walls": walls, "void": void,
    "open": open_surface, "non-manifold": non_manifold,
}
# Families in turn; those that are filled come more often than those that are refused.
TURNS = [*FAMILIES, "torus", "sphere", "nested", "voxels", "torus", "sphere", "crossing", "walls", "pinched", "cavity"]


# What is done to points. None changes a quad.

def jittered(points, rng):
    return [[x + rng.gauss(0, 0.15) for x in p] for p in points]


def spiky(points, rng):
    """Some vertices far out, or through the other side."""
    some = set(rng.sample(range(len(points)), min(len(points), rng.randint(1, 4))))
    return [[rng.choice([-1, 5, 1e3]) * x + rng.uniform(-1, 1) for x in p] if i in some else p for i, p in enumerate(points)]


def coincident(points, rng):
    """Some vertices in the spots of others."""
    points = [list(p) for p in points]
    for _ in range(rng.randint(1, 6)):
        points[rng.randrange(len(points))] = list(rng.choice(points))
    return points


def one_spot(points, rng):
    """All vertices but a few in one spot."""
    keep = set(rng.sample(range(len(points)), rng.randint(0, 3)))
    return [p if i in keep else list(points[0]) for i, p in enumerate(points)]


def flat(points, rng):
    k = rng.randrange(3)
    height = rng.choice([0.0, 1e-14, 1e-9])
    return [[height * x if i == k else x for i, x in enumerate(p)] for p in points]


def straight(points, rng):
    return [[x if i == 0 else 0.0 for i, x in enumerate(p)] for p in points]


def needle(points, rng):
    k, factor = rng.randrange(3), rng.choice([1e6, 1e-6, 1e12])
    return [[factor * x if i == k else x for i, x in enumerate(p)] for p in points]


def sheared(points, rng):
    s = rng.choice([3.0, 100.0, 1e6])
    return [[p[0] + s * p[1], p[1] + 0.5 * s * p[2], p[2]] for p in points]


def anywhere(points, rng):
    return [[rng.uniform(-1, 1) for _ in range(3)] for _ in points]


def mirrored(points, rng):
    return [[-p[0], p[1], p[2]] for p in points]


def far_away(points, rng):
    s = rng.choice([1e3, 1e8, 1e15])
    return [[x + s for x in p] for p in points]


def unchanged(points, rng):
    return points


DEFORMATIONS = [
    unchanged, unchanged, unchanged, jittered, spiky, spiky, coincident, coincident, one_spot, flat, straight, needle, sheared,
    anywhere, mirrored, far_away,
]
SCALES = [1.0] * 7 + [1e-160, 1e160, 1e-30, 1e30, 1e-6, 1e6, 1e-100, 1e100, 1e-300, 1e300]
QUICK = 26


def surface(seed, number, quick):
    """Surface `number` of a seed: (name, points, quads, hexes)."""
    rng = random.Random(f"{seed}-{number}")
    family = TURNS[number % len(TURNS)]
    points, quads, *hexes = FAMILIES[family](rng)
    for _ in range(20):
        if not quick or len(quads) <= QUICK:
            break
        points, quads, *hexes = FAMILIES[family](rng)
    deform, scale = rng.choice(DEFORMATIONS), rng.choice(SCALES)
    points = [[scale * x for x in p] for p in deform(points, rng)]
    return f"{number:04}_{family}_{len(quads)}_{deform.__name__}_{scale:g}", points, quads, *hexes


def write(folder, name, points, quads, hexes=None):
    """An OBJ file, or a MEDIT file where there are hexes; returns its path."""
    ids = lambda cells, end="": [" ".join(str(v + 1) for v in cell) + end for cell in cells]
    if hexes is None:
        lines = [f"v {x!r} {y!r} {z!r}" for x, y, z in points] + ["f " + face for face in ids(quads)]
    else:
        lines = ["MeshVersionFormatted 2", "Dimension 3", f"Vertices {len(points)}"]
        lines += [f"{x!r} {y!r} {z!r} 0" for x, y, z in points]
        lines += [f"Quadrilaterals {len(quads)}", *ids(quads, " 1"), f"Hexahedra {len(hexes)}", *ids(hexes, " 1"), "End"]
    path = folder / (name + (".obj" if hexes is None else ".mesh"))
    path.write_text("\n".join(lines) + "\n")
    return path


def run(command, limit):
    """Exit code (None: killed for time), stdout, stderr, seconds of CPU time of all its threads.

    CPU time is what the program needs; the wall would also count who else is at work on the machine. A hundred limits of wall
    time end a command that sleeps.
    """
    with tempfile.TemporaryFile("w+", errors="replace") as out, tempfile.TemporaryFile("w+", errors="replace") as err:
        limits = lambda: resource.setrlimit(resource.RLIMIT_CPU, (math.ceil(limit), math.ceil(limit) + 1))
        process = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=out, stderr=err, preexec_fn=limits)
        timer = threading.Timer(100 * limit, process.kill)
        timer.start()
        _, status, usage = os.wait4(process.pid, 0)
        timer.cancel()
        process.returncode = os.waitstatus_to_exitcode(status)
        code = None if process.returncode in (-signal.SIGXCPU, -signal.SIGKILL) else process.returncode
        out.seek(0)
        err.seek(0)
        return code, out.read(), err.read(), usage.ru_utime + usage.ru_stime


def try_one(number, args):
    """Makes a surface and runs the three commands over it: a row."""
    name, points, quads, *hexes = surface(args.seed, number, args.quick)
    path, out = write(args.out, name, points, quads, *hexes), args.out / f"{name}.vtu"
    out.unlink(missing_ok=True)
    code, text, err, seconds = run([args.hexfill, "fill", str(path), "-o", str(out), "--json", *args.more], args.limit)
    row = {"surface": name, "family": name.split("_")[1], "quads": len(quads), "code": code, "seconds": seconds}
    row["why"] = last_line(err) or "; ".join(parsed(text).get("notes", []))[:200]
    if code is None:
        row["outcome"] = "TIMEOUT"
    elif panicked(code, err):
        row["outcome"] = "PANIC"
    elif out.exists():
        judge(row, path, out, args, " ".join(parsed(text).get("notes", [])))
    else:
        row["outcome"] = {1: "none", 2: "refused"}.get(code, "WRONG")
    code, _, err, row["doctor"] = run([args.hexfill, "doctor", str(path)], args.limit)
    if panicked(code, err):
        row.update(outcome="PANIC", why="doctor: " + last_line(err))
    elif code is None:
        row.update(outcome="TIMEOUT", why="doctor")
    out.unlink(missing_ok=True)
    if row["outcome"] not in BAD and not args.keep:
        path.unlink()
    return row


def judge(row, path, out, args, notes):
    """The outcome of a mesh, from the files alone. Regions are no surface to compare with, and may lie apart; where the file has solids that
    touch in edges or vertices alone, fill has to say that the whole is no manifold."""
    is_regions = row["family"] in ("walls", "non-manifold", "void")
    against = [] if is_regions else ["--surface", str(path)]
    code, text, err, _ = run([args.hexfill, "check", str(out), *against, "--json"], args.limit)
    if code is None or panicked(code, err):
        row.update(outcome="TIMEOUT" if code is None else "PANIC", why="check: " + last_line(err))
        return
    report = parsed(text)
    levels = {entry["level"]: entry["outcome"] for entry in report.get("levels", [])}
    broken = {v["rule"] for v in report.get("failures", []) if v["level"] == "L3"}
    allowed = {"mesh-disconnected"} | ({"edge-pinched", "vertex-pinched"} if "no manifold" in notes else set())
    if is_regions and broken and broken <= allowed:
        levels["L3"] = "passed"
    passed = [level for level in ("L1", "L2", "L3", "L4", "L5") if levels.get(level) == "passed"]
    if len(passed) == 5 and row["code"] == 0:
        row["outcome"] = "certified"
    elif row["code"] == 1 and {"L1", "L2", "L3"} <= set(passed):
        row["outcome"] = "invalid"
    else:
        row.update(outcome="WRONG", why=f"fill ended with {row['code']}, check with {code}: passed {passed}")


def summary(family, rows):
    counts = Counter(row["outcome"] for row in rows)
    seconds = sorted(row["seconds"] for row in rows)
    numbers = [len(rows), *(counts[o] for o in OUTCOMES), f"{seconds[len(rows) // 2]:.2f}", f"{seconds[-1]:.1f}"]
    return f"| {family} | " + " | ".join(map(str, numbers)) + " |"


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("hexfill", help="the program to run")
    parser.add_argument("--count", type=int, default=2000, metavar="N", help="how many surfaces [2000]")
    parser.add_argument("--first", type=int, default=0, metavar="I", help="number of the first [0]")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--only", metavar="FAMILY", choices=FAMILIES)
    parser.add_argument("--quick", action="store_true", help=f"surfaces of at most {QUICK} quads")
    parser.add_argument("--limit", type=float, default=60, metavar="SECONDS", help="kill a command after this much CPU time [60]")
    parser.add_argument("--jobs", type=int, default=1, metavar="N", help="surfaces at a time [1]")
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("hostile-out"), help="folder for surfaces that went wrong")
    parser.add_argument("--keep", action="store_true", help="keep all surfaces")
    parser.add_argument("--make-only", action="store_true", help="write the surfaces and run nothing")
    parser.add_argument("--json", type=pathlib.Path, metavar="FILE", help="also write all rows as JSON")
    cut = sys.argv.index("--") if "--" in sys.argv else len(sys.argv)
    return parser.parse_args(sys.argv[1:cut], argparse.Namespace(more=sys.argv[cut + 1:]))


def main():
    args = arguments()
    args.out.mkdir(parents=True, exist_ok=True)
    numbers = range(args.first, args.first + args.count)
    if args.only:
        numbers = [i for i in numbers if TURNS[i % len(TURNS)] == args.only]
    if args.make_only:
        for i in numbers:
            write(args.out, *surface(args.seed, i, args.quick))
        return 0
    rows = []
    with concurrent.futures.ThreadPoolExecutor(args.jobs) as pool:
        for row in pool.map(lambda i: try_one(i, args), numbers):
            rows.append(row)
            if row["outcome"] in BAD:
                print(f"{row['outcome']}: {row['surface']} after {row['seconds']:.1f} s: {row['why']}", flush=True)
            if args.json:
                args.json.write_text(json.dumps(rows, indent=1) + "\n")
    print("\n" + table_head(["family", "surfaces", *OUTCOMES, "median s", "most s"]))
    for family in FAMILIES:
        of_family = [row for row in rows if row["family"] == family]
        if of_family:
            print(summary(family, of_family))
    print(summary("all", rows))
    return int(any(row["outcome"] in BAD for row in rows))


if __name__ == "__main__":
    sys.exit(main())
