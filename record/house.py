#!/usr/bin/env python3
"""Counts of the house, as `record/house-*.md` gives them: `record/house.py [ROOT]` (a tree with `crates/`).

Files under `src/`; a test module at the end of a file, files of tests and examples are left out. A comment is a line that begins with `//`, a documentation
line one with `///` or `//!`; a function ends at the brace under its `fn`. Circles are strongly connected files by `use` of one another. Two functions are
duplicates if their bodies are the same but for white space, over at least 6 lines.
"""

import collections
import pathlib
import re
import sys

ROOT = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parent.parent)
FN = re.compile(r"^(\s*)(?:pub(?:\([a-z: ]+\))? )?(?:const )?(?:unsafe )?fn (\w+)")


def lines_of(path):
    lines = path.read_text().split("\n")
    for i, line in enumerate(lines[:-1]):
        if line.startswith("#[cfg(test)]") and re.match(r"mod \w+ \{", lines[i + 1]):
            return lines[:i]
    return lines


def functions(lines):
    """Name, first line and lines of every function; those inside another one belong to it."""
    at = 0
    while at < len(lines):
        head = FN.match(lines[at])
        if head is None:
            at += 1
            continue
        end = at
        while end + 1 < len(lines) and lines[end].rstrip() != head[1] + "}" and not (end == at and lines[at].rstrip().endswith("}")):
            if lines[end].rstrip().endswith(";") and "{" not in "".join(lines[at : end + 1]):
                break
            end += 1
        yield head[2], at + 1, lines[at : end + 1]
        at = end + 1


def module_of(path, src):
    parts = list(path.relative_to(src).with_suffix("").parts)
    return tuple(parts[:-1] if parts[-1] in ("mod", "lib", "main") else parts)


def uses(lines, module, modules):
    """Modules of the same crate that a file names, as deep as they are files."""
    found = set()
    text = "\n".join(line for line in lines if not line.strip().startswith("//"))
    text = re.sub(r"\{([^{}]*)\}", lambda m: "{" + m[1].replace("\n", " ") + "}", text)
    for root, rest in re.findall(r"\b((?:crate|super)(?:::super)*)::([\w:]+)", text):
        base = () if root == "crate" else module[: len(module) - 1 - root.count("::super")]
        path = base + tuple(p for p in rest.split("::") if p)
        for n in range(len(path), 0, -1):
            if path[:n] in modules:
                found.add(path[:n])
                break
    return found - {module}


def circles(graph):
    """Strongly connected components of more than one module (Tarjan)."""
    index, low, stack, on, found = {}, {}, [], set(), []

    def visit(v):
        index[v] = low[v] = len(index)
        stack.append(v)
        on.add(v)
        for w in graph[v]:
            if w not in index:
                visit(w)
                low[v] = min(low[v], low[w])
            elif w in on:
                low[v] = min(low[v], index[w])
        if low[v] == index[v]:
            part = []
            while True:
                w = stack.pop()
                on.discard(w)
                part.append(w)
                if w == v:
                    break
            if len(part) > 1:
                found.append(sorted("/".join(p) or "lib" for p in part))

    for v in sorted(graph):
        if v not in index:
            visit(v)
    return found


def main():
    sys.setrecursionlimit(10000)
    total = collections.Counter()
    per_crate = collections.defaultdict(collections.Counter)
    long, bodies, all_circles, longest_file, doctests, n_files, silent = [], collections.defaultdict(list), [], (0, ""), 0, 0, 0
    for crate in sorted((ROOT / "crates").iterdir()):
        src = crate / "src"
        files = [p for p in sorted(src.rglob("*.rs")) if "test" not in p.name and p.name != "oracle.rs"]
        modules = {module_of(p, src) for p in files}
        graph = {m: set() for m in modules}
        for path in files:
            lines = lines_of(path)
            n_files += 1
            longest_file = max(longest_file, (len(path.read_text().split("\n")), str(path.relative_to(ROOT))))
            kinds = collections.Counter()
            for line in map(str.strip, lines):
                if line:
                    doc = line.startswith(("///", "//!"))
                    kinds["doc" if doc else "comment" if line.startswith("//") else "code"] += 1
            page = "\n".join(line for line in lines if line.startswith("//!"))
            silent += "Source:" not in page
            doctests += len(re.findall(r"^\s*//[/!] ```$", "\n".join(lines), re.M)) // 2
            for name, at, body in functions(lines):
                inner = [line.strip() for line in body]
                kinds["comment in"] += sum(line.startswith("//") and not line.startswith("///") for line in inner)
                kinds["code in"] += sum(bool(line) and not line.startswith("//") for line in inner)
                where = f"{path.relative_to(ROOT)}:{at} {name}"
                long.append((len(body), where))
                if len(body) >= 6:
                    bodies["".join("".join(inner[1:]).split())].append(where)
            per_crate[crate.name].update(kinds)
            total.update(kinds)
            graph[module_of(path, src)] |= uses(lines, module_of(path, src), modules)
        # A folder's page lists its files; that is no use of them.
        graph = {m: {w for w in ws if w[: len(m)] != m} for m, ws in graph.items() if m}
        graph = {m: {w for w in ws if w in graph} for m, ws in graph.items()}
        all_circles += [f"{crate.name}: {', '.join(c)}" for c in circles(graph)]
    for name, c in [*sorted(per_crate.items()), ("all", total)]:
        print(
            f"{name:20} code {c['code']:6}  comments {c['comment'] / max(1, c['code']):.4f}"
            f"  in functions {c['comment in'] / max(1, c['code in']):.4f}  documentation {c['doc'] / max(1, c['code']):.3f}"
        )
    long.sort(reverse=True)
    print(f"files {n_files}, longest {longest_file[0]} lines {longest_file[1]}; doctests about {doctests}; modules without a source {silent}")
    print(f"functions over 80 lines: {sum(n > 80 for n, _ in long)}; longest {long[0][0]} {long[0][1]}")
    print(f"circles: {len(all_circles)}", *all_circles, sep="\n  ")
    same = sorted((where for where in bodies.values() if len(where) > 1), key=len, reverse=True)
    print(f"duplicates: {len(same)}", *(" = ".join(where) for where in same[:12]), sep="\n  ")


main()
