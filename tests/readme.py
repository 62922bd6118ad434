#!/usr/bin/env python3
"""Runs the README's first command word for word in a scratch copy of its outputs, and looks at what it wrote."""
import pathlib
import re
import shlex
import subprocess
import sys

root = pathlib.Path(__file__).resolve().parent.parent
commands = re.findall(r"^\$ (.+)$", (root / "README.md").read_text(), flags=re.M)
assert len(commands) == 2, f"the README has two commands: {commands}"
main, tests = commands
assert tests == "./test.sh", tests

outputs = [root / word for word in shlex.split(main) if word.endswith((".vtk", ".html", ".png"))]
assert len(outputs) == 3, outputs
for path in outputs:
    path.unlink(missing_ok=True)
try:
    run = subprocess.run(main, shell=True, cwd=root, capture_output=True, text=True)
    print(run.stderr[-600:])
    assert run.returncode == 0, f"exit code {run.returncode}"
    assert "16 quads filled with 36 hexes" in run.stderr
    assert "certified in all 36 hexes" in run.stderr
    mesh, page, picture = outputs
    lines = mesh.read_text().splitlines()
    assert sum(line.strip() == "12" for line in lines) == 36, "36 VTK hexahedra"
    assert page.read_text().rstrip().endswith("</html>")
    assert picture.read_bytes().startswith(b"\x89PNG")
    check = subprocess.run(
        ["cargo", "run", "--release", "-q", "--", "check", mesh.name, "--surface", ":schneiders-pyramid"],
        cwd=root, capture_output=True, text=True,
    )
    assert check.returncode == 0, check.stdout + check.stderr
finally:
    for path in outputs:
        path.unlink(missing_ok=True)
print("README: the main command does what it says")
sys.exit(0)
