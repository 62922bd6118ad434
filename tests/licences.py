#!/usr/bin/env python3
"""Every crate that hexfill builds on must be under a permissive licence. Reads `cargo metadata` on stdin."""
import json
import re
import sys

ALLOWED = {
    "MIT", "MIT-0", "Apache-2.0", "Apache-2.0 WITH LLVM-exception", "BSD-2-Clause", "BSD-3-Clause", "Zlib", "MPL-2.0",
    "CC0-1.0", "Unlicense", "0BSD", "BSL-1.0", "Unicode-3.0", "ISC",
}


def permitted(expression: str) -> bool:
    """Whether some way to read the SPDX expression uses allowed licences only ("/" is the old "OR")."""
    expression = expression.replace("/", " OR ")
    expression = re.sub(r"(\S+) WITH (\S+)", r"\1_WITH_\2", expression)
    words = re.findall(r"\(|\)|[^\s()]+", expression)
    python = " ".join(
        {"AND": "and", "OR": "or", "(": "(", ")": ")"}.get(w, str(w.replace("_WITH_", " WITH ") in ALLOWED)) for w in words
    )
    return bool(eval(python, {"__builtins__": {}}))  # only True, False, and, or, parentheses are left


bad = []
packages = json.load(sys.stdin)["packages"]
for package in packages:
    licence = package.get("license")
    if not licence or not permitted(licence):
        bad.append(f"{package['name']} {package['version']}: {licence or 'no licence named'}")
assert permitted("MIT OR GPL-3.0") and not permitted("GPL-3.0") and not permitted("MIT AND LGPL-2.1")
if bad:
    sys.exit("not permissive:\n  " + "\n  ".join(bad))
print(f"licences: {len(packages)} packages, all permissive")
