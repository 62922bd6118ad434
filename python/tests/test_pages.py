"""What people read is run: the tutorial, the chapter of the book, the README."""

import contextlib
import io
import os
import pathlib
import re

import pytest
from conftest import REPOSITORY, box


def test_the_tutorial(tmp_path):
    nbclient, nbformat = pytest.importorskip("nbclient"), pytest.importorskip("nbformat")
    notebook = nbformat.read(REPOSITORY / "python" / "tutorial.ipynb", as_version=4)
    assert not any(cell.get("outputs") for cell in notebook.cells), "the notebook is kept without outputs"
    client = nbclient.NotebookClient(notebook, timeout=300, kernel_name="python3", resources={"metadata": {"path": tmp_path}})
    client.execute()
    kinds = [kind for cell in notebook.cells for output in cell.get("outputs", []) for kind in output.get("data", {})]
    # Two pictures of PyVista, two pages of the viewer.
    assert kinds.count("image/png") >= 2 and kinds.count("text/html") >= 2, kinds
    if folder := os.environ.get("HEXFILL_TUTORIAL_OUT"):
        nbformat.write(notebook, pathlib.Path(folder) / "tutorial.ipynb")


def blocks(page: str):
    """The blocks of code of a page: language and text."""
    return re.findall(r"^```(\w+)\n(.*?)^```$", page, flags=re.M | re.S)


def run_page(path: pathlib.Path, names: dict) -> int:
    """Runs the blocks marked python; one marked text right after must be what was printed, `[..]` standing for anything."""
    printed, count = "", 0
    for language, text in blocks(path.read_text(encoding="utf-8")):
        if language == "python":
            out = io.StringIO()
            with contextlib.redirect_stdout(out):
                exec(compile(text, str(path), "exec"), names)
            printed, count = out.getvalue(), count + 1
        elif language == "text":
            pattern = ".*".join(map(re.escape, text.split("[..]")))
            assert re.fullmatch(pattern, printed), f"{path}: printed\n{printed}\nthe page shows\n{text}"
    return count


def test_the_chapter_of_the_book(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    assert run_page(REPOSITORY / "book" / "src" / "python.md", {}) >= 7


def test_the_readme(monkeypatch):
    pyvista = pytest.importorskip("pyvista")
    monkeypatch.setattr(pyvista, "OFF_SCREEN", True)
    points, quads = box(2, 2, 2)
    assert run_page(REPOSITORY / "python" / "README.md", {"points": points, "quads": quads}) == 1
