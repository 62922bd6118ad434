#!/usr/bin/env python3
"""Runs `hexfill fill` and `hexfill check` over a folder of surfaces and prints a markdown table.

    tests/campaign.py HEXFILL FOLDER [--out WORK] [--only PATTERN] [--limit SECONDS] [--threads N] [--compare-threads]
                      [--jobs N] [--json FILE] [-- MORE FLAGS OF fill]

A surface whose name stands in FOLDER/references.json (written by `cargo run --release --example make_solids -- FOLDER`) is
compared with the mesh known for it. A run is one of

    certified  exit code 0, `check --surface` passes levels 1 to 5
    invalid    a mesh that check passes up to level 3 or 4 only
    none       no mesh, and a reason
    WRONG      fill claims more than check finds, or check finds less than level 3
    PANIC      exit code 70 or 101, a signal, or more than one line about a panic
    TIMEOUT    killed after --limit
    DIFFERS    with --compare-threads: `-j 1` and `-j 2` did not write the same bytes

The last four make the exit code 1.
"""
import argparse
import concurrent.futures
import fnmatch
import json
import os
import pathlib
import signal
import subprocess
import sys
import time

SURFACES = (".obj", ".off", ".ply", ".vtk", ".vtu", ".mesh", ".msh", ".inp")
BAD = ("WRONG", "PANIC", "TIMEOUT", "DIFFERS")


def run(command, limit):
    """Exit code (None: killed for time), stdout, stderr, seconds. All processes of the command end with it."""
    start = time.monotonic()
    process = subprocess.Popen(
        command, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
        errors="replace", start_new_session=True,
    )
    try:
        out, err = process.communicate(timeout=limit)
        code = process.returncode
    except subprocess.TimeoutExpired:
        os.killpg(process.pid, signal.SIGKILL)
        out, err = process.communicate()
        code = None
    return code, out, err, time.monotonic() - start


def parsed(text):
    """The JSON of a report, or an empty one: a command that fails may print none."""
    try:
        value = json.loads(text)
    except ValueError:
        return {}
    return value if isinstance(value, dict) else {}


def panicked(code, err):
    return code is not None and (code in (70, 101) or code < 0) or "panicked at" in err or "internal error" in err


def last_line(text):
    lines = [line.strip() for line in text.splitlines() if line.strip()]
    errors = [line for line in lines if line.startswith("error")]
    return (errors or lines or [""])[-1][:160].replace("|", "/")


def engine(mesh):
    """Which engine made the mesh: the name of a route, or of a route that carries facts."""
    route = mesh.get("route", "")
    return route if isinstance(route, str) else "+".join(sorted(route)) if isinstance(route, dict) else str(route)


def fill(surface, out, args, threads):
    """One run of fill as a row."""
    out.unlink(missing_ok=True)
    command = [args.hexfill, "fill", str(surface), "-o", str(out), "--json", *args.more]
    if threads:
        command += ["-j", str(threads)]
    code, text, err, seconds = run(command, args.limit)
    report = parsed(text)
    row = {"surface": surface.name, "seconds": seconds, "code": code, "outcome": "none", "why": last_line(err)}
    if code is None:
        row["outcome"] = "TIMEOUT"
    elif panicked(code, err):
        row["outcome"] = "PANIC"
    elif report.get("meshes"):
        mesh = report["meshes"][0]
        geometry = mesh.get("geometry") or {}
        row.update(
            quads=mesh["quads"], hexes=mesh["hexes"], engine=engine(mesh), interior=mesh.get("interior_vertices"),
            tried=mesh.get("tried"), claimed_certified=geometry.get("certified"),
            # Without an embedding, exit code 0 says nothing about geometry.
            claimed=code == 0 and "--no-embed" not in args.more,
        )
    else:
        row["why"] = report.get("error") or row["why"]
    return row


def judge(row, surface, out, args):
    """Has the outcome judged from the files alone."""
    code, text, err, _ = run([args.hexfill, "check", str(out), "--surface", str(surface), "--json"], args.limit)
    report = parsed(text)
    if panicked(code, err):
        row.update(outcome="PANIC", why="check: " + last_line(err))
        return
    levels = {entry["level"]: entry["outcome"] for entry in report.get("levels", [])}
    passed = [level for level in ("L1", "L2", "L3", "L4", "L5") if levels.get(level) == "passed"]
    geometry = report.get("geometry") or {}
    quality = geometry.get("quality") or {}
    row["certified_hexes"] = geometry.get("certified")
    row["sj"] = (quality.get("certified_scaled_jacobian") or [None])[0]
    row["mean"] = quality.get("mean_corner_scaled_jacobian")
    if len(passed) == 5:
        row["outcome"] = "certified"
    elif not {"L1", "L2", "L3"} <= set(passed):
        row.update(outcome="WRONG", why=f"check: passed {passed}")
    elif row["claimed"]:
        row.update(outcome="WRONG", why=f"fill ended with 0, check: passed {passed}")
    else:
        row["outcome"] = "invalid"


def campaign(surface, args, references):
    """Everything about one surface."""
    out = args.out / (surface.stem + ".vtu")
    row = fill(surface, out, args, 1 if args.compare_threads else args.threads)
    reference = references.get(surface.name, {})
    row["kind"] = reference.get("kind") or surface.stem.split("_")[0]
    row["reference"] = {key: reference.get(key) for key in ("hexes", "scaled_jacobian")}
    row.setdefault("quads", reference.get("quads"))
    if "hexes" in row:
        if out.exists():
            judge(row, surface, out, args)
        else:
            row.update(outcome="WRONG", why="fill reports a mesh and wrote none")
    if args.compare_threads and "hexes" in row:
        other = args.out / (surface.stem + ".j2.vtu")
        again = fill(surface, other, args, 2)
        row["seconds_2"] = again["seconds"]
        if again["outcome"] in BAD:
            row.update(outcome=again["outcome"], why="-j 2: " + again["why"])
        elif not other.exists() or other.read_bytes() != out.read_bytes():
            row.update(outcome="DIFFERS", why="-j 1 and -j 2 wrote other bytes")
        other.unlink(missing_ok=True)
    if not args.keep:
        out.unlink(missing_ok=True)
    return row


def number(value, digits):
    return "-" if value is None else f"{value:.{digits}f}" if digits else str(value)


def per_quad(row):
    return row["hexes"] / row["quads"] if row.get("hexes") and row.get("quads") else None


HEADER = ["surface", "quads", "hexes", "hexes/quad", "SJ", "mean SJ", "seconds", "engine", "outcome", "known hexes", "known SJ"]


def line(row):
    known = row["reference"]
    outcome = row["outcome"]
    if outcome == "invalid":
        outcome += f" ({row['hexes'] - (row.get('certified_hexes') or 0)} hexes)"
    cells = [
        row["surface"], number(row.get("quads"), 0), number(row.get("hexes"), 0), number(per_quad(row), 2),
        number(row.get("sj"), 3), number(row.get("mean"), 3), number(row["seconds"], 1), row.get("engine", "-"), outcome,
        number(known["hexes"], 0), number(known["scaled_jacobian"], 3),
    ]
    if row["outcome"] not in ("certified", "invalid"):
        cells[8] += f": {row['why']}"
    return "| " + " | ".join(cells) + " |"


def extreme(pick, values, digits):
    values = [value for value in values if value is not None]
    return number(pick(values), digits) if values else "-"


def summary(kind, rows):
    """A line about the surfaces of one kind."""
    count = lambda *outcomes: sum(row["outcome"] in outcomes for row in rows)
    known = [row for row in rows if row.get("hexes") and row["reference"]["hexes"]]
    ratios = [row["hexes"] / row["reference"]["hexes"] for row in known]
    sound = [row for row in known if row["outcome"] == "certified" and row["reference"]["scaled_jacobian"]]
    jacobians = [row["sj"] / row["reference"]["scaled_jacobian"] for row in sound]
    cells = [
        kind, str(len(rows)), str(count("certified")), str(count("invalid")), str(count("none")), str(count("WRONG")),
        str(count("PANIC")), str(count("TIMEOUT")), str(count("DIFFERS")), extreme(max, map(per_quad, rows), 2),
        extreme(min, (row.get("sj") for row in rows), 3), extreme(max, (row["seconds"] for row in rows), 1),
        extreme(max, ratios, 2), str(sum(ratio <= 1.1 for ratio in ratios)) + f"/{len(ratios)}",
        str(sum(ratio >= 0.95 for ratio in jacobians)) + f"/{len(known)}",
    ]
    return "| " + " | ".join(cells) + " |"


SUMMARY = [
    "kind", "surfaces", "certified", "invalid", "none", "wrong", "panicked", "timed out", "differ", "max hexes/quad", "min SJ",
    "max seconds", "max hexes/known", "hexes <= 1.1 known", "SJ >= 0.95 known",
]


def table_head(names):
    return "| " + " | ".join(names) + " |\n|" + "---|" * len(names)


def arguments():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    words = sys.argv[1:]
    more = words[words.index("--") + 1:] if "--" in words else []
    words = words[:words.index("--")] if "--" in words else words
    parser.add_argument("hexfill", help="the program to run")
    parser.add_argument("folder", type=pathlib.Path, help="surfaces; references.json if there is one")
    parser.add_argument("--out", type=pathlib.Path, default=pathlib.Path("campaign-out"), help="folder for the meshes")
    parser.add_argument("--keep", action="store_true", help="keep the meshes")
    parser.add_argument("--only", action="append", metavar="PATTERN", help="surfaces with such names (solid_*); may be repeated")
    parser.add_argument("--most-quads", type=int, metavar="N", help="leave out references with more quads")
    parser.add_argument("--limit", type=float, default=600, metavar="SECONDS", help="kill a run after this long [600]")
    parser.add_argument("--threads", type=int, metavar="N", help="-j of each run [all cores]")
    parser.add_argument("--jobs", type=int, default=1, metavar="N", help="surfaces at a time [1]")
    parser.add_argument("--compare-threads", action="store_true", help="run with -j 1 and -j 2 and compare the bytes")
    parser.add_argument("--json", type=pathlib.Path, metavar="FILE", help="also write all rows as JSON")
    parser.add_argument("--summary-only", action="store_true", help="no line for a surface unless it went wrong")
    args = parser.parse_args(words)
    args.more = more
    return args


def main():
    args = arguments()
    args.out.mkdir(parents=True, exist_ok=True)
    facts = args.folder / "references.json"
    references = json.loads(facts.read_text()) if facts.exists() else {}
    surfaces = sorted(path for path in args.folder.iterdir() if path.suffix in SURFACES)
    if args.only:
        surfaces = [path for path in surfaces if any(fnmatch.fnmatch(path.name, pattern) for pattern in args.only)]
    if args.most_quads is not None:
        surfaces = [path for path in surfaces if references.get(path.name, {}).get("quads", 0) <= args.most_quads]
    if not surfaces:
        sys.exit(f"no surfaces in {args.folder}")
    rows = []
    print(table_head(HEADER), flush=True)
    with concurrent.futures.ThreadPoolExecutor(args.jobs) as pool:
        # In the order of the names, each as soon as it and all before it are done.
        for row in pool.map(lambda surface: campaign(surface, args, references), surfaces):
            rows.append(row)
            if not args.summary_only or row["outcome"] in BAD:
                print(line(row), flush=True)
            if args.json:
                args.json.write_text(json.dumps(rows, indent=1) + "\n")
    print("\n" + table_head(SUMMARY))
    for kind in sorted({row["kind"] for row in rows}):
        print(summary(kind, [row for row in rows if row["kind"] == kind]))
    print(summary("all", rows))
    return int(any(row["outcome"] in BAD for row in rows))


if __name__ == "__main__":
    sys.exit(main())
